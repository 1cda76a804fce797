"""What the turtle of an animation does: turns, shapes, materials, cameras, set pieces."""

import math
from collections import Counter

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import MATERIALS, Device, Source

NONE = "() () () () () () ()"
LINE = "R () () () () (1) () ()"
TURNS = "+ () () () () (40) () ()\n& () () () () (25) () ()\n$ () () () () (70) () ()"


def text(*symbols: str, head: str = "") -> str:
    return f"{head}\nAxiom\n" + "\n".join(symbols) + "\nProductions\nEndProductions\n"


def animation(*symbols: str, head: str = "", **options) -> Animation:
    return Animation(text(*symbols, head=head), **options)


def axes(made: Animation) -> np.ndarray:
    """Return heading, left and up where three strokes of length 1 along them begin."""
    return np.array([np.subtract(one.end, one.start) for one in made.frame.lines[-3:]])


FRAME = f"[ {NONE}\n{LINE}\n] {NONE}\n[ {NONE}\n+ () () () () (90) () ()\n{LINE}\n] {NONE}\n"
FRAME += f"[ {NONE}\n^ () () () () (90) () ()\n{LINE}\n] {NONE}"


@pytest.mark.capability("NA-070")
def test_turns_keep_the_frame_orthonormal():
    made = animation(TURNS, FRAME)
    assert axes(made) @ axes(made).T == pytest.approx(np.eye(3), abs=1e-12)
    pose = bio.lsystem.animation.vectors.Pose()
    for _ in range(100_000):
        pose = pose.turned(7.3).pitched(-3.1).rolled(11.7)
    frame = np.array([pose.heading, pose.left, pose.up])
    assert np.abs(frame @ frame.T - np.eye(3)).max() < 1e-9


@pytest.mark.capability("NA-071")
def test_modes_of_the_roll_symbol(tmp_path):
    def turned(mode: str, before: str = TURNS, more: str = "") -> np.ndarray:
        made = animation(before, f"$ () () ({mode}) () (35) () ()", FRAME, head=more)
        made.advance()
        return axes(made)

    heading, left, up = axes(animation(TURNS, FRAME))
    rolled = turned("0")
    assert rolled[0] == pytest.approx(heading)
    assert rolled[1] == pytest.approx(
        math.cos(math.radians(35)) * left + math.sin(math.radians(35)) * up
    )
    level = turned("1")
    assert level[0] == pytest.approx(heading)
    assert level[1][1] == pytest.approx(0, abs=1e-12)
    assert level[2][1] > 0
    vertical = "+ () () () () (90) () ()"
    assert turned("1", vertical) == pytest.approx(axes(animation(vertical, FRAME)), abs=1e-12)
    fallen = turned("2")
    assert fallen[0] == pytest.approx((0, -1, 0), abs=1e-12)
    assert fallen[1][1] == pytest.approx(0, abs=1e-12)
    # About its left: that stays.
    assert fallen[1] == pytest.approx(level[1], abs=1e-12)
    assert turned("3") == pytest.approx(np.eye(3))
    shadow = turned("6")
    assert shadow[0] == pytest.approx(
        np.array([heading[0], 0, heading[2]]) / np.hypot(*heading[::2])
    )
    assert shadow[2] == pytest.approx((0, 1, 0))
    for one in (rolled, level, fallen, shadow):
        assert one @ one.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(one) == pytest.approx(1)
    # Along the velocity of the particle that was met last; as it is without speed.
    flying = turned("4", f"{TURNS}\nC () () () () (1) (2) (2)")
    assert flying[0] == pytest.approx((1 / 3, 2 / 3, 2 / 3))
    assert flying[1][1] == pytest.approx(0, abs=1e-12)
    assert turned("4", f"{TURNS}\nC {NONE}")[0] == pytest.approx(heading)
    # Along an imported trajectory.
    (tmp_path / "path.txt").write_text("1 0 0 0 0 0\n1 0 1 3 0 4\n")
    head = "Camera_AnimationParameters t_final_interval 9 0.5\nOptions\nimport_trace 1 path.txt\n"
    source = text(TURNS, "$ () () (5) (1) () () ()", FRAME, head=head)
    made = Animation(Source(source, "a.lm", tmp_path))
    made.advance()
    assert made.frame.lines[0].start == pytest.approx((1.5, 0, 2))
    assert axes(made)[0] == pytest.approx((0.6, 0, 0.8))
    assert axes(made)[2] == pytest.approx((0, 1, 0))


