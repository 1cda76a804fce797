"""The folder in which a new species begins."""

from __future__ import annotations

import re
from pathlib import Path

from bioscope.errors import InvalidValueError
from bioscope.files import written_whole

_TEMPLATE = Path(__file__).parent / "template"
_NAME = re.compile(r"[a-z][a-z0-9_]*")


def begin(name: str, parent: Path) -> list[Path]:
    """Write the folder of a new species: model, colors, a place for photographs, what to do.

    Parameters
    ----------
    name
        Name of the species: small letters, digits and `_`.
    parent
        The folder in which the new one shall be.

    Returns
    -------
    list of Path
        What was written.

    Raises
    ------
    InvalidValueError
        If the name is none.
    FileExistsError
        If there is something of this name already.
    """
    if not _NAME.fullmatch(name):
        raise InvalidValueError(f"'{name}': expected small letters, digits and _, a letter first")
    folder = parent / name
    if folder.exists():
        raise FileExistsError(f"{folder} is there already: nothing was written")
    (folder / "photographs").mkdir(parents=True)
    written = []
    for source in sorted(_TEMPLATE.rglob("*")):
        if source.is_dir():
            continue
        relative = str(source.relative_to(_TEMPLATE)).replace("species", name)
        text = source.read_text(encoding="utf-8")
        title = name.replace("_", " ")
        text = text.replace("@NAME@", name).replace("@TITLE@", title[0].upper() + title[1:])
        with written_whole(folder / relative) as temporary:
            temporary.write_text(text, encoding="utf-8")
        written.append(folder / relative)
    return written
