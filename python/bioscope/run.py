"""Running a world without watching: events to a file, the world saved at the end."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Protocol

import msgspec

from bioscope.errors import InvalidValueError, MissingExtraError
from bioscope.files import written_whole
from bioscope.world.events import Event, table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from bioscope.world import World

_TICKS_AT_ONCE = 60


class Sink(Protocol):
    """Where events go."""

    def write(self, events: list[Event]) -> None:
        """Append events."""

    def close(self) -> None:
        """Finish the file."""


def run_world(
    world: World,
    seconds: float,
    events: Path | None = None,
    save: Path | None = None,
    say: Callable[..., None] = print,
) -> None:
    """Run a world, streaming its events to a file; memory stays bounded.

    Parameters
    ----------
    world, seconds
        What to run, and for how much world time.
    events
        A .jsonl file (one JSON object per line) or .parquet file (zstd); whole or not there. If the
        run is interrupted, the events so far are kept.
    save
        Where to save the world at the end.
    say
        Called with messages.
    """
    last = world.tick + round(seconds / world.dt)
    with contextlib.ExitStack() as stack:
        sink = stack.enter_context(event_file(events)) if events else None
        try:
            while world.tick < last:
                world.step(min(_TICKS_AT_ONCE, last - world.tick))
                _hand_over(world, sink)
        except KeyboardInterrupt:
            _hand_over(world, sink)
            stack.close()
            if save:
                world.save(save)
            say(f"stopped at {world.time:.2f} s")
            raise
    if save:
        world.save(save)
    say(f"ran to {world.time:.2f} s, tick {world.tick}")


def _hand_over(world: World, sink: Sink | None) -> None:
    drained = world.drain_events()
    if sink:
        sink.write(drained)


@contextlib.contextmanager
def event_file(path: Path) -> Iterator[Sink]:
    """Open an event file by its suffix; it gets its name when the block ends well.

    Raises
    ------
    InvalidValueError
        For another suffix.
    """
    kinds: dict[str, Callable[[Path], Sink]] = {".jsonl": _JsonLines, ".parquet": _Parquet}
    if path.suffix not in kinds:
        raise InvalidValueError(f"{path}: expected a name that ends in .jsonl or .parquet")
    with written_whole(path) as temporary:
        sink = kinds[path.suffix](temporary)
        try:
            yield sink
        finally:
            sink.close()


class _JsonLines:
    def __init__(self, path: Path) -> None:
        self._file = path.open("wb")

    def write(self, events: list[Event]) -> None:
        for event in events:
            self._file.write(msgspec.json.encode(event) + b"\n")

    def close(self) -> None:
        self._file.close()


class _Parquet:
    def __init__(self, path: Path) -> None:
        try:
            import pyarrow.parquet
        except ImportError:
            raise MissingExtraError("A Parquet file of events", "data") from None
        schema = table([]).schema
        self._writer = pyarrow.parquet.ParquetWriter(path, schema, compression="zstd")

    def write(self, events: list[Event]) -> None:
        if events:
            self._writer.write_table(table(events))

    def close(self) -> None:
        self._writer.close()
