"""Figures of flocks: updates per second at constant density."""

import time
from collections.abc import Iterator

from bioscope.bench import Figure
from bioscope.crowds import Flock

RADIUS = 10.0
NEIGHBORS = 12.5


def updates_per_second(count: int) -> float:
    """Return agent updates per second of a flock with about 12 neighbors each (best of several)."""
    volume = 4.19 * RADIUS**3
    side = (count * volume / NEIGHBORS) ** (1 / 3) / 2
    best = 0.0
    ticks = max(2, 100_000 // count)
    for seed in range(6):
        flock = Flock(count, half=(side,) * 3, seed=seed, boxed=True, radius=RADIUS)
        flock.step(1 / 60, 1)
        start = time.perf_counter()
        flock.step(1 / 60, ticks)
        best = max(best, count * ticks / (time.perf_counter() - start))
    return best


def flocks() -> Iterator[Figure]:
    """10,000 and 100,000 agents, and how much dearer each is than among 1,000."""
    few = updates_per_second(1_000)
    for name, count in (("flock.10k", 10_000), ("flock.100k", 100_000)):
        many = updates_per_second(count)
        note = f"cost per agent {few / many:.2f} times that at 1,000 (at most 1.5)"
        yield Figure(name, many, "updates/s", target=5e6, better="higher", note=note)


BENCHMARKS = {"flock": flocks}