@pytest.mark.capability("NA-072")
def test_modes_of_the_move_symbol():
    heading, left, up = axes(animation(TURNS, FRAME))
    start = np.array([1.0, 1, 1])
    for mode, expected in [
        ("()", start + 2 * heading),
        ("(1)", start + np.array([2, 3, 4])),
        ("(2)", np.array([2, 3, 4])),
        ("(3)", start + 2 * heading + 3 * left + 4 * up),
    ]:
        made = animation(
            "f () () () (1) (1) (1) (1)", TURNS, f"f () () () {mode} (2) (3) (4)", LINE
        )
        assert made.frame.lines[0].start == pytest.approx(expected, abs=1e-12), mode
        assert np.subtract(made.frame.lines[0].end, expected) == pytest.approx(heading)


@pytest.mark.capability("NA-073", "NA-074")
def test_shapes_have_bounds_ends_and_resolution():
    ends = {"c": 2, "d": 2, "p": 2, "q": 2, "O": 2, "N": 2, "o": 2, "P": 2, "Q": 2, "a": 0, "s": 0}
    bounds = {
        "c": ((0, -1.5, -2), (2, 1.5, 2)),
        "p": ((0, -1.5, -2), (2, 1.5, 2)),
        "s": ((-1, -1.5, -2), (1, 1.5, 2)),
        "a": ((-1, -1, -1), (1, 1, 1)),
        "o": ((0, -1.5, -2), (2, 1.5, 2)),
        "O": ((-1.75, -1.5, -2), (3.75, 1.5, 2)),
        "P": ((-1.5, -2, -2), (4, 2, 2)),
    }
    for symbol, end in ends.items():
        made = animation("n () (64) () () () () ()", f"{symbol} () () () () (2) (3) (4)", LINE)
        assert made.frame.lines[0].start == pytest.approx((end, 0, 0)), symbol
        low, high = bounds[{"d": "c", "q": "p", "N": "O", "Q": "P"}.get(symbol, symbol)]
        corners = np.array(made.frame.pieces[0].corners)
        assert corners.min(axis=0) == pytest.approx(low, abs=1e-2), symbol
        assert corners.max(axis=0) == pytest.approx(high, abs=1e-2), symbol
        sides = edges(made.frame.pieces[0].triangles())
        if symbol != "o":
            assert all(sides[b, a] == 1 for a, b in sides), symbol
            assert volume(made.frame.pieces[0]) > 0, symbol
    for symbol in "ONPQas":
        counts = [
            len(
                animation(f"n () {n} () () () () ()", f"{symbol} () () () () (2) (3) (4)")
                .frame.pieces[0]
                .triangles()
            )
            for n in ("(2)", "(3)", "(10)", "(20)")
        ]
        assert counts[0] == counts[1] < counts[2] < counts[3], symbol
    plain = animation("a () () () () (2) () ()").frame.pieces[0]
    ten = animation("n () (10) () () () () ()", "a () () () () (2) () ()").frame.pieces[0]
    assert len(plain.triangles()) == len(ten.triangles())


def edges(triangles: list[tuple[int, int, int]]) -> Counter:
    """Return how often each directed edge occurs."""
    return Counter((one[at], one[(at + 1) % 3]) for one in triangles for at in range(3))


def volume(piece) -> float:
    corners = [np.array(one) for one in piece.corners]
    return (
        sum(
            float(np.dot(corners[a], np.cross(corners[b], corners[c])))
            for a, b, c in piece.triangles()
        )
        / 6
    )


OUTLINE = [(0, 0), (4, 0), (4, 3), (2, 1), (0, 3)]
"""A polygon with a notch, in the plane of heading and left."""


def outlined(closing: str) -> list:
    corners = "\n".join(f"f () () () (2) ({x}) ({y}) ()\n. {NONE}" for x, y in OUTLINE)
    return animation("{ " + NONE, corners, f"}} {closing}").frame.pieces


