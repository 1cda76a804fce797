"""One running world, watched by any number of pages that never hold it up."""

from __future__ import annotations

import threading
import time
import traceback
from collections import deque
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from bioscope import _engine, worlds
from bioscope.errors import BioscopeError
from bioscope.live import messages
from bioscope.live.messages import encode
from bioscope.live.populations import catalog, check_addition, check_count, residents
from bioscope.live.timeline import Timeline
from bioscope.world.changes import Order, Script, Setting, read_script

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.live.messages import AnyCommand
    from bioscope.world import World
    from bioscope.world.changes import AnyChange

FRAMES_PER_SECOND = 30.0
_STATISTICS_EVERY = 0.5
_TIMELINE_EVERY = 1.0
_MOST_CATCH_UP = 0.1
_EVENTS_KEPT = 500
_SLICE = 0.02
"""Seconds of ticks between two looks at the commands."""


@dataclass
class Snapshot:
    """The newest state of the stream, shared by all pages."""

    revision: int = 0
    layout: bytes = b""
    assets: dict[int, bytes] = field(default_factory=dict)
    frame: bytes = b""
    annotated: bytes = b""
    tick: int = -1
    number: int = 0


class Session:
    """A world in a thread of its own.

    Parameters
    ----------
    world
        The world to run, or the name or path of one.
    seed
        Seed, if `world` is a name.
    publish
        Called from the session's thread: with nothing when a newer `snapshot` is there, with a
        message that every page should get, otherwise.
    """

    def __init__(
        self, world: World | str, seed: int, publish: Callable[[bytes | None], None]
    ) -> None:
        self.name = world if isinstance(world, str) else world.title
        self._load = isinstance(world, str)
        self.world = worlds.load(world, seed) if isinstance(world, str) else world
        self._publish = publish
        self._commands: deque[tuple[AnyCommand, Callable[[bytes], None]]] = deque()
        self._wake = threading.Event()
        self._closed = False
        self.running = True
        self.speed: float | None = 1.0
        self.rate = 0.0
        self.stride: int | None = None
        """Ticks from one picture to the next; none for as many pictures as can be."""
        self.annotations = 0
        """How many pages want annotations."""
        self.events: deque[dict[str, Any]] = deque(maxlen=_EVENTS_KEPT)
        self.snapshot = Snapshot()
        self._begin()
        self._thread = threading.Thread(target=self._run, name="bioscope-world", daemon=True)

    def start(self) -> None:
        """Begin to run."""
        self._thread.start()

    def close(self) -> None:
        """Stop for good."""
        self._closed = True
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(timeout=10)

    def command(self, command: AnyCommand, answer: Callable[[bytes], None]) -> None:
        """Pass on a page's command; `answer` is called from the session's thread."""
        if len(self._commands) < 1000:
            self._commands.append((command, answer))
        self._wake.set()

    def _begin(self) -> None:
        self.timeline = Timeline(self.world)
        self._encoder = _engine.Encoder()
        self._initial = {(row.owner, row.name): row.value for row in self.world.parameters()}
        self._newest_event = self.world.tick
        self.events.clear()
        self.world.drain_events()
        self._frame()

    @property
    def closed(self) -> bool:
        """Whether the session has ended."""
        return self._closed

    # What pages are told.

    def greeting(self) -> list[bytes]:
        """Return the first messages to a page."""
        first = [self.hello(), self.parameters(), self.past_events(), self.timeline_message()]
        return [*first, self.populations()]

    def hello(self) -> bytes:
        """Return the first message to a page."""
        return encode(
            "hello",
            version=_engine.VERSION,
            world=Path(self.name).stem,
            title=self.world.title,
            seed=self.world.seed,
            dt=self.world.dt,
            cameras=self.world.cameras.describe(),
            shots=self.world.shots,
            page=["restart"] if self._load else [],
            catalog=catalog(),
        )

    def populations(self) -> bytes:
        """Return the message that says who lives in the world."""
        return encode("populations", stride=self.stride, populations=residents(self.world))

    def parameters(self) -> bytes:
        """Return the message that describes all parameters."""
        owners: dict[str, list[dict[str, Any]]] = {}
        for row in self.world.parameters():
            one = {name: getattr(row, name) for name in row.__slots__ if name != "owner"}
            one["initial"] = self._initial.get((row.owner, row.name), row.value)
            owners.setdefault(row.owner, []).append(one)
        table = [{"name": name, "parameters": rows} for name, rows in owners.items()]
        return encode("parameters", owners=table)

    def past_events(self) -> bytes:
        """Return the message with the last events."""
        return encode("events", events=list(self.events))

    def timeline_message(self) -> bytes:
        """Return the message that says between which ticks one may seek."""
        return encode("timeline", first=self.timeline.first, last=self.timeline.last)

    # The thread.

    def _run(self) -> None:
        self._clock = time.perf_counter()
        self._due = 0.0
        next_frame = next_statistics = next_timeline = self._clock
        counted, counted_at = self.world.tick, self._clock
        while not self._closed:
            changed = self._obey()
            now = time.perf_counter()
            if self.running:
                self._advance(now)
                now = time.perf_counter()
            if changed or (self.running and now >= next_frame and self._shows()):
                self._frame()
                next_frame = max(next_frame + 1 / FRAMES_PER_SECOND, now)
            if now >= next_statistics:
                next_statistics = now + _STATISTICS_EVERY
                self.rate = max(0.0, (self.world.tick - counted) / max(now - counted_at, 1e-6))
                counted, counted_at = self.world.tick, now
                self._tell_statistics()
            if now >= next_timeline:
                next_timeline = now + _TIMELINE_EVERY
                self._publish(self.timeline_message())
            self._rest(next_frame, next_statistics)

    def _rest(self, next_frame: float, next_statistics: float) -> None:
        """Sleep until the next tick or frame is due, or a command comes."""
        if self.running and self.speed is None:
            return
        wake = next_statistics
        if self.running and self.speed is not None:
            wake = min(next_frame, time.perf_counter() + self.world.dt / self.speed / 2)
        if self._wake.wait(max(0.0, wake - time.perf_counter())):
            self._wake.clear()

    def _advance(self, now: float) -> None:
        """Make the ticks that are due, but at most a slice of them."""
        elapsed, self._clock = min(now - self._clock, _MOST_CATCH_UP), now
        dt = self.world.dt
        if self.speed is None:
            self._due = float("inf")
        else:
            self._due = min(
                self._due + elapsed * self.speed / dt, _MOST_CATCH_UP * self.speed / dt + 1
            )
        try:
            while self._due >= 1 and time.perf_counter() - now < _SLICE:
                self.timeline.step()
                self._due -= 1
                if self.stride is not None and self._shows():
                    break
        except Exception as error:
            self._fail(error)
        if self.speed is None:
            self._due = 0.0
        self._tell_events()

    def _shows(self) -> bool:
        """Whether the present tick is one of those to be shown."""
        return self.stride is None or self.world.tick >= self.snapshot.tick + self.stride

    def _fail(self, error: Exception) -> None:
        """Stop at the last complete tick and say why."""
        self.running = False
        text = f"The world stopped at tick {self.world.tick}: {error}"
        if not isinstance(error, BioscopeError):
            place = traceback.extract_tb(error.__traceback__)[-1]
            kind = type(error).__name__
            text = f"The world stopped at tick {self.world.tick}: {kind}: {error}"
            text += f" ({place.filename}:{place.lineno})"
        self._publish(encode("notice", level="error", text=text))
        self._frame()

    def _frame(self) -> None:
        scene = self.world.scene
        encoded = partial(
            self._encoder.encode, scene, running=self.running, speed=self.speed, rate=self.rate
        )
        revision, layout, frame = encoded()
        annotated = frame
        if self.annotations:
            _, _, annotated = encoded(annotations=True)
        old = self.snapshot
        self.snapshot = Snapshot(
            revision=revision,
            layout=layout or old.layout,
            assets=self._assets(old.assets) if layout else old.assets,
            frame=frame,
            annotated=annotated,
            tick=scene.tick,
            number=old.number + 1,
        )
        self._publish(None)

    def _assets(self, known: dict[int, bytes]) -> dict[int, bytes]:
        """Return the messages of everything that the present layout uses, by key."""
        keys = self._encoder.keys()
        return {key: known.get(key) or self._encoder.asset(key) or b"" for key in keys}

    def _tell_events(self) -> None:
        """Send events that were not sent before (a replayed past brings none)."""
        new = [one.as_dict() for one in self.world.drain_events() if one.tick > self._newest_event]
        if new:
            self._newest_event = new[-1]["tick"]
            self.events.extend(new)
            self._publish(encode("events", events=new[-_EVENTS_KEPT:]))

    def _tell_statistics(self) -> None:
        world = self.world
        self._publish(
            encode("statistics", tick=world.tick, time=world.time, values=world.statistics())
        )

    # Commands.

    def _obey(self) -> bool:
        """Carry out the commands that have come; return whether the picture changed."""
        changed = False
        while self._commands:
            command, answer = self._commands.popleft()
            try:
                self._carry_out(command, answer)
            except Exception as error:
                answer(encode("notice", level="error", text=str(error) or type(error).__name__))
            changed = True
        return changed

    def _carry_out(self, command: AnyCommand, answer: Callable[[bytes], None]) -> None:
        match command:
            case messages.Play():
                self._set_running(running=True)
            case messages.Pause():
                self._set_running(running=False)
            case messages.Step(ticks=ticks):
                self._set_running(running=False)
                for _ in range(ticks):
                    self.timeline.step()
                self._tell_events()
            case messages.Back(ticks=ticks):
                self._set_running(running=False)
                self._seek(self.world.tick - ticks)
            case messages.Seek(tick=tick):
                self._seek(tick)
            case messages.Speed(factor=factor):
                self.speed = factor
                self._due = 0.0
            case messages.Set(owner=owner, name=name, value=value):
                self._change(Setting(owner, name, value))
                self._publish(self.parameters())
            case messages.Add(addition=addition):
                check_addition(addition.kind, addition.count)
                self._change(addition)
                self._publish(self.parameters())
                self._publish(self.populations())
            case messages.Display(ticks=ticks):
                self.stride = ticks
                self._publish(self.populations())
            case messages.AskScript():
                name = f"{self.world.title}-{self.world.tick}.json"
                answer(encode("script", name=name, text=self.script().text()))
            case messages.PlayScript(text=text):
                self._play(read_script(text))
            case messages.Restart():
                self._restart(command)
            case messages.Snapshot():
                name = f"{self.world.title}-{self.world.tick}.world"
                answer(encode("snapshot", name=name, bytes=self.world._engine.save()))
            case _:
                self._change(self._order(command))

    def _order(self, command: AnyCommand) -> Order:
        """Return what a command tells which population."""
        match command:
            case messages.Resize(population=population, count=count):
                check_count(self.world, population, count)
                return Order(population, {"number": count})
            case messages.Remove(id=one):
                return Order(self._home(one), {"remove": one})
            case messages.Place(id=one, position=position, scale=scale):
                place = {"id": one, "position": position, "scale": scale}
                return Order(self._home(one), {"place": place})
            case messages.Trait(id=one, name=name, value=value):
                return Order(self._home(one), {"trait": {"id": one, "name": name, "value": value}})
            case messages.Steer(id=one, steering=steering):
                wanted = None if steering is None else msgspec.to_builtins(steering)
                return Order(self._home(one), {"steer": {"id": one, "steering": wanted}})
            case _:
                raise BioscopeError(f"{type(command).__name__} is no order")

    def _home(self, individual: int) -> str:
        """Return the population in which an individual lives."""
        found = self.world.inspect(individual)
        if found is None:
            raise BioscopeError(
                f"{individual} is nobody that can be changed: it is no more, or stays"
            )
        return str(found["population"])

    def _change(self, change: AnyChange) -> None:
        self.timeline.change(change)
        self._newest_event = min(self._newest_event, self.world.tick)

    def script(self) -> Script:
        """Return how this world was made and what was done to it."""
        made = (self.name, self.world.seed, self.world.tick)
        return Script(*made, self.timeline.changes)

    def _set_running(self, *, running: bool) -> None:
        if running and not self.running:
            self._clock, self._due = time.perf_counter(), 0.0
        self.running = running

    def _seek(self, tick: int) -> None:
        self.timeline.seek(tick)
        self._clock, self._due = time.perf_counter(), 0.0
        self._tell_events()

    def _restart(self, command: messages.Restart) -> None:
        seed = self.world.seed if command.seed is None else command.seed
        if self._load:
            self.world = worlds.load(self.name, seed)
        elif seed == self.world.seed:
            self.timeline.seek(self.timeline.first)
        else:
            raise BioscopeError("this world was made by a program: run it again for another seed")
        self._begin()
        for setting in command.set:
            self.timeline.change(Setting(*setting))
        self._run_to(command.tick)
        self._tell_all()

    def _play(self, script: Script) -> None:
        """Make the world of a script, in place of the present one."""
        if not self._load or script.world != self.name:
            made = f"is of the world '{script.world}', this is '{self.name}'"
            raise BioscopeError(f"the script {made}: open it with `bioscope live SCRIPT`")
        if script.tick > 100_000:
            raise BioscopeError(f"the script goes to tick {script.tick}: expected at most 100,000")
        self.world = worlds.load(self.name, script.seed)
        self._begin()
        for step in sorted(script.steps, key=lambda one: one.tick):
            if step.tick > script.tick:
                break
            self._run_to(step.tick)
            self.timeline.change(step.change)
        self._run_to(script.tick)
        self._set_running(running=False)
        self._tell_all()

    def _run_to(self, tick: int) -> None:
        while self.world.tick < tick and not self._closed:
            self.timeline.step()

    def _tell_all(self) -> None:
        """Tell pages everything about a world that is new to them."""
        self._clock, self._due = time.perf_counter(), 0.0
        self._publish(self.hello())
        self._publish(self.parameters())
        self._publish(self.timeline_message())
        self._publish(self.populations())
        self._frame()
