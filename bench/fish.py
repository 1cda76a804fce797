"""Figures of the muscle-driven fish: a step, replayed fishes, the same springs in MuJoCo."""

import importlib.util
from collections.abc import Iterator

import bioscope as bio
from bioscope.bench import Figure, best_of

COUNT = 256
GROUP = 8
"""Bodies that one core computes side by side."""
TICK = 1 / 60


def seconds_per_tick(shoal: bio.fish.Shoal, dt: float, ticks: int) -> float:
    """Return the best time of a tick in several runs."""
    shoal.step(dt, 2)
    return best_of(5, lambda: shoal.step(dt, ticks)) / ticks


def steps() -> Iterator[Figure]:
    """One body step with controllers: forces, assembly, solve, frames."""
    shoal = bio.fish.Shoal("anthias", GROUP)
    each = seconds_per_tick(shoal, shoal.natural_step, 400) / GROUP
    note = "f32, eight side by side on one core"
    yield Figure("fish.step", each * 1e6, "us", target=15, note=note)
    tank = bio.fish.Tank("anthias")
    tank.swim(tank.cruise)
    tank.step(steps=100)
    alone = best_of(1, lambda: tank.step(steps=5000)) / 5000
    yield Figure("fish.alone", alone * 1e6, "us", note="one body in f64, one core")


def replays() -> Iterator[Figure]:
    """Ten thousand replayed fishes at 60 ticks per second, and how much cheaper a tick is."""
    driven = seconds_per_tick(bio.fish.Shoal("anthias", COUNT), TICK, 10) / COUNT
    tick = seconds_per_tick(bio.fish.Shoal("anthias", 10_000, replayed=True), TICK, 20)
    yield Figure("fish.replayed", 1 / tick, "ticks/s", target=60, better="higher", note="10,000")
    ratio = driven / (tick / 10_000)
    yield Figure("fish.ratio", ratio, "1", target=20, better="higher", note="simulated / replayed")


def mixed() -> Iterator[Figure]:
    """A school of ten thousand that replays, with muscles for the hundred near an observer."""
    world = bio.World(seed=1, dt=TICK)
    world.environment.water(surface=30.0)
    world.add(bio.FishSchool("anthias", 10_000, center=(0, 0, 0), replayed=1.0, driven=100))
    world.step(20)
    best = best_of(5, lambda: world.step(10)) / 10
    note = "9,900 replayed and 100 by muscles, with Reynolds' rules, at 60 ticks/s"
    yield Figure("fish.mixed", 1 / best, "ticks/s", better="higher", note=note)


def springs() -> Iterator[Figure]:
    """The springs of the fish without water, let go from a stretched shape: ours and MuJoCo's."""
    if importlib.util.find_spec("mujoco") is None:
        print("fish.rollout: skipped, mujoco is not installed (pip install --group bench)")
        return
    from peers.mujoco_fish import Rollout

    rollout = Rollout()
    ours, ours_rate = rollout.ours()
    theirs, theirs_rate = rollout.mujoco()
    yield Figure(
        "fish.rollout",
        ours,
        "L",
        peer="mujoco",
        peer_value=theirs,
        note="node error after 0.2 s at the published step",
    )
    yield Figure(
        "fish.rate", ours_rate, "steps/s", better="higher", peer="mujoco", peer_value=theirs_rate
    )


BENCHMARKS = {
    "fish.step": steps,
    "fish.replayed": replays,
    "fish.mixed": mixed,
    "fish.rollout": springs,
}
