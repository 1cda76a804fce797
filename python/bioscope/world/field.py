"""Fields: what acts at every point and time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bioscope import _engine
from bioscope.errors import UnknownNameError
from bioscope.world import state

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

_kinds: dict[str, type[Field]] = {}


class Field:
    """A field of your own: a lamp, a warm spring, a scent, a whirlpool.

    Subclass it and implement `at`. Attributes that are plain data are saved with the world.
    """

    kind: ClassVar[str]
    """Word under which saved worlds find the class: its name, if you say nothing else."""

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "kind" not in cls.__dict__:
            cls.kind = cls.__name__
        _kinds[cls.kind] = cls

    def at(self, points: NDArray[np.float32], time: float) -> Mapping[str, NDArray[np.float32]]:
        """Return what acts at points (n, 3) in metres at `time` in seconds.

        Any of `flow` (n, 3) in m/s, `force` (n, 3) in m/s², `light` (n,) 0 to 1, `temperature` (n,)
        in kelvin above the world's, `scent` (n,) from 0 to 1 at the source; float32. Must depend on
        points, time and the field's attributes alone.
        """
        raise NotImplementedError(f"{type(self).__name__}.at")

    def _save(self) -> bytes:
        return state.to_bytes(type(self).__name__, vars(self))

    def _restore(self, data: bytes) -> None:
        vars(self).clear()
        vars(self).update(state.from_bytes(type(self).__name__, data))


class Current:
    """Water that flows one way, is rocked by a swell and curls in eddies.

    Parameters
    ----------
    direction
        Towards where it flows; any length but zero.
    **parameters
        `speed` (m/s), `surge` (m/s), `surge_period` (s), `turbulence` (m/s), `eddy_size` (m); see
        `World.parameters`.
    """

    def __init__(
        self, direction: tuple[float, float, float] = (1.0, 0.0, 0.0), **parameters: float
    ) -> None:
        self._field = _engine.current(direction, **parameters)


def kinds() -> list[str]:
    """Return the kinds of all field classes defined in Python."""
    return list(_kinds)


def rebuild(kind: str, data: bytes) -> Field:
    """Bring back a field of this kind from its saved state, without calling `__init__`."""
    try:
        cls = _kinds[kind]
    except KeyError:
        raise UnknownNameError(
            f"unknown field '{kind}': import the module that defines it first"
        ) from None
    field = cls.__new__(cls)
    field._restore(data)
    return field
