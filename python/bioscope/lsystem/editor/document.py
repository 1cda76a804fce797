"""The file that is edited: the only one that is ever written."""

from __future__ import annotations

from pathlib import Path

from bioscope.errors import FormatError, InvalidValueError
from bioscope.files import written_whole
from bioscope.lsystem.editor.messages import LONGEST_TEXT

_STARTER = Path(__file__).with_name("starter.l")


class Document:
    """A model's text and where it is kept.

    Parameters
    ----------
    name
        A file (a new one begins with a small example), or a model of `bioscope list`, which can be
        looked at but not overwritten; the example if not given.

    Raises
    ------
    InvalidValueError
        For a folder, or a name that is neither a model nor ends in `.l`.
    FormatError
        If the file is too long to edit.
    """

    def __init__(self, name: str | None) -> None:
        from bioscope.populations.plants import models

        known = models()
        self.savable = name is not None and (Path(name).is_file() or name not in known)
        """Whether the text may be written back."""
        self.path = _STARTER
        """Where the text is read; what errors call it, and beside which colours are looked for."""
        if name is not None:
            self.path = Path(name).resolve() if self.savable else known[name]
        if self.path.is_dir():
            raise InvalidValueError(f"{name}: expected a file, found a folder")
        if not self.path.exists() and self.path.suffix != ".l":
            raise InvalidValueError(
                f"{name}: expected a file that ends in .l, or one of {', '.join(known)}"
            )
        self.read()

    @property
    def title(self) -> str:
        """What the page calls it."""
        return "untitled.l" if self.path == _STARTER else self.path.name

    def read(self) -> str:
        """Return the text as it is now."""
        path = self.path if self.path.exists() else _STARTER
        text = path.read_text(encoding="utf-8", errors="replace")
        if len(text) > LONGEST_TEXT:
            raise FormatError(f"{path}: {len(text)} letters: expected at most {LONGEST_TEXT}")
        return text

    def save(self, text: str, known: str) -> None:
        """Write the text, unless somebody else has changed the file since it was `known`.

        Raises
        ------
        InvalidValueError
            If it may not be written, or another program has changed it.
        OSError
            If it cannot be written.
        """
        if not self.savable:
            raise InvalidValueError(f"{self.title} comes with Bioscope: download a copy instead")
        if self.path.exists() and self.read() not in (known, text):
            raise InvalidValueError(
                f"{self.title} was changed by another program: download a copy, then reload"
            )
        with written_whole(self.path) as temporary:
            temporary.write_text(text, encoding="utf-8", newline="")
