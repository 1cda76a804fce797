"""The nine motor controllers, alone and together."""

import numpy as np
import pytest

import bioscope as bio


def cruising(**options) -> bio.fish.Tank:
    """A fish that has been swimming at its cruising speed for a while."""
    tank = bio.fish.Tank("anthias", **options)
    tank.kick((0, 0, tank.cruise))
    tank.swim(tank.cruise)
    tank.run(4)
    return tank


def mean_heading(tank: bio.fish.Tank, beats: float = 2.0) -> float:
    """Heading averaged over some tail beats."""
    beat = np.interp(tank.cruise, tank.strokes[:, 0], tank.strokes[:, 1])
    yaws = []
    for _ in range(round(beats / beat / tank.dt)):
        tank.step()
        yaws.append(tank.yaw)
    return float(np.unwrap(yaws).mean())


def turned(tank: bio.fish.Tank, angle: float) -> float:
    """Turn, swim on for a while, and return the change of the mean heading, radians."""
    before = mean_heading(tank)
    tank.turn(angle)
    waited = 0.0
    while tank.turning and waited < 60:
        tank.step(steps=20)
        waited += 20 * tank.dt
    assert not tank.turning
    tank.run(3)
    after = mean_heading(tank)
    return (after - before + np.pi) % (2 * np.pi) - np.pi


@pytest.mark.capability("TF-030", "TF-031", "TF-032", "TF-046", "AA-024")
def test_speed_follows_the_command():
    tank = bio.fish.Tank("anthias")
    commanded = np.linspace(0.3, 1.6, 5) * tank.cruise
    reached = []
    for speed in commanded:
        tank.swim(speed)
        tank.run(8)
        start = tank.center
        tank.run(4)
        reached.append(np.linalg.norm(tank.center - start) / 4)
    assert (np.diff(reached) > 0).all()
    assert reached == pytest.approx(commanded, rel=0.15)
    strokes = tank.strokes[1:]
    effort = strokes[:, 1] * strokes[:, 3]
    below = strokes[:, 0] < 0.9 * tank.top_speed
    assert np.corrcoef(effort[below], strokes[below, 0])[0, 1] ** 2 > 0.8
    for frequency_or_amplitude in (strokes[:, 1], strokes[:, 3]):
        linear = np.corrcoef(frequency_or_amplitude[below], strokes[below, 0])[0, 1] ** 2
        assert linear >= 0.9


