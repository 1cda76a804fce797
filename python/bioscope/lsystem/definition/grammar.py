"""The grammar of definition files: text to sections, symbols and productions."""

from __future__ import annotations

import contextlib
import difflib
import math
import re
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

from bioscope.errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

SECTIONS = (
    "Camera_AnimationParameters",
    "RepetitionParameters",
    "Options",
    "Splines",
    "Constants",
    "Surfaces",
    "Axiom",
    "Productions",
)
CAMERA = {
    "pref_pos_x1_x2_y1_y2": 4,
    "prefpos_x1_x2_y1_y2": 4,
    "observer": 3,
    "lookatPoint": 3,
    "twist": 1,
    "viewAngle": 1,
    "aspectRatio": 1,
    "near": 1,
    "far": 1,
    "swapinterval": 1,
    "nbrCalcStep_seed": 2,
    "t_final_interval": 2,
}
REPETITION = {
    "rotate": 3,
    "rotate_max": 3,
    "translate": 3,
    "translate_max": 3,
    "scale": 1,
    "scale_max": 1,
    "time_scale": 1,
    "time_const": 1,
    "startp_sidel_nbr_dist": 4,
}
OPTIONS = {
    "MaxPart": "i",
    "command_file": "iwww",
    "fConst": "iffffffff",
    "VLNETdeclare": "*",
    "AUDIOport_host": "iw",
    "NBR_actors": "i",
    "iVisionWinSize": "iii",
    "iVisionWinSize_maxColors": "iii",
    "NBR_walk_motors": "i",
    "actorNbr_automata": "iii*",
    "Sound_event_file": "w*",
    "rs_file_path_name": "ww",
    "rs_switch": "iiiiii",
    "NbrChannels_listOfNames": "i*",
    "trace_actor": "iw",
    "import_trace": "iw",
}
"""By option what follows: whole numbers, numbers, words, anything."""
LINEAR = set("abcdefghijklmnopqrsABCD")
CURVED = set("EFGHIJKLMNOPQRS")
END_OF_SPLINE = 1e30
SLOTS = 7
LONGEST = 1 << 20
SHOWN = 60
"""Characters of a long line that an error shows on either side of its place."""


@dataclass(frozen=True, slots=True)
class Expression:
    """A postfix expression as it stands between parentheses; empty is zero."""

    text: str
    place: str = field(compare=False)
    words: str = field(compare=False, default="")
    """As it is written, with its blanks: the commands of an automaton."""

    def __str__(self) -> str:
        """Return it as it is written."""
        return f"({self.words or self.text})"


@dataclass(frozen=True, slots=True)
class Template:
    """A symbol with its age, three parameters and three growth expressions."""

    symbol: str
    slots: tuple[Expression, ...]
    place: str = field(compare=False)

    def __str__(self) -> str:
        """Return it as it is written."""
        return " ".join((self.symbol, *map(str, self.slots)))


@dataclass(frozen=True, slots=True)
class Rule:
    """A production: what replaces a symbol of this age under this condition in this context."""

    symbol: str
    age: Expression
    condition: tuple[Expression | str, ...]
    left: str
    right: str
    alternatives: list[tuple[float, list[Template]]]
    place: str = field(compare=False)

    def __str__(self) -> str:
        """Return it as it is written."""
        test = ""
        for part in self.condition:
            test += f"[{part}" if isinstance(part, Expression) else part.removeprefix("0")
            test += "]" if isinstance(part, str) and part.startswith("0") else ""
        head = f"{self.symbol} {self.age} {test or '()'} ({self.left}) ({self.right})"
        made = [
            f"{chance:.17g}\n" + "\n".join(map(str, symbols)) + "\nEndProb"
            for chance, symbols in self.alternatives
        ]
        return "\n".join([head, *made, "End"])


@dataclass(frozen=True, slots=True)
class Option:
    """An entry of the section of options."""

    name: str
    words: list[str]
    places: list[str] = field(compare=False, default_factory=list)
    """Where the name stands, and every word."""

    def error(self, message: str, word: int = -1) -> FormatError:
        """Return what is wrong with a word, or with the whole."""
        return FormatError(f"{self.places[word + 1]}: {message}")


