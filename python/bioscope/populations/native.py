"""How populations of the engine are asked for."""

from __future__ import annotations

from typing import Any

import msgspec

from bioscope import _engine
from bioscope.world.population import Native


class Asked(Native):
    """A population of the engine, asked for by kind, options and parameters."""

    def __init__(
        self,
        kind: str,
        options: dict[str, Any],
        parameters: dict[str, float],
        **always: Any,
    ) -> None:
        said = {name: value for name, value in options.items() if value is not None} | always
        text = msgspec.json.encode(said).decode()
        super().__init__(_engine.resident(kind, text, parameters))
