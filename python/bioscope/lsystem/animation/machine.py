"""Postfix expressions as functions of what they refer to (thesis, appendix B).

Angles are degrees. What is not a finite number counts as 0, and so does a quotient by 0; both are
remarked once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from bioscope._engine import (
    arc_sine,
    cosine,
    exponential,
    hyperbolic_tangent,
    power,
    sine,
)
from bioscope.errors import FormatError
from bioscope.lsystem.animation.functions import FUNCTIONS, NEEDS, SENSES, spline_value
from bioscope.lsystem.definition.grammar import CURVED, LINEAR
from bioscope.lsystem.definition.postfix import TOKEN, hermite_array, spline_pieces

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from bioscope.lsystem.animation.scope import Scope
    from bioscope.lsystem.definition.grammar import Definition, Expression

    Value = Callable[[Scope], float]

REGISTERS = 8
"""Memory registers of a symbol."""
PARTS = 2_000
"""Most tokens of an expression: closures nest as deep."""
DEPTH = 200
"""How deep results may nest."""


@dataclass(slots=True)
class Compiler:
    """Makes functions of the expressions of one definition."""

    definition: Definition
    senses: Collection[str]
    """Names of the senses that the host gives."""
    known: dict[tuple[str, bool], Value] = field(default_factory=dict)

    def value(self, expression: Expression, *, in_field: bool = False) -> Value:
        """Return an expression as a function.

        Parameters
        ----------
        expression
            As it stands in the file.
        in_field
            Whether it is in a growth slot of `v`, `C` or `e`, where `r` is a distance.

        Raises
        ------
        FormatError
            If it is no expression, or asks for a sense that the host does not give.
        """
        key = (expression.text, in_field)
        if key not in self.known:
            self.known[key] = _finite(self._parsed(expression, in_field), expression)
        return self.known[key]

    def _parsed(self, expression: Expression, in_field: bool) -> Value:
        stack: list[tuple[Value, int, bool]] = []

        def pop() -> tuple[Value, int, bool]:
            if not stack:
                raise FormatError(f"{expression.place}: too few numbers in '({expression.text})'")
            return stack.pop()

        tokens = TOKEN.findall(expression.text)
        if len(tokens) > PARTS:
            raise FormatError(f"{expression.place}: an expression has at most {PARTS} parts")
        for token in tokens:
            if token == "'":
                continue
            unary, binary = self._unary(token, expression), _binary(token, expression)
            if binary is not None:
                (second, above, _), (first, below, _) = pop(), pop()
                made, depth = binary(first, second), max(above, below) + 1
            elif unary is not None:
                inner, depth, _ = pop()
                made, depth = unary(inner), depth + 1
            else:
                made, depth = self._operand(token, expression, in_field), 0
            if depth > DEPTH:
                raise FormatError(f"{expression.place}: the expression is nested too deeply")
            stack.append((made, depth, token in ("<", "?15", "?20", "?21", "?23")))
        return _last(stack, expression)

    def _unary(self, token: str, expression: Expression) -> Callable[[Value], Value] | None:
        if token == "?03":
            return self._spline(3, expression)
        if token == "?29":
            self._needs(token, expression)
            curve = hermite_array(self.definition)
            return lambda a: lambda scope: curve(a(scope))
        return _UNARY.get(token)

    def _operand(self, token: str, expression: Expression, in_field: bool) -> Value:
        if token[0].isdigit() or (token[0] == "." and len(token) > 1):
            number = float(token)
            return lambda scope: number
        if token == "r" and (in_field or "r" not in self.definition.constants):
            return lambda scope: scope.distance
        if token in _VARIABLES:
            return _VARIABLES[token]
        if token in LINEAR or token in CURVED:
            if token not in self.definition.constants:
                raise FormatError(f"{expression.place}: constant '{token}' is not declared")
            return constant(token, self.definition.constants[token])
        if token == "!":
            return lambda scope: scope.draw()
        if token == "#":
            low, width = self.definition.constants.get("#", [0.0, 1.0])
            return lambda scope: low + scope.draw() * width
        if token in ("?00", "?01", "?02"):
            along = self._spline(int(token[1:]), expression)
            return along(lambda scope: scope.time)
        if token[1:] in FUNCTIONS and token[0] == "?":
            self._needs(token, expression)
            return FUNCTIONS[token[1:]]
        if token[0] == "?" and token[1:] in SENSES:
            return self._sense(token, expression)
        raise FormatError(f"{expression.place}: '{token}' in '({expression.text})' means nothing")

    def _spline(self, number: int, expression: Expression) -> Callable[[Value], Value]:
        keys = self.definition.splines.get(number)
        if not keys:
            raise FormatError(f"{expression.place}: spline {number} is not declared")
        pieces = spline_pieces(keys)
        return lambda a: lambda scope: spline_value(pieces, a(scope))

    def _sense(self, token: str, expression: Expression) -> Value:
        name = SENSES[token[1:]]
        if name not in self.senses:
            raise FormatError(
                f"{expression.place}: '{token}' asks a sense of the actor, and nobody answers; "
                f"declare actors that see with 'NBR_actors', or give senses={{'{name}': ...}}"
            )
        return lambda scope: float(scope.stage.senses[name](scope.actor))

    def _needs(self, token: str, expression: Expression) -> None:
        number = NEEDS.get(token[1:])
        if number == "P":
            if "P" not in self.definition.constants:
                raise FormatError(f"{expression.place}: '{token}' needs the constant 'P'")
        elif number is not None and int(number) not in self.definition.arrays:
            raise FormatError(
                f"{expression.place}: '{token}' needs the constants 'fConst {number}'"
            )


def constant(name: str, values: list[float]) -> Value:
    """Return a constant of the file, which is a function of the global time."""
    first, second, *rest = values
    if not rest:
        return lambda scope: first + second * scope.time
    third = rest[0]
    if name in "EFG":
        return lambda scope: first + second * scope.time + third * scope.time * scope.time
    if name in "HIJ":
        return lambda scope: first + second * cosine(math.radians(third * scope.time))
    if name in "KLMNO":
        return lambda scope: first + second * sine(math.radians(third * scope.time))
    return lambda scope: first + second * exponential(third * scope.time)


def _last(stack: list[tuple[Value, int, bool]], expression: Expression) -> Value:
    """Return the value on top; what is below it is evaluated for what it remembers alone."""
    if not stack:
        return lambda scope: 0.0
    *below, (top, _, _) = stack
    if not all(remembers for _, _, remembers in below):
        raise FormatError(
            f"{expression.place}: {len(stack)} numbers are left over in '({expression.text})'"
        )
    if not below:
        return top
    first = [one for one, _, _ in below]

    def run(scope: Scope) -> float:
        for one in first:
            one(scope)
        return top(scope)

    return run


def _finite(value: Value, expression: Expression) -> Value:
    def run(scope: Scope) -> float:
        found = value(scope)
        if math.isfinite(found):
            return found
        scope.remark(f"{expression.place}: '({expression.text})' is no finite number; 0 is taken")
        return 0.0

    return run


def _register(index: float) -> int:
    return int(index) if 0 <= index < REGISTERS else REGISTERS - 1


def _stored(first: Value, second: Value) -> Value:
    def run(scope: Scope) -> float:
        index, number = first(scope), second(scope)
        scope.memory[_register(index)] = number
        return number

    return run


def _stepped(first: Value, second: Value) -> Value:
    def run(scope: Scope) -> float:
        a = first(scope)
        return 0.0 if a < second(scope) or a < 0 else 1.0

    return run


def _channel(first: Value, second: Value) -> Value:
    return lambda scope: scope.stage.channel(first(scope), second(scope))


def _guarded(of: Callable[[float, float], float]) -> Callable[[Expression], _Binary]:
    """Return an operation that has no value for a second number of 0."""

    def at(expression: Expression) -> _Binary:
        def combine(first: Value, second: Value) -> Value:
            def run(scope: Scope) -> float:
                a, b = first(scope), second(scope)
                if b != 0:
                    return of(a, b)
                scope.remark(
                    f"{expression.place}: division by 0 in '({expression.text})'; 0 is taken"
                )
                return 0.0

            return run

        return combine

    return at


if TYPE_CHECKING:
    _Binary = Callable[[Value, Value], Value]

_BINARY: dict[str, _Binary] = {
    "+": lambda a, b: lambda scope: a(scope) + b(scope),
    "-": lambda a, b: lambda scope: a(scope) - b(scope),
    "*": lambda a, b: lambda scope: a(scope) * b(scope),
    "^": lambda a, b: lambda scope: power(a(scope), b(scope)),
    "~": _stepped,
    "<": _stored,
    "?50": _channel,
}
_GUARDED = {
    "/": _guarded(lambda a, b: a / b),
    "%": _guarded(lambda a, b: a - b * math.floor(a / b) if math.isfinite(a / b) else 0.0),
}


def _binary(token: str, expression: Expression) -> _Binary | None:
    return _GUARDED[token](expression) if token in _GUARDED else _BINARY.get(token)


_UNARY: dict[str, Callable[[Value], Value]] = {
    "|": lambda a: lambda scope: abs(a(scope)),
    "_": lambda a: lambda scope: -a(scope),
    "$": lambda a: lambda scope: sine(math.radians(a(scope))),
    "&": lambda a: lambda scope: cosine(math.radians(a(scope))),
    ":": lambda a: lambda scope: math.degrees(arc_sine(a(scope))),
    '"': lambda a: lambda scope: hyperbolic_tangent(a(scope)),
    ">": lambda a: lambda scope: scope.memory[_register(a(scope))],
    "?08": lambda a: lambda scope: min(1.0, max(0.0, a(scope))),
    "?44": lambda a: lambda scope: scope.replaced_memory[_register(a(scope))],
}
_VARIABLES: dict[str, Value] = {
    "t": lambda scope: scope.age,
    "T": lambda scope: scope.time,
    "x": lambda scope: scope.place[0],
    "y": lambda scope: scope.place[1],
    "z": lambda scope: scope.place[2],
    "u": lambda scope: scope.velocity[0],
    "v": lambda scope: scope.velocity[1],
    "w": lambda scope: scope.velocity[2],
    "X": lambda scope: scope.source[0],
    "Y": lambda scope: scope.source[1],
    "Z": lambda scope: scope.source[2],
    "U": lambda scope: scope.source_velocity[0],
    "V": lambda scope: scope.source_velocity[1],
    "W": lambda scope: scope.source_velocity[2],
}
