"""Figures of fishes that decide for themselves: senses, minds and bodies, per fish and tick."""

import resource
import time
from collections.abc import Iterator

import bioscope as bio
from bioscope.bench import Figure, best_of
from bioscope.populations.place import Habitat, Rectangle

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
    ticks = max(3, 3000 // count)
    return 1e6 * best_of(5, lambda: world.step(ticks)) / ticks / count


def minds() -> Iterator[Figure]:
    """Each mind at 1,000 fishes, and how much dearer a fish is than among 100."""
    for kind in ("intentions", "behavior_network", "free_flow"):
        few, many = microseconds(100, kind), microseconds(1000, kind)
        note = f"with senses and swimmer, on all cores; {many / few:.2f} times that at 100"
        yield Figure(f"fish.{kind}", many, "us", target=33.0, note=note)


TICK = 1 / 30
"""Seconds per tick of complete fishes."""
KINDS = {"anthias": 0.5, "chromis": 0.3, "fusilier": 0.15, "butterflyfish": 0.05}
"""Share of each species among complete fishes."""


REACTION = 2 * TICK
"""Seconds from one decision of a complete fish to the next: less than fishes take to answer."""


def reef(count: int, radius: float, reaction: float = REACTION) -> bio.World:
    """Return the reef's ground, rocks, corals, plants and plankton with this many complete fishes.

    Each has muscles that pull springs in water, all senses and a mind with drives; they begin in a
    ball of this radius.
    """
    world = bio.World(seed=7, dt=TICK)
    swell = bio.Current(direction=(1.0, 0.0, 0.35), speed=0.08, surge=0.16, turbulence=0.05)
    world.environment.water(surface=0.0, current=swell)
    world.add(bio.Ground(relief={}))
    world.add(bio.Rocks(46, habitat=Habitat(area=Rectangle((-9.0, -8.0), (9.0, 5.0)))))
    garden = Habitat(area=Rectangle((-8.0, -7.0), (8.0, 3.0)), patchiness=0.75, patch=2.5)
    world.add(bio.Corals({"Brain": 12, "Table": 9, "Bush": 22, "Fan": 12}, habitat=garden))
    world.add(bio.Plants("seagrass", 60, habitat=garden))
    world.add(bio.Plants("kelp", 16, habitat=garden))
    world.add(bio.Plankton(1800, low=(-9.0, -9.0, -8.0), high=(9.0, -0.2, 10.0)))
    for species, share in KINDS.items():
        mind = bio.minds.Intentions(
            "generic", enemies=["shark"], food=["plankton"], habits=["school"], home_range=radius
        )
        world.add(
            bio.RoamingFish(
                species,
                round(share * count),
                center=(0.0, -4.0, 0.0),
                radius=radius,
                mind=mind,
                body="muscle_swimmer",
                reaction=reaction,
            )
        )
    return world


def seconds_per_tick(count: int, radius: float, reaction: float = REACTION) -> float:
    """Return the time of a tick (best of several) after the fishes have taken their places."""
    world = reef(count, radius, reaction)
    world.step(60)
    return best_of(5, lambda: world.step(10)) / 10


def full() -> Iterator[Figure]:
    """Complete fishes in the reef: muscles, senses, minds, at 30 ticks per second."""
    empty = seconds_per_tick(0, 1.0)
    few = (seconds_per_tick(100, 2.0) - empty) / 100
    whole = seconds_per_tick(1000, 2.0 * 10 ** (1 / 3))
    many = (whole - empty) / 1000
    note = (
        f"1,000, with senses and minds that decide at 15/s, at 30 ticks/s; {1e6 * many:.1f} us "
        "each; reef included"
    )
    yield Figure("fish.full", TICK / whole, "x real time", target=1, better="higher", note=note)
    eager = seconds_per_tick(1000, 2.0 * 10 ** (1 / 3), 0.0)
    note = "the same, but all decide in every tick"
    yield Figure("fish.full_eager", TICK / eager, "x real time", better="higher", note=note)
    note = "cost per fish among 1,000 over that among 100 at equal density"
    yield Figure("fish.full_growth", many / few, "1", target=1.3, note=note)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    yield Figure("fish.full_memory", memory, "MB", target=1000, note="of the whole process")


def published_scene() -> bio.World:
    """Return the scene that was measured in 1996: 10 fishes, 15 morsels and 4 cylinders."""
    world = bio.World(seed=1, dt=TICK)
    world.environment.water(surface=0.0)
    for x, z in [(-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8)]:
        world.environment.cylinder((x, -5.0, z), (x, -0.5, z), 0.15)
    mind = bio.minds.Intentions("pacifist", food=["plankton"], home_range=1.5, appetite=50.0)
    world.add(bio.RoamingFish("clownfish", 10, center=(0, -2, 0), radius=0.6, mind=mind))
    world.add(bio.Plankton(15, low=(-1.0, -2.5, -1.0), high=(1.0, -1.5, 1.0)))
    return world


def scene() -> Iterator[Figure]:
    """The benchmark scene of X. Tu 1996, section 8.3, which ran at about 4 frames per second."""
    world = published_scene()
    world.step(60)
    best = best_of(20, lambda: world.step(100), time.process_time) / 100
    note = "10 fishes with muscles, senses and minds, 15 morsels, 4 cylinders; of one core's time"
    yield Figure("fish.scene", 1 / best, "ticks/s", target=4000, better="higher", note=note)


BENCHMARKS = {"minds": minds, "fish.full": full, "fish.scene": scene}