@pytest.mark.capability("TF-033")
def test_the_body_is_s_shaped():
    tank = cruising()
    bends = []
    for _ in range(400):
        tank.step()
        line = np.array([tank.nodes[4 * k - 3 : 4 * k + 1].mean(axis=0) for k in range(1, 6)])
        step = np.diff(line[:, [0, 2]], axis=0)
        bends.append(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
    bends = np.array(bends)
    assert np.corrcoef(bends[:, 0], bends[:, 1])[0, 1] < -0.5


@pytest.mark.capability("TF-034", "TF-035", "AA-025")
@pytest.mark.parametrize("degrees", [30, 45, 60, 90, -30, -90, 37, 76, 140])
def test_turns_reach_their_angle(degrees):
    angle = np.degrees(turned(cruising(), np.radians(degrees)))
    assert angle == pytest.approx(degrees, rel=0.1)
    assert angle == pytest.approx(degrees, abs=10)


def quick_turn(seconds: float) -> tuple[float, float]:
    """Swim for a while, turn by 90 degrees: radius in body lengths, seconds to 80 degrees."""
    tank = cruising()
    tank.run(seconds)
    start = tank.yaw
    tank.turn(np.pi / 2)
    now, track = tank.center, []
    while not track or track[-1][0] < np.radians(80):
        tank.step()
        before, now = now, tank.center
        yaw = float(np.unwrap([start, tank.yaw])[1]) - start
        track.append((yaw, np.linalg.norm(now - before)))
        assert len(track) * tank.dt < 2
    angles, ways = np.array(track).T
    turning = slice(int(np.argmax(angles > np.radians(15))), None)
    span = angles[-1] - angles[turning][0]
    return ways[turning].sum() / span / tank.length, len(track) * tank.dt


@pytest.mark.capability("TF-034")
def test_turns_are_as_tight_and_as_quick_as_a_fishs():
    turns = [quick_turn(0.1 * number) for number in range(6)]
    radius, seconds = np.mean(turns, axis=0)
    assert 0.15 < radius < 0.5
    assert 0.3 < seconds < 0.8


@pytest.mark.capability("TF-044", "AA-026")
def test_fins_against_each_other_roll_and_turn():
    tank = cruising()
    tank.place(roll=np.pi / 6)
    tank.kick((0, 0, tank.cruise))
    tank.step(steps=3)
    left, right = tank.fins
    assert abs(left - right) > 0.1
    tank.run(1)
    assert abs(tank.roll) < np.radians(10)
    still = bio.fish.Tank("anthias")
    still.turn(np.pi / 2)
    still.run(1.5)
    assert still.yaw > np.radians(60)


@pytest.mark.capability("TF-037")
@pytest.mark.parametrize("degrees", [30, 60, 90, -60])
def test_a_turn_is_a_fast_bend_and_a_slow_recovery_that_keeps_the_heading(degrees):
    tank = cruising()
    tank.feedback(False)
    tank.glide()
    tank.run(0.5)
    yaws, bends = [tank.yaw], []
    tank.turn(np.radians(degrees))
    while tank.turning:
        tank.step()
        yaws.append(tank.yaw)
        bends.append(tank.contraction[:4].max())
    angles = np.abs(np.degrees(np.unwrap(yaws) - yaws[0]))[1:]
    deepest = np.flatnonzero(bends >= max(bends) - 1e-4)
    first, recovery = int(deepest[0]), int(deepest[-1])
    assert len(bends) - recovery > 3 * (first + 1), "the recovery is the slow part"
    assert abs(angles[-1] - angles[recovery]) < 0.2 * angles[-1]


@pytest.mark.capability("TF-036", "AA-025")
def test_a_u_turn_is_made_of_parts():
    angle = np.degrees(turned(cruising(), np.pi))
    assert abs(abs(angle) - 180) < 20


@pytest.mark.capability("TF-035", "TF-046")
def test_the_steering_map_rises():
    bends = bio.fish.Tank("anthias").bends
    assert (np.diff(bends[:, 0]) > 0).all()
    assert (np.diff(bends[:, 1]) >= 0).all()


@pytest.mark.capability("TF-038")
def test_gliding_lets_the_muscles_rest():
    tank = cruising()
    tank.glide()
    tank.run(2)
    assert tank.contraction.max() < 0.05
    assert 0.2 * tank.cruise < np.linalg.norm(tank.velocity) < tank.cruise


@pytest.mark.capability("TF-039", "TF-040", "TF-045", "AA-026")
@pytest.mark.parametrize("up", [True, False])
def test_fish_swim_and_climb_at_once(up):
    tank = cruising()
    (tank.ascend if up else tank.descend)(0.5)
    tank.step(steps=5)
    fin = np.mean(tank.fins)
    low, high = (np.pi / 2, 3 * np.pi / 4) if up else (np.pi / 4, np.pi / 2)
    assert low - 1e-3 <= fin <= high + 1e-3
    start = tank.center
    tank.run(3)
    rise = tank.center[1] - start[1]
    assert rise * (1 if up else -1) > 0.3 * tank.length
    assert tank.velocity[2] > 0.5 * tank.cruise


@pytest.mark.capability("TF-041")
def test_balance_rights_the_body():
    tank = bio.fish.Tank("anthias")
    tank.place(roll=np.pi / 4)
    assert abs(tank.roll) == pytest.approx(np.pi / 4, abs=1e-3)
    tank.kick((0, 0, tank.cruise))
    tank.swim(tank.cruise)
    tank.balance()
    tank.run(5)
    assert abs(tank.roll) < np.radians(5)


@pytest.mark.capability("TF-042", "AA-026")
def test_braking_is_faster_than_gliding():
    speeds = []
    for verb in ("glide", "brake"):
        tank = cruising()
        getattr(tank, verb)()
        tank.run(1)
        speeds.append(np.linalg.norm(tank.velocity))
    assert speeds[1] < 0.75 * speeds[0]


@pytest.mark.capability("TF-043")
def test_rowing_goes_backward():
    tank = bio.fish.Tank("anthias")
    tank.backward(0.2 * tank.cruise)
    tank.run(3)
    assert tank.velocity[2] == pytest.approx(-0.2 * tank.cruise, rel=0.25)
