"""Figures of L-systems: modules per second of three models on one core, and memory."""

import resource
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

from bioscope import LSystem
from bioscope.bench import Figure

MODELS = Path(__file__).parent / "lsystem"
PEER = Path(__file__).parent / "symbios" / "Cargo.toml"
PEER_SECONDS = 900.0
"""How long building the peer and deriving a model with it may take."""
# Measured with cpfg on one core of such a machine; it cannot be installed from a registry.
REFERENCE = {"a": 147e6, "b": 22e6, "c": 12.7e6}


def seconds(system: LSystem, steps: int, threads: bool = False) -> float:
    """Return the time of a derivation, the best of three."""
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        system.derive(steps, threads=threads)
        best = min(best, time.perf_counter() - start)
    return best


def modules(system: LSystem, first: int) -> int:
    """Return the modules of all strings after step `first`."""
    return sum(len(system.derive(step)) for step in range(first + 1, system.steps + 1))


def lsystems() -> Iterator[Figure]:
    """A bush without parameters, a parametric tree, signals in a filament."""
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    bush = LSystem.read(MODELS / "a.l")
    speed = len(bush.derive()) / seconds(bush, bush.steps)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3 - memory
    yield figure("a", speed, "modules/s", 300e6, f"{peak:.0f} MB more than before")
    tree = LSystem.read(MODELS / "b.l")
    made = modules(tree, 0)
    alone, both = seconds(tree, tree.steps), seconds(tree, tree.steps, threads=True)
    note = f"{alone / both:.2f} times that with all cores"
    yield figure("b", made / alone, "module-steps/s", 45e6, note)
    signals = LSystem.read(MODELS / "c.l")
    grown = seconds(signals, 16)
    alone = seconds(signals, 216) - grown
    both = seconds(signals, 216, threads=True) - grown
    note = f"{alone / both:.2f} times that with all cores"
    yield figure("c", 200 * 262_656 / alone, "module-steps/s", 25e6, note)


def figure(name: str, speed: float, unit: str, target: float, note: str) -> Figure:
    """Return one figure beside that of cpfg, and of the crate symbios in the same run."""
    note = f"{speed / REFERENCE[name]:.1f} times the {REFERENCE[name] / 1e6:g} M of cpfg; {note}"
    peer = symbios(name)
    return Figure(
        f"lsystem.{name}",
        speed,
        unit,
        target=target,
        better="higher",
        peer="symbios" if peer is not None else None,
        peer_value=peer,
        note=note,
    )


def symbios(name: str) -> float | None:
    """Return the speed of the crate symbios with the same model; None if it cannot be built."""
    command = ["cargo", "run", "--release", "--quiet", "--manifest-path", str(PEER), "--", name]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, check=True, timeout=PEER_SECONDS
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return float(done.stdout)


BENCHMARKS = {"lsystem": lsystems}
