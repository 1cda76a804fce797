"""A controller from outside: it reads what the body feels and contracts the muscles itself."""

import math

import numpy as np
import pytest

from bioscope.fish import Tank

BEAT, LAG = 0.16, math.pi
"""Beats per time unit, and lag of the tail behind the trunk."""


def contractions(time, bend):
    """Return those of all 12 muscles: a beat in the two hind segments within a bend to one side."""
    sides = []
    for side in (1, -1):
        curl, free = max(0.0, side * bend), 1 - abs(bend)
        wave = [0.5 + 0.5 * side * math.sin(math.tau * BEAT * time + lag) for lag in (0.0, LAG)]
        front, middle, tail = 0.7 * curl, curl + 0.3 * free * wave[0], 0.8 * curl
        sides.append((front, middle, tail + 0.7 * free * wave[1]))
    muscles = [[left, left, right, right] for left, right in zip(*sides, strict=True)]
    return np.clip(np.ravel(muscles), 0.0, 1.0)


def swim_to(goal, *, steers=True, seconds=12.0):
    """Return how near the fish comes to a place, metres."""
    tank = Tank("anthias")
    error, nearest = 0.0, math.inf
    for step in range(round(seconds / tank.dt)):
        away = np.subtract(goal, tank.center)
        bearing = math.remainder(math.atan2(away[0], away[2]) - tank.yaw, math.tau)
        # The beat swings the head: what repeats with it is no reason to turn.
        error += (bearing - error) * tank.dt / (4 * tank.time_unit)
        bend = float(np.clip(1.5 * error, -0.6, 0.6)) if steers else 0.0
        tank.step(contractions(step * tank.dt / tank.time_unit, bend))
        nearest = min(nearest, float(np.linalg.norm(np.subtract(goal, tank.center))))
    return nearest


@pytest.mark.capability("AA-011")
@pytest.mark.parametrize("goal", [(0.6, 0, 0.6), (-0.6, 0, 0.6), (0, 0, 0.8), (0.5, 0, -0.5)])
def test_a_program_swims_a_body_to_a_place_muscle_by_muscle(goal):
    assert swim_to(goal) < 0.5 * Tank("anthias").length


def test_without_looking_it_misses():
    assert swim_to((0.6, 0, 0.6), steers=False) > 0.3
