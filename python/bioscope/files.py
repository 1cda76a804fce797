"""Output that is whole or not there: written under a temporary name, then renamed."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

from bioscope.errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike


@contextlib.contextmanager
def written_whole(path: str | PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside `path`, and rename it to `path` if the block succeeds.

    If the block fails the temporary file is removed and whatever was at `path` stays.

    Raises
    ------
    OSError
        If the folder does not exist or cannot be written.
    """
    final = Path(path)
    if final.is_dir():
        raise IsADirectoryError(f"{final} is a folder: expected the name of a file to write")
    if not final.parent.is_dir():
        raise FileNotFoundError(f"{final.parent} does not exist: make the folder first")
    temporary = final.with_name(f".{final.stem}.partial{final.suffix}")
    try:
        yield temporary
        temporary.replace(final)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise


@contextlib.contextmanager
def naming(path: str | PathLike[str]) -> Iterator[None]:
    """Put the file's name before the message of a format error."""
    try:
        yield
    except FormatError as error:
        raise FormatError(f"{path}: {error}") from None
