"""Names that every program accepts."""

from __future__ import annotations

import re


class Names:
    """Gives each key a name of its own: letters, digits and underscores, no digit first."""

    def __init__(self, *taken: str) -> None:
        self._taken = set(taken)
        self._given: dict[object, str] = {}

    def of(self, key: object, wish: str) -> str:
        """Return the name of `key`, made from `wish` the first time."""
        if key not in self._given:
            plain = re.sub(r"\W", "_", wish, flags=re.ASCII) or "_"
            plain = f"_{plain}" if plain[0].isdigit() else plain
            name, number = plain, 2
            while name in self._taken:
                name, number = f"{plain}_{number}", number + 1
            self._taken.add(name)
            self._given[key] = name
        return self._given[key]
