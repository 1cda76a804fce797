"""What an animation looks like: materials, strokes, cameras, and all of it in a world."""

import math

import numpy as np
import pytest

import bioscope as bio
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import MATERIALS, Device

NONE = "() () () () () () ()"
LINE = "R () () () () (1) () ()"


def text(*symbols: str, head: str = "") -> str:
    return f"{head}\nAxiom\n" + "\n".join(symbols) + "\nProductions\nEndProductions\n"


def animation(*symbols: str, head: str = "", **options) -> Animation:
    return Animation(text(*symbols, head=head), **options)


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
