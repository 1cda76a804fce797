"""Vines circle until they meet a pole, and wind up it; ivy creeps over a tree.

Watch for: free stems that sweep round in circles while they grow; the contact, after which a signal
runs down the stem and its joints freeze; coils that close upon the pole. A day lasts a third of a
second. Behind them shoots of ivy follow the trunk of a tree out along its branches, and stop where
ivy is dense.

Sources: P. Prusinkiewicz, M. Hammel, R. Měch, J. Hanan, "The artificial life of plants", SIGGRAPH
1995 course notes, section 8, figure 26; R. Měch and P. Prusinkiewicz, "Visual models of plants
interacting with their environment", SIGGRAPH 1996, section 8, figure 13.
"""

import math

import bioscope as bio
from bioscope import gallery
from bioscope.lsystem import ModuleString, Segments, Turtle
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

SIZE = 1 / 3
"""Metres per unit of the model."""

POLES = [(-2.6, -0.4), (-0.9, 0.5), (0.9, -0.5), (2.6, 0.3)]
"""Feet of the poles, x and z in metres."""

TREE = (0.75, -3.1)
"""Foot of the tree, x and z in metres."""

TREE_SIZE = 0.5
"""Metres per unit of the tree and its ivy."""

_YEARS, _YEAR = 8, 31
"""Age of the tree, and steps of a year, by the model."""

_BARK = (0.12, 0.09, 0.065)
_COLORS = [_BARK, _BARK, (0.07, 0.17, 0.035), (0.11, 0.25, 0.045)]
"""Of the tree by number: bark, leaves, leaves of this year."""

_DAY = 41
"""Steps of a day, by the model."""


def world(seed: int) -> bio.World:
    """Make the row of poles, each with its vine."""
    land = bio.World(seed=seed, dt=1 / 30, title="climber")
    landscape.rolling(land, extent=50.0, relief=2.5, flat=9.0)
    landscape.daylight(land, elevation=38.0, azimuth=-30.0)
    landscape.meadow(land, radius=13.0, tufts=2200, wind=1.2)
    poles = Habitat(area=POLES)
    land.add(
        bio.Plants("pole", len(POLES), habitat=poles, size=1.0, variants=1, flexibility=0.0),
        "poles",
    )
    for number, (x, z) in enumerate(POLES):
        land.environment.cylinder((x, 0.0, z), (x, 3.3, z), 0.3 * SIZE)
        land.add(vine((x, z), angle=1.2 + 0.5 * number), f"vine-{number + 1}")
    grown = tree(seed)
    land.add(standing(grown, TREE), "tree")
    land.add(ivy(grown, TREE), "ivy")
    cameras = land.cameras
    cameras.orbit("round", target=(0.0, 1.3, 0.0), radius=6.4, height=1.6, period=100)
    cameras.fixed("close", position=(-1.6, 1.5, 3.2), target=(-0.9, 1.35, 0.4), field_of_view=48)
    cameras.fixed("row", position=(-4.6, 1.4, 3.4), target=(0.4, 1.3, -0.1), field_of_view=46)
    x, z = TREE
    cameras.fixed("ivy", position=(x + 1.3, 1.1, z + 1.7), target=(x, 0.95, z), field_of_view=44)
    land.shots = [("round", 10.0), ("close", 6.0), ("ivy", 6.0), ("row", 8.0)]
    return land


def vine(
    pole: tuple[float, float],
    *,
    angle: float,
    rate: float = 3 * _DAY,
    steps: int = 2350,
    start: int = 0,
) -> bio.Plants:
    """Return a vine that grows beside a pole (x and z in metres), at this angle from it."""
    foot = (pole[0] - SIZE * math.cos(angle), pole[1] - SIZE * math.sin(angle))
    way = ((pole[0] - foot[0]) / SIZE, (pole[1] - foot[1]) / SIZE)
    return bio.Plants(
        "twiner",
        1,
        species="vine",
        habitat=Habitat(area=[foot]),
        size=SIZE,
        rate=rate,
        steps=steps,
        start=start,
        environment=bio.environments.Pole(x=way[0], z=way[1], radius=0.3),
        turned=False,
        flexibility=0.0,
        variety=0.1,
    )


def tree(seed: int, years: int = _YEARS) -> ModuleString:
    """Grow the tree that the ivy climbs, with a stout trunk."""
    text = gallery.text("light_tree").replace("#define W 0.02", "#define W 0.045")
    return bio.environments.derive(bio.LSystem(text), years * _YEAR - 1, seed=seed)


def standing(grown: ModuleString, foot: tuple[float, float]) -> bio.Props:
    """Return a grown tree that stands at a place (x and z in metres)."""
    mesh = Turtle().interpret(grown).mesh(sides=10, palette=_COLORS)
    return bio.Props(
        mesh.positions * TREE_SIZE,
        mesh.triangles,
        places=[(foot[0], 0.0, foot[1])],
        species="tree",
        color=(1.0, 1.0, 1.0),
        colors=mesh.colors,
    )


def ivy(
    grown: ModuleString,
    foot: tuple[float, float],
    *,
    shoots: int = 3,
    rate: float = 10.0,
    steps: int = 340,
    start: int = 25,
) -> bio.Plants:
    """Return shoots of ivy that begin round the foot of a grown tree (x and z in metres)."""
    wood: Segments = Turtle().interpret(grown).segments
    off = (float(wood.radii[0, 0]) + 0.012) * TREE_SIZE
    angles = [math.tau * (number + 0.2) / shoots for number in range(shoots)]
    places = [(foot[0] + off * math.cos(a), foot[1] + off * math.sin(a)) for a in angles]
    return bio.Plants(
        "ivy",
        shoots,
        habitat=Habitat(area=places),
        room=0.0,
        size=TREE_SIZE,
        rate=rate,
        steps=steps,
        start=start,
        environment=bio.environments.Limbs(wood, stem=0.012, reach=0.16),
        origin=(foot[0], 0.0, foot[1]),
        turned=False,
        flexibility=0.0,
        flutter=0.03,
        variety=0.15,
    )
