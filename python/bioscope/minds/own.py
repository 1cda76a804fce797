"""Minds of one's own: percepts in, an intention out."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable
from typing import Any, ClassVar, Protocol, Self

from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.world import state

Decision = Callable[[dict[str, Any]], dict[str, Any]]
"""A function of percepts that returns what an animal wants; see `Mind.decide`."""

_classes: dict[str, dict[str, type[Mind]]] = {}
"""All classes by kind, then by module and name; the class defined last comes last."""


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
        alike = _classes.setdefault(cls.kind, {})
        alike.pop(_whole_name(cls), None)
        alike[_whole_name(cls)] = cls

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

    @classmethod
    def _rebuilt(cls, data: bytes) -> Self:
        """Bring back a mind of this class from its saved state, without calling `__init__`."""
        mind = cls.__new__(cls)
        vars(mind).update(state.from_bytes(cls.__name__, data))
        return mind


class Reviving(Protocol):
    """What brings minds back from their saved states: a class of them, usually."""

    def _rebuilt(self, data: bytes) -> Mind: ...


class _Ambiguous:
    """Stands for several classes of one kind, of which saved states do not say which they mean."""

    def __init__(self, kind: str, names: list[str]) -> None:
        self._message = (
            f"several classes of minds are of the kind '{kind}' ({', '.join(names)}): "
            "give each a `kind` of its own"
        )

    def _rebuilt(self, data: bytes) -> Mind:
        del data
        raise UnknownNameError(self._message)


def kinds() -> dict[str, Reviving]:
    """Return the classes of minds by the kinds under which saved worlds find them.

    Of classes defined again under the same name, and of those defined within functions, the last.
    """
    found: dict[str, Reviving] = {}
    for kind, alike in _classes.items():
        lasting = [name for name in alike if "<" not in name]
        found[kind] = _Ambiguous(kind, lasting) if len(lasting) > 1 else [*alike.values()][-1]
    return found


def from_function(decide: Decision) -> type[Mind]:
    """Return a class of minds that decide by this function and remember nothing.

    Populations take the function itself as well. Its kind is its name; that of a lambda says where
    it is written.

    Examples
    --------
    >>> def drift(percepts):
    ...     return {"behavior": "drift", "heading": percepts["flow"], "speed": 0.3}
    >>> from_function(drift).kind
    'drift'
    """
    kind = name = getattr(decide, "__name__", type(decide).__name__)
    if name == "<lambda>":
        name = "Lambda"
        kind = f"lambda, {decide.__module__}, line {decide.__code__.co_firstlineno}"
    members = {
        "__module__": decide.__module__,
        "__qualname__": getattr(decide, "__qualname__", name),
        "__doc__": decide.__doc__,
        "kind": kind,
        "decide": lambda self, percepts: decide(percepts),
    }
    return type(name, (Mind,), members)


def maker(mind: object) -> Callable[[], Mind]:
    """Return what makes one mind after the other, as somebody asked for them.

    Parameters
    ----------
    mind
        A class of minds or another function without arguments that returns one; a function of
        percepts; or a mind, of which each animal gets a copy.

    Raises
    ------
    InvalidValueError
        For anything else, also from what is returned.
    """
    if isinstance(mind, Mind):
        return lambda: copy.deepcopy(mind)
    if not callable(mind):
        raise InvalidValueError(f"mind = {mind!r}: expected {_EXPECTED}")
    make = from_function(mind) if _takes_percepts(mind) else mind

    def one() -> Mind:
        made = make()
        if not isinstance(made, Mind):
            raise InvalidValueError(f"mind: made {made!r}: expected {_EXPECTED}")
        return made

    return one


_EXPECTED = (
    "the name of a mind of the engine's, a `bioscope.Mind`, a class of them, or a function of "
    "percepts"
)


def _takes_percepts(function: Callable[..., Any]) -> bool:
    """Say whether a function has to be given percepts, or takes whatever it is given."""
    if isinstance(function, type) and issubclass(function, Mind):
        return False
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # Functions of some C modules do not tell.
        return False
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    required = (one.kind in positional and one.default is one.empty for one in parameters)
    return any(required) or any(one.kind is one.VAR_POSITIONAL for one in parameters)


def _whole_name(cls: type[Mind]) -> str:
    return f"{cls.__module__}.{cls.__qualname__}"