@pytest.mark.capability("NA-081", "NA-036")
def test_polygons_are_flipped_doubled_and_closed():
    area = 4 * 3 - 4 * 2 / 2
    (flat,) = outlined("() () () () () () ()")
    assert flat.corners == [(x, y, 0) for x, y in OUTLINE]
    turned = lambda piece: sum(  # noqa: E731
        np.cross(*(np.subtract(piece.corners[one], piece.corners[a]) for one in (b, c)))[2] / 2
        for a, b, c in piece.triangles()
    )
    assert turned(flat) == pytest.approx(area)
    (flipped,) = outlined("() (1) () () () () ()")
    assert turned(flipped) == pytest.approx(-area)
    (twin,) = outlined("() () (1) () (0.5) () ()")
    assert sorted({corner[2] for corner in twin.corners}) == [0, 0.5]
    assert turned(twin) == pytest.approx(0)
    assert len(twin.triangles()) == 2 * len(flat.triangles())
    # Closed by side faces: every edge has its counterpart, and Euler's 2 comes out.
    for distance, inward in [("0.5", True), ("0.5_", False)]:
        (closed,) = outlined(f"() () (1) (1) ({distance}) () ()")
        sides = edges(closed.triangles())
        assert all(count == 1 and sides[b, a] == 1 for (a, b), count in sides.items())
        assert len(closed.corners) - len(sides) // 2 + len(closed.triangles()) == 2
        assert volume(closed) == pytest.approx(-area / 2 if inward else area / 2)
    # Rimmed by cylinders that reach from one to the other.
    first, *rims = outlined("() () (1) (3) (0.5) () ()")
    assert len(rims) == len(OUTLINE)
    assert len(first.triangles()) == len(twin.triangles())
    heights = np.array([corner for rim in rims for corner in rim.corners])[:, 2]
    assert heights.min() == pytest.approx(0, abs=0.02)
    assert heights.max() == pytest.approx(0.5, abs=0.02)
    # Nested surfaces.
    inner = "\n".join(f"f () () () (2) ({x}) () ({x}'5*)\n. {NONE}" for x in (1, 2, 3))
    nested = animation(
        "{ " + NONE,
        f". {NONE}",
        "{ " + NONE,
        inner,
        "} " + NONE,
        f"f () () () (2) (9) (1) ()\n. {NONE}",
        f"f () () () (2) (9) () ()\n. {NONE}",
        "} " + NONE,
    ).frame.pieces
    assert [len(one.corners) for one in nested] == [3, 3]
    assert nested[0].corners[2] == (3, 0, 15)
    assert nested[1].corners == [(0, 0, 0), (9, 1, 0), (9, 0, 0)]


NAMES = [
    "green",
    "brown",
    "blue",
    "red",
    "yellow",
    "gray",
    "white",
    "earth",
    "green2",
    "actor1",
    "actor2",
    "ball",
    "mirror",
    "skin",
    "grey0",
    "grey1",
    "grey2",
    "grey3",
    "cr_quartz",
    "cr_pyrite",
    "cr_emeraude",
    "cr_grossulaire",
    "cr_fluorine",
    "cr_rhodochrosite",
    "cr_natrolite",
    "cr_celestine",
    "cr_aigue_marine",
]


@pytest.mark.capability("NA-075")
def test_named_materials():
    assert [MATERIALS[number].name for number in range(1, 28)] == NAMES
    cube = "c () () () () (1) (1) (1)"
    for number, name in enumerate(NAMES, 1):
        (piece,) = animation(f"m () ({number}) () () () () ()", cube).frame.pieces
        assert piece.material is MATERIALS[number]
        assert piece.material.surface().name == name
        # Of one hue in light and in shadow.
        lit, dark = np.array(piece.material.diffuse), np.array(piece.material.ambient)
        assert lit / np.linalg.norm(lit) == pytest.approx(dark / np.linalg.norm(dark), abs=0.01)
    assert len({one.diffuse for one in MATERIALS.values()}) == 27
    ball = MATERIALS[12]
    assert (ball.ambient, ball.diffuse, ball.specular) == ((0.4, 0.2, 0.1), (0.8, 0.4, 0.2), 0)
    # Active until the next, in all branches.
    made = animation(
        f"[ {NONE}", "m () (4) () () () () ()", f"] {NONE}", cube, "m () (3) () () () () ()", cube
    )
    assert [one.material.name for one in made.frame.pieces] == ["red", "blue"]
    # The diffuse color may be animated, and light switched off.
    made = animation("m () (4) () (1) (T) (0.5) (1T-)", cube, "m () (4) () (2) () () ()", cube)
    made.advance()
    first, second = (one.material for one in made.frame.pieces)
    assert first.diffuse == pytest.approx((0.04, 0.5, 0.96))
    assert first.lit
    assert not second.lit
    assert second.diffuse == MATERIALS[4].diffuse
    # They reach a scene, one mesh per material.
    assert [material.name for material, _, _ in made.frame.meshes()] == ["red", "red"]


