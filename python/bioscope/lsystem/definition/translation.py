"""Definition files as models in the notation of our own.

Every symbol has growth expressions of its own, so a symbol becomes one module per set of them:
`R_1`, `R_2` and so on. Productions and contexts of a symbol hold for all its modules.
"""

from __future__ import annotations

import re
from itertools import product

from bioscope.errors import FormatError
from bioscope.lsystem.definition.drawing import DRAWINGS
from bioscope.lsystem.definition.grammar import (
    Definition,
    Expression,
    Rule,
    Template,
    pointing,
    read,
)
from bioscope.lsystem.definition.postfix import Surroundings, infix

NAMES = {
    "+": "left",
    "-": "right",
    "&": "down",
    "^": "up",
    "/": "roll_right",
    "$": "roll",
    "{": "polygon",
    ".": "corner",
    "}": "end",
}
IGNORED = "+-/$^&mn"
COMPARISONS = {"0<": "<", "0p": "<=", "0>": ">", "0g": ">=", "0=": "==", "0!": "!="}
STEP = 0.04
"""Seconds of a step if the file says nothing."""


def translated(text: str, file: str) -> str:
    """Return the model of a definition file in the notation of our own.

    Raises
    ------
    FormatError
        With file, line and column, if the file is wrong or has rules that depend on actors,
        particles, senses, memories or cuts.
    """
    definition = read(text, file)
    with pointing(text, file):
        return _Translation(definition).model()


