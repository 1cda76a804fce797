"""What is said to the engine in JSON."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np

from bioscope.errors import InvalidValueError


def json_text(value: Any) -> str:
    """Return a value as JSON; numbers and arrays of NumPy as those of Python.

    Raises
    ------
    InvalidValueError
        For a value, or a part of it, that JSON has no word for.
    """
    return msgspec.json.encode(value, enc_hook=_plain).decode()


def _plain(value: Any) -> Any:
    if isinstance(value, (np.generic, np.ndarray)) and value.dtype.kind in "biufU":
        return value.tolist()
    msg = f"{value!r}: expected numbers, words, or lists of them"
    raise InvalidValueError(msg)