@pytest.mark.capability("NA-076")
def test_color_of_strokes():
    made = animation(LINE, "r () () () () (255) (T100*) (300)", LINE)
    assert [one.color for one in made.frame.lines] == [(255, 255, 255), (255, 0, 255)]
    made.advance()
    assert made.frame.lines[1].color == pytest.approx((255, 4, 255))


FLIGHT = "C () (1) () () (T10*) (3) (4)"


@pytest.mark.capability("NA-077", "NA-085")
def test_modes_of_the_camera_symbol():
    def directed(mode: int, growth: str = "(1) (2) (3)", before: str = FLIGHT, par2: str = "()"):
        made = animation(
            "f () () () (2) (7) (8) (9)",
            "D () (40) () () () () ()",
            before,
            f"l () () {par2} ({mode}) {growth}",
        )
        made.advance()
        made.advance()
        return made

    assert directed(0).camera.eye == (1, 2, 3)
    assert directed(1).camera.target == (1, 2, 3)
    shown = directed(2, "(450) (1.5) (10)").camera
    assert (shown.angle, shown.aspect, shown.twist) == (45, 1.5, 10)
    assert directed(3).light.position == (1, 2, 3)
    # The eye of a particle, and what lies ahead of it.
    riding = directed(4)
    assert riding.camera.eye == pytest.approx((0.8, 3, 4))
    assert riding.camera.eye == riding.particles[0].position
    assert directed(5, "(5) () ()").camera.target == pytest.approx((5.8, 3, 4))
    # The eyes of an actor, and a view that tracks it.
    to = "f () () () (2) (T) (1) (2)"
    actor = f"{to}\nM () (7) () (4) () () ()\n{to}\ng {NONE}"
    ridden = directed(6, "(4) () ()", actor).camera
    assert ridden.eye == pytest.approx((0.08, 1, 2))
    assert np.subtract(ridden.target, ridden.eye) == pytest.approx((1, 0, 0))
    assert directed(7, "(4) () ()", actor).camera.target == pytest.approx((0.08, 1, 2))
    # With a microphone.
    heard = directed(8, par2="(2)")
    assert heard.camera.eye == (1, 2, 3)
    assert "MP 2 1 2 3" in heard.air.log[-1]
    watching = directed(10, par2="(1)")
    assert (watching.camera.eye, watching.camera.target) == ((1, 2, 3), (7, 8, 9))
    assert "MP 1 1 2 3" in watching.air.log[-1]
    # Key-framed.
    spline = "Splines\nfunction time_spline 1 2 1 1 0 5 1 9 1e30 1e30\n"
    made = animation("l () () () () (?01) () ()", head=spline)
    made.run(seconds=1)
    assert made.camera.eye == pytest.approx((9, 0, 0))


