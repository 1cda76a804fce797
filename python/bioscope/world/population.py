"""Populations: what lives in a world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.world import state

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from bioscope._engine import Publication, View
    from bioscope._engine import Resident as NativeResident
    from bioscope.world.world import World

_kinds: dict[str, type[Population]] = {}


class Resident:
    """Anything that lives in a world: populations of the engine and of your own alike."""

    name: str
    """Name in the world it was added to; empty before."""

    _world: World | None = None

    @property
    def world(self) -> World:
        """The world it lives in.

        Raises
        ------
        RuntimeError
            Before it was added to one.
        """
        if self._world is None:
            raise RuntimeError(f"this {type(self).__name__} is in no world yet: world.add(it)")
        return self._world

    @property
    def parameters(self) -> dict[str, float]:
        """Current values of its parameters by name; `World.parameters` describes them."""
        rows = self.world.parameters()
        return {row.name: row.value for row in rows if row.owner == self.name}

    def set(self, **values: float) -> None:
        """Set parameters by name, between two ticks; the change is part of a recording.

        Raises
        ------
        UnknownNameError, InvalidValueError
            For an unknown name or a value outside the parameter's range; nothing after it is set.
        """
        for name, value in values.items():
            self.world.set(self.name, name, value)

    def resize(self, count: int) -> None:
        """Be this many, between two ticks: the youngest go, or others like the first come.

        Raises
        ------
        InvalidValueError
            For a number that is too large or below 0, and populations that cannot change theirs.
        """
        if count < 0:
            msg = f"count = {count}: expected 0 or more"
            raise InvalidValueError(msg)
        self.world.order(self.name, {"number": count})

    def remove(self, individual: int) -> None:
        """Take one individual out of the world, by its id."""
        self.world.order(self.name, {"remove": individual})

    def place(
        self, individual: int, position: tuple[float, float, float], *, scale: float = 1.0
    ) -> None:
        """Put one individual elsewhere (metres), and size it by `scale` if it can be sized."""
        order = {"id": individual, "position": [*position], "scale": scale}
        self.world.order(self.name, {"place": order})

    def set_one(self, individual: int, **values: float) -> None:
        """Set parameters of one individual alone: its temper, its habits, its body."""
        for name, value in values.items():
            order = {"id": individual, "name": name, "value": value}
            self.world.order(self.name, {"trait": order})

    def steer(
        self,
        individual: int,
        *,
        turn: float = 0.0,
        pitch: float = 0.0,
        speed: float = 1.0,
        brake: float = 0.0,
        mouth: float = 0.0,
    ) -> None:
        """Let an animal do this instead of what its mind wants, until `release`.

        Its mind goes on feeling hunger, libido and fear. With an open mouth it bites the food
        nearest to it.

        Parameters
        ----------
        individual
            Its id.
        turn, pitch
            Angles in radians to turn by (positive to the left) and to climb at.
        speed
            Body lengths per second; negative to back away.
        brake, mouth
            How hard to brake and how far to open the mouth, 0 to 1.
        """
        steering = {"turn": turn, "pitch": pitch, "speed": speed, "brake": brake, "mouth": mouth}
        self.world.order(self.name, {"steer": {"id": individual, "steering": steering}})

    def release(self, individual: int) -> None:
        """Give a steered animal back to its mind."""
        self.world.order(self.name, {"steer": {"id": individual, "steering": None}})

    @property
    def statistics(self) -> dict[str, float]:
        """Present figures by name, `count` among them."""
        prefix = f"{self.name}."
        figures = self.world.statistics().items()
        return {name.removeprefix(prefix): one for name, one in figures if name.startswith(prefix)}

    def values(self, name: str) -> NDArray[Any]:
        """Return one value of the inner life of every individual, in the order of their ids.

        Parameters
        ----------
        name
            `id`, `intention`, `target` (0 for nobody), or whatever minds and bodies tell: `hunger`,
            `libido`, `fear`, `speed_m_per_s`, …

        Raises
        ------
        UnknownNameError
            If they have nothing of this name.
        """
        found = self.world._engine.values(self.name, name)
        if found is None:
            raise UnknownNameError(f"'{self.name}' has no values '{name}' of its individuals")
        return np.array(found)

    def _settled(self, world: World, name: str) -> None:
        self._world, self.name = world, name


class Native(Resident):
    """Base of the engine's populations: carries the engine's object until it is added."""

    def __init__(self, resident: NativeResident) -> None:
        self.name = ""
        self._resident = resident


class Population:
    """A population of your own, on numpy arrays.

    Subclass it, keep the individuals in arrays on `self`, and implement the verbs that you need. In
    every tick the world calls `sense`, `decide`, `move`, `grow` and `publish`, each on all
    populations before the next begins. All attributes that are plain data (numbers, texts, lists,
    dicts, numpy arrays) are the state: they are saved, hashed and put back when a tick fails. Name
    others in `transient`.

    An exception in a verb stops `World.step`, and the world is as it was after the last complete
    tick.

    Examples
    --------
    >>> import numpy as np, bioscope as bio
    >>> class Sinkers(bio.Population):
    ...     count = 5
    ...     def born(self, ids):
    ...         self.ids, self.heights = ids, np.full(len(ids), 9.0, np.float32)
    ...     def settle(self):
    ...         return self.count
    ...     def move(self, dt):
    ...         self.heights -= 0.5 * dt
    >>> world = bio.World(seed=1, dt=0.1)
    >>> sinkers = world.add(Sinkers())
    >>> world.step(10)
    >>> round(float(sinkers.heights[0]), 3)
    8.5
    """

    transient: ClassVar[tuple[str, ...]] = ()
    """Attributes that are no state: built again when needed, neither saved nor hashed."""

    tunable: ClassVar[dict[str, tuple[str, float, float, float, str]]] = {}
    """Attributes that are parameters: name to (unit, minimum, maximum, default, meaning)."""

    kind: ClassVar[str]
    """Word under which saved worlds find the class: its name, if you say nothing else."""

    name: str = ""
    """Name in the world it was added to; empty before."""

    _always_transient: ClassVar[tuple[str, ...]] = ("_world", "name")

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "kind" not in cls.__dict__:
            cls.kind = cls.__name__
        _kinds[cls.kind] = cls

    def settle(self) -> int | None:
        """Return how many individuals are to be born at the start; `born` gets their ids."""

    def born(self, ids: NDArray[np.uint32]) -> None:
        """Take in individuals with these new ids (n,), never used before in this world."""

    def sense(self, view: View) -> None:
        """Notice the world of the last tick: `view.scene`, `view.sounds`, `view.flow(points)`."""

    def decide(self) -> None:
        """Turn percepts into intentions."""

    def move(self, dt: float) -> None:
        """Move the bodies by `dt` seconds."""

    def grow(self) -> int | None:
        """Let individuals grow and die; return how many are to be born."""

    def publish(self, scene: Publication) -> None:
        """Show yourself: `scene.instances(…)`, `scene.points(…)`, `scene.event(…)`.

        Must depend on the state alone, so that it can be repeated after a restore.
        """

    def inspect(self, individual: int) -> Mapping[str, Any] | None:
        """Return live values of one individual for the inspector, or none if it is not here."""

    def statistics(self) -> Mapping[str, float]:
        """Return figures for charts."""
        return {"count": float(getattr(self, "count", 0))}

    def state(self) -> dict[str, Any]:
        """Return the complete state; all public and private attributes but the transient ones."""
        left_out = {*self._always_transient, *self.transient}
        return {name: value for name, value in vars(self).items() if name not in left_out}

    def restore(self, values: dict[str, Any]) -> None:
        """Go back to a state that `state` gave."""
        for name in self.state():
            delattr(self, name)
        vars(self).update(values)

    def _save(self) -> bytes:
        return state.to_bytes(type(self).__name__, self.state())

    def _restore(self, data: bytes) -> None:
        self.restore(state.from_bytes(type(self).__name__, data))


def kinds() -> list[str]:
    """Return the kinds of all population classes defined in Python."""
    return list(_kinds)


def rebuild(kind: str, data: bytes) -> Population:
    """Bring back a population of this kind from its saved state, without calling `__init__`."""
    try:
        cls = _kinds[kind]
    except KeyError:
        raise UnknownNameError(
            f"unknown population '{kind}': import the module that defines it first"
        ) from None
    population = cls.__new__(cls)
    population._restore(data)
    return population
