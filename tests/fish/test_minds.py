"""What fishes want, with typed-in percepts: Tu 1996, chapters 5 and 6."""

import itertools
import math

import pytest

import bioscope as bio

LENGTH = 0.1
MOUTH = 0.048


def mind(role="generic", *, kind=bio.minds.Intentions, habits=(), **temper):
    names = {"species": "clownfish", "enemies": ["shark"], "food": ["plankton"]}
    return kind(role, habits=habits, **names, **{"stagger": 0.0} | temper)


def thing(number, species, place, **more):
    return {"id": number, "species": species, "position": place, "heading": (0, 0, 1)} | more


def food(number, place):
    return thing(number, "plankton", place, size=0.01)


def mate(number, place, **display):
    shown = {"sex": "female", "act": "courting"} | display
    return thing(number, "clownfish", place, display=shown)


def percepts(**more):
    return {
        "id": 1,
        "dt": 1 / 30,
        "body_length": LENGTH,
        "depth": 3.0,
        "velocity": (0, 0, 0.1),
        "temperature": 24.0,
        "light": 0.5,
    } | more


ROCK = {"distance": 0.1, "aim": (0.1, 0, 0.1)}


def after(one, seconds, **more):
    """Let a mind live for some seconds; returns its last decision."""
    for tick in range(round(seconds * 30)):
        wanted = one.decide(percepts(time=tick / 30, **more))
    return wanted


def at(degrees, far):
    angle = math.radians(degrees)
    return (far * math.sin(angle), 0.0, far * math.cos(angle))


@pytest.mark.capability("TF-101", "TF-106", "AA-038")
def test_hunger_has_the_published_values():
    def hunger(fed):
        one = mind()
        one.decide(percepts(fed=fed, smelled=[food(5, (0, 0, MOUTH + 0.01))]))
        return one.hunger

    # n = a with food at the mouth: 0.8. n = 2 a: nothing. Feeding stops at (1.8 - r) a = 7.5.
    assert hunger(5) == pytest.approx(0.8, abs=1e-5)
    assert hunger(10) == 0
    assert hunger(7) > 0.3 > hunger(8)


@pytest.mark.capability("TF-106", "AA-058")
def test_a_full_fish_digests_and_is_hungry_again():
    one = mind()
    one.decide(percepts(fed=10))
    assert one.hunger == 0
    assert one.intention != "eat"
    # 1 / p0 = 1492.5 steps at 30 steps per second.
    assert after(one, 49).get("behavior") is not None
    assert one.hunger < 1
    after(one, 2)
    assert one.hunger == 1
    assert one.values["eaten"] == 0


@pytest.mark.capability("TF-102", "AA-038")
def test_libido_grows_after_mating_and_hunger_stills_it():
    one = mind()
    one.decide(percepts(fed=9))
    # With H near 0 libido saturates at 1 / p1 = 400 steps.
    after(one, 6.5)
    assert 0.4 < one.libido < 0.6
    hungry = mind()
    after(hungry, 20)
    assert hungry.hunger == 1
    assert hungry.libido == 0


@pytest.mark.capability("TF-103", "AA-038")
def test_fear_is_the_sum_over_predators_in_view():
    def fear(*distances):
        one = mind()
        one.decide(percepts(seen=[thing(9, "shark", (0, 0, far)) for far in distances]))
        return one.fear

    reach = 200 / 14 * LENGTH
    assert fear() == 0
    assert fear(2 * reach) == pytest.approx(0.5, abs=1e-3)
    assert fear(2 * reach, 4 * reach) == pytest.approx(0.75, abs=1e-3)
    assert fear(reach / 2) == fear(2 * reach, 2 * reach, 2 * reach) == 1


@pytest.mark.capability("TF-104")
def test_ravenous_manic_and_timid_tempers_show():
    ravenous, nominal = mind(digestion=0.005), mind()
    for one in (ravenous, nominal):
        one.decide(percepts(fed=7))
        after(one, 6)
    assert ravenous.hunger > nominal.hunger + 0.5
    manic, nominal = mind(libido_growth=0.01), mind()
    for one in (manic, nominal):
        one.decide(percepts(fed=9))
        after(one, 3)
    assert manic.libido > 3 * nominal.libido
    shark = [thing(9, "shark", (0, 0, 5.0))]
    coward, nominal = mind(fear_distance=500 / 14), mind()
    for one in (coward, nominal):
        one.decide(percepts(fed=9, seen=shark))
    assert coward.intention == "escape"
    assert nominal.intention != "escape"


