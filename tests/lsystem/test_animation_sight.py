"""Actors that see: their windows, and every function that asks what is in them."""

import math
import random

import msgspec
import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError, InvalidValueError
from bioscope.live.inspection import inspection
from bioscope.live.messages import Select
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import MATERIALS, Code

NONE = "() () () () () () ()"
BALL = (204, 102, 51)


def at(x: float, y: float, z: float) -> str:
    return "f () () () (2) " + " ".join(f"({abs(v)}{'_' if v < 0 else ''})" for v in (x, y, z))


def box(place: tuple[float, float, float], size: tuple[float, float, float], material: int) -> str:
    """Return a box around a place, in one of the materials."""
    x, y, z = place
    edges = " ".join(f"({one})" for one in size)
    return f"m () ({material}) () () () () ()\n{at(x - size[0] / 2, y, z)}\nc () () () () {edges}\n"


def scene(
    things: str, *options: str, actors: int = 1, rules: str = "", asked: str = ""
) -> Animation:
    """Return actors at the origin that look along x at some things, and ask something."""
    told = "\n".join(f"actorNbr_automata {one} {one} 9 fov 900" for one in range(actors))
    actor = f"[ {NONE}\nM () (7) () (0) () () ()\n"
    ask = "".join(f"b () () () () ({one}) () ()\n" for one in asked.split())
    text = (
        "Camera_AnimationParameters t_final_interval 60 0.04\n"
        f"Options\nNBR_actors {actors}\n{told}\n" + "\n".join(options) + "\n"
        f"Axiom\n{things}{actor}{ask}] {NONE}\nProductions\n{rules}EndProductions\n"
    )
    made = Animation(text)
    made.advance()
    return made


def answers(things: str, asked: str, *commands: str) -> list[float]:
    told = [f"actorNbr_automata 0 0 9 {one}" for one in commands]
    made = scene(things, *told, asked=asked)
    return [one.growth[0] for one in made.layers[0].string if one.symbol == "b"]


@pytest.mark.capability("NA-059", "NA-060")
def test_every_declared_actor_has_a_window_of_its_own():
    colors = (1, 3, 4, 5, 12)
    row = "".join(box((6, 0, 2.2 * n - 4.4), (1, 1, 1), one) for n, one in enumerate(colors))
    for most in (1, 3, 5, 9):
        made = scene(
            row,
            f"iVisionWinSize_maxColors 1 50 {most}",
            "iVisionWinSize 2 7 1",
            "actorNbr_automata 1 1 9 interest 1 0",
            actors=3,
        )
        assert list(made.windows) == [0, 1, 2]
        assert made.windows[0].color.shape == (40, 40, 3)
        window = made.windows[1]
        assert window.color.shape == (50, 50, 3)
        assert window.depth.shape == window.identity.shape == (50, 50)
        assert made.windows[2].identity.shape == (7, 7)
        seen = set(np.unique(window.identity)) - {0}
        assert len(seen) == min(most, 5) == len(window.codes)
        # What interests the actor is told apart first, though it is drawn last.
        assert window.codes[0] == Code("ball", BALL)
        assert (window.identity == 1).sum() > 20
        assert np.isfinite(window.depth[window.identity > 0]).all()
    assert Animation(f"Axiom\nb {NONE}\nProductions\nEndProductions\n").windows == {}


