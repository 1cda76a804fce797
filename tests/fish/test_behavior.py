"""What fishes do in a tank of points (see arena.py): Tu 1996, sections 6.4 and 6.5."""

import math

import numpy as np
import pytest
from arena import Arena, Fish, Pillar, distance, spread

import bioscope as bio

LENGTH = 0.1


def intentions(role, **more):
    names = {"species": "fish", "enemies": ["shark"], "food": ["plankton"]} | more
    return bio.minds.Intentions(role, **{"stagger": 0.0} | names)


def sated(role, **more):
    """A fish that is not hungry for a while."""
    one = intentions(role, **{"digestion": 0.0} | more)
    one.decide({"fed": 11})
    return one


def school(count, *, radius=0.25, seed=1, **more):
    return [
        Fish(
            number,
            "fish",
            sated("prey", habits=["school"], **more),
            place,
            yaw=0.4 * math.sin(number),
        )
        for number, place in enumerate(spread(count, seed, radius, height=0.08), start=1)
    ]


def nearest_distances(fishes):
    places = np.array([fish.place for fish in fishes])
    gaps = np.linalg.norm(places[:, None] - places[None], axis=2) + np.eye(len(places)) * 1e9
    return gaps.min(axis=1)


def polarization(fishes):
    return float(np.linalg.norm(np.mean([fish.heading for fish in fishes], axis=0)))


def clusters(fishes, link):
    """Return the number of groups whose members are linked by less than a distance."""
    left, count = set(range(len(fishes))), 0
    while left:
        count, edge = count + 1, [left.pop()]
        while edge:
            one = edge.pop()
            near = {
                other for other in left if distance(fishes[one].place, fishes[other].place) < link
            }
            left -= near
            edge += near
    return count


@pytest.mark.capability("TF-121", "TF-119", "AA-045", "AA-046", "AA-060")
def test_a_hungry_fish_eats_what_it_smells_until_it_is_full():
    places = spread(20, 3, 0.9)
    food = {100 + index: place for index, place in enumerate(places)}
    fish = Fish(1, "fish", intentions("pacifist"), (0.0, 0.0, 0.0))
    arena = Arena([fish], food=food)
    assert arena.run(60, until=lambda: fish.mind.hunger < 0.3 and fish.eaten >= 3), fish.eaten
    assert len(arena.food) == 20 - fish.eaten
    assert fish.mind.values["eaten"] >= 3


@pytest.mark.capability("TF-122", "AA-047")
def test_wanderers_lose_their_heading_and_stay_near_home():
    turned, farthest = [], 0.0
    for seed in range(12):
        fish = Fish(seed + 1, "fish", sated("pacifist", home_range=1.0), (0.0, 0.0, 0.0))
        arena = Arena([fish], seed=seed)
        before = fish.heading
        arena.run(20)
        turned.append(sum(a * b for a, b in zip(before, fish.heading, strict=True)))
        arena.run(60)
        farthest = max(farthest, math.hypot(*fish.place))
    assert abs(float(np.mean(turned))) < 0.6
    assert farthest < 3.0


@pytest.mark.capability("TF-123", "AA-059", "AA-037")
def test_those_who_like_the_dark_end_in_the_dark():
    def light(place):
        return min(1.0, max(0.0, 0.5 + place[0]))

    fishes = [
        Fish(
            number,
            "fish",
            sated("pacifist", habits=["dark"], home_range=1.5, libido_growth=0.0),
            place,
            yaw=number,
        )
        for number, place in enumerate(spread(10, 2, 0.8), start=1)
    ]
    arena = Arena(fishes, light=light)
    begin = np.mean([light(fish.place) for fish in fishes])
    arena.run(40)
    dark = []
    for _ in range(20):
        arena.run(1)
        dark += [light(fish.place) < 0.5 for fish in fishes]
    assert np.mean(dark) > 0.7
    assert begin > 0.4


def slalom(**temper):
    """Eight fishes among nine pillars; returns fish-steps inside a pillar and all fish-steps."""
    pillars = [Pillar(x, z, 0.12) for x in (-0.7, 0, 0.7) for z in (-0.7, 0, 0.7)]
    fishes = [
        Fish(number, "fish", sated("pacifist", home_range=1.0, **temper), place, yaw=number)
        for number, place in enumerate(spread(8, 5, 0.5), start=1)
    ]
    for fish in fishes:
        fish.place = (fish.place[0] + 0.35, fish.place[1], fish.place[2] + 0.35)
        if any(pillar.gap(fish.place) < 0.05 for pillar in pillars):
            fish.place = (0.35, fish.place[1], 0.35)
    arena, inside, steps = Arena(fishes, pillars=pillars), 0, 0
    for _ in range(1250):
        arena.step()
        inside += sum(pillar.gap(fish.place) < 0 for fish in fishes for pillar in pillars)
        steps += len(fishes)
    return inside, steps


@pytest.mark.capability("TF-117", "TF-092", "AA-043")
def test_nobody_enters_a_pillar():
    inside, steps = slalom()
    assert steps == 10_000
    assert inside == 0


