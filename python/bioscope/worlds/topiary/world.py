"""A garden of bushes that are clipped to shapes while they grow.

Watch for: bushes that fill their shapes from within; the shoots that are cut as soon as they leave
them, and the dormant buds below that wake up in their place, until no gap is left.

Source: P. Prusinkiewicz, M. James, R. Měch, "Synthetic topiary", SIGGRAPH 1994.
"""

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

SHAPES = {
    "ball": "x*x+(y-6)*(y-6)+z*z > 36",
    "box": "(abs(x) > 5) || (abs(z) > 5) || (y > 11)",
    "cone": "(y > 15) || (x*x+z*z > (6.2*(1-y/15))*(6.2*(1-y/15)))",
    "double": "(x*x+(y-5)*(y-5)+z*z > 25) && (x*x+(y-12.5)*(y-12.5)+z*z > 12.5)",
    "column": "(x*x+z*z > 12) || (y > 14)",
    "hourglass": "(y > 13) || (x*x+z*z > (2.2+0.62*abs(y-6.5))*(2.2+0.62*abs(y-6.5)))",
    "mushroom": "(y < 7 && x*x+z*z > 5) || (y >= 7 && x*x+z*z+2.2*(y-7)*(y-7) > 40)",
}
"""What is cut off, in units of the model (decimetres) from the foot of the plant."""

_PLACES = {
    "box": (-4.6, -0.6),
    "ball": (-2.8, 1.2),
    "cone": (-1.4, -1.6),
    "hourglass": (0.6, 0.9),
    "double": (2.3, -1.3),
    "mushroom": (3.4, 1.5),
    "column": (4.8, -0.4),
}


def world(seed: int) -> bio.World:
    """Make the garden."""
    land = bio.World(seed=seed, dt=1 / 30, title="topiary")
    landscape.rolling(land, extent=50.0, relief=2.0, flat=10.0)
    landscape.daylight(land, elevation=40.0, azimuth=-46.0)
    landscape.lawn(land)
    for name, place in _PLACES.items():
        land.add(bush(name, place), name)
    cameras = land.cameras
    cameras.orbit("round", target=(0.0, 0.7, 0.0), radius=8.2, height=1.7, period=90)
    cameras.fixed("row", position=(-6.2, 1.2, 4.2), target=(0.6, 0.6, -0.2), field_of_view=48)
    cameras.fixed("middle", position=(0.4, 0.95, 4.6), target=(0.3, 0.75, 0.0), field_of_view=52)
    land.shots = [("round", 8.0), ("middle", 5.0), ("row", 6.0)]
    return land


def bush(shape: str, place: tuple[float, float], *, rate: float = 2.0) -> bio.Plants:
    """Return a bush that is clipped to one of the `SHAPES`, at x and z in metres."""
    text = bio.gallery.path("topiary").read_text(encoding="utf-8")
    clipped = [line for line in text.splitlines() if not line.startswith("#define prune")]
    at = next(number for number, line in enumerate(clipped) if line.startswith("ignore:"))
    clipped.insert(at, f"#define prune(x,y,z) (({SHAPES[shape]}) || (y < 0))")
    return bio.Plants(
        "\n".join(clipped) + "\n",
        1,
        species=f"{shape}_bush",
        habitat=Habitat(area=[place]),
        size=0.1,
        rate=rate,
        steps=34,
        unfold=True,
        colors=bio.gallery.path("topiary").with_suffix(".colors"),
        variety=0.1,
        flexibility=0.02,
        flutter=0.02,
    )
