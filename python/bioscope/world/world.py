"""The world: advances time, holds what lives in it, lets itself be watched."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from bioscope import _engine, minds
from bioscope.errors import InvalidValueError
from bioscope.files import naming, written_whole
from bioscope.json_text import json_text
from bioscope.world import field as fields
from bioscope.world import population as populations
from bioscope.world.cameras import Cameras
from bioscope.world.environment import Environment
from bioscope.world.events import Event, EventLog
from bioscope.world.parameter import Parameter
from bioscope.world.population import Native, Population, Resident

if TYPE_CHECKING:
    from os import PathLike

    from bioscope._engine import Scene

AnyPopulation = TypeVar("AnyPopulation", bound=Native | Population)


class World:
    """A virtual world: time, environment and everything that lives in it.

    Parameters
    ----------
    seed
        Seed of all randomness; one is drawn if not given. The same seed gives the same world.
    dt
        Length of a tick in seconds.
    title
        What the world is called.

    Examples
    --------
    >>> import bioscope as bio
    >>> world = bio.World(seed=7, dt=1 / 60)
    >>> world.environment.water(surface=0.0, current=bio.Current(direction=(1, 0, 0), speed=0.1))
    >>> world.step(60)
    >>> world.tick, round(world.time, 3)
    (60, 1.0)
    """

    def __init__(
        self, seed: int | None = None, dt: float = 1 / 60, *, title: str = "world"
    ) -> None:
        self._engine = _engine.World(secrets.randbits(32) if seed is None else seed, dt)
        self._engine.title = title
        self._prepare()

    def _prepare(self) -> None:
        self.environment = Environment(self)
        """Terrain, water, light and fields."""
        self.cameras = Cameras(self)
        """Named points of view."""
        self._events = EventLog()
        self._minds: dict[str, tuple[type[minds.Mind], ...]] = {}

    @classmethod
    def _of(cls, engine: _engine.World) -> World:
        world = cls.__new__(cls)
        world._engine = engine
        world._prepare()
        return world

    @property
    def seed(self) -> int:
        """Seed of all randomness."""
        return self._engine.seed

    @property
    def dt(self) -> float:
        """Length of a tick in seconds."""
        return self._engine.dt

    @property
    def tick(self) -> int:
        """Ticks made so far."""
        return self._engine.tick

    @property
    def time(self) -> float:
        """World time in seconds."""
        return self._engine.time

    @property
    def title(self) -> str:
        """What the world is called."""
        return self._engine.title

    @property
    def scene(self) -> Scene:
        """What the last tick published, as numpy views; stays as it is while the world goes on."""
        return self._engine.scene

    @property
    def sounds(self) -> list[dict[str, Any]]:
        """What sounded in the last tick."""
        return self._engine.sounds

    @property
    def shots(self) -> list[tuple[str, float]]:
        """The film the world suggests: names of cameras and seconds to stay with each."""
        return self._engine.shots

    @shots.setter
    def shots(self, shots: list[tuple[str, float]]) -> None:
        self._engine.shots = shots

    def add(self, population: AnyPopulation, name: str | None = None) -> AnyPopulation:
        """Let a population live here, and return it.

        Parameters
        ----------
        population
            One of the engine's (`FishSchool`, `Plants`, …) or of your own (`Population`).
        name
            Its name in the world; one is made from its kind if not given.

        Raises
        ------
        InvalidValueError
            If the name is taken or the population lives somewhere already.
        """
        if isinstance(population, Population):
            kind = type(population).kind
            given = self._engine.add_python(population, kind, name)
            population.name = given
        else:
            given = self._engine.add(population._resident, name)
            population._settled(self, given)
        return population

    @property
    def populations(self) -> dict[str, int]:
        """How many individuals each population has, by name."""
        return {name: count for name, _, count in self._engine.populations}

    def step(self, ticks: int = 1) -> None:
        """Make ticks. If your code fails in one, the world is back at the last complete tick."""
        self._engine.step(ticks)

    def run(self, seconds: float) -> None:
        """Make the ticks of this much world time, rounded to whole ticks."""
        self.step(round(seconds / self.dt))

    def state_hash(self) -> str:
        """Return 64 hex digits over the complete simulation state."""
        return self._engine.state_hash()

    @property
    def events(self) -> EventLog:
        """What has happened since the world was made, restored or last drained."""
        self._events.extend(Event(*row) for row in self._engine.events(len(self._events)))
        return self._events

    def drain_events(self) -> list[Event]:
        """Take the events out, for observers that store them elsewhere."""
        self._events = EventLog()
        return [Event(*row) for row in self._engine.drain_events()]

    def parameters(self) -> list[Parameter]:
        """Describe every tunable number of the world with its present value."""
        return [Parameter(*row) for row in self._engine.parameters()]

    def set(self, owner: str, name: str, value: float) -> None:
        """Set a parameter of a population, a field, `environment` or `world` between two ticks.

        Raises
        ------
        UnknownNameError, InvalidValueError
            For an unknown owner or name, or a value outside the parameter's range.
        """
        self._engine.set(owner, name, value)

    def order(self, population: str, order: dict[str, Any]) -> None:
        """Tell a population something between two ticks; it is part of a recording.

        Populations of the engine offer the orders as methods: `resize`, `remove`, `place`,
        `set_one`, `steer`, `release`.

        Raises
        ------
        UnknownNameError, InvalidValueError, FormatError
            For an unknown population, or an order that it cannot obey; nothing is changed then.
        """
        self._engine.order(population, json_text(order))

    def inspect(self, individual: int) -> dict[str, Any] | None:
        """Return what can be known of one individual; none if there is no such one.

        `population`, `species`, `behavior`, `values`, `traits` (its own values of the population's
        parameters), `percepts` and `eye` (a camera, or none).
        """
        return self._engine.inspect(individual)

    def statistics(self) -> dict[str, float]:
        """Return the present figures of all populations as `population.figure`."""
        return self._engine.statistics()

    def save(self, path: str | PathLike[str]) -> None:
        """Store the world in a file; `World.restore` continues it bit by bit as it would have.

        Raises
        ------
        InvalidValueError
            If minds of different classes that live here are of one kind, which is all that a file
            says of their class.
        """
        self._tell_minds_apart()
        with written_whole(path) as temporary:
            temporary.write_bytes(self._engine.save())

    @classmethod
    def restore(cls, path: str | PathLike[str]) -> World:
        """Bring back a saved world. Define or import its Python populations and fields first.

        Raises
        ------
        FormatError
            If the file is not a whole saved world of this or an earlier release.
        """
        data = Path(path).read_bytes()
        with naming(path):
            return cls._of(
                _engine.World.restore(data, populations.kinds(), fields.kinds(), minds.kinds())
            )

    def export(
        self, path: str | PathLike[str], seconds: float, fps: float = 24.0, **options: Any
    ) -> None:
        """Run for `seconds` and write what can be seen to a .usdc, .usda or .glb file.

        `options` are those of `bioscope.export.export_world`.
        """
        from bioscope.export import export_world

        export_world(self, path, seconds, fps, **options)

    def film(
        self,
        path: str | PathLike[str],
        seconds: float = 10.0,
        *,
        size: tuple[int, int] = (1280, 720),
        frames_per_second: float = 30.0,
        renderer: str = "preview",
        camera: str | None = None,
    ) -> None:
        """Film the world for `seconds` of its time, with sound, to an MP4 file.

        See `bioscope.film.FilmOptions`. The world's own shot list is filmed without a `camera`.
        """
        from bioscope.film import FilmOptions, film_world

        options = FilmOptions(
            seconds=seconds,
            size=size,
            frames_per_second=frames_per_second,
            renderer=renderer,
            camera=camera,
        )
        film_world(self, Path(path), options, say=lambda *_: None)

    def show(self, *, height: int = 560) -> Any:
        """Show the world live: inside a notebook as a widget, else in the browser until Ctrl-C."""
        from bioscope.live.notebook import show

        return show(self, height=height)

    def record(self) -> None:
        """Begin to record: from now on every change from outside is kept."""
        self._engine.record()

    def save_recording(self, path: str | PathLike[str]) -> None:
        """Store the run since `record`: where it began and what was done to it.

        Raises
        ------
        RuntimeError
            If `record` was not called.
        InvalidValueError
            See `save`.
        """
        self._tell_minds_apart()
        data = self._engine.recording()
        if data is None:
            raise RuntimeError("nothing is being recorded: call world.record() first")
        with written_whole(path) as temporary:
            temporary.write_bytes(data)

    def _tell_minds_apart(self) -> None:
        """Raise if a file could not tell whose class is which."""
        classes: dict[str, type[minds.Mind]] = {}
        for population, own in self._minds.items():
            for one in own:
                if classes.setdefault(one.kind, one) is not one:
                    raise InvalidValueError(
                        f"the minds of '{population}' are of the kind '{one.kind}' as others of "
                        "this world are: give each class a `kind` of its own"
                    )

    @classmethod
    def replay(cls, path: str | PathLike[str]) -> World:
        """Repeat a recorded run to its end; ends in the same state, to the bit."""
        data = Path(path).read_bytes()
        with naming(path):
            return cls._of(
                _engine.World.replay(data, populations.kinds(), fields.kinds(), minds.kinds())
            )


__all__ = ["Resident", "World"]