@pytest.mark.capability("NA-130", "NA-131")
def test_a_window_shows_what_is_drawn_and_where():
    wall = box((8.5, 0, 0), (1, 40, 40), 6)
    made = scene(wall + box((4, 0, -1), (1, 1, 1), 4))
    window = made.windows[0]
    points = window.points()
    assert len(points) == 1600
    near = points[:, 0] < 7
    assert 20 < near.sum() < 200
    # Pixels are projected back to the surfaces that they show: the wall, the box before it.
    assert points[~near, 0] == pytest.approx(8.0, abs=1e-4)
    assert np.abs(points[near] - (4, 0, -1)).max() <= 0.5 + 1e-4
    assert np.abs(np.abs(points[near] - (4, 0, -1)).max(axis=1) - 0.5).max() < 1e-4
    # To the eye and back: the same pixels at the same depths, but for the rounding of these.
    away = np.linalg.norm(points - window.camera.eye, axis=1)
    depths = window.depth.ravel()
    assert (np.abs(away - depths) <= 0.5 * np.spacing(depths)).all()
    centers = (np.arange(40) + 0.5) / 20 - 1
    places = [window.camera.project(tuple(one)) for one in points]
    assert np.abs(np.array(places) - [(x, -y) for y in centers for x in centers]).max() < 1e-9
    # The first pixel is at the left and the top, half a pixel from the edges of the view.
    assert points[0] == pytest.approx((8, 8 * 39 / 40, -8 * 39 / 40), abs=1e-3)
    assert window.color[0, 0] == pytest.approx(window.color[0, 1], rel=0.01)
    # A tree that only a rule draws is no less visible, and it is seen to grow.
    rule = "R (0.08) () () ()\n1.0\nO () () () () (2) (0.5) (0.5)\nEndProb\nEnd\n"
    grown = f"{at(5, -1, 0)}\n+ () () () () (90) () ()\nR () () () () (0.5) () ()\n"
    made = scene(grown, rules=rule)
    before = np.isfinite(made.windows[0].depth).sum()
    made.advance()
    after = made.windows[0]
    assert before < np.isfinite(after.depth).sum()
    assert after.points()[:, 1].max() > 0.7


@pytest.mark.capability("NA-153")
def test_bodies_go_with_actors_and_actors_with_rules():
    # `M` brings the turtle to the actor: its body is where it is, headed as it is.
    axiom = f"M () (7) () () () () ()\n? {NONE}\nf () () () () (5) () ()\n? {NONE}\n"
    made = scene(axiom, "actorNbr_automata 0 0 9 obs 2 1 3 lat 2 1 9")
    actor = made.actors[0]
    first, second = [one.parameters for one in made.layers[0].string if one.symbol == "?"]
    assert (first, actor.position) == ((2, 1, 3), (2, 1, 3))
    assert second == pytest.approx((2, 1, 8))
    # `g` brings the actor to the turtle, 30 degrees and 2 units farther in every frame.
    walk = f"M () (7) () () () () ()\n+ () () () () (30) () ()\nf () () () () (2) () ()\n? {NONE}\n"
    for symbol, height in ((f"g {NONE}", 1), ("g () (2) () () (0.5) () ()", 0.5)):
        made = scene(walk + f"{symbol}\n", "actorNbr_automata 0 0 9 obs 0 1 0 lat 1 1 0")
        actor, angle, place = made.actors[0], 60.0, None
        for _ in range(12):
            made.advance()
            angle += 30
            (asked,) = [one.parameters for one in made.layers[0].string if one.symbol == "?"]
            assert actor.position == pytest.approx((asked[0], height, asked[2]), abs=1e-9)
            turned = math.cos(math.radians(angle)), 0, -math.sin(math.radians(angle))
            assert actor.heading == pytest.approx(turned, abs=1e-9)
            if place is not None:
                way = [a - b for a, b in zip(actor.position, place, strict=True)]
                assert way == pytest.approx([2 * one for one in turned], abs=1e-9)
            place = actor.position
            assert made.windows[0].camera.eye == actor.position
    # Or it rides on a particle, and looks where that goes.
    ride = "C () (1) () () (2) (T) (T3*_)\n$ () () (4) () () () ()\n" + f"g {NONE}\n"
    made = scene(box((2, 5, -15), (1, 1, 1), 4) + ride)
    for _ in range(100):
        made.advance()
    actor = made.actors[0]
    assert actor.position == pytest.approx((2, made.time, -3 * made.time), abs=1e-9)
    assert actor.heading == pytest.approx((0, 1 / 10**0.5, -3 / 10**0.5), abs=1e-9)
    assert made.windows[0].distance == pytest.approx(2.38 / 3 * 10**0.5, rel=0.02)


