"""Minds of one's own: percepts in, an intention out."""

from __future__ import annotations

from typing import Any, ClassVar

from bioscope.errors import UnknownNameError
from bioscope.world import state

_kinds: dict[str, type[Mind]] = {}


class Mind:
    """What one animal wants, decided once a tick from what it notices.

    Subclass it and implement `decide`. Attributes that are plain data are the mind's memory: saved
    and hashed with the world. Any mind drives any body.

    Examples
    --------
    >>> class Follower(Mind):
    ...     def decide(self, percepts):
    ...         for one in percepts["seen"]:
    ...             if one["species"] == "anchovy":
    ...                 return {"behavior": "follow", "heading": one["position"], "speed": 2.0}
    ...         return {"behavior": "drift", "heading": (0, 0, 1), "speed": 0.5}
    """

    kind: ClassVar[str]
    """Word under which saved worlds find the class: its name, if you say nothing else."""

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "kind" not in cls.__dict__:
            cls.kind = cls.__name__
        _kinds[cls.kind] = cls

    def decide(self, percepts: dict[str, Any]) -> dict[str, Any]:
        """Return what the animal wants now.

        Parameters
        ----------
        percepts
            All that it may know, in its own frame (x left, y up, z ahead), metres and seconds:
            `id` (its own), `time`, `dt`, `velocity`, `attitude` (own frame to world's, xyzw),
            `body_length`, `depth`, `home` (vector to it), `seen` (dicts with `id`, `species`,
            `position`, `velocity`, `heading`, `size`, `color` and `display`, which has `sex`, `act`
            and `partner`; nearest first), `smelled` (food, alike), `fed` (things swallowed since
            the last decision), `ahead` (none, or `distance` and `aim` beside the obstacle),
            `solids` (points of solids round it), `heard` (`source`, `kind`, `direction`,
            `amplitude`), `flow`, `light`, `temperature`, `retina` (of those who look: `width`,
            `height`, `color`, `range`, `identity`), `other`, and `random`, four numbers uniform in
            [0, 1) of this animal in this tick.

        Returns
        -------
        dict
            Any of `behavior` (a word), `heading` (own frame), `speed` (body lengths per second,
            negative to back away), `urgency`, `brake` and `mouth` (0 to 1), `gaze` (point in the
            own frame), `target` (an id), `display` (what to show: `sex`, `act`, `partner`).
        """
        raise NotImplementedError(f"{type(self).__name__}.decide")

    def _save(self) -> bytes:
        return state.to_bytes(type(self).__name__, vars(self))


def kinds() -> list[str]:
    """Return the kinds of all mind classes."""
    return list(_kinds)


def rebuild(kind: str, data: bytes) -> Mind:
    """Bring back a mind of this kind from its saved state, without calling `__init__`."""
    try:
        cls = _kinds[kind]
    except KeyError:
        raise UnknownNameError(
            f"unknown mind '{kind}': import the module that defines it first"
        ) from None
    mind = cls.__new__(cls)
    vars(mind).update(state.from_bytes(cls.__name__, data))
    return mind