@dataclass(slots=True)
class Definition:
    """A definition file."""

    file: str = field(compare=False)
    camera: dict[str, list[float]] = field(default_factory=dict)
    repetition: dict[str, list[float]] = field(default_factory=dict)
    options: list[Option] = field(default_factory=list)
    splines: dict[int, list[tuple[float, float]]] = field(default_factory=dict)
    constants: dict[str, list[float]] = field(default_factory=dict)
    surfaces: dict[int, str] = field(default_factory=dict)
    axiom: list[Template] = field(default_factory=list)
    rules: list[Rule] = field(default_factory=list)

    @property
    def arrays(self) -> dict[int, list[float]]:
        """The constant arrays `fConst`, eight numbers each."""
        found = {}
        for option in self.options:
            if option.name == "fConst":
                number, *values = option.words
                found[int(float(number))] = [*map(float, values)]
        return found

    def __str__(self) -> str:
        """Return the file, which reads back as the same definition."""
        lines = [SECTIONS[0], *(f"{name} {_told(one)}" for name, one in self.camera.items())]
        lines += [SECTIONS[1], *(f"{name} {_told(one)}" for name, one in self.repetition.items())]
        lines += [SECTIONS[2], *(" ".join((one.name, *one.words)) for one in self.options)]
        lines.append(SECTIONS[3])
        for number, keys in self.splines.items():
            pairs = " ".join(_told(key) for key in keys)
            lines.append(f"function time_spline {number} {len(keys)} 1 1 {pairs} 1e30 1e30")
        lines += [SECTIONS[4], *(f"{name} {_told(one)}" for name, one in self.constants.items())]
        lines += [SECTIONS[5], *(f"fig_sm {one} {file}" for one, file in self.surfaces.items())]
        lines += [SECTIONS[6], *map(str, self.axiom), SECTIONS[7], *map(str, self.rules)]
        return "\n".join([*lines, "EndProductions"]) + "\n"


def _told(values: Iterable[float]) -> str:
    return " ".join(f"{one:.17g}" for one in values)


def read(text: str, file: str) -> Definition:
    """Return what a definition file says.

    Raises
    ------
    FormatError
        With file, line and column.
    """
    if len(text) > LONGEST:
        raise FormatError(f"{file}: a definition file has at most {LONGEST} characters")
    with pointing(text, file):
        reader = _Reader(text, file)
        definition = Definition(file)
        reader.sections(definition)
    return definition


@contextlib.contextmanager
def pointing(text: str, file: str) -> Iterator[None]:
    """Show the line of the text that an error is about, if its message begins with a place."""
    try:
        yield
    except FormatError as error:
        found = re.match(rf"{re.escape(file)}:(\d+):(\d+): [^\n]*$", str(error))
        if found is None:
            raise
        number, column = int(found[1]), int(found[2]) - 1
        line = text.split("\n")[number - 1]
        first = max(0, column - SHOWN)
        shown = re.sub(r"[\x00-\x1f\x7f]", " ", line[first : column + SHOWN]).rstrip()
        gutter = " " * len(found[1])
        mark = f" {number} | {shown}\n {gutter} | {' ' * (column - first)}^"
        raise FormatError(f"{error}\n{mark}") from None


def meant(name: str, known: Iterable[str]) -> str:
    """Return what to say about an unknown name: the one that it is like, or all."""
    known = list(known)
    like = difflib.get_close_matches(name, known, 1)
    return f"did you mean '{like[0]}'?" if like else f"known are {', '.join(known)}"


