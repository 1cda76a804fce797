"""The minds of artificial fishes, by themselves or for a population."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, Self

from bioscope import _engine
from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.json_text import json_text

if TYPE_CHECKING:
    from collections.abc import Iterable

_HABITS = ("bright", "dark", "cold", "warm", "school", "female")
_ROLES = ("predator", "prey", "pacifist", "generic")


class FishMind:
    """A mind of a fish, made from its nature and temper.

    It can be asked by itself, with typed-in percepts (`decide`), or given to a population, in which
    every fish gets such a mind of its own. After Tu, "Artificial animals for computer animation"
    (1996); see the page "What a fish wants".

    Parameters
    ----------
    role
        `predator` (hunts; neither fears, schools nor courts), `prey` (schools and flees, does not
        court), `pacifist` (feeds and courts, does not flee) or `generic` (all of it).
    species
        Its own species; the population's if not given.
    enemies, food, leaders
        Species that it flees from, that it eats, and behind which it schools: one name or several.
        In a world `shark` means all sharks.
    habits
        Any of `bright`, `dark`, `cold`, `warm` (what it likes; both of a pair is indifference),
        `school` (likes company) and `female`.
    eye
        Whether a fish in a population renders what it sees on a retina and takes the brightness
        from it; costly.
    **temper
        How it feels and acts, in numbers: `appetite`, `fear_distance`, `persistence`, …; see
        `parameters`.

    Examples
    --------
    >>> import bioscope as bio
    >>> mind = bio.minds.Intentions("prey", enemies=["shark"], stagger=0.0)
    >>> shark = {"id": 7, "species": "shark", "position": (0.0, 0.0, 0.5)}
    >>> mind.decide({"body_length": 0.1, "seen": [shark]})["behavior"]
    'escape'
    """

    kind: ClassVar[str] = ""

    def __init__(
        self,
        role: str = "pacifist",
        *,
        species: str = "",
        enemies: str | Iterable[str] = (),
        food: str | Iterable[str] = (),
        leaders: str | Iterable[str] = (),
        habits: str | Iterable[str] = (),
        eye: bool = False,
        **temper: float,
    ) -> None:
        if role not in _ROLES:
            raise UnknownNameError(f"unknown role '{role}'; known: {', '.join(_ROLES)}")
        for name, value in temper.items():
            if isinstance(value, float) and not math.isfinite(value):
                raise InvalidValueError(f"{name} = {value}: expected a finite number")
        liked = {}
        for habit in _names("habits", habits):
            if habit not in _HABITS:
                raise UnknownNameError(f"unknown habit '{habit}'; known: {', '.join(_HABITS)}")
            liked[habit] = True
        self._request: dict[str, Any] = {
            "kind": self.kind,
            "nature": {
                "role": role,
                "habits": liked,
                "species": species,
                "enemies": _names("enemies", enemies),
                "food": _names("food", food),
                "leaders": _names("leaders", leaders),
            },
            "temper": temper,
        }
        if eye:
            self._request["eye"] = True
        self._mind = _engine.FishMind(json_text(self._request))
        self._tick = 0
        self._last: dict[str, Any] = {}

    def decide(self, percepts: dict[str, Any], *, seed: int = 0) -> dict[str, Any]:
        """Return what the fish wants now; each call is one tick of its life.

        Parameters
        ----------
        percepts
            Any of those that `Mind.decide` gets; what is left out is as if nothing were noticed.
        seed
            Of the world; with it chance differs.

        Returns
        -------
        dict
            `behavior`, `heading` (own frame), `turn` (radians, positive to the left), `pitch`
            (radians, positive up), `speed` (body lengths per second, negative to back away),
            `urgency`, `brake` and `mouth` (0 to 1), `gaze`, `target`, `display` (`sex`, `act`,
            `partner`) and `annotations` (role, from, to).
        """
        if not isinstance(percepts, dict):
            raise InvalidValueError(f"percepts = {percepts!r}: expected a dict")
        self._tick += 1
        self._last = self._mind.decide(percepts, seed, self._tick)
        return self._last

    @property
    def hunger(self) -> float:
        """Hunger, 0 to 1."""
        return float(self.values["hunger"])

    @property
    def libido(self) -> float:
        """Libido, 0 to 1."""
        return float(self.values["libido"])

    @property
    def fear(self) -> float:
        """Fear, 0 to 1."""
        return float(self.values["fear"])

    @property
    def intention(self) -> str:
        """Behavior of the last decision; empty before the first."""
        return str(self._last.get("behavior", ""))

    @property
    def target(self) -> int | None:
        """Whom the last decision concerned."""
        target: int | None = self._last.get("target")
        return target

    @property
    def values(self) -> dict[str, Any]:
        """Inner life by name: drives, food eaten, stage of courtship."""
        return self._mind.values()

    @property
    def parameters(self) -> dict[str, float]:
        """Its temper: values by name."""
        return {row[0]: row[-1] for row in self._mind.parameters()}

    def set(self, **temper: float) -> None:
        """Change numbers of its temper."""
        for name, value in temper.items():
            self._mind.set(name, value)

    def save(self) -> bytes:
        """Return the complete state."""
        return self._mind.save()

    def restored(self, data: bytes) -> Self:
        """Return a mind like this one in the state that `save` returned."""
        other = type(self).__new__(type(self))
        other._request, other._tick, other._last = self._request, self._tick, dict(self._last)
        other._mind = _engine.FishMind.restore(self.kind, data)
        return other

    @property
    def request(self) -> dict[str, Any]:
        """How the engine is asked for such a mind."""
        return self._request


class Intentions(FishMind):
    """The mind of an artificial fish: one intention at a time, by priority (Tu 1996)."""

    kind = "intentions"


class BehaviorNetwork(FishMind):
    """A behavior-choice network (Maes 1989, 1991) on the same percepts."""

    kind = "behavior_network"


class FreeFlow(FishMind):
    """A free-flow hierarchy (Rosenblatt and Payton 1989, Tyrrell 1993) on the same percepts."""

    kind = "free_flow"


def _names(field: str, names: str | Iterable[str]) -> list[str]:
    """Return the names as a list, or raise if they are none; one alone is one name."""
    if isinstance(names, str):
        return [names]
    try:
        found = [*names]
    except TypeError:
        raise InvalidValueError(f"{field} = {names!r}: expected names") from None
    for name in found:
        if not isinstance(name, str):
            raise InvalidValueError(f"{field} = {name!r}: expected names")
    return found


_KINDS: dict[str, type[FishMind]] = {
    one.kind: one for one in (Intentions, BehaviorNetwork, FreeFlow)
}


def asked(mind: str | FishMind) -> FishMind:
    """Return a mind by the name of its kind, or the mind itself.

    Raises
    ------
    UnknownNameError
        For a name that is none of `intentions`, `behavior_network` and `free_flow`.
    """
    if isinstance(mind, FishMind):
        return mind
    if mind not in _KINDS:
        raise UnknownNameError(f"unknown mind '{mind}'; known: {', '.join(_KINDS)}")
    return _KINDS[mind]()
