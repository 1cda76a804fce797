"""The protocol between a plant and its surroundings, and deriving strings in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bioscope import _engine
from bioscope.environments.amounts import Amounts
from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.lsystem.lsystem import LSystem, ModuleString
from bioscope.world import state

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import ArrayLike, NDArray

    from bioscope.lsystem.turtle import ViewFile


_kinds: dict[str, type[Environment]] = {}


class Environment:
    r"""What surrounds a plant; write your own by deriving from it and defining `exchange`.

    Of an environment of growing plants in a world, attributes that are plain data are its memory:
    saved and hashed with the world. Name what shall not be in `transient`.

    Examples
    --------
    >>> import bioscope as bio
    >>> class Ceiling(bio.environments.Environment):
    ...     def exchange(self, step, messages):
    ...         return (messages["positions"][:, 1:2] < 2.5) * 1.0
    >>> grow = "Lsystem: x\naxiom: A?E(1)\nA > ?E(x) : x > 0 --> F(1)A\nendlsystem\n"
    >>> bio.environments.derive(bio.LSystem(grow), steps=9, environment=Ceiling()).string()
    'F(1)F(1)F(1)A?E(0)'
    """

    _inner: _engine.Environment | None = None
    _asked: dict[str, Any] | None = None
    """What the engine makes it from, where it is one of the engine's: name, settings, map."""
    fields: tuple[str, ...] | None = None
    """Which parts of the messages are sent, so that no more is told than needed; None is all."""
    kind: ClassVar[str]
    """Word under which saved worlds find the class: its name, if you say nothing else."""
    transient: ClassVar[tuple[str, ...]] = ()
    """Names of attributes that are not saved."""

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "kind" not in cls.__dict__:
            cls.kind = cls.__name__
        _kinds[cls.kind] = cls

    def exchange(self, step: int, messages: dict[str, NDArray[Any]]) -> NDArray[np.float32] | None:
        """Answer the messages of one string, in its order.

        Parameters
        ----------
        step
            Derivation step, 0 for the axiom.
        messages
            Arrays with a row per message: `parameters` (n, k; what shorter messages lack is not a
            number), `positions`, `headings`, `lefts`, `ups` (n, 3), `widths`, `modules` (n,), and
            `following`: the module after each message as (symbol, numbers), None at the end of a
            branch. Only those that `fields` names, if it does.

        Returns
        -------
        array or None
            New parameters (n, up to k); what is not a number stays as it is, and so does
            everything for None.
        """
        raise NotImplementedError(f"{type(self).__name__} does not define exchange")

    def asked(self) -> dict[str, Any]:
        """Return what a growing stand in a world makes its own one from, or knows this one by."""
        return self._asked or {"name": self.kind, "foreign": True}

    def _save(self) -> bytes:
        left_out = {"_inner", *self.transient}
        own = {name: value for name, value in vars(self).items() if name not in left_out}
        return state.to_bytes(type(self).__name__, own)

    def _restore(self, data: bytes) -> None:
        vars(self).update(state.from_bytes(type(self).__name__, data))

    @property
    def engine(self) -> _engine.Environment:
        """What the engine talks to."""
        if self._inner is None:
            self._inner = _engine.Environment.python(self)
        return self._inner

    @property
    def amounts(self) -> Amounts | None:
        """What it keeps in its cells now, as `SoilWater` does water; None if it keeps nothing."""
        kept = self.engine.amounts()
        if kept is None:
            return None
        (columns, rows, layers), (x, y, z), cell, values = kept
        return Amounts(values.reshape(layers, rows, columns), (x, y, z), cell)

    def ask(
        self,
        parameters: ArrayLike,
        positions: ArrayLike,
        headings: ArrayLike | None = None,
        step: int = 0,
    ) -> list[list[float]]:
        """Ask once, as a plant with these messages would; return their parameters afterwards.

        Parameters
        ----------
        parameters
            Numbers of each message (n, k).
        positions
            Where they are (n, 3), metres.
        headings
            Where the turtle looks there (n, 3); upward if not given.
        step
            Derivation step.
        """
        places = np.ascontiguousarray(positions, np.float32)
        if headings is None:
            headings = np.tile(np.array([0, 1, 0], np.float32), (len(places), 1))
        ahead = np.ascontiguousarray(headings, np.float32)
        rows = [[float(one) for one in np.atleast_1d(row)] for row in np.asarray(parameters)]
        return self.engine.ask(rows, places, ahead, step)