@pytest.mark.capability("NA-004")
def test_strings_step_once_however_many_look():
    rules = "b (0.1) () () ()\n1.0\nb () (x1+) () () () () ()\nEndProb\nEnd\n"
    placed = "RepetitionParameters startp_sidel_nbr_dist 0 9 4 0.1\n"
    strings = []
    for actors, repeated in [(0, ""), (1, ""), (6, ""), (3, placed)]:
        made = Animation(
            f"Camera_AnimationParameters t_final_interval 60 0.04\n{repeated}"
            f"Options\nNBR_actors {actors}\nAxiom\nb {NONE}\nProductions\n{rules}EndProductions\n"
        )
        made.run(seconds=4)
        strings.append((made.string(), made.crew.made, len(made.windows)))
    assert {one[:2] for one in strings} == {strings[0][:2]}
    assert [one[2] for one in strings] == [0, 1, 6, 3]


@pytest.mark.capability("NA-130")
def test_nobody_sees_its_own_body():
    body = f"M () (7) () (1) () () ()\ng () () () () () () ()\na () () () () (1) () ()\n] {NONE}\n"
    made = scene(
        f"[ {NONE}\n{body}",
        "actorNbr_automata 1 1 9 obs 3 0 0 lat 0 0 0",
        "actorNbr_automata 1 1 9 fov 900",
        actors=2,
    )
    assert not np.isfinite(made.windows[1].depth).any()
    assert made.windows[0].distance == pytest.approx(2.5, abs=0.04)
    assert [part.body for part in made.parts()] == [1]


@pytest.mark.capability("NA-132")
def test_identity_is_exact():
    places = {4: (5, 1.2, -1.5), 1: (6, -1.5, 0), 12: (7, 0, 2), 3: (9, 2, 1)}
    made = scene("".join(box(place, (1, 1, 1), one) for one, place in places.items()))
    window = made.windows[0]
    shown = {code.name: number for number, code in enumerate(window.codes, 1)}
    for number, place in places.items():
        # All pixels of a box are of its color, and no others, in light and shade.
        mine = window.identity == shown[MATERIALS[number].name]
        assert mine.sum() >= 9
        inside = np.abs(window.points() - place).max(axis=1) < 0.5 + 1e-3
        assert np.array_equal(inside, mine[np.isfinite(window.depth)])
    assert (window.identity == 0).sum() == (~np.isfinite(window.depth)).sum()


@pytest.mark.capability("NA-051")
def test_the_distance_in_the_middle():
    for x in (0.8, 3.0, 20.0):
        (found,) = answers(box((x + 0.5, 0, 0), (1, 1, 1), 4), "?30")
        assert found == pytest.approx(x, rel=2e-3)
    # Nothing there, or beyond the far plane: as far as one sees.
    assert answers("", "?30", "vision_range 0.1 70 0") == [70]
    assert answers(box((90, 0, 0), (1, 30, 30), 4), "?30", "vision_range 0.1 70 0") == [70]
    # What is nearer than the near plane is not seen.
    slab = box((1.5, 0, 0), (0.2, 9, 9), 4) + box((8.5, 0, 0), (1, 9, 9), 4)
    assert answers(slab, "?30", "vision_range 2 70 0")[0] == pytest.approx(8, rel=2e-3)