@pytest.mark.capability("TF-118", "AA-043")
def test_crossing_fishes_avoid_each_other():
    overlaps = steps = 0
    for seed in range(6):
        fishes = []
        for number in range(10):
            angle = 2 * math.pi * number / 10 + 0.1 * seed
            place = (math.sin(angle) * 0.8, 0.02 * math.sin(5 * number), math.cos(angle) * 0.8)
            one = sated("pacifist", home_range=0.3)
            fishes.append(Fish(number + 1, "fish", one, place, yaw=angle + math.pi))
        arena = Arena(fishes, seed=seed)
        for _ in range(450):
            arena.step()
            # Bodies are a fifth as thick as long.
            overlaps += int((nearest_distances(fishes) < 0.2 * LENGTH).sum())
            steps += len(fishes)
    assert overlaps / steps < 0.01, overlaps / steps


@pytest.mark.capability("TF-120")
def test_turning_beyond_what_flees_aside_catches_it_sooner():
    def time_to_catch(lead, seed):
        angle = 0.7 + 0.1 * seed
        hunter = Fish(1, "hunter", None, (0.0, 0.0, 0.0), size=0.3, speed=0.3, maneuvers=True)
        hunter.mind = bio.minds.Intentions(
            "predator", species="hunter", food=["fish"], stagger=0.0, lead=lead, full_speed=2.0
        )

        class Straight:
            def decide(self, percepts, *, seed=0):
                wanted = {"behavior": "swim", "turn": 0.0, "pitch": 0.0, "brake": 0.0}
                return wanted | {"speed": 4.5, "mouth": 0.0, "target": None, "display": {}}

        place = (math.sin(angle) * 1.2, 0.0, math.cos(angle) * 1.2)
        prey = Fish(2, "fish", Straight(), place, yaw=angle + 1.3, speed=0.45)
        arena = Arena([hunter, prey], seed=seed)
        assert arena.run(30, until=lambda: len(arena.fishes) == 1)
        return arena.time

    leading = np.array([time_to_catch(0.5, seed) for seed in range(6)])
    plain = np.array([time_to_catch(0.0, seed) for seed in range(6)])
    assert leading.mean() < 0.97 * plain.mean(), (leading, plain)


@pytest.mark.capability("TF-124")
def test_those_who_escape_outlive_those_who_do_not():
    def survives(role, seed):
        angle = 2 * math.pi * seed / 20
        fish = Fish(1, "fish", sated(role), (0.0, 0.0, 0.0))
        place = (0.5 * math.sin(angle), 0.0, 0.5 * math.cos(angle))
        hunter = bio.minds.Intentions(
            "predator", species="shark", food=["fish"], stagger=0.0, full_speed=1.0
        )
        # As fast as the prey at most.
        shark = Fish(2, "shark", hunter, place, yaw=angle + math.pi, size=0.3)
        arena = Arena([fish, shark], seed=seed)
        return not arena.run(4, until=lambda: len(arena.fishes) == 1)

    assert sum(survives("prey", seed) for seed in range(20)) >= 16
    assert sum(survives("pacifist", seed) for seed in range(20)) <= 4


@pytest.mark.capability("TF-125", "AA-049")
def test_a_school_keeps_together_aligned_and_a_body_length_apart():
    fishes = school(20)
    arena = Arena(fishes)
    arena.run(15)
    aligned, gaps = [], []
    for _ in range(10):
        arena.run(1)
        aligned.append(polarization(fishes))
        gaps.append(nearest_distances(fishes).mean() / LENGTH)
    assert np.mean(aligned) > 0.8, aligned
    assert 0.7 < np.mean(gaps) < 1.5, gaps
    assert clusters(fishes, 3 * LENGTH) == 1


@pytest.mark.capability("TF-126", "TF-093")
def test_the_larger_the_region_the_looser_the_school():
    def spacing(timidity):
        fishes = school(14, timidity=timidity, spacing=0.5)
        arena, gaps = Arena(fishes), []
        arena.run(12)
        for _ in range(8):
            arena.run(1)
            gaps.append(nearest_distances(fishes).mean())
        return np.mean(gaps)

    tight, middle, loose = spacing(0.5), spacing(1.5), spacing(3.0)
    assert tight < middle < loose, (tight, middle, loose)


@pytest.mark.capability("TF-129", "TF-128")
def test_scattered_fish_gather_behind_a_leader():
    leader = Fish(99, "boss", None, (0.0, 0.0, 0.0), size=0.15)

    class Zigzag:
        def decide(self, percepts, *, seed=0):
            swing = 0.5 * math.sin(percepts["time"] * 0.8)
            turn = 0.4 * (swing - leader.yaw)
            return {
                "behavior": "lead",
                "turn": turn,
                "pitch": 0.0,
                "brake": 0.0,
                "speed": 0.6,
                "mouth": 0.0,
                "target": None,
                "display": {},
            }

    leader.mind = Zigzag()
    fishes = [
        Fish(number, "fish", sated("prey", habits=["school"], leaders=["boss"]), place, yaw=number)
        for number, place in enumerate(spread(12, 1, 1.0), start=1)
    ]
    arena = Arena([leader, *fishes])

    def members():
        return int((nearest_distances(fishes) < 2 * LENGTH).sum())

    assert members() <= 3
    arena.run(40)
    assert members() >= 0.9 * len(fishes)
    middle = np.mean([fish.place for fish in fishes], axis=0)
    assert distance(tuple(middle), leader.place) < 8 * LENGTH


