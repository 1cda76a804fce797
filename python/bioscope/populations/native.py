"""How populations of the engine are asked for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bioscope import _engine
from bioscope.errors import InvalidValueError
from bioscope.json_text import json_text
from bioscope.world.population import Native


class Asked(Native):
    """A population of the engine, asked for by kind, options and parameters."""

    def __init__(
        self,
        kind: str,
        options: dict[str, Any],
        parameters: dict[str, float],
        *,
        environment: _engine.Environment | None = None,
        **always: Any,
    ) -> None:
        text = asked_text(options, **always)
        super().__init__(_engine.resident(kind, text, parameters, environment))


def asked_text(options: dict[str, Any], **always: Any) -> str:
    """Return options as the engine reads them; those that are none are left to the engine."""
    said = {name: value for name, value in options.items() if value is not None} | always
    for name, value in said.items():
        if not _finite(value):
            # JSON has no word for it, so the engine could not tell which it was.
            msg = f"{name} = {value}: expected finite numbers"
            raise InvalidValueError(msg)
    return json_text(said)


def _finite(value: Any) -> bool:
    """Say whether all numbers in a value are finite."""
    if isinstance(value, (list, tuple)):
        return all(_finite(one) for one in value)
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        return bool(np.isfinite(value).all())
    return not isinstance(value, (float, np.floating)) or math.isfinite(value)