@pytest.mark.capability("NA-051", "NA-143")
def test_the_side_of_the_nearest_obstacle():
    room = "size_actor 1", "dist_coll 3"

    def side(place, *commands, size=(0.4, 0.4, 0.4)):
        return answers(box(place, size, 4), "?31", *(commands or room))[0]

    # Heading along x with y up, the left is toward −z.
    assert side((2, 0, -0.4)) == -1
    assert side((2, 0, 0.4)) == 1
    assert side((2, 0, 0)) == 1
    # Free: too far, aside, above, below, behind.
    for place in [(3.5, 0, 0), (2, 0, -0.9), (2, 0, 0.9), (2, 0.9, 0), (2, -0.9, 0), (-2, 0, 0)]:
        assert side(place) == 0, place
    # A larger actor needs more room, a hastier one looks farther ahead.
    assert side((2, 0, -0.9), "size_actor 2", "dist_coll 3") == -1
    assert side((3.5, 0, 0.3), "size_actor 1", "dist_coll 4") == 1
    # The nearer of two counts, on whatever side more is seen.
    both = box((2.5, 0, 0.4), (0.5, 1, 0.5), 4) + box((1.5, 0, -0.4), (0.2, 0.2, 0.2), 3)
    assert answers(both, "?31", *room) == [-1]
    # The ground on which it stands is no obstacle.
    ground = "D () (2) () () (0.6_) () ()\n"
    assert answers(ground, "?31", *room) == [0]
    assert answers("", "?31", *room) == [0]


@pytest.mark.capability("NA-051")
def test_looking_at_the_goal_and_arriving():
    asked = "?32 ?33 ?39"
    assert answers("", asked) == [-1, -1, -1]
    for goal, looks in [("9 0 1", 1), ("9 0 4", -1), ("9 4 0", -1), ("-9 0 0", -1)]:
        found = answers("", asked, f"local_goal 2 {goal} eps_look_at 2 0.95 eps_arrived 2 2")
        assert found == [looks, -1, -1], goal
    # The threshold is the cosine of the angle; the distance is from the eye.
    told = "local_goal 0 9 0 4 eps_look_at 0 {} eps_arrived 0 {}"
    far = math.hypot(9, 4)
    assert answers("", asked, told.format(9 / far - 0.01, far + 0.01)) == [1, 1, 1]
    assert answers("", asked, told.format(9 / far + 0.01, far - 0.01)) == [-1, -1, -1]
    # Without a local goal the top of the stack is meant; a local goal set later takes its place.
    assert answers("", asked, "goal 5 0 0 goal 1 0 0.5 eps_arrived 0 2") == [-1, 1, 1]
    assert answers("", asked, "goal 1 0 0 local_goal 1 9 0 0 eps_arrived 1 2") == [1, -1, -1]
    # `g` makes the turtle's place a goal.
    made = scene(f"{at(0, 0, -3)}\ng () (1) () () () () ()\n", asked=asked)
    made.actors[0].heading = (0.0, 0.0, -1.0)
    made.advance()
    assert [one.growth[0] for one in made.layers[0].string if one.symbol == "b"] == [1, -1, -1]


@pytest.mark.capability("NA-051", "NA-142")
def test_things_of_interest():
    ball = "m () (12) () () () () ()\n" + at(6, 0.5, 1) + "\na () () () () (1) () ()\n"
    decoys = box((5, 0, -2), (1, 1, 1), 4) + box((5, 1, -1), (1, 1, 1), 2)
    assert answers(decoys + ball, "?36", "interest 1 0") == [1]
    assert answers(decoys, "?36", "interest 1 0") == [-1]
    assert answers(decoys + ball, "?36") == [-1]
    assert answers(decoys + ball, "?36", "interest 1 1") == [-1]
    assert answers(decoys + ball, "?36", "interest 1 0 interest 0 0") == [-1]
    # Behind a wall, and behind one's back, it is not found.
    assert answers(box((3, 0, 0), (0.1, 9, 9), 7) + ball, "?36", "interest 1 0") == [-1]
    assert answers(ball, "?36", "interest 1 0 lat -1 0 0") == [-1]
    # The players, by the names of their materials.
    for thing, material in ((1, 10), (2, 11)):
        player = box((6, 0, 0), (1, 1, 1), material)
        assert answers(player, "?36", f"interest 1 {thing}") == [1]
        assert answers(player, "?36", f"interest 1 {3 - thing}") == [-1]