class BuiltIn(Environment):
    """An environment of the engine."""

    def __init__(self, name: str, settings: dict[str, object], **picture: Any) -> None:
        entries = [(key, _told(value)) for key, value in settings.items() if value is not None]
        self._make(name, entries, **picture)

    def _make(self, name: str, entries: list[tuple[str, str]], **picture: Any) -> None:
        self._inner = _engine.Environment.built_in(name, entries, **picture)
        self._asked = {"name": name, "settings": entries}
        if "map" in picture:
            rows, columns = picture["map"].shape
            light = np.clip(np.nan_to_num(picture["map"]), 0.0, 1.0).ravel().tolist()
            corners = {"low": picture["low"], "size": picture["size"]}
            self._asked["map"] = {"cells": (columns, rows), "light": light, **corners}


def _told(value: object) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return value
    return " ".join(repr(float(one)) for one in np.atleast_1d(np.asarray(value)).ravel())


class _Made(Environment):
    def __init__(self, engine: _engine.Environment) -> None:
        self._inner = engine

    def asked(self) -> dict[str, Any]:
        raise InvalidValueError(
            "an environment file, or an environment in words: a saved world would need it again; "
            "plants of a world live in environments of the engine, in your own and at the end of "
            "pipes"
        )


def read(path: str | PathLike[str]) -> Environment:
    """Return the environment of an environment file (.e) and the specification beside it.

    The field program that it names is never run: it is built in.

    Raises
    ------
    FormatError
        If the file cannot be read, or names a program that is not built in.
    """
    return _Made(_engine.Environment.read(path))


def named(words: str) -> Environment:
    """Return an environment by name and parameters, as a model asks for it: "soil_water D=0.1".

    A name that ends in `.e` is an environment file, see `read`.

    Raises
    ------
    FormatError
        If there is no such environment, or its parameters make no sense.
    """
    return _Made(_engine.Environment.named(words))


def names() -> list[str]:
    """Return the names of the environments and field programs that are built in."""
    return _engine.environment_names()


def rebuild(kind: str) -> Environment:
    """Bring back an environment of a saved world, without calling `__init__`."""
    try:
        cls = _kinds[kind]
    except KeyError:
        raise UnknownNameError(
            f"unknown environment '{kind}': import the module that defines it first"
        ) from None
    return cls.__new__(cls)


def derive(
    system: LSystem,
    steps: int | None = None,
    *,
    environment: Environment | None = None,
    seed: int = 1,
    view: ViewFile | None = None,
    threads: bool = True,
    **options: Any,
) -> ModuleString:
    """Derive a string of a model that asks its surroundings.

    Parameters
    ----------
    system
        The model.
    steps
        Number of steps; as many as the file says, if not given.
    environment
        What answers `?E`; it keeps its state afterwards. If not given, the one that the file
        declares (`environment: sky_light tau=0.25`).
    seed
        Seed of the random numbers.
    view
        A view file: how the turtle walks, and the functions that the model uses.
    threads
        Whether several threads may be used; the string does not depend on it.
    **options
        Options of the turtle, see `bioscope.Turtle`.

    Raises
    ------
    FormatError
        If a production cannot be evaluated, a limit is reached, or the environment fails.
    """
    engine = _engine.derive_in(
        system._engine,
        system.steps if steps is None else steps,
        seed,
        environment.engine if environment is not None else None,
        view._engine if view is not None else None,
        options,
        threads,
    )
    return ModuleString(engine)
