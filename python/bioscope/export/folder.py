"""A folder that is whole or not there."""

from __future__ import annotations

import contextlib
import shutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@contextlib.contextmanager
def written_folder(final: Path) -> Iterator[Path]:
    """Give a temporary folder beside `final`; it takes its place if the block succeeds.

    If the block fails, whatever was at `final` stays. If the folder stays empty, none is made.
    """
    temporary = final.with_name(f".{final.name}.partial")
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir()
    try:
        yield temporary
        if any(temporary.iterdir()):
            old = final.with_name(f".{final.name}.old")
            if final.exists():
                final.rename(old)
            temporary.rename(final)
            shutil.rmtree(old, ignore_errors=True)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
