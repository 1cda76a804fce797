"""Sizes and times of the six models that the paper on plants and their environment measured.

R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, table 1. scripts/model_sizes.py writes the table beside
the published one from what this measures.
"""

import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bioscope as bio
from bioscope import gallery
from bioscope.bench import Figure
from bioscope.lsystem.specimen import palette_beside, portrait

APART = 4.8
"""Between the middles of the two tiers, in lengths of a first branch; not published."""

PIXELS = 960


@dataclass(frozen=True)
class Model:
    """A model of the table, and what is published of it."""

    title: str
    figure: int
    """Number of its figure in the paper."""
    gallery: str
    """Name in the gallery."""
    steps: int
    organ: str
    """What is counted beside segments."""
    organs_in: str
    """What finds them in the string; every end of a segment and middle of a tier if empty."""
    segments: int
    organs: int
    simulation: str
    rendering: str
    changed: Callable[[str], str] = str
    """Makes the model of the table out of the text of the gallery."""


def two_tiers(text: str) -> str:
    """Return two tiers beside each other in place of one."""
    axiom = re.search(r"axiom:((?:.*\n)+?)p1:", text)[1]
    tiers = "".join(f"[-(90)f({place})+(90){axiom.strip()}]" for place in (-APART / 2, APART / 2))
    return text.replace(f"axiom:{axiom}", f"axiom: {tiers}\n")


def two_conifers(text: str) -> str:
    """Return a pair of conifers 4 apart that keep branches without light."""
    text = text.replace("#define ROWS 1 ", "#define ROWS 2 ").replace("SHED 1 ", "SHED 0 ")
    return text.replace("SPACING 6 ", "SPACING 4 ").replace("i < many*many", "i < 2")


LEAVES, TIPS = "leaf clusters", "active apices"
LIVING = r"L\([^,]+,[^,]+,[0-4],"
"""Clusters of leaves younger than five years."""
MODELS = {
    "tiers": Model(
        "two branch tiers", 5, "branch_tiers", 5, LEAVES, "", 138, 140, "1 s", "1 s", two_tiers
    ),
    "clone": Model(
        "clonal plant", 7, "clonal_plant", 182, LEAVES, "@o", 786, 229, "50 s", "2 s"
    ),
    "roots": Model("roots in a plane", 9, "roots", 186, TIPS, r"A\(", 4194, 34, "67 s", "3 s"),
    "roots_3d": Model(
        "two root systems", 10, "roots_3d", 301, TIPS, r"A\(", 37228, 448, "15 min", "70 s"
    ),
    "tree": Model(
        "deciduous tree", 12, "light_tree", 744, LEAVES, LIVING, 22462, 19195, "22 min", "13 s"
    ),
    "conifers": Model(
        "pair of conifers", 15, "conifer", 194, LEAVES, LIVING, 13502, 3448, "4 min", "8 s",
        two_conifers,
    ),
}  # fmt: skip


def measured(name: str) -> Iterator[Figure]:
    """Grow a model once, look at it once; its sizes and times."""
    model = MODELS[name]
    system = bio.LSystem(model.changed(gallery.text(model.gallery)), f"{model.gallery}.lsys")
    start = time.process_time()
    string = bio.environments.derive(system, model.steps, threads=False)
    simulation = time.process_time() - start
    start = time.process_time()
    drawn = bio.Turtle().interpret(string)
    palette = palette_beside(gallery.path(model.gallery))
    portrait(drawn.mesh(palette=palette), PIXELS, PIXELS)
    picture = time.process_time() - start
    text = string.string()
    segments = len(re.findall(r"(?<![~@])F", text))
    organs = len(re.findall(model.organs_in, text)) if model.organs_in else segments + 2
    figures = {
        "segments": (segments, "1", f"published: {model.segments:,}"),
        "organs": (organs, "1", f"{model.organ}; published: {model.organs:,}"),
        "simulation": (simulation, "s", f"{model.steps} steps, one thread, processor time"),
        "picture": (picture, "s", f"turtle, mesh and {PIXELS}x{PIXELS} pixels, processor time"),
    }
    for part, (value, unit, note) in figures.items():
        yield Figure(f"models.{name}.{part}", value, unit, note=note)


def benchmark(name: str) -> Callable[[], Iterator[Figure]]:
    """Return the benchmark of a model."""
    return lambda: measured(name)


BENCHMARKS = {f"models.{name}": benchmark(name) for name in MODELS}
