"""The special functions `?nn` of definition files (thesis, appendix B, table B5).

`?03`, `?08`, `?29`, `?44` and `?50` take numbers from the stack and are in `machine.py`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bioscope._engine import power, sine
from bioscope.lsystem.animation.scope import uniform
from bioscope.lsystem.animation.vectors import ZERO, dot, length, subtract, times
from bioscope.lsystem.definition.postfix import hermite

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.lsystem.animation.scope import Scope
    from bioscope.lsystem.definition.postfix import Pieces

    Value = Callable[[Scope], float]

GRAVITY = 9.81
"""m/s²; the thesis prints `91*mass`, its decimals are lost."""
NEAR = 1e-20
TOUCH_OF_GROUND = 0.5
"""Share of the range of `?27` at which a ball is heard to hit the ground."""
BALL_ON_GROUND = 1
"""Number of that sound."""

SENSES = {
    "30": "distance",
    "31": "obstacle",
    "32": "looks_at_goal",
    "33": "near_goal",
    "35": "automaton",
    "36": "interest",
    "37": "color_of_interest",
    "38": "color_of_interest_as_goal",
    "39": "at_goal",
}
"""Functions that only the eyes and automata of an actor can answer: the host gives them by name."""

NEEDS = {
    "12": "P",
    "13": "P",
    "14": "P",
    "15": "0",
    "19": "1",
    "21": "3",
    "23": "4",
    "26": "5",
    "27": "6",
    "28": "5",
    "29": "5",
}
"""The constant or constant array that a function takes its coefficients from."""


def spline_value(pieces: Pieces, at: float) -> float:
    """Return a spline's value; the first and the last outside its keys."""
    if at < pieces.start:
        return pieces.before
    for begin, end, width, coefficients in pieces.pieces:
        if at < end:
            share = (at - begin) / width
            low, linear, square, cubic = coefficients
            return low + ((cubic * share + square) * share + linear) * share
    return pieces.after


def _toward_source(scope: Scope) -> float:
    if scope.distance < NEAR:
        return 1.0
    return (scope.source[0] - scope.place[0]) / scope.distance


def _walls(axis: int) -> Value:
    """Return a pair of walls across an axis, as far and as strong as the constant P says."""

    def push(scope: Scope) -> float:
        low, high, force = scope.arrays[-1][:3]
        return force * ((scope.place[axis] < low) - (scope.place[axis] > high))

    return push


def _racket(scope: Scope) -> float:
    """Return a racket's push along x; the thesis's equation is lost, this one is derived.

    Away from its face, within its radius, falling off with the distance from its plane.
    """
    stage = scope.stage
    array = scope.arrays[0]
    a, b, p = array[4:7]
    normal = (array[0], array[1], array[2])
    offset = subtract(scope.place, scope.source)
    ahead = dot(offset, normal)
    aside = length(subtract(offset, times(normal, ahead)))
    stage.racket = ZERO
    if aside < array[3] and ahead != 0:
        stage.racket = times(normal, math.copysign(a * power(b, -p * ahead * ahead), ahead))
    array[7] = length(stage.racket)
    return stage.racket[0]


def _net(scope: Scope) -> float:
    a, b, c, d, e = scope.arrays[1][:5]
    height, width = scope.arrays[1][5:7]
    x, y, z = scope.place
    below = power((x - a) / b, c) + d if b != 0 else 0.0
    if not (0 < y < height and 0 < z < width) or below == 0:
        return 0.0
    return (x - a - scope.velocity[0] * e) / below


def _swim(scope: Scope) -> float:
    particle = scope.particle
    if particle is None:
        return 0.0
    if particle.swam_at != scope.stage.tick:
        particle.swam_at = scope.stage.tick
        particle.phase += 0.2 * length(particle.velocity) * scope.stage.interval
    return 5 * sine(particle.phase)


def _shape(scope: Scope) -> float:
    array, stage = scope.arrays[3], scope.stage
    p = []
    for index in range(4):
        draw = uniform(stage.seed, scope.layer, scope.repetition, index, 21)
        p.append(((draw - 0.5) * array[2 * index + 1] + 1) * array[2 * index])
    stage.shape = p[0] + p[1] * sine(math.radians(p[2] * scope.time + p[3]))
    return stage.shape


def _generic(scope: Scope) -> float:
    c = scope.arrays[4]
    r, below = scope.distance, scope.distance + c[4]
    rise = power(c[1], c[2] * power(r, c[3]))
    scope.stage.generic = c[0] * rise / below if below != 0 else 0.0
    return scope.stage.generic


def _ball_ground(scope: Scope) -> float:
    array, particle = scope.arrays[6], scope.particle
    force = hermite(array[3] - scope.place[1], *array[:3])
    if particle is not None:
        hits = force > array[1] + TOUCH_OF_GROUND * (array[2] - array[1])
        if hits and not particle.grounded:
            scope.stage.air.begin(BALL_ON_GROUND, particle.owner.id, scope.place)
        particle.grounded = hits
    return force


def _ground(scope: Scope) -> float:
    array = scope.arrays[5]
    return hermite(array[0] + array[3] - scope.place[1], *array[:3])


def _aged(scope: Scope) -> float:
    array = scope.arrays[5]
    return hermite(scope.age + array[3], *array[:3])


def _phase(scope: Scope) -> float:
    return scope.particle.phase if scope.particle is not None else 0.0


FUNCTIONS: dict[str, Value] = {
    "09": _toward_source,
    "12": _walls(0),
    "13": _walls(1),
    "14": _walls(2),
    "15": _racket,
    "16": lambda scope: scope.stage.racket[1],
    "17": lambda scope: scope.stage.racket[2],
    "18": lambda scope: GRAVITY * scope.particle.mass if scope.particle is not None else 0.0,
    "19": _net,
    "20": _swim,
    "21": _shape,
    "22": lambda scope: scope.stage.shape,
    "23": _generic,
    "24": lambda scope: scope.stage.generic,
    "25": lambda scope: 0.5 * sine(_phase(scope)),
    "26": _ground,
    "27": _ball_ground,
    "28": _aged,
    "34": lambda scope: math.degrees(_phase(scope)),
    "40": lambda scope: scope.stage.touch(scope.place, scope.actor),
    "41": lambda scope: scope.growth[0],
    "42": lambda scope: scope.growth[1],
    "43": lambda scope: scope.growth[2],
    "60": lambda scope: float(scope.stage.air.count()),
    "61": lambda scope: float(scope.stage.air.sound_of(scope.place[0])),
    "62": lambda scope: float(scope.stage.air.source_of(scope.place[0])),
}
"""By number: what a function without arguments is worth."""
