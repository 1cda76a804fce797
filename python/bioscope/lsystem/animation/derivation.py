"""Strings of timed symbols and their step in time (thesis, section 2.1.3).

Every frame a symbol grows older by the interval; the first production of the file whose terminal
age it has reached, whose condition holds and whose context fits replaces it. Contexts are read
from the string before the step. A production without condition and context hands on by how much
its symbol was too old, so that the length of the interval does not matter; other symbols begin
at their initial age.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from bioscope.errors import FormatError, LimitError
from bioscope.lsystem.animation.particles import Particle
from bioscope.lsystem.animation.scope import Scope, uniform
from bioscope.lsystem.animation.vectors import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bioscope.lsystem.animation.frame import Piece
    from bioscope.lsystem.animation.machine import Compiler
    from bioscope.lsystem.animation.scope import Stage
    from bioscope.lsystem.definition.grammar import Definition, Expression, Rule, Template

    Value = Callable[[Scope], float]

IGNORED = "+-/$^&mn"
"""What no context sees."""
LENGTH = 1_000_000
"""Most symbols of a string."""
AGAIN = 64
"""Most replacements of a symbol and its successors within one frame."""
SLACK = 1e-9
"""Seconds by which an age may fall short because times are rounded."""
COMPARISONS: dict[str, Callable[[float], bool]] = {
    "<": lambda value: value < 0,
    "p": lambda value: value <= 0,
    ">": lambda value: value > 0,
    "g": lambda value: value >= 0,
    "=": lambda value: value == 0,
    "!": lambda value: value != 0,
}


@dataclass(slots=True, eq=False)
class Instance:
    """A symbol of the string."""

    symbol: str
    id: int
    age: float
    parameters: Vector
    programs: tuple[Value, Value, Value]
    layer: int
    varies: bool = False
    """Whether its growth values differ between the places where its string is drawn."""
    growth: Vector = ZERO
    memory: list[float] = field(default_factory=lambda: [0.0] * 8)
    particle: Particle | None = None
    sensed: tuple[int, Particle | None] = (0, None)
    """The actor and the particle that were current when it was last drawn."""
    shown: bool = False
    drawn: dict[int, tuple[tuple[object, ...], Piece]] | None = None
    """What it showed last where its string was drawn, and of what that was made."""

    def mode(self, number: int) -> int:
        """Return parameter 1 to 3 as a whole number, which selects what some symbols do."""
        return round(self.parameters[number - 1])

    @property
    def opens(self) -> bool:
        """Whether it begins a branch."""
        return self.symbol == "[" and self.mode(1) == 0

    @property
    def closes(self) -> bool:
        """Whether it ends a branch."""
        return self.symbol == "]" and self.mode(1) == 0

    @property
    def ignored(self) -> bool:
        """Whether contexts look past it; stored and recalled positions are no branches."""
        return self.symbol in IGNORED or (self.symbol in "[]" and self.mode(1) != 0)

    def path(self, stage: Stage, time: float, particle: Particle) -> Vector:
        """Return where its growth values lead its particle at a time."""
        scope = Scope(stage, time, age=self.age, memory=self.memory, particle=particle)
        scope.place, scope.velocity = particle.position, particle.velocity
        scope.identity, scope.layer = self.id, self.layer
        first, second, third = self.programs
        return first(scope), second(scope), third(scope)


@dataclass(slots=True)
class Sprout:
    """A symbol of a successor, not yet made."""

    symbol: str
    values: tuple[Value, ...]
    """Age and parameters, computed when it is made."""
    programs: tuple[Value, Value, Value]
    varies: bool
    words: str
    """Its first growth slot as it is written."""
    place: str


@dataclass(slots=True)
class Production:
    """A production whose expressions are functions."""

    age: Value
    condition: list[tuple[Value, Callable[[float], bool]] | str]
    left: str
    right: str
    alternatives: list[tuple[float, list[Sprout]]]
    place: str
    rule: Rule

    @property
    def carries(self) -> bool:
        """Whether it hands on by how much its symbol was too old."""
        return not (self.condition or self.left or self.right)


class Derivation:
    """The string of one definition file."""

    def __init__(self, definition: Definition, compiler: Compiler, layer: int) -> None:
        self.layer = layer
        self.compiler = compiler
        self.productions: dict[str, list[Production]] = {}
        for rule in definition.rules:
            self.productions.setdefault(rule.symbol, []).append(self._production(rule))
        self.axiom = [self._sprout(one) for one in definition.axiom]
        for one in definition.axiom:
            if one.symbol == "]" and _cuts(one.slots[1]):
                raise FormatError(f"{one.place}: a cut in the axiom")
        self.string: list[Instance] = []

    def begin(self, crew: Crew) -> None:
        """Make the axiom; what its expressions refer to is zero."""
        pen = _Pen(self, crew, [], 0.0)
        pen.write(self.axiom, crew.scope(self.layer), 0.0)
        self.string = pen.new

    def step(self, crew: Crew, seconds: float) -> None:
        """Let the string grow older."""
        pen = _Pen(self, crew, self.string, seconds)
        pen.run()
        self.string = pen.new

    def _sprout(self, template: Template) -> Sprout:
        fields = template.symbol in "vCe"
        value = self.compiler.value
        first, second, third = (
            (lambda scope: 0.0)
            if template.symbol == "e" and template.slots[1].text in ("", "0")
            else value(one, in_field=fields)
            for one in template.slots[4:]
        )
        varies = any("?21" in one.text or "?22" in one.text for one in template.slots[4:])
        values = tuple(map(value, template.slots[:4]))
        words = template.slots[4].words
        made = (first, second, third)
        return Sprout(template.symbol, values, made, varies, words, template.place)

    def _production(self, rule: Rule) -> Production:
        total = sum(chance for chance, _ in rule.alternatives)
        if total > 1 + 1e-6 or any(chance < 0 for chance, _ in rule.alternatives):
            raise FormatError(f"{rule.place}: the probabilities sum to {total:g}, more than 1")
        condition: list[tuple[Value, Callable[[float], bool]] | str] = []
        pending: list[Value] = []
        depth = 0
        for part in rule.condition:
            if not isinstance(part, str):
                pending.append(self.compiler.value(part))
            elif part.startswith("0"):
                condition.append((pending.pop(), COMPARISONS[part[1]]))
                depth += 1
            else:
                needed = 1 if part == "!" else 2
                if depth < needed:
                    raise FormatError(f"{rule.place}: too few conditions before '{part}'")
                depth -= needed - 1
                condition.append(part)
        if depth > 1:
            raise FormatError(f"{rule.place}: conditions that no '&' or '|' connects")
        alternatives = [
            (chance, [self._sprout(one) for one in made]) for chance, made in rule.alternatives
        ]
        age = self.compiler.value(rule.age)
        return Production(age, condition, rule.left, rule.right, alternatives, rule.place, rule)


class Crew:
    """What strings need of the stage: identities, particles, behaviors."""

    def __init__(self, stage: Stage, most: int, push: Callable[[str, str], None]) -> None:
        self.stage = stage
        self.time = 0.0
        self.most = most
        """Most particles."""
        self.push = push
        """Puts the commands of an automaton on the stack of its actor."""
        self.made = 0
        self.particles: list[Particle] = []

    def scope(self, layer: int) -> Scope:
        """Return an empty scope at the present time."""
        return Scope(self.stage, self.time, layer=layer)

    def identity(self) -> int:
        """Return the next identity."""
        self.made += 1
        return self.made

    def enroll(self, owner: Instance, fields: dict[int, tuple[Value, ...]], place: str) -> None:
        """Give a symbol `C` its particle, unless there are too many."""
        if len(self.particles) >= self.most:
            self.stage.remark(
                f"{place}: no particle for 'C': there are {self.most}, as many as MaxPart allows"
            )
            return
        owner.particle = Particle(owner, fields.get(10), fields.get(11), swam_at=self.stage.tick)
        self.particles.append(owner.particle)


class _Pen:
    """Writes the next string."""

    def __init__(
        self, derivation: Derivation, crew: Crew, old: list[Instance], seconds: float
    ) -> None:
        self.derivation, self.crew, self.old, self.seconds = derivation, crew, old, seconds
        self.new: list[Instance] = []
        self.open: list[int] = []
        """Where the branches begin in the new string that are open."""
        self.at = 0

    def run(self) -> None:
        while self.at < len(self.old):
            one = self.old[self.at]
            self.at += 1
            one.age += self.seconds
            found = self.applicable(one, self.at - 1)
            if found is None:
                self.emit(one)
            else:
                self.replace(one, *found, 0)

    def emit(self, one: Instance) -> None:
        if one.opens:
            self.open.append(len(self.new))
        elif one.closes and self.open:
            self.open.pop()
        self.new.append(one)

    def applicable(
        self, one: Instance, index: int | None
    ) -> tuple[Production, list[Sprout], float] | None:
        """Return the first production that applies, what it makes, and how much too old one is.

        A symbol made in this step has no index yet: only what carries replaces it.
        """
        for rule in self.derivation.productions.get(one.symbol, ()):
            if index is None and not rule.carries:
                continue
            scope = self.scope(one)
            age = rule.age(scope)
            if one.age < age - SLACK or not _holds(rule.condition, scope):
                continue
            if index is not None and not self.fits(rule, index):
                continue
            made = self.chosen(rule, one)
            if made is not None:
                return rule, made, max(0.0, one.age - age) if rule.carries else 0.0
            return None
        return None

    def scope(self, one: Instance) -> Scope:
        scope = self.crew.scope(one.layer)
        scope.age, scope.place = one.age, one.parameters
        scope.growth, scope.replaced_memory = one.growth, one.memory
        scope.memory = one.memory
        scope.identity = one.id
        scope.actor, scope.particle = one.sensed
        return scope

    def chosen(self, rule: Production, one: Instance) -> list[Sprout] | None:
        """Return the alternative of the symbol's own random number."""
        total = sum(chance for chance, _ in rule.alternatives)
        again = self.crew.stage.tick if total < 1 - 1e-6 else 0
        draw = uniform(self.crew.stage.seed, one.id, again, 1 << 32)
        for chance, made in rule.alternatives:
            if draw < chance:
                return made
            draw -= chance
        return rule.alternatives[-1][1] if total >= 1 - 1e-6 and rule.alternatives else None

    def replace(
        self, one: Instance, rule: Production, made: list[Sprout], over: float, depth: int
    ) -> None:
        if len(self.new) + len(made) > LENGTH:
            raise LimitError(
                f"{rule.place}: the string has more than {LENGTH} symbols; the production of "
                f"'{one.symbol}' explodes"
            )
        if one.particle is not None:
            self.crew.particles.remove(one.particle)
        self.write(made, self.scope(one), over, depth)

    def write(self, made: Sequence[Sprout], scope: Scope, over: float, depth: int = 0) -> None:
        """Write a successor: parameters are computed from the symbol that is replaced."""
        fields: dict[int, tuple[Value, ...]] = {}
        for sprout in made:
            values = []
            for slot, value in enumerate(sprout.values):
                scope.slot, scope.drawn = slot + 8 * len(self.new), 0
                values.append(value(scope))
            age, x, y, z = values
            if sprout.symbol == "e":
                if round(x) == 0:
                    self.crew.push(sprout.words, sprout.place)
                else:
                    fields[round(x)] = sprout.programs
                continue
            if sprout.symbol == "]" and (x < 0 or x == 100):
                self.cut(x)
                continue
            one = Instance(
                sprout.symbol,
                self.crew.identity(),
                age + over,
                (x, y, z),
                sprout.programs,
                self.derivation.layer,
                sprout.varies,
            )
            one.sensed = scope.actor, scope.particle
            if sprout.symbol == "C":
                self.crew.enroll(one, fields, sprout.place)
                fields = {}
            found = self.applicable(one, None) if over > 0 and depth < AGAIN else None
            if found is None:
                self.emit(one)
            else:
                self.replace(one, *found, depth + 1)

    def cut(self, amount: float) -> None:
        """Remove the branch that the symbol is in, or the next units of that branch."""
        if abs(amount) == 100:
            if self.open:
                del self.new[self.open.pop() :]
                self.at = min(_end(self.old, self.at) + 1, len(self.old))
            return
        for _ in range(round(-amount)):
            if self.at >= len(self.old) or self.old[self.at].closes:
                return
            if self.old[self.at].opens:
                self.at = _end(self.old, self.at + 1)
            self.at += 1

    def fits(self, rule: Production, index: int) -> bool:
        if rule.left and _left(self.old, index) != rule.left:
            return False
        return not rule.right or _right(self.old, index + 1, rule.right)