@pytest.mark.capability("TF-127", "AA-050")
def test_a_school_splits_at_a_pillar_and_closes_behind_it():
    fishes = school(16, radius=0.22, home_range=1000)
    for fish in fishes:
        fish.yaw = 0.0
    arena = Arena(fishes)
    arena.run(6)
    middle = np.mean([fish.place for fish in fishes], axis=0)
    course = np.mean([fish.heading for fish in fishes], axis=0)
    course /= np.linalg.norm(course)
    ahead = middle + course * 1.2
    arena.pillars.append(Pillar(float(ahead[0]), float(ahead[2]), 0.12))
    counts, inside = [], 0
    for _ in range(45 * 30):
        arena.step()
        counts.append(clusters(fishes, 2 * LENGTH))
        inside += sum(arena.pillars[0].gap(fish.place) < 0 for fish in fishes)
    assert inside == 0
    assert max(counts) >= 2, counts[::30]
    assert (min(counts[:30]), counts[-1]) == (1, 1), counts[::30]


def courters(*sizes):
    """Males of these sizes and one female, sated and amorous."""
    amorous = {"libido_growth": 0.01, "mate_weight": 0.0, "home_range": 2.0, "spawning_depth": 0.5}
    fishes = [
        Fish(
            number,
            "fish",
            sated("pacifist", **amorous),
            (0.3 * number, 0.0, -0.3 * number),
            size=size,
        )
        for number, size in enumerate(sizes, start=1)
    ]
    she = sated("pacifist", habits=["female"], **amorous)
    return [*fishes, Fish(10, "fish", she, (-0.3, 0.0, 0.2))]


@pytest.mark.capability(
    "TF-136", "TF-137", "TF-138", "TF-139", "TF-140", "TF-141", "TF-143", "AA-057"
)
def test_a_pair_goes_through_all_stages_to_spawning():
    male, female = courters(0.1)
    arena, stages, touches, hovers = Arena([male, female], surface=1.0), [], 0, 0
    before = 0.0
    for _ in range(150 * 30):
        arena.step()
        for fish in (male, female):
            act = fish.display.get("act", "other")
            if (fish.id, act) not in stages:
                stages.append((fish.id, act))
        if female.display.get("act") == "nuzzling":
            hovers += female.speed < 0.3 * LENGTH
            if male.wanted["behavior"] != "mate":
                continue  # He avoids a collision, and backs off further afterwards.
            backing = male.wanted["speed"] < 0
            touches += backing and before >= 0
            before = male.wanted["speed"]
        if (10, "spawned") in stages:
            break
    for who in (1, 10):
        order = [act for number, act in stages if number == who and act in ACTS]
        assert order == ACTS, (who, stages)
    # The third touch ends it, so that he backs off twice.
    assert touches == 2
    assert hovers > 10
    # His has grown since he has spawned; neither cares for it.
    assert max(male.mind.libido, female.mind.libido) < 0.3


ACTS = ["courting", "circling", "ascending", "nuzzling", "spawned"]


@pytest.mark.capability("TF-142", "AA-056")
def test_the_larger_of_two_males_wins_and_the_other_leaves():
    small, large, female = courters(0.08, 0.12)
    large.place = (0.9, 0.0, 0.9)
    arena, partners = Arena([small, large, female], surface=1.0), []

    def chosen():
        partner = female.display.get("partner")
        if partner is not None and (not partners or partners[-1] != partner):
            partners.append(partner)
        return female.display.get("act") == "circling"

    assert arena.run(120, until=chosen), partners
    assert partners[-1] == large.id
    arena.run(3)
    assert small.display.get("partner") != female.id


@pytest.mark.capability("AA-061")
def test_the_region_shrinks_in_formation():
    # The same neighbor at the side: a threat to a wanderer, not to a member of the school.
    def answers(schooling):
        one = sated("generic", habits=["school"] if schooling else [])
        wanted = {}
        for tick in range(6):
            beside = {"id": 4, "species": "fish", "heading": (0, 0, 1), "velocity": (0, 0, 0.1)}
            place = (0.049 if tick > 4 else 0.12, 0, 0.0)
            now = {
                "time": tick / 30,
                "velocity": (0, 0, 0.1),
                "seen": [beside | {"position": place}],
            }
            wanted = one.decide(now)
        return wanted["behavior"]

    assert (answers(True), answers(False)) == ("school", "avoid")