@pytest.mark.capability("NA-051", "NA-135", "NA-142")
def test_any_color_is_found_and_becomes_a_goal():
    spot = "m () (7) () (1) (0.2) (0.6) (1)\n" + at(7, 1, -2) + "\na () () () () (1.4) () ()\n"
    decoys = box((5, 0, 2), (1, 1, 1), 4) + box((5, 1, 0), (1, 1, 1), 12)
    for asked in ("?37", "?38"):
        assert answers(spot + decoys, asked, "rgb_interest 51 153 255 1") == [1]
        assert answers(spot + decoys, asked, "rgb_interest 51 153 254 1") == [-1]
        assert answers(spot + decoys, asked, "rgb_interest 51 153 255 0") == [-1]
        assert answers(decoys, asked, "rgb_interest 51 153 255 1") == [-1]
    told = "actorNbr_automata 0 0 9 rgb_interest 51 153 255 1"
    assert scene(spot + decoys, told, asked="?37").actors[0].goal is None
    # ?38 says where: within the ball, though only its front is seen.
    actor = scene(spot + decoys, told, asked="?38").actors[0]
    assert actor.aim == 1
    assert math.dist(actor.local_goals[1], (7, 1, -2)) <= 0.7
    # Strokes have the color that is written.
    stroke = f"r () () () () (51) (153) (255)\n{at(0.3, -0.1, 0)}\n+ () () () () (90) () ()\n"
    made = scene(stroke + "R () () () () (0.2) () ()\n", told, asked="?37")
    assert Code("stroke", (51, 153, 255)) in made.windows[0].codes