def _cuts(expression: Expression) -> bool:
    return expression.text.endswith("_") or expression.text == "100"


def _holds(condition: list[tuple[Value, Callable[[float], bool]] | str], scope: Scope) -> bool:
    stack: list[bool] = []
    for part in condition:
        if not isinstance(part, str):
            value, compare = part
            stack.append(compare(value(scope)))
        elif part == "!":
            stack.append(not stack.pop())
        else:
            second, first = stack.pop(), stack.pop()
            stack.append(first and second if part == "&" else first or second)
    return not stack or stack[0]


def _end(string: list[Instance], at: int) -> int:
    """Return where the branch ends that contains what stands at `at`."""
    depth = 0
    for index in range(at, len(string)):
        if string[index].opens:
            depth += 1
        elif string[index].closes:
            if depth == 0:
                return index
            depth -= 1
    return len(string)


def _left(string: list[Instance], index: int) -> str:
    """Return the nearest symbol on the way to the root; empty if there is none."""
    depth = 0
    for at in range(index - 1, -1, -1):
        one = string[at]
        if one.closes:
            depth += 1
        elif one.opens:
            depth = max(0, depth - 1)
        elif depth == 0 and not one.ignored:
            return one.symbol
    return ""


def _right(string: list[Instance], at: int, wanted: str) -> bool:
    """Return whether the next symbol is the wanted one, here or in a branch that begins here."""
    behind: list[int] = []
    while at < len(string):
        one = string[at]
        if one.opens:
            behind.append(_end(string, at + 1) + 1)
        elif one.closes or not one.ignored:
            if one.symbol == wanted and not one.closes:
                return True
            if not behind:
                return False
            at = behind.pop()
            continue
        at += 1
    return False