@pytest.mark.capability("TF-105", "TF-110", "AA-041")
def test_a_courting_fish_snatches_food_and_returns_to_the_same_mate():
    one = mind("pacifist")
    seen = [mate(5, (0, 0, 0.25)), mate(8, (0.35, 0, 0))]
    one.decide(percepts(fed=5, seen=seen))
    assert after(one, 16, seen=seen)["target"] == 5
    assert one.intention == "mate"
    one.decide(percepts(time=20, seen=seen, smelled=[food(6, (0.02, 0, 0.08))]))
    assert (one.intention, one.target) == ("eat", 6)
    one.decide(percepts(time=20.1, seen=seen, fed=1))
    assert (one.intention, one.target) == ("mate", 5)


@pytest.mark.capability("TF-107", "TF-108", "AA-039")
@pytest.mark.parametrize(
    ("more", "habits", "expected"),
    [
        ({"ahead": ROCK, "seen": [thing(9, "shark", (0.6, 0, 0))]}, (), "avoid"),
        ({"seen": [thing(4, "crab", (0, 0, 0.06)), thing(9, "shark", (0.6, 0, 0))]}, (), "avoid"),
        (
            {"seen": [thing(9, "shark", (0.6, 0, 0))], "smelled": [food(6, (0.2, 0, 0))]},
            (),
            "escape",
        ),
        ({"seen": [thing(9, "shark", (2.2, 0, 0))]}, ("school",), "school"),
        ({"seen": [thing(9, "shark", (2.2, 0, 0))]}, (), "escape"),
        ({"smelled": [food(6, (0.2, 0, 0))]}, ("school",), "eat"),
        ({"fed": 9, "seen": [thing(3, "clownfish", (0.3, 0, 0))]}, ("school",), "school"),
        ({"fed": 9, "light": 0.9}, ("dark",), "leave"),
        ({"fed": 9, "light": 0.1}, ("dark",), "wander"),
        ({"fed": 9, "temperature": 18.0}, ("warm",), "leave"),
        ({"fed": 9, "temperature": 18.0}, ("warm", "cold"), "wander"),
    ],
)
def test_one_intention_by_priority(more, habits, expected):
    one = mind(habits=habits)
    assert one.decide(percepts(**more))["behavior"] == expected


@pytest.mark.capability("TF-109")
def test_equal_drives_are_decided_once():
    # Libido rises through hunger: where they are equal it keeps what it does.
    one = mind("pacifist", fatigue_time=1e5)
    seen = [mate(5, (0, 0.068, 0.01))]
    one.decide(percepts(fed=3, seen=seen))
    course = []
    for tick in range(900):
        course.append(one.decide(percepts(time=tick / 30, seen=seen))["behavior"])
    changes = sum(a != b for a, b in itertools.pairwise(course))
    assert changes <= 1, course


@pytest.mark.capability("TF-110", "AA-041")
def test_after_an_obstacle_the_same_target_is_taken_up_again():
    one = mind("pacifist")
    morsels = [food(6, (0.3, 0, 0.3)), food(7, (-0.35, 0, 0.35))]
    assert after(one, 0.2, smelled=morsels)["target"] == 6
    assert after(one, 0.3, smelled=morsels, ahead=ROCK)["behavior"] == "avoid"
    nearer = [morsels[0], food(7, (-0.28, 0, 0.28))]
    wanted = one.decide(percepts(smelled=nearer))
    assert (wanted["behavior"], wanted["target"], one.values["resumed"]) == ("eat", 6, True)
    one.decide(percepts(smelled=nearer, ahead=ROCK))
    assert one.decide(percepts(smelled=nearer[1:]))["target"] == 7, "what is gone is forgotten"