@pytest.mark.capability("NA-077")
def test_devices_and_voices_move_the_camera():
    head = "Camera_AnimationParameters observer 0 5 20 lookatPoint 0 5 0\n"
    made = animation("l () () () (9) () () ()", head=head)
    made.use_device(Device(translation=(1, 2, 3)))
    made.advance()
    assert made.camera.eye == pytest.approx((1, 7, 17))
    assert made.camera.target == pytest.approx((1, 7, -3))
    made.advance()
    assert made.camera.eye == pytest.approx((1, 7, 17))
    # Buttons: farther per push, more turn per twist; the height locked.
    made.use_device(Device(translation=(0, 9, 2), buttons=frozenset({1, 8})))
    made.advance()
    assert made.camera.eye == pytest.approx((1, 7, 14))
    made.use_device(Device(translation=(0, 9, 0), buttons=frozenset({2, 7})))
    made.advance()
    assert made.camera.eye == pytest.approx((1, 16, 14))
    for buttons, angle in [({3}, 60), ({4}, 40)]:
        before = np.subtract(made.camera.target, made.camera.eye)
        made.use_device(Device(rotation=(0, 40, 0), buttons=frozenset(buttons)))
        made.advance()
        after = np.subtract(made.camera.target, made.camera.eye)
        turn = math.degrees(math.acos(np.dot(before, after) / 400))
        assert turn == pytest.approx(angle)
    # Voice: what is said goes on until `stop`.
    said = animation("l () () () (11) () () ()", head=head)
    for words, expected in [
        ("move", (0, 5, 19)),
        (None, (0, 5, 18)),
        ("faster", (0, 5, 16.5)),
        ("slow down", (0, 5, 15.5)),
        ("go back", (0, 5, 16.5)),
        ("move right", (1, 5, 16.5)),
        ("move left", (0, 5, 16.5)),
        ("move up", (0, 6, 16.5)),
        ("block", (0, 6, 16.5)),
        ("free it", (0, 7, 16.5)),
        ("move down", (0, 6, 16.5)),
        ("stop", (0, 6, 16.5)),
        ("strawberry", (0, 6, 16.5)),
    ]:
        if words:
            said.say(words)
        said.advance()
        assert said.camera.eye == pytest.approx(expected), words
    for words, sign, axis in [
        ("turn left", -1, 0),
        ("turn right", 1, 0),
        ("turn up", 1, 1),
        ("turn down", -1, 1),
    ]:
        turning = animation("l () () () (11) () () ()", head=head)
        turning.say(words)
        turning.advance()
        way = np.subtract(turning.camera.target, turning.camera.eye)
        assert math.copysign(1, way[axis]) == sign, words
        assert abs(way[axis]) == pytest.approx(20 * math.sin(math.radians(5)))
    turning.say("turn faster")
    turning.say("turn less")
    turning.advance()
    assert turning.camera.agility == pytest.approx(1)
    # Where no symbol lets them, neither does.
    still = animation(LINE, head=head)
    still.use_device(Device(translation=(1, 2, 3)))
    still.say("move")
    still.advance()
    assert still.camera.eye == (0, 5, 20)


@pytest.mark.capability("NA-078")
def test_set_pieces():
    (ground,) = animation("D () (2) () () (1.5) () ()").frame.pieces
    corners = np.array(ground.corners)
    assert corners.min(axis=0).tolist() == [-1000, 1.5, -1000]
    assert corners.max(axis=0).tolist() == [1000, 1.5, 1000]
    a, b, c = (corners[one] for one in ground.triangles()[0])
    assert np.cross(b - a, c - a)[1] > 0
    (square,) = animation("f () () () (2) (5) (6) (7)", "D () (3) () () (4) (2) ()").frame.pieces
    corners = np.array(square.corners)
    assert corners.min(axis=0).tolist() == [3, 2, 5]
    assert corners.max(axis=0).tolist() == [7, 2, 9]
    court = {
        one.material.name: np.array(one.corners)
        for one in animation(f"D () (41) {NONE[6:]}").frame.pieces
    }
    length, doubles = 23.77, 10.97
    assert np.ptp(court["green"], axis=0) == pytest.approx((length, 0, doubles))
    assert court["green"].mean(axis=0) == pytest.approx((0, 0, 0))
    # The net stands in the plane x = 0, 0.91 m high.
    assert np.ptp(court["grey1"], axis=0) == pytest.approx((0, 0.91, doubles))
    assert court["grey1"][:, 0].tolist() == [0] * 4
    lines = court["white"].reshape(-1, 4, 3)
    found = {tuple(strip.mean(axis=0).round(3)[[0, 2]]) for strip in lines}
    for place in [(0, 4.115), (0, -4.115), (6.4, 0), (-6.4, 0), (11.885, 0), (0, 5.485), (0, 0)]:
        assert place in found
    assert all(not one.material.lit for one in animation("D () (41) () () () () ()").frame.pieces)
    surrounded = animation("D () (41) (1) () () () ()").frame.pieces
    assert {one.material.name for one in surrounded} == {"green", "white", "grey1", "gray"}


