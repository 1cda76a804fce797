"""Fish: schools, and single ones with minds of their own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bioscope import _engine, minds
from bioscope.populations.native import Asked, asked_text
from bioscope.world.population import Native

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.minds import Mind

Vector = tuple[float, float, float]


def _species(species: str) -> object:
    """Return the engine's form of a species: its name, or the name and text of its file."""
    if species.endswith(".toml"):
        return (species, Path(species).read_text(encoding="utf-8"))
    return species


class FishSchool(Asked):
    """A school of fish by Reynolds' rules: separation, alignment, cohesion, obstacles first.

    C. W. Reynolds, "Flocks, herds, and schools: a distributed behavioral model", SIGGRAPH 1987. The
    fishes flee from large animals that they see, keep off seabed, rocks and surface, and are
    carried by the current; their bodies undulate with the thrust that their motion needs.

    Parameters
    ----------
    species
        A species by name (`anchovy`, `fusilier`, `anthias`, …), or the path of a species file
        (.toml).
    count
        How many, up to 200,000.
    center
        Where they begin, metres; also the middle of their home unless `home` is given.
    half
        Half axes of the ellipsoid in which they begin, metres; by size and number if not given.
    home
        Middle of their home range, metres.
    **parameters
        Any of the school's parameters; see `World.parameters`.
    """

    def __init__(
        self,
        species: str = "anchovy",
        count: int = 100,
        *,
        center: Vector = (0.0, -3.0, 0.0),
        half: Vector | None = None,
        home: Vector | None = None,
        **parameters: float,
    ) -> None:
        options = {
            "species": _species(species),
            "count": count,
            "center": center,
            "half": half,
            "home": home,
        }
        super().__init__("fish_school", options, parameters)


class RoamingFish(Asked):
    """Single fishes with eyes, touch, ears, a lateral line and a roamer's mind.

    They cruise through their home range, keep clear of what they touch or see ahead, inspect
    schools, and dash now and then.

    Parameters
    ----------
    species
        A species by name (`grey_reef_shark`, …), or the path of a species file (.toml).
    count
        How many.
    center, radius
        Ball in which they begin, metres.
    home
        Middle of their home range, metres; `center` if not given.
    mind
        Called once per fish for a mind of your own (a `Mind` class will do); a roamer's if not
        given.
    **parameters
        Any of the population's parameters; see `World.parameters`.
    """

    def __init__(
        self,
        species: str = "grey_reef_shark",
        count: int = 1,
        *,
        center: Vector = (0.0, -3.0, 0.0),
        radius: float = 1.0,
        home: Vector | None = None,
        mind: Callable[[], Mind] | None = None,
        **parameters: float,
    ) -> None:
        options = {
            "species": _species(species),
            "count": count,
            "center": center,
            "radius": radius,
            "home": home,
        }
        if mind is None:
            super().__init__("roaming_fish", options, parameters)
        else:
            text = asked_text(options)
            Native.__init__(self, _engine.fish_with_minds(text, mind, minds.kinds()))