@pytest.mark.capability("TF-111")
def test_a_resumed_courtship_resists_where_a_new_one_gives_way():
    def interrupted(yes):
        one = mind("pacifist", fatigue_time=1e5)
        seen = [mate(5, (0, 0.068, 0.01))]
        one.decide(percepts(fed=4, seen=seen))
        assert after(one, 10, seen=seen)["behavior"] == "mate"
        if yes:
            one.decide(percepts(seen=seen, ahead=ROCK))
            assert one.decide(percepts(seen=seen))["behavior"] == "mate"
        tempting = [food(6, (0, 0, MOUTH + 0.0465))]
        wanted = one.decide(percepts(seen=seen, smelled=tempting))
        assert one.libido < one.hunger < one.libido + 0.2
        return wanted["behavior"]

    assert (interrupted(False), interrupted(True)) == ("eat", "mate")


@pytest.mark.capability("TF-112")
def test_a_hungry_fish_without_food_does_other_things_now_and_then():
    def share(fatigue_time):
        one, other = mind("pacifist", fatigue_time=fatigue_time), 0
        for tick in range(3000):
            other += one.decide(percepts(time=tick / 30))["behavior"] != "eat"
        return other / 3000

    assert 0.1 < share(20) < 0.9
    assert share(1e5) == 0


@pytest.mark.capability("TF-113", "TF-144", "AA-042")
def test_the_fickle_zigzag_between_morsels_and_the_devoted_do_not():
    def switches(persistence):
        one, targets = mind("pacifist", persistence=persistence), []
        for tick in range(120):
            # Two morsels that are nearer in turn.
            swing = 0.03 * math.sin(tick / 8)
            morsels = [food(6, at(40, 0.3 + swing)), food(7, at(-40, 0.3 - swing))]
            targets.append(one.decide(percepts(time=tick / 30, smelled=morsels))["target"])
        return sum(a != b for a, b in itertools.pairwise(targets))

    counts = [switches(one) for one in (0.0, 0.2, 0.45, 5.0)]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] >= 3
    assert counts[-1] == 0


@pytest.mark.capability("TF-087", "AA-035")
def test_attention_rests_on_one_target():
    one = mind()
    many = [food(number, at(number * 20, 0.3 + 0.01 * number)) for number in range(2, 9)]
    wanted = one.decide(percepts(smelled=many, seen=[mate(20, at(50, 0.6)), mate(21, at(90, 0.7))]))
    roles = [role for role, _, _ in wanted["annotations"]]
    assert (wanted["target"], roles) == (2, ["heading", "target"])
    assert wanted["gaze"] == pytest.approx(many[0]["position"], abs=1e-6)


@pytest.mark.capability("TF-088", "TF-114", "AA-036")
def test_a_second_obstacle_and_food_decide_the_way_round_the_first():
    # D-34: an obstacle ahead, a second one to the left, food to the right.
    for seed in range(20):
        one = mind("pacifist")
        wanted = one.decide(
            percepts(
                ahead={"distance": 0.1, "aim": (0.001, 0, 0.12)},
                solids=[(0, 0, 0.1), (0.1, 0, 0.02)],
                smelled=[food(6, (-0.3, 0, 0.0))],
            ),
            seed=seed,
        )
        assert wanted["behavior"] == "avoid"
        assert wanted["turn"] < -0.3
    sides = set()
    for seed in range(20):
        wanted = mind("pacifist").decide(
            percepts(ahead={"distance": 0.1, "aim": (0.001, 0, 0.12)}), seed=seed
        )
        sides.add(wanted["turn"] > 0)
    assert sides == {True, False}, "without preferences it is chance"


@pytest.mark.capability("TF-089")
def test_a_discouraged_turn_is_weakened():
    aside = {"distance": 0.1, "aim": (0.08, 0, 0.12)}
    free = mind("pacifist").decide(percepts(ahead=aside))["turn"]
    walls = [(0, 0, 0.1), (0.1, 0, 0.02), (-0.1, 0, 0.02)]
    weak = mind("pacifist").decide(percepts(ahead=aside, solids=walls))["turn"]
    assert weak == pytest.approx(0.5 * free, rel=0.01), "min(1, 1.5 - 1)"