class _Translation:
    def __init__(self, definition: Definition) -> None:
        self.definition = definition
        # By symbol: its growth expressions, one entry per module.
        self.modules: dict[str, list[tuple[str, ...]]] = {}
        made = [*definition.axiom]
        made += [one for rule in definition.rules for _, made in rule.alternatives for one in made]
        for template in made:
            if not self.is_bracket(template) and template.symbol != "?":
                growth = self.growth(template)
                known = self.modules.setdefault(template.symbol, [])
                if growth not in known:
                    known.append(growth)

    def model(self) -> str:
        """Return the text of the model."""
        end, step = self.definition.camera.get("t_final_interval", [0.0, STEP])
        steps = round(end / step) if step > 0 else 0
        lines = [f"timed: {step:.17g}", f"derivation length: {steps}"]
        names = [name for symbol in self.modules for name in self.names(symbol)]
        # A model has at least one production; a definition that only stands there has none.
        declared = [*(f"{name}(x,y,z)" for name in names), "nothing"]
        lines.append("modules: " + ", ".join(declared))
        ignored = [name for symbol in IGNORED for name in self.names(symbol)]
        if ignored:
            lines.append("ignore: " + " ".join(ignored))
        axiom = self.string(self.definition.axiom, Surroundings(self.definition))
        # The turtle of the source begins along x, its up is z.
        lines.append(f"axiom: @R(1,0,0,0,0,1) {axiom}")
        for symbol, growths in self.modules.items():
            for number, growth in enumerate(growths, 1):
                shown = ", ".join(("x", "y", "z", *growth))
                lines.append(f"growth: {_name(symbol, number)} = {shown}")
        for rule in self.definition.rules:
            lines += self.productions(rule)
        if not self.definition.rules:
            lines.append("nothing --> nothing")
        lines += self.homomorphism()
        return "\n".join(lines) + "\n"

    def names(self, symbol: str) -> list[str]:
        return [_name(symbol, number + 1) for number in range(len(self.modules.get(symbol, [])))]

    def is_bracket(self, template: Template) -> bool:
        """Return whether a symbol begins, ends or cuts a branch; stored positions are refused."""
        if template.symbol not in "[]":
            return False
        if template.slots[1].text not in ("", "0") and _cut(template) is None:
            raise FormatError(
                f"{template.place}: stored positions cannot be derived; '{template.symbol}' with "
                "another first parameter than 0, -1 to -99 or 100"
            )
        return True

    def growth(self, template: Template) -> tuple[str, ...]:
        around = Surroundings(self.definition)
        return tuple(infix(one, around) for one in template.slots[4:])

    def string(self, templates: list[Template], around: Surroundings) -> str:
        """Return a successor, or the axiom."""
        words = []
        for template in templates:
            if self.is_bracket(template):
                cut = _cut(template)
                if cut is not None and templates is self.definition.axiom:
                    raise FormatError(f"{template.place}: a cut in the axiom")
                words.append(template.symbol if cut is None else f"%({cut})")
                continue
            if template.slots[0].text.strip("0."):
                raise FormatError(
                    f"{template.slots[0].place}: a symbol begins at age 0; found "
                    f"'({template.slots[0].text})'"
                )
            parameters = ", ".join(infix(one, around) for one in template.slots[1:4])
            if template.symbol == "?":
                # It is told where the turtle is, and never replaced.
                words.append(f"?P({parameters})")
                continue
            number = self.modules[template.symbol].index(self.growth(template)) + 1
            words.append(f"{_name(template.symbol, number)}({parameters})")
        return " ".join(words) or "*"

    def productions(self, rule: Rule) -> list[str]:
        """Return one production per alternative, and per module of its symbols."""
        chances = sum(chance for chance, _ in rule.alternatives)
        if abs(chances - 1) > 1e-6 or any(chance < 0 for chance, _ in rule.alternatives):
            raise FormatError(f"{rule.place}: the probabilities sum to {chances:g}, not to 1")
        rivals = [one for one in self.definition.rules if one.symbol == rule.symbol]
        if len(rule.alternatives) > 1 and len(rivals) > 1:
            raise FormatError(
                f"{rule.place}: '{rule.symbol}' has alternatives and another production too"
            )
        lines = []
        for number, growth in enumerate(self.modules.get(rule.symbol, []), 1):
            around = Surroundings(self.definition, growth)
            age = infix(rule.age, around)
            test = self.condition(rule, around)
            strict = f"{_name(rule.symbol, number)}(x,y,z)"
            for left, right in product(self.contexts(rule.left), self.contexts(rule.right)):
                before = f"{left}(lx,ly,lz) < " if left else ""
                after = f" > {right}(rx,ry,rz)" if right else ""
                for chance, made in rule.alternatives:
                    weight = f" : {chance:.17g}" if len(rule.alternatives) > 1 else ""
                    string = self.string(made, around)
                    lines.append(f"{before}{strict}{after} after {age}{test} --> {string}{weight}")
        return lines

    def contexts(self, symbol: str) -> list[str]:
        """Return the modules that a context may be; one empty name if there is none."""
        return self.names(symbol) if symbol else [""]

    def condition(self, rule: Rule, around: Surroundings) -> str:
        stack: list[str] = []
        for part in rule.condition:
            if isinstance(part, Expression):
                stack.append(infix(part, around))
            elif part in COMPARISONS:
                stack.append(f"({stack.pop()} {COMPARISONS[part]} 0)")
            elif part == "!" and stack:
                stack.append(f"(!{stack.pop()})")
            elif part in ("&", "|") and len(stack) > 1:
                second, first = stack.pop(), stack.pop()
                stack.append(f"({first} {part * 2} {second})")
            else:
                raise FormatError(f"{rule.place}: too few conditions before '{part}'")
        if len(stack) > 1:
            raise FormatError(f"{rule.place}: conditions that no '&' or '|' connects")
        return f" : {stack[0]}" if stack else ""

    def homomorphism(self) -> list[str]:
        """Return what the turtle draws for each symbol."""
        lines = []
        for symbol in self.modules:
            for condition, drawing in DRAWINGS.get(symbol, ()):
                test = f" : {condition}" if condition else ""
                lines += [f"{name}(x,y,z,a,b,c){test} --> {drawing}" for name in self.names(symbol)]
        return ["homomorphism", *lines] if lines else []


def _cut(template: Template) -> int | None:
    """Return how much a closing bracket cuts: 100 for its branch, -n for n symbols; None if not."""
    number = re.fullmatch(r"(\d+)(_?)", template.slots[1].text)
    if template.symbol != "]" or number is None:
        return None
    amount = -int(number[1]) if number[2] else int(number[1])
    return amount if abs(amount) == 100 or -100 < amount < 0 else None


def _name(symbol: str, number: int) -> str:
    word = NAMES.get(symbol, f"n{symbol}" if symbol.isdigit() else symbol)
    return f"{word}_{number}"
