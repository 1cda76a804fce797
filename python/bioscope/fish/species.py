"""Species of fishes by name or by file."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from bioscope.errors import FormatError, InvalidValueError

Species = str | PathLike[str]
"""A species by name, or the path of a species file (.toml)."""


def asked_species(species: Species) -> str | tuple[str, str]:
    """Return the engine's form of a species: its name, or the name and text of its file.

    Raises
    ------
    InvalidValueError, FormatError, OSError
        For what is neither a name nor a path, and files that are no text or cannot be read.
    """
    if not isinstance(species, str | PathLike):
        expected = "the name of a species, or the path of its file (.toml)"
        raise InvalidValueError(f"species = {species!r}: expected {expected}")
    name = fspath(species)
    if not name.endswith(".toml"):
        return name
    try:
        return name, Path(name).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise FormatError(f"{name}: not a text in UTF-8 ({error.reason})") from None
