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
    system = bio.LSystem.read(GALLERY / "light_tree.lsys")
    start = time.perf_counter()
    string = bio.environments.derive(system, 744, threads=False)
    seconds = time.perf_counter() - start
    strokes = len(bio.Turtle().interpret(string).segments.end)
    note = f"{strokes:,} segments; published: 22 minutes"
    yield Figure("light_tree", seconds, "s", target=2.0, note=note)


def roots() -> Iterator[Figure]:
    """Two root systems that drink the water of one deep field, 301 steps."""
    system = bio.LSystem.read(GALLERY / "roots_3d.lsys")
    start = time.perf_counter()
    string = bio.environments.derive(system, 301, threads=False)
    seconds = time.perf_counter() - start
    strokes = len(bio.Turtle().interpret(string).segments.end)
    note = f"{strokes:,} segments; published: 37,228 in 15 minutes"
    yield Figure("roots3d", seconds, "s", target=5.0, note=note)


BENCHMARKS = {"turtle": turtle, "light_tree": light_tree, "roots3d": roots}
