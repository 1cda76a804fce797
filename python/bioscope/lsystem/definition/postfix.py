"""Postfix expressions of definition files, as infix expressions of our own notation.

Angles are degrees. `t` is the age of a symbol, `T` the time, `x y z` its parameters; what belongs
to particles (`u v w X Y Z`) is zero. Division by zero gives zero, `%` is floored.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from bioscope.errors import FormatError
from bioscope.lsystem.definition.grammar import CURVED, LINEAR, Definition, Expression

if TYPE_CHECKING:
    from collections.abc import Callable

TOKEN = re.compile(r"\d+\.?\d*|\.\d+|\?\d\d|.")
UNARY = {
    "|": "abs({})",
    "_": "(-{})",
    "$": "sin({})",
    "&": "cos({})",
    ":": "asin({})",
    '"': "tanh({})",
    "?08": "min(1, max(0, {}))",
}
BINARY = {"+": "({} + {})", "-": "({} - {})", "*": "({} * {})", "^": "({} ^ {})"}
VARIABLES = {"t": "age", "T": "T", "x": "x", "y": "y", "z": "z"}
PARTICLES = set("uvwXYZ")
LONGEST = 20_000
HERMITE = 5
"""Which constant array `?28` and `?29` take their coefficients from."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What expressions refer to."""

    definition: Definition
    growth: tuple[str, ...] = ("0", "0", "0")
    """Growth values of the symbol that is replaced, for `?41` to `?43`."""


def infix(expression: Expression, around: Surroundings) -> str:
    """Return an expression in infix notation.

    Raises
    ------
    FormatError
        If it is none, or uses what only actors, particles and memories have.
    """
    stack: list[str] = []

    def pop() -> str:
        if not stack:
            raise FormatError(f"{expression.place}: too few numbers in '({expression.text})'")
        return stack.pop()

    for token in TOKEN.findall(expression.text):
        if token == "'":
            continue
        if token in UNARY:
            stack.append(UNARY[token].format(pop()))
        elif token in BINARY or token in "/%~":
            second, first = pop(), pop()
            stack.append(_binary(token, first, second))
        elif token in ("?03", "?29"):
            stack.append(_function(token, pop(), expression, around))
        else:
            stack.append(_operand(token, expression, around))
        if len(stack[-1]) > LONGEST:
            raise FormatError(f"{expression.place}: the expression is too large")
    if len(stack) > 1:
        raise FormatError(
            f"{expression.place}: {len(stack)} numbers are left over in '({expression.text})'"
        )
    return stack[0] if stack else "0"


def _binary(token: str, first: str, second: str) -> str:
    if token == "/":
        if re.fullmatch(r"[\d.]+", second) and float(second) != 0:
            return f"({first} / {second})"
        return f"({second} == 0 ? 0 : {first} / {second})"
    if token == "%":
        return f"({first} - {second} * floor({first} / {second}))"
    if token == "~":
        return f"({first} < {second} || {first} < 0 ? 0 : 1)"
    return BINARY[token].format(first, second)


def _operand(token: str, expression: Expression, around: Surroundings) -> str:
    constants = around.definition.constants
    if token[0].isdigit() or (token[0] == "." and len(token) > 1):
        return token
    if token in VARIABLES:
        return VARIABLES[token]
    if token in constants and token != "#":
        return _constant(token, constants[token])
    if token in PARTICLES or token == "r":
        return "0"
    if token in LINEAR or token in CURVED:
        raise FormatError(f"{expression.place}: constant '{token}' is not declared")
    if token == "!":
        return "ran(1)"
    if token == "#":
        low, width = constants.get("#", [0.0, 1.0])
        return f"({low:.17g} + ran(1) * {width:.17g})"
    if token in ("?00", "?01", "?02"):
        return _spline(int(token[1:]), "T", expression, around.definition)
    if token == "?28":
        return _function("?29", "age", expression, around)
    if token in ("?41", "?42", "?43"):
        return f"({around.growth[int(token[1:]) - 41]})"
    raise FormatError(
        f"{expression.place}: '{token}' in '({expression.text})' belongs to actors, particles, "
        "senses or memories, which a plant has not; bioscope.lsystem.Animation has them"
    )


