"""What the turtle of an animation does: turns, moves, bending, where it is."""

import math

import numpy as np
import pytest
from definitions import LINE, NONE, TURNS, animation, text

import bioscope as bio
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import Source


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