def chromatic(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return math.dist(*([one / sum(color) for one in color] for color in (a, b)))


@pytest.mark.capability("NA-133")
def test_a_ball_is_told_by_its_hue_in_light_and_shade():
    ball = MATERIALS[12].diffuse
    others = [
        number
        for number, one in MATERIALS.items()
        if one.specular <= 0.04 and chromatic(one.diffuse, ball) >= 0.2
    ]
    assert len(others) >= 6
    chance = random.Random(17)
    shades = []
    for _ in range(60):
        # Somewhere in view, from whatever side: four boxes, and the ball before or behind them.
        way = np.array([chance.gauss(0, 1) for _ in range(3)])
        way /= np.linalg.norm(way)
        places = [way * chance.uniform(3, 9) + [chance.uniform(-2, 2)] * 3 for _ in range(5)]
        *boxes, place = [tuple(float(round(part, 3)) for part in one) for one in places]
        things = "".join(box(one, (1.2, 1.2, 1.2), chance.choice(others)) for one in boxes)
        things += f"n () (24) () () () () ()\nm () (12) () () () () ()\n{at(*place)}\n"
        things += "a () () () () (1.6) () ()\n"
        x, y, z = (f"{part:.6f}" for part in way)
        window = scene(things, f"actorNbr_automata 0 0 9 lat {x} {y} {z}").windows[0]
        truth, seen = window.showing(names=("ball",)), window.resembling(ball)
        assert not (seen & ~truth).any()
        if truth.sum() >= 5:
            assert (seen & truth).sum() >= 0.9 * truth.sum()
            assert math.dist(window.center(seen), place) <= 0.8
            shades.append(window.color[truth].sum(axis=1))
    # Its sunny side is four times as bright as its dark one.
    assert len(shades) >= 30
    bright = np.concatenate(shades)
    assert bright.max() > 4 * bright.min()
    with pytest.raises(InvalidValueError, match="not black"):
        window.resembling((0, 0, 0))


@pytest.mark.capability("NA-134")
@pytest.mark.parametrize(("aside", "error"), [(0, 0.05), (4, 0.5)])
def test_how_large_a_thing_is(aside: float, error: float):
    # A disc of 3 units across the line of sight, in the middle and aside.
    disc = f"n () (64) () () () () ()\nm () (12) () () () () ()\n{at(9, aside, -aside)}\n"
    disc += "s () () () () (0.001) (3) (3)\n"
    eye = "iVisionWinSize_maxColors 0 100 2", "actorNbr_automata 0 0 9 interest 1 0"
    window = scene(disc, *eye).windows[0]
    seen = window.showing(names=("ball",))
    expected = math.pi * 1.5**2
    assert window.area(seen) == pytest.approx(expected, rel=0.05)
    # Its distance alone is good enough in the middle, and worse aside.
    far = float(np.median(window.depth[seen]))
    assert window.area(seen, far) == pytest.approx(expected, rel=error)
    assert abs(window.area(seen, far) - expected) > (aside > 0) * 0.05 * expected


@pytest.mark.capability("NA-132")
def test_materials_without_lighting_are_seen_as_they_are():
    flat = box((5, 0, 0), (1, 2, 2), 12).replace("(12) () ()", "(12) () (2)")
    window = scene(flat).windows[0]
    shown = np.isfinite(window.depth)
    assert shown.sum() >= 64
    assert np.abs(window.color[shown] - (0.8, 0.4, 0.2)).max() < 1e-6
    # A wider angle shows the same smaller.
    wide = scene(flat, "actorNbr_automata 0 0 9 fov 1400").windows[0]
    assert np.isfinite(wide.depth).sum() <= shown.sum() / 4


def test_what_is_answered_is_the_past():
    """A rule knows what was seen when the last frame was complete, not what is being drawn."""
    moving = "f () () () (2) (T50*5+) () ()\nc () () () () (1) (1) (1)\n"
    made = scene(moving, asked="?30")
    seen = []
    for _ in range(4):
        before = made.windows[0].distance
        made.advance()
        assert made.layers[0].string[-2].growth[0] == before
        seen.append(before)
    assert np.diff(seen) == pytest.approx(2.0, rel=1e-3)
    # Who has no eye sees nothing, and that is said.
    made = scene(f"M () (7) () (4) () () ()\nb () () () () (?30) () ()\nb {NONE}\n")
    assert made.layers[0].string[1].growth[0] == 10000
    assert made.remarks == ["actor 4 has no eye: 'NBR_actors' does not declare it"]


def test_what_is_too_large_is_left_out():
    corner = f". {NONE}\n"
    far = "f () () () (2) (1) (10'20^) ()\n"
    for huge, symbol in [
        ("c () () () () (10'300^) (1) (1)\n", "c"),
        ("f () () () () (10'300^) () ()\nR () () () () (10'308^) () ()\n", "R"),
        (f"{{ {NONE}\n{corner}{at(1, 0, 0)}\n{corner}{far}{corner}}} {NONE}\n", "}"),
    ]:
        made = scene(box((3, 0, 0), (1, 1, 1), 4) + huge)
        assert made.windows[0].distance == pytest.approx(2.5, rel=1e-3)
        assert made.remarks == [f"'{symbol}' draws beyond 1e+09 units; it is left out"]


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("iVisionWinSize 2 40 1", r"4:16: expected an actor .*\(0 to 0\), found 2"),
        ("iVisionWinSize 0 0 1", "4:18: expected an edge of 1 to 512 pixels, found 0"),
        ("iVisionWinSize 0 9999 1", "4:18: expected an edge of 1 to 512 pixels, found 9999"),
        ("iVisionWinSize_maxColors 0 40 0", "4:31: expected at least 1 color"),
        ("iVisionWinSize 0 forty 1", "4:18: expected a whole number"),
        ("NBR_actors -1", "4:12: expected 0 to 64 actors, found -1"),
        ("actorNbr_automata 0 0 9 fov 1800", "4:29: 'fov' expects 1 to 1790 .*found 1800"),
        ("actorNbr_automata 0 0 9 vision_range 5 1 9", "4:40: .*far plane beyond the near"),
        ("actorNbr_automata 0 0 9 size_actor -1", "4:36: 'size_actor' expects at least 0"),
        ("actorNbr_automata 0 0 9 rgb_interest 0 0 300 1", "4:42: .*0 to 255.*argument 3"),
        ("actorNbr_automata 0 0 9 interest 1 3", "4:36: 'interest' expects 0 to 2"),
        ("actorNbr_automata 0 0 9 eps_look_at 0 2", "4:39: 'eps_look_at' expects -1 to 1"),
    ],
)
def test_impossible_eyes_are_refused_with_their_place(option: str, message: str):
    text = f"\nOptions\nNBR_actors 1\n{option}\nAxiom\nb {NONE}\nProductions\nEndProductions\n"
    with pytest.raises(FormatError, match=f"<text>.lm:{message}"):
        Animation(text)


