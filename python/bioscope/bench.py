"""Running the benchmarks of a checkout: one JSON line per figure."""

from __future__ import annotations

import importlib.util
import json
import os
import platform
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from bioscope import __version__
from bioscope.errors import BioscopeError, UnknownNameError
from bioscope.files import written_whole

FOLDER = Path(__file__).resolve().parents[2] / "bench"


@dataclass(frozen=True)
class Figure:
    """One measured figure."""

    name: str
    value: float
    unit: str
    target: float | None = None
    """What is aimed at."""
    better: str = "lower"
    """Whether `lower` or `higher` is better."""
    peer: str | None = None
    """What ran beside it in the same run."""
    peer_value: float | None = None
    note: str = ""

    @property
    def ratio(self) -> float | None:
        """How many times better than the peer."""
        if not self.peer_value:
            return None
        ratio = self.value / self.peer_value
        return ratio if self.better == "higher" else 1 / ratio

    @property
    def reached(self) -> bool | None:
        """Whether the target is reached; none without one."""
        if self.target is None:
            return None
        if self.better == "higher":
            return self.value >= self.target
        return self.value <= self.target

    def line(self) -> str:
        """Return the figure as one JSON line."""
        fields = {key: value for key, value in asdict(self).items() if value not in (None, "")}
        if self.ratio is not None:
            fields["ratio"] = self.ratio
        return json.dumps(fields)


Benchmark = Callable[[], Iterator[Figure]]


def best_of(
    rounds: int, work: Callable[[], object], clock: Callable[[], float] = time.perf_counter
) -> float:
    """Return the least seconds that `work` took.

    `clock` is `time.perf_counter`, or `time.process_time` for the time of the processor alone.
    """
    best = float("inf")
    for _ in range(rounds):
        start = clock()
        work()
        best = min(best, clock() - start)
    return best


def benchmarks() -> dict[str, Benchmark]:
    """Return the benchmarks of the checkout by name: `topic.function` of bench/topic.py.

    Raises
    ------
    BioscopeError
        Outside a checkout.
    """
    if not FOLDER.is_dir():
        raise BioscopeError("the benchmarks are part of the source checkout, not of the package")
    sys.path.insert(0, str(FOLDER))
    found: dict[str, Benchmark] = {}
    for path in sorted(FOLDER.glob("*.py")):
        spec = importlib.util.spec_from_file_location(f"bench_{path.stem}", path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found |= getattr(module, "BENCHMARKS", {})
    return found


def run(names: list[str], results: Path | None, say: Callable[..., None]) -> None:
    """Run benchmarks whose names begin with one of `names`, or all; store the lines in `results`.

    Raises
    ------
    UnknownNameError
        For a name that begins no benchmark's.
    """
    known = benchmarks()
    for name in names:
        if not any(one.startswith(name) for one in known):
            raise UnknownNameError(f"unknown benchmark '{name}'; known: {', '.join(known)}")
    lines: list[str] = []
    for name, benchmark in known.items():
        if names and not any(name.startswith(one) for one in names):
            continue
        say(f"… {name}")
        for figure in benchmark():
            lines.append(figure.line())
            print(lines[-1], flush=True)
            say(_told(figure))
    if results is not None:
        head = json.dumps(
            {
                "version": __version__,
                "machine": platform.machine(),
                "cores": len(os.sched_getaffinity(0)),
                "python": platform.python_version(),
            }
        )
        with written_whole(results) as temporary:
            temporary.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


def _told(figure: Figure) -> str:
    """Return a table row for people."""
    told = f"  {figure.name:16} {figure.value:14,.2f} {figure.unit:10}"
    if figure.target is not None:
        sign = "at least" if figure.better == "higher" else "at most"
        told += f" ({sign} {figure.target:g}: {'reached' if figure.reached else 'MISSED'})"
    if figure.peer:
        told += f"  {figure.peer}: {figure.peer_value:,.2f} ({figure.ratio:.2f} times as good)"
    return told