def _constant(name: str, values: list[float]) -> str:
    first, second, *third = (f"{value:.17g}" for value in values)
    first, second = f"({first})", f"({second})"
    if not third:
        return f"({first} + {second} * T)"
    if name in "EFG":
        return f"({first} + {second} * T + ({third[0]}) * T * T)"
    function = "cos" if name in "HIJ" else "sin" if name in "KLMNO" else "exp"
    return f"({first} + {second} * {function}(({third[0]}) * T))"


def _function(token: str, argument: str, expression: Expression, around: Surroundings) -> str:
    if token == "?03":
        return _spline(3, argument, expression, around.definition)
    array = around.definition.arrays.get(HERMITE)
    if array is None:
        raise FormatError(f"{expression.place}: '{token}' needs the constants 'fConst {HERMITE}'")
    grown, low, high, offset = array[:4]
    return _hermite(f"({argument} + ({offset:.17g}))", grown, low, high)


def _hermite(argument: str, grown: float, low: float, high: float) -> str:
    """Rise smoothly from `low` at 0 to `high` at `grown` (section 3.10)."""
    share = f"(min(1, max(0, {argument} / {grown:.17g})))" if grown else f"({argument} > 0)"
    rise = high - low
    return f"({low:.17g} + ({rise:.17g}) * {share} * {share} * (3 - 2 * {share}))"


def hermite(argument: float, grown: float, low: float, high: float) -> float:
    """Rise smoothly from `low` at 0 to `high` at `grown` (section 3.10)."""
    share = min(1.0, max(0.0, argument / grown)) if grown else float(argument > 0)
    return low + (high - low) * share * share * (3 - 2 * share)


def hermite_array(definition: Definition) -> Callable[[float], float]:
    """Return `?29`: the rise that constant array 5 describes."""
    grown, low, high, offset = definition.arrays[HERMITE][:4]
    return lambda argument: hermite(argument + offset, grown, low, high)


@dataclass(frozen=True, slots=True)
class Pieces:
    """A spline: cubics between its keys, constant outside."""

    start: float
    """Where it begins."""
    before: float
    """Its value until there."""
    after: float
    """Its value after its last key."""
    pieces: list[tuple[float, float, float, tuple[float, float, float, float]]]
    """Begin, end and width, and the coefficients of the powers 0 to 3 of the share of the way."""


def spline_pieces(keys: list[tuple[float, float]]) -> Pieces:
    """Return the spline through all keys with one slope at each (Catmull-Rom)."""
    pieces = []
    if len(keys) > 1:
        ends = range(1, len(keys) - 1)
        chords = [(0, 1), *((at - 1, at + 1) for at in ends), (-2, -1)]
        slopes = [(keys[b][1] - keys[a][1]) / (keys[b][0] - keys[a][0]) for a, b in chords]
        for at, ((start, low), (end, high)) in enumerate(pairwise(keys)):
            width = end - start
            a, b = slopes[at] * width, slopes[at + 1] * width
            cubic, square = 2 * (low - high) + a + b, 3 * (high - low) - 2 * a - b
            pieces.append((start, end, width, (low, a, square, cubic)))
    return Pieces(keys[0][0], keys[0][1], keys[-1][1], pieces)


def _spline(number: int, argument: str, expression: Expression, definition: Definition) -> str:
    keys = definition.splines.get(number)
    if not keys:
        raise FormatError(f"{expression.place}: spline {number} is not declared")
    spline = spline_pieces(keys)
    text = f"({spline.after:.17g})"
    for start, end, width, (low, linear, square, cubic) in reversed(spline.pieces):
        way = f"(({argument} - ({start:.17g})) / {width:.17g})"
        value = f"((({cubic:.17g}) * {way} + ({square:.17g})) * {way} + ({linear:.17g})) * {way}"
        text = f"({argument} < {end:.17g} ? ({low:.17g}) + {value} : {text})"
    return f"({argument} < {spline.start:.17g} ? ({spline.before:.17g}) : {text})"