WATCHER = (
    "Options\nNBR_actors 1\nactorNbr_automata 0 0 9 fov 900 rgb_interest 255 0 0 1\n"
    f"Axiom\n[ {NONE}\nM () (7) () () () () ()\ng {NONE}\nm () (3) () () () () ()\n"
    f"a () () () () (0.5) () ()\nb () () () () (?30) (?38) ()\n] {NONE}\n"
    "Productions\nEndProductions\n"
)


def watched(folder, **options) -> tuple[bio.World, bio.Animated]:
    """Return an actor in a world in which a red square comes nearer."""
    (folder / "watcher.lm").write_text(WATCHER)
    world = bio.World(seed=2, dt=0.04)
    square = np.array([(0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)], np.float32)

    class Comer(bio.Population):
        kind = "Comer"

        def __init__(self):
            self.away = 12.0

        def settle(self):
            return 1

        def born(self, ids):
            self.ids = ids

        def move(self, dt):
            self.away -= dt

        def publish(self, scene):
            mesh = bio.Mesh(square, np.array([(0, 1, 2), (0, 2, 3)], np.uint32))
            red = bio.Material("red", color=(1, 0, 0), two_sided=True)
            place = np.array([(self.away, 3, 0)], np.float32)
            scene.instances("comer", mesh, red, ids=self.ids, positions=place)

    world.add(Comer())
    animated = world.add(bio.Animated(folder / "watcher.lm", **options))
    return world, animated


@pytest.mark.capability("NA-130")
def test_in_a_world_its_inhabitants_are_seen(tmp_path):
    world, animated = watched(tmp_path, position=(0, 3, 0), scale=2.0)
    world.step(50)
    animation = animated.animation
    window = animation.windows[0]
    # Half as many units as metres, one tick ago; nothing of the own body.
    assert window.distance == pytest.approx((12 - 49 * 0.04) / 2, rel=2e-3)
    assert window.codes == [Code("comer", (255, 0, 0))]
    assert animation.actors[0].local_goals[1] == pytest.approx((5.04, 0, 0), abs=0.05)
    # It is an individual, whose eye and percepts can be looked at.
    seen = world.inspect(int(animated.ids[1]))
    assert seen["values"]["distance"] == pytest.approx(window.distance)
    assert seen["eye"].position == pytest.approx((0, 3, 0))
    assert world.inspect(int(animated.ids[0])) is None
    bodies = [one for one in world.scene.batches if animated.ids[1] in one.ids]
    assert [one.alive for one in bodies] == [True]


def test_what_was_seen_is_part_of_the_state(tmp_path):
    world, animated = watched(tmp_path)
    world.step(20)
    world.save(tmp_path / "a.world")
    again = bio.World.restore(tmp_path / "a.world")
    for one in (world, again):
        one.step(20)
    assert again.state_hash() == world.state_hash()
    assert animated.animation.frame.number == 40
    assert len(animated.seen) == 40


def test_the_inspector_shows_what_an_actor_sees(tmp_path):
    world, animated = watched(tmp_path, position=(0, 3, 0))
    world.step(25)
    chosen = Select(id=int(animated.ids[1]), retina=(32, 32))
    found = msgspec.msgpack.decode(inspection(world, chosen))
    identity = np.frombuffer(found["retina"]["identity"], np.uint32).reshape(32, 32)
    # The red square in the middle; nothing of the body that the eye is in.
    assert set(np.unique(identity)) == {0, 1}
    assert identity[16, 16] == 1
    assert found["values"]["distance"] == pytest.approx(12 - 24 * 0.04, rel=2e-3)