def _blanks(comment: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", comment.group())


class _Reader:
    """A place in the text."""

    def __init__(self, text: str, file: str) -> None:
        # Comments become blanks, so that places stay what they are.
        self.text = re.sub(r"/\*.*?\*/", _blanks, text, flags=re.S)
        self.file = file
        self.at = 0

    def place(self) -> str:
        line = self.text.count("\n", 0, self.at) + 1
        column = self.at - (self.text.rfind("\n", 0, self.at) + 1) + 1
        return f"{self.file}:{line}:{column}"

    def error(self, message: str) -> FormatError:
        return FormatError(f"{self.place()}: {message}")

    def skip(self) -> None:
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1

    def peek(self) -> str:
        """Return the next word without taking it; empty at the end."""
        self.skip()
        match = re.compile(r"[^\s()]+").match(self.text, self.at)
        return match.group() if match else ""

    def word(self, expected: str) -> str:
        found = self.peek()
        if not found:
            raise self.error(f"expected {expected}")
        self.at += len(found)
        return found

    def number(self, expected: str) -> float:
        found = self.peek()
        try:
            value = float(found)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.error(f"expected {expected}, found '{found or 'the end'}'")
        self.at += len(found)
        return value

    def whole(self, expected: str) -> int:
        place, found = self.at, self.peek()
        value = self.number(expected)
        if value != int(value):
            self.at = place
            self.skip()
            raise self.error(f"expected {expected}, found '{found}'")
        return int(value)

    def sections(self, definition: Definition) -> None:
        for name in SECTIONS:
            if name == "Axiom":
                self.keyword(name)
                while not self.peek().startswith("Productions"):
                    if not self.peek():
                        raise self.error("expected 'Productions' after the axiom")
                    definition.axiom.append(self.template())
            elif name == "Productions":
                self.keyword(name)
                while self.peek() != "EndProductions":
                    definition.rules.append(self.rule())
            elif self.peek() == name:
                self.keyword(name)
                self.head(name, definition)

    def keyword(self, name: str) -> None:
        if self.peek() != name:
            raise self.error(f"expected '{name}', found '{self.peek() or 'the end of the file'}'")
        self.at += len(name)

    def head(self, section: str, definition: Definition) -> None:
        """Read a section before the axiom."""
        while self.peek() and self.peek() not in SECTIONS:
            if section == "Camera_AnimationParameters":
                self.numbers(CAMERA, definition.camera)
            elif section == "RepetitionParameters":
                self.numbers(REPETITION, definition.repetition)
            elif section == "Options":
                self.option(definition)
            elif section == "Splines":
                self.spline(definition)
            elif section == "Constants":
                self.constant(definition)
            else:
                self.keyword("fig_sm")
                number = self.whole("the number of a surface")
                definition.surfaces[number] = self.word("a file")

    def numbers(self, known: dict[str, int], into: dict[str, list[float]]) -> None:
        name = self.peek()
        if name not in known:
            raise self.error(f"unknown parameter '{name}'; {meant(name, known)}")
        self.at += len(name)
        into[name] = [self.number(f"a number of '{name}'") for _ in range(known[name])]

    def option(self, definition: Definition) -> None:
        name = self.peek()
        if name == "function":
            self.spline(definition)
            return
        if name not in OPTIONS:
            raise self.error(f"unknown option '{name}'; {meant(name, OPTIONS)}")
        places = [self.place()]
        self.at += len(name)
        words: list[str] = []
        for kind in OPTIONS[name].removesuffix("*"):
            self.peek()
            places.append(self.place())
            begin = self.at
            if kind == "i":
                self.whole(f"a whole number of '{name}'")
            elif kind == "f":
                self.number(f"a number of '{name}'")
            else:
                self.word(f"a word of '{name}'")
            words.append(self.text[begin : self.at])
        while OPTIONS[name].endswith("*") and (found := self.peek()):
            if found in OPTIONS or found in SECTIONS or found == "function":
                break
            places.append(self.place())
            words.append(self.word("a word"))
        definition.options.append(Option(name, words, places))

    def spline(self, definition: Definition) -> None:
        self.keyword("function")
        self.keyword("time_spline")
        number = self.whole("the number of a spline")
        count = self.whole("how many pairs it has")
        scales = self.number("a scale of arguments"), self.number("a scale of values")
        keys: list[tuple[float, float]] = []
        while (argument := self.number("an argument")) != END_OF_SPLINE:
            keys.append((argument * scales[0], self.number("a value") * scales[1]))
        self.number("1e30")
        if len(keys) != count or not keys:
            raise self.error(f"spline {number} has {len(keys)} pairs, not {count}")
        if any(later[0] <= earlier[0] for earlier, later in pairwise(keys)):
            raise self.error(f"the arguments of spline {number} do not increase")
        definition.splines[number] = keys

    def constant(self, definition: Definition) -> None:
        name = self.peek()
        count = 2 if name in LINEAR or name == "#" else 3 if name in CURVED else 0
        if not count:
            raise self.error(f"'{name}' is no name of a constant")
        self.at += len(name)
        values = [self.number(f"a number of constant '{name}'") for _ in range(count)]
        definition.constants[name] = values

    def symbol(self) -> str:
        self.skip()
        found = self.text[self.at : self.at + 1]
        if not (found.isascii() and (found.isalnum() or found in "[]{}./^&$+-?")) or not found:
            raise self.error(f"expected a symbol, found '{self.peek() or 'nothing'}'")
        self.at += 1
        return found

    def expression(self) -> Expression:
        self.skip()
        place = self.place()
        end = self.text.find(")", self.at)
        if self.text[self.at : self.at + 1] != "(" or end < 0:
            raise self.error("expected an expression in parentheses")
        inner = self.text[self.at + 1 : end]
        if "(" in inner:
            raise self.error("an expression in parentheses that are not closed")
        self.at = end + 1
        return Expression("".join(inner.split()), place, inner.strip())

    def template(self) -> Template:
        self.skip()
        place = self.place()
        symbol = self.symbol()
        slots: list[Expression] = []
        for _ in range(SLOTS):
            self.skip()
            if self.text[self.at : self.at + 1] != "(":
                raise self.error(
                    f"expected an expression in parentheses: '{symbol}' has {len(slots)} of 7, "
                    "its age, x, y, z, and three growth values"
                )
            slots.append(self.expression())
        return Template(symbol, tuple(slots), place)

    def rule(self) -> Rule:
        self.skip()
        place = self.place()
        symbol, age, condition = self.symbol(), self.expression(), self.condition()
        left, right = self.context(), self.context()
        alternatives = []
        while self.peek() != "End":
            if self.peek() in ("", "EndProductions"):
                raise self.error(f"expected 'End' after the production of '{symbol}'")
            chance = self.number("a probability")
            made = []
            while not self.peek().startswith("EndProb"):
                if self.peek() in ("", "End", "EndProductions"):
                    raise self.error(f"expected 'EndProb' after a successor of '{symbol}'")
                made.append(self.template())
            self.keyword("EndProb")
            alternatives.append((chance, made))
        self.keyword("End")
        return Rule(symbol, age, condition, left, right, alternatives, place)

    def condition(self) -> tuple[Expression | str, ...]:
        """Read atoms `[ (expression) predicate ]` and `&`, `|`, `!` after them."""
        self.skip()
        if self.text[self.at : self.at + 1] == "(":
            if self.expression().text:
                raise self.error("expected '()' or a condition in brackets")
            return ()
        parts: list[Expression | str] = []
        while (letter := self.peek()[:1]) and letter in "[&|!":
            self.at += 1
            if letter != "[":
                parts.append(letter)
                continue
            parts.append(self.expression())
            predicate = self.peek()[:1]
            if not predicate or predicate not in "<p>g=!":
                raise self.error("expected one of < p > g = ! after an expression")
            self.at += 1
            parts.append("0" + predicate)
            self.keyword_letter("]")
        return tuple(parts)

    def keyword_letter(self, letter: str) -> None:
        self.skip()
        if self.text[self.at : self.at + 1] != letter:
            raise self.error(f"expected '{letter}'")
        self.at += 1

    def context(self) -> str:
        found = self.expression()
        if len(found.text) > 1:
            raise self.error("a context is one symbol in parentheses, or '()'")
        return found.text