@pytest.mark.capability("TF-090", "TF-091", "TF-115")
def test_food_towards_the_mate_is_preferred_by_the_amorous():
    # D-33. 1 - d / O_r with O_r = 20 lengths: 0.80 ahead, 0.72 to the left.
    morsels = [food(6, (0, 0, MOUTH + 0.4)), food(7, (0.56, 0, MOUTH))]

    def chosen(seconds):
        one = mind("pacifist", appetite=20, libido_growth=0.01)
        one.decide(percepts(fed=11))
        after(one, seconds)
        one.decide(percepts(smelled=morsels, seen=[mate(5, (0.6, 0, 0), act="other")]))
        assert one.intention == "eat", (one.hunger, one.libido)
        return one.target

    assert (chosen(0.1), chosen(2.7)) == (6, 7)


@pytest.mark.capability("TF-093", "AA-040")
def test_the_timid_mind_what_the_bold_let_pass():
    def answers(timidity, far):
        one = mind("pacifist", timidity=timidity)
        return one.decide(percepts(fed=9, seen=[thing(4, "crab", (0, 0, far))]))["behavior"]

    assert [answers(0.5, 0.08), answers(1, 0.13), answers(2, 0.24)] == ["avoid"] * 3
    assert [answers(0.5, 0.13), answers(1, 0.24), answers(2, 0.5)] == ["wander"] * 3


@pytest.mark.capability("TF-092", "TF-094")
def test_the_feeler_is_one_body_length_and_the_worst_is_avoided_first():
    def answers(far):
        ahead = {"distance": far, "aim": (0.1, 0, far)}
        return mind("pacifist").decide(percepts(fed=9, ahead=ahead))["behavior"]

    # From the middle: 0.45 to the snout and one length of feeler.
    assert (answers(0.144), answers(0.146)) == ("avoid", "wander")
    crossing = [
        thing(3, "crab", (0.06, 0, 0.05), heading=(1, 0, 0)),
        thing(4, "crab", (0.0, 0, 0.06)),
    ]
    wanted = mind("pacifist").decide(percepts(fed=9, seen=crossing))
    assert (wanted["behavior"], wanted["target"]) == ("avoid", 4)


RULES = [
    # close, bearing, course of the predator, expected turn: sign, 2 for about, 0 for straight on
    (False, 10, 180, 2),
    (False, 170, 0, 0),
    (False, 90, 0, -1),
    (False, -90, 0, 1),
    (True, 10, 90, -1),
    (True, 10, -90, 1),
    (True, 10, 180, 2),
    (True, 170, 0, -1),
    (True, -170, 0, 1),
    (True, 180, 90, -1),
    (True, 180, -90, 1),
    (True, 180, 180, 0),
    (True, 90, 180, -1),
    (True, -90, 180, 1),
]


@pytest.mark.capability("TF-124")
@pytest.mark.parametrize(("close", "bearing", "course", "expected"), RULES)
def test_every_rule_of_escape(close, bearing, course, expected):
    one = mind("prey")
    shark = thing(9, "shark", at(bearing, 0.5 if close else 0.9))
    shark |= {"velocity": at(course, 0.5), "heading": at(course, 1.0), "size": 0.5}
    wanted = one.decide(percepts(seen=[shark]))
    assert wanted["behavior"] == "escape"
    assert wanted["speed"] == pytest.approx(3.0)
    if expected == 2:
        assert abs(wanted["turn"]) > 3
    elif expected == 0:
        assert wanted["turn"] == 0
    else:
        assert wanted["turn"] * expected > 0.7


@pytest.mark.capability("TF-131", "TF-130", "AA-051")
def test_prey_is_chosen_by_its_cost():
    def chosen(*prey):
        one = bio.minds.Intentions("predator", food=["prey"], stagger=0.0, preference_weight=0.0)
        return one.decide(percepts(body_length=0.5, seen=list(prey)))["target"]

    def prey(number, degrees, far, act="other"):
        x, y, z = at(degrees, far)
        return thing(number, "prey", (x, y, z + 0.24), size=0.1, display={"act": act})

    assert chosen(prey(2, 0, 2.0), prey(3, 0, 1.9)) == 3
    assert chosen(prey(2, 0, 2.0), prey(3, 0, 1.5, "schooling")) == 2, "1.5 * 1.5 > 2"
    assert chosen(prey(2, 0, 2.0), prey(3, 180, 1.7)) == 2, "1.7 * 1.2 > 2"
    assert chosen(prey(2, 0, 2.0), prey(3, 180, 1.6)) == 3


