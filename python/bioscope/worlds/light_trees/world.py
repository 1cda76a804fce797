"""Trees grow up together on a meadow and compete for light.

Watch for: saplings that are all alike at first; crowns that stop where they meet and go on to the
open side; branches that are shed where it is dark; seeds that sail away with the wind and germinate
in the gaps. A year lasts four seconds.

Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their environment",
SIGGRAPH 1996, section 4.4, after A. Takenaka (1994).
"""

import bioscope as bio
from bioscope.populations.place import Disk, Habitat
from bioscope.worlds import landscape

_YEAR = 31
"""Steps of a year, by the model."""


def world(seed: int) -> bio.World:
    """Make the meadow with its saplings."""
    land = bio.World(seed=seed, dt=1 / 30, title="light_trees")
    landscape.rolling(land, extent=70.0, relief=3.0, flat=14.0)
    landscape.daylight(land)
    landscape.meadow(land, radius=20.0, tufts=3000)
    land.add(trees(count=18, radius=10.0, start=4))
    _place_cameras(land)
    return land


def trees(count: int, radius: float, *, start: int = 2, rate: float = _YEAR / 4) -> bio.Plants:
    """Return a stand of trees that compete for light, `start` years old."""
    return bio.Plants(
        "sun_tree",
        count,
        species="tree",
        habitat=Habitat(area=Disk((0.0, 0.0), radius), slope=(0.0, 40.0)),
        room=2.6,
        rate=rate,
        start=start * _YEAR,
        season=_YEAR,
        most=4 * count,
        seeds="S",
        litter="D",
        variety=0.16,
        dispersal=4.0,
        flexibility=0.06,
        period=1.1,
        flutter=0.05,
    )


def _place_cameras(land: bio.World) -> None:
    cameras = land.cameras
    cameras.fixed("meadow", position=(4.0, 1.9, 21.0), target=(0.0, 4.0, 0.0), field_of_view=46)
    cameras.orbit("round", target=(0.0, 3.6, 0.0), radius=19.0, height=2.6, period=90)
    cameras.fixed("under", position=(2.5, 1.5, 12.0), target=(0.0, 4.6, -2.0), field_of_view=58)
    cameras.fixed("above", position=(14.0, 24.0, 16.0), target=(0.0, 3.0, 0.0), field_of_view=44)
    land.shots = [("round", 12.0), ("under", 6.0), ("above", 6.0), ("meadow", 6.0)]
