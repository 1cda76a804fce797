"""Figures of fishes that decide for themselves: senses, minds and bodies, per fish and tick."""

import time
from collections.abc import Iterator

import bioscope as bio
from bioscope.bench import Figure

DENSITY = 2.0
"""Fishes per cubic metre."""


def microseconds(count: int, kind: str) -> float:
    """Return the time per fish and tick of a population of schooling fishes (best of several)."""
    radius = (count / DENSITY / 4.19) ** (1 / 3)
    world = bio.World(seed=1, dt=1 / 30)
    world.environment.water(surface=radius + 1)
    mind = bio.minds.asked(kind).__class__(
        "generic", enemies=["shark"], food=["plankton"], habits=["school"], home_range=radius
    )
    world.add(bio.RoamingFish("anthias", count, center=(0, 0, 0), radius=radius, mind=mind))
    world.step(10)
    best = float("inf")
    ticks = max(3, 3000 // count)
    for _ in range(5):
        start = time.perf_counter()
        world.step(ticks)
        best = min(best, time.perf_counter() - start)
    return 1e6 * best / ticks / count


def minds() -> Iterator[Figure]:
    """Each mind at 1,000 fishes, and how much dearer a fish is than among 100."""
    for kind in ("intentions", "behavior_network", "free_flow"):
        few, many = microseconds(100, kind), microseconds(1000, kind)
        note = f"with senses and swimmer, on all cores; {many / few:.2f} times that at 100"
        yield Figure(f"fish.{kind}", many, "us", target=33.0, note=note)


BENCHMARKS = {"minds": minds}