@pytest.mark.capability("TF-130", "TF-133", "TF-134", "TF-005", "AA-004", "AA-054")
def test_the_three_types_differ_in_what_they_do_not_do():
    seen = [thing(9, "shark", (0, 0, 0.5)), mate(5, (0.5, 0, 0))]

    def wants(role):
        one = mind(role)
        one.decide(percepts(fed=9, seen=seen))
        return after(one, 14, seen=seen)["behavior"]

    assert [wants(role) for role in ("predator", "prey", "pacifist")] == [
        "wander",
        "escape",
        "mate",
    ]


@pytest.mark.capability("TF-135", "AA-055")
def test_males_prefer_the_near_and_females_the_large_of_their_species():
    def chosen(female, *others):
        habits = ("female",) if female else ()
        one = mind("pacifist", habits=habits, preference_weight=0.0)
        one.decide(percepts(fed=9, seen=list(others)))
        return after(one, 13, seen=list(others))["target"]

    def male(number, place, size, species="clownfish"):
        return thing(number, species, place, size=size, display={"sex": "male", "act": "courting"})

    assert chosen(False, mate(5, (0, 0, 0.6)), mate(6, (0, 0, 0.3))) == 6
    stranger = mate(6, (0, 0, 0.3)) | {"species": "angelfish"}
    assert chosen(False, mate(5, (0, 0, 0.6)), stranger) == 5
    assert chosen(True, male(5, (0, 0, 0.3), 0.1), male(6, (0, 0, 0.6), 0.14)) == 6
    assert chosen(True, male(5, (0, 0, 0.3), 0.1), male(6, (0, 0, 0.6), 0.2, "angelfish")) == 5


@pytest.mark.capability("TF-100", "AA-037")
def test_habits_are_innate_and_unknown_ones_refused():
    assert mind(habits=("female",)).decide(percepts())["display"]["sex"] == "female"
    assert mind().decide(percepts())["display"]["sex"] == "male"
    with pytest.raises(bio.BioscopeError, match=r"lazy.*bright"):
        mind(habits=("lazy",))
    with pytest.raises(bio.BioscopeError, match=r"parasite.*predator"):
        mind("parasite")


KINDS = [bio.minds.Intentions, bio.minds.BehaviorNetwork, bio.minds.FreeFlow]


@pytest.mark.parametrize("kind", KINDS)
def test_minds_go_on_from_their_saved_state(kind):
    one = mind(kind=kind, habits=("school",))
    scene = {"seen": [mate(5, (0.2, 0, 0.3))], "smelled": [food(6, (0, 0, 0.3))]}
    after(one, 2, **scene)
    two = one.restored(one.save())
    for tick in range(60, 120):
        now = percepts(time=tick / 30, **scene)
        assert one.decide(now, seed=3) == two.decide(now, seed=3)
    assert one.save() == two.save()


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"velocity": (math.nan, 0, 0)}, "velocity"),
        ({"seen": [{"id": 1, "species": "x", "place": (0, 0, 0)}]}, "place.*position"),
        ({"ahead": {"distance": 1.0}}, "aim"),
        ({"hunger": 1.0}, "hunger.*smelled"),
        ({"attitude": (0, 0, 0, 0)}, "attitude"),
    ],
)
def test_impossible_percepts_are_refused(more, message):
    with pytest.raises(bio.BioscopeError, match=message):
        mind().decide(percepts(**more))


def test_impossible_tempers_are_refused():
    with pytest.raises(LookupError, match="courage"):
        mind(courage=1.0)
    with pytest.raises(ValueError, match="appetite"):
        mind(appetite=-1.0)
    with pytest.raises(LookupError, match=r"roamer.*intentions"):
        bio.RoamingFish(mind="roamer")
