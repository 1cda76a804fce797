"""Going back in time: checkpoints of the world and the changes made to it, replayed to any tick."""

from __future__ import annotations

import bisect
from typing import TYPE_CHECKING

from bioscope.errors import BioscopeError, FormatError
from bioscope.world.changes import Step, brief, perform

if TYPE_CHECKING:
    from bioscope.world import World
    from bioscope.world.changes import AnyChange

_MOST_CHANGES = 100_000


class Timeline:
    """The past of one world, in bounded memory.

    Keeps a checkpoint every `interval` ticks; when they outgrow `most_bytes`, every other one is
    dropped (but the first) and the interval doubles, so any tick stays within reach of a replay.
    """

    def __init__(self, world: World, interval: int = 60, most_bytes: int = 96 << 20) -> None:
        self._world = world
        self._interval = interval
        self._most_bytes = most_bytes
        self._ticks: list[int] = []
        self._states: list[bytes] = []
        self._changes: list[Step] = []
        self.last = world.tick
        """Greatest tick reached since the last change of the past."""
        self._keep()

    @property
    def first(self) -> int:
        """Least tick that one can go back to."""
        return self._ticks[0]

    def step(self) -> None:
        """Make one tick, with the changes that were once made after it."""
        self._world.step()
        tick = self._world.tick
        # A checkpoint is of the state before the changes of its tick.
        if tick % self._interval == 0 and tick > self._ticks[-1]:
            self._keep()
        self._apply_changes(tick)
        self.last = max(self.last, tick)

    def change(self, change: AnyChange) -> None:
        """Make a change now; what was the future before is forgotten.

        One that is refused changes nothing, and the future stays.
        """
        if len(self._changes) >= _MOST_CHANGES:
            raise BioscopeError(f"{_MOST_CHANGES} changes are remembered: restart the world")
        perform(self._world, change)
        now = self._world.tick
        self._changes = [one for one in self._changes if one.tick <= now]
        self._changes.append(Step(now, change))
        kept = bisect.bisect_right(self._ticks, now)
        del self._ticks[kept:], self._states[kept:]
        self.last = now

    def seek(self, tick: int) -> None:
        """Go to a tick between `first` and `last`, by the nearest checkpoint and a replay."""
        tick = min(max(tick, self.first), self.last)
        now = self._world.tick
        index = bisect.bisect_right(self._ticks, tick) - 1
        if tick < now or self._ticks[index] > now:
            self._return_to(index)
        while self._world.tick < tick:
            self.step()

    @property
    def changes(self) -> list[Step]:
        """All changes up to now that matter."""
        return brief([one for one in self._changes if one.tick <= self._world.tick])

    def _return_to(self, index: int) -> None:
        """Go to a checkpoint; to an earlier one if it has populations that are not here yet."""
        while True:
            try:
                self._world._engine.return_to(self._states[index])
                break
            except FormatError:
                if index == 0:
                    raise
                index -= 1
        self._apply_changes(self._ticks[index])

    def _apply_changes(self, tick: int) -> None:
        for one in self._changes:
            if one.tick == tick:
                perform(self._world, one.change)

    def _keep(self) -> None:
        self._ticks.append(self._world.tick)
        self._states.append(self._world._engine.save())
        while len(self._ticks) > 3 and sum(map(len, self._states)) > self._most_bytes:
            del self._ticks[1::2], self._states[1::2]
            self._interval *= 2