@pytest.mark.capability("NA-079")
def test_a_box_around_what_was_drawn(tmp_path):
    symbols = [
        "s () () () () (9) (9) (9)",
        "D () (20) () () () () ()",
        TURNS,
        "c () () () () (2) (3) (0.4)",
        "a () () () () (1.7) () ()",
        LINE,
        "D () (21) () () () () ()",
        "s () () () () (9) (9) (9)",
    ]
    made = animation(*symbols)
    drawn = [*made.frame.pieces[1].corners, *made.frame.pieces[2].corners]
    drawn += [made.frame.lines[0].start, made.frame.lines[0].end]
    made.write(tmp_path)
    (path,) = tmp_path.glob("*.lm")
    assert path.name == "box1.0000.lm"
    low, high = Animation.read(path).frame.bounds()
    assert low == pytest.approx(np.min(drawn, axis=0), abs=1e-6)
    assert high == pytest.approx(np.max(drawn, axis=0), abs=1e-6)
    # A plant of the other reading, too.
    string = bio.LSystem.read(path).derive(0)
    corners = np.vstack([one for one, _ in bio.Turtle().interpret(string).polygons])
    assert corners.min(axis=0) == pytest.approx(low, abs=1e-5)
    assert animation("D () (21) () () () () ()").remarks


@pytest.mark.capability("NA-080")
def test_surfaces_are_imported_and_the_scene_exported(tmp_path):
    (tmp_path / "rock.sm").write_text("SM 4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 2 1\n0 1 3\n0 3 2\n")
    head = "Surfaces\nfig_sm 7 rock.sm"
    symbols = ["f () () () (2) (5) () ()", "B () (7) () () (2) (3) (4)", LINE]
    made = Animation(Source(text(*symbols, head=head), "a.lm", tmp_path))
    assert made.frame.bounds() == ((5, 0, 0), (7, 3, 4))
    assert len(made.frame.pieces[0].triangles()) == 3
    # Its corners are those of the file, and it moves nothing.
    assert made.frame.pieces[0].corners == [(5, 0, 0), (7, 0, 0), (5, 3, 0), (5, 0, 4)]
    assert made.frame.lines[0].start == (5, 0, 0)
    # The whole scene of frame 10, as one surface that can be imported again.
    scene = text(TURNS, "c () () () () (T10*) (2) (3)", "a () () () () (2) () ()", head="Splines\n")
    first = Animation(scene)
    first.run(seconds=0.4)
    assert first.frame.number == 10
    (tmp_path / "rock.sm").write_text(first.surface())
    second = Animation(Source(text("B () (7) () () (1) (1) (1)", head=head), "a.lm", tmp_path))
    expected = sum(len(one.triangles()) for one in first.frame.pieces)
    assert len(second.frame.pieces[0].triangles()) == expected
    assert np.array(second.frame.bounds()) == pytest.approx(
        np.array(first.frame.bounds()), abs=1e-6
    )
    with pytest.raises(FormatError, match="there is no file"):
        Animation(Source(text("B " + NONE, head="Surfaces\nfig_sm 1 no.sm"), "a.lm", tmp_path))


@pytest.mark.capability("NA-082")
def test_the_turtle_tells_where_it_is():
    print_it = "D () (30) () () () () ()"
    made = animation(
        "f () () () (2) (5) (T) (7)",
        print_it,
        "D () (40) () () () () ()",
        TURNS,
        "f () () () () (2) () ()",
        print_it,
        "l () () () (10) (1) (2) (3)",
        LINE,
    )
    made.advance()
    first, second = made.frame.printed
    assert first == pytest.approx((5, 0.04, 7))
    assert second == made.frame.lines[0].start
    assert made.look_at == first
    assert made.camera.target == first


def test_forces_bend_branches():
    """Tropism after the thesis (section 2.3.2): half a right angle at unit torque, never beyond."""
    for strength, angle in [("0.5", 30), ("1", 45), ("2", 60), ("9", 81)]:
        made = animation("v () (1) () () (2) () ()", f"v () () () () () ({strength}'2*_) ()", LINE)
        way = np.subtract(made.frame.lines[0].end, made.frame.lines[0].start)
        assert math.degrees(math.atan2(-way[1], way[0])) == pytest.approx(angle)
    made = animation("v () () () () () (1_) ()", "v () (2) () () () () ()", LINE)
    assert made.frame.lines[0].end == pytest.approx((1, 0, 0))


