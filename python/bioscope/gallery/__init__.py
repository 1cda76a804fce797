"""The gallery: ready-made L-system models, each with a line, a source and parameters.

A model is a text, `NAME.l` in the dialect of cpfg or `NAME.lsys` in the notation of our own, with
its colors in `NAME.colors`. Its first comment says what it is; see docs/concepts/gallery.md. Beside
them are animations, definition files `NAME.lm` that run.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from bioscope.errors import FormatError, InvalidValueError, UnknownNameError

if TYPE_CHECKING:
    from bioscope.lsystem import LSystem

__all__ = [
    "Model",
    "Parameter",
    "animations",
    "description",
    "files",
    "model",
    "names",
    "parameters",
    "path",
    "read",
    "text",
]

_FOLDER = Path(__file__).parent
_COMMENT = re.compile(r"\s*/\*(.*?)\*/", re.S)
_FIELD = re.compile(r"^   ([a-z]+) {2,}(\S.*)$")
_NUMBER = r"-?\d+(?:\.\d+)?"
_PARAMETER = re.compile(
    rf"^(#define[ ]+(?P<name>\w+)[ ]+)(?P<value>\(?{_NUMBER}\)?)(?P<rest>[ ]+"
    rf"/\*[ ]*parameter:[ ]*(?P<low>{_NUMBER})[ ]to[ ](?P<high>{_NUMBER})[ ]?(?P<unit>[^,]*),"
    rf"[ ]*(?P<meaning>[^*]*?)[ ]*\*/)",
    re.M,
)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number of a model that may be changed: by a slider, or by breeding."""

    name: str
    value: float
    """As the text has it."""
    low: float
    high: float
    unit: str
    """`metres`, `degrees`, ...; empty for a pure number."""
    meaning: str


@dataclass(frozen=True, slots=True)
class Model:
    """What the first comment of a model says about it."""

    name: str
    path: Path
    title: str
    """What it is called, `Weeping willow`."""
    description: str
    """What it is, in one line."""
    kind: str
    """`tree`, `fern`, `grass`, `flower`, `inflorescence`, `vine`, `kelp`, `coral`, `root`, `clone`,
    `stand`, `fractal`, `diagram` or `example`."""
    architecture: str
    """The architectural model of a tree; empty where there is none."""
    source: str
    """Where it comes from."""
    watch: str
    """What to look at while it grows."""
    modules: str
    """What the letters stand for."""
    count: str
    """How many modules there are after n steps, `n^2 internodes F after n steps`; empty where only
    growing the model tells (the course's sense of emergence)."""
    parameters: tuple[Parameter, ...]


@cache
def files() -> dict[str, Path]:
    """Return the files of all models by name, in alphabetical order."""
    texts = [one for one in _FOLDER.iterdir() if one.suffix in (".l", ".lsys")]
    return {one.stem: one for one in sorted(texts)}


@cache
def animations() -> dict[str, Path]:
    """Return the definition files of all animations by name, in alphabetical order."""
    return {one.stem: one for one in sorted(_FOLDER.glob("*.lm"))}


def names() -> list[str]:
    """Return the names of all models, in alphabetical order."""
    return list(files())


def path(name: str) -> Path:
    """Return the file of a model.

    Raises
    ------
    UnknownNameError
        If there is none of this name.
    """
    if name not in files():
        raise UnknownNameError(f"unknown gallery model '{name}'; known: {', '.join(files())}")
    return files()[name]


def description(name: str) -> str:
    """Return what a model or an animation is, in one line."""
    if name not in animations():
        return model(name).description
    comment = _COMMENT.match(animations()[name].read_text(encoding="utf-8"))
    head = comment[1].partition("\n\n")[0] if comment is not None else ""
    return " ".join(head.split()).partition(": ")[2].rstrip(".")


def parameters(name: str) -> tuple[Parameter, ...]:
    """Return the numbers of a model that may be changed, in the order of its text."""
    return model(name).parameters


@cache
def model(name: str) -> Model:
    """Return what a model says about itself.

    Raises
    ------
    UnknownNameError
        If there is none of this name.
    FormatError
        If its first comment does not have the form of docs/concepts/gallery.md.

    Examples
    --------
    >>> import bioscope as bio
    >>> bio.gallery.model("maple").architecture
    'Rauh'
    """
    file = path(name)
    source = file.read_text(encoding="utf-8")
    comment = _COMMENT.match(source)
    if comment is None:
        raise FormatError(f"{file}: expected a comment that says what the model is")
    head, _, rest = comment[1].partition("\n\n")
    title, colon, line = " ".join(head.split()).partition(": ")
    fields = _fields(rest)
    missing = [one for one in ("kind", "source", "watch", "modules") if one not in fields]
    if not colon or missing:
        raise FormatError(f"{file}: expected 'Title: description' and {', '.join(missing)}")
    return Model(
        name=name,
        path=file,
        title=title,
        description=line.rstrip("."),
        kind=fields["kind"],
        architecture=fields.get("architecture", ""),
        source=fields["source"],
        watch=fields["watch"],
        modules=fields["modules"],
        count=fields.get("count", ""),
        parameters=tuple(_parameters(source)),
    )


def text(name: str, **values: float) -> str:
    """Return the text of a model with other values of its parameters.

    Raises
    ------
    UnknownNameError
        If it has no such parameter.
    InvalidValueError
        For a value outside the range of its parameter.
    """
    known = {one.name: one for one in parameters(name)}
    for key, value in values.items():
        if key not in known:
            raise UnknownNameError(f"{name} has no parameter '{key}'; known: {', '.join(known)}")
        low, high = known[key].low, known[key].high
        if not (math.isfinite(value) and low <= value <= high):
            raise InvalidValueError(f"{key} = {value}: expected {low:g} to {high:g}")

    def changed(line: re.Match[str]) -> str:
        value = values.get(line["name"])
        return line[0] if value is None else f"{line[1]}({value:.9f}){line['rest']}"

    return _PARAMETER.sub(changed, path(name).read_text(encoding="utf-8"))


def read(name: str, **values: float) -> LSystem:
    """Return a model, ready to derive, with other values of its parameters.

    Examples
    --------
    >>> import bioscope as bio
    >>> bio.gallery.read("wheat", TILLERS=3).constants["TILLERS"]
    3.0
    """
    from bioscope.lsystem import LSystem

    return LSystem(text(name, **values), str(path(name)))


def _fields(rest: str) -> dict[str, str]:
    """Read the lines `word   what it says`; deeper lines continue the one above."""
    fields: dict[str, str] = {}
    word = ""
    for line in rest.splitlines():
        begins = _FIELD.match(line)
        if begins:
            word = begins[1]
            fields[word] = begins[2].strip()
        elif word and line.startswith(" " * 10):
            fields[word] += " " + line.strip()
        else:
            word = ""
    return fields


def _parameters(source: str) -> list[Parameter]:
    return [
        Parameter(
            line["name"],
            float(line["value"].strip("()")),
            float(line["low"]),
            float(line["high"]),
            line["unit"].strip(),
            line["meaning"],
        )
        for line in _PARAMETER.finditer(source)
    ]
