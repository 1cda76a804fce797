"""Figures of the turtle and of environments: strokes to a mesh, a tree in light, roots in soil."""

import time
from collections.abc import Iterator
from pathlib import Path

import bioscope as bio
from bioscope.bench import Figure

CURVE = "Lsystem: curve\naxiom: F\nF --> FF-[-F+F+F]+[+F-F-F]\nendlsystem\n"
GALLERY = Path(bio.__file__).parent / "gallery"


def turtle() -> Iterator[Figure]:
    """2,097,152 strokes to one mesh (best of three)."""
    string = bio.LSystem(CURVE).derive(steps=7)
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        drawn = bio.Turtle(angle=22.5).interpret(string)
        mesh = drawn.mesh()
        best = min(best, time.perf_counter() - start)
    note = f"{len(mesh.positions):,} vertices, {len(mesh.triangles):,} triangles"
    yield Figure("turtle", best, "s", target=1.5, note=note)


def light_tree() -> Iterator[Figure]:
    """24 years of a tree that grows as its leaves find light."""
    yield grown("light_tree", "light_tree", 744, 2.0, "published: 22 minutes")


def roots() -> Iterator[Figure]:
    """Two root systems that drink the water of one deep field."""
    yield grown("roots3d", "roots_3d", 301, 5.0, "published: 37,228 in 15 minutes")


def grown(name: str, model: str, steps: int, target: float, published: str) -> Figure:
    """Return how long a model of the gallery takes to grow in its environment, on one core."""
    system = bio.LSystem.read(GALLERY / f"{model}.lsys")
    start = time.perf_counter()
    string = bio.environments.derive(system, steps, threads=False)
    seconds = time.perf_counter() - start
    strokes = len(bio.Turtle().interpret(string).segments.end)
    note = f"{strokes:,} segments; {published}"
    return Figure(name, seconds, "s", target=target, note=note)


BENCHMARKS = {"turtle": turtle, "light_tree": light_tree, "roots3d": roots}