def test_repetitions_keep_their_distance():
    head = (
        "RepetitionParameters rotate 0 0 0 rotate_max 0 360 0 scale 1 scale_max 2 "
        "startp_sidel_nbr_dist -50 100 40 0.6\n"
    )
    made = animation(LINE, head=head)
    starts = np.array([one.start for one in made.frame.lines])
    assert len(starts) == 40
    assert np.abs(starts[:, [0, 2]]).max() <= 50
    gaps = [math.dist(a, b) for at, a in enumerate(starts) for b in starts[:at]]
    assert min(gaps) >= 0.6 * 100 / math.sqrt(40)
    lengths = [math.dist(one.start, one.end) for one in made.frame.lines]
    assert 1 <= min(lengths) < max(lengths) <= 2
    made.advance()
    assert np.array([one.start for one in made.frame.lines]) == pytest.approx(starts)


def seen(made: str, tmp_path) -> np.ndarray:
    """Return the linear color in the middle of a picture of what stands there (3,)."""
    (tmp_path / "seen.lm").write_text(made)
    world = bio.World()
    animated = world.add(bio.Animated(tmp_path / "seen.lm", stroke=1))
    world.step()
    eye = animated.animation.camera.view()
    ((colors, _, ids),) = bio._engine.Rasterizer().look(world.scene, [eye], 25, 20)
    assert ids[10, 12] == animated.ids[0]
    return colors[10, 12, :3]


@pytest.mark.capability("NA-075", "NA-076")
def test_colors_are_seen_in_a_world(tmp_path):
    head = "Camera_AnimationParameters observer 0 0 10 lookatPoint 0 0 0"
    cube = "f () () () (2) (1_) () ()\nc () () () () (2) (2) (2)"
    whites = seen(text("m () (7) () () () () ()", cube, head=head), tmp_path)
    for number, material in MATERIALS.items():
        color = seen(text(f"m () ({number}) () () () () ()", cube, head=head), tmp_path)
        expected = np.array(material.diffuse) / MATERIALS[7].diffuse
        if material.specular <= 0.04:
            assert color / whites == pytest.approx(expected, rel=0.1, abs=0.03), material.name
    # An animated color, and that of a stroke as screens show it.
    color = seen(text("m () (4) () (1) (0.1) (0.2) (0.8)", cube, head=head), tmp_path)
    assert color / whites * 0.85 == pytest.approx((0.1, 0.2, 0.8), rel=0.1, abs=0.03)
    line = "f () () () (2) (3_) () ()\nR () () () () (6) () ()"
    blue = seen(text("r () () () () (51) (102) (255)", line, head=head), tmp_path)
    white = seen(text("r () () () () (255) (255) (255)", line, head=head), tmp_path)
    assert blue / white == pytest.approx((0.0331, 0.1329, 1), rel=0.1, abs=0.03)


def test_an_animation_in_a_world_is_saved_and_restored(tmp_path):
    (tmp_path / "ball.lm").write_text(
        text("C () () () () (T) (1) ()", "a () () () () (0.5) () ()", "b () (!) () () () () ()")
    )
    world = bio.World(seed=3, dt=0.03)
    ball = world.add(bio.Animated(tmp_path / "ball.lm", position=(0, 5, 0), scale=2))
    world.step(10)
    assert ball.animation.frame.number == 7
    world.save(tmp_path / "a.world")
    world.step(20)
    # Units of the model are two metres here; one unit per second upward.
    (batch,) = world.scene.batches
    assert batch.positions[0].tolist() == [0, 5, 0]
    assert batch.scales[0] == 2
    assert batch.mesh.positions[:, 1].mean() == pytest.approx(22 * 0.04, abs=0.01)
    again = bio.World.restore(tmp_path / "a.world")
    again.step(20)
    assert again.state_hash() == world.state_hash()
    (twin,) = again.scene.batches
    assert np.array_equal(twin.mesh.positions, batch.mesh.positions)
