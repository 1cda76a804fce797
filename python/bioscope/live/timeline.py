"""Going back in time: checkpoints of the world and the changes made to it, replayed to any tick."""

from __future__ import annotations

import bisect
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from bioscope.world import World


class Change(NamedTuple):
    """A parameter set from outside after a tick."""

    tick: int
    owner: str
    name: str
    value: float


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
        self._changes: list[Change] = []
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
        self._apply_changes(tick)
        self.last = max(self.last, tick)
        if tick % self._interval == 0 and tick > self._ticks[-1]:
            self._keep()

    def change(self, owner: str, name: str, value: float) -> None:
        """Set a parameter now; what was the future before is forgotten."""
        self._world.set(owner, name, value)
        now = self._world.tick
        self._changes = [one for one in self._changes if one.tick <= now]
        self._changes.append(Change(now, owner, name, value))
        kept = bisect.bisect_left(self._ticks, now, lo=1)
        del self._ticks[kept:], self._states[kept:]
        self.last = now

    def seek(self, tick: int) -> None:
        """Go to a tick between `first` and `last`, by the nearest checkpoint and a replay."""
        tick = min(max(tick, self.first), self.last)
        now = self._world.tick
        index = bisect.bisect_right(self._ticks, tick) - 1
        if tick < now or self._ticks[index] > now:
            self._world._engine.return_to(self._states[index])
            self._apply_changes(self._ticks[index])
        while self._world.tick < tick:
            self.step()

    @property
    def changes(self) -> list[Change]:
        """All changes up to now."""
        return [one for one in self._changes if one.tick <= self._world.tick]

    def _apply_changes(self, tick: int) -> None:
        for one in self._changes:
            if one.tick == tick:
                self._world.set(one.owner, one.name, one.value)

    def _keep(self) -> None:
        self._ticks.append(self._world.tick)
        self._states.append(self._world._engine.save())
        while len(self._ticks) > 3 and sum(map(len, self._states)) > self._most_bytes:
            del self._ticks[1::2], self._states[1::2]
            self._interval *= 2
