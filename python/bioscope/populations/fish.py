"""Fish: schools, and single ones with minds of their own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from bioscope import _engine, minds
from bioscope.populations.native import Asked, asked_text
from bioscope.world.population import Native

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bioscope.minds import Mind

    AnyMind = Callable[[], Mind] | minds.FishMind | str

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
    mind
        None for Reynolds' rules. With a mind (see `RoamingFish`) each fish decides for itself and
        swims by its own muscles: whether they school is up to them.
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
        mind: AnyMind | None = None,
        **parameters: float,
    ) -> None:
        if mind is not None:
            radius = max(half) if half else 0.5 * count ** (1 / 3)
            place = {"center": center, "radius": radius, "home": home}
            options = {"species": _species(species), "count": count, "body": "muscle_swimmer"}
            _with_mind(self, options | place, mind, parameters)
            return
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
        A mind of the engine's by name (`intentions`, `behavior_network`, `free_flow`) or made by
        one of those classes of `bioscope.minds`; or what is called once per fish for a mind of your
        own (a `Mind` class will do). A roamer's if not given. With a mind of the engine's the
        fishes have an artificial fish's senses: they see all within 15 times its size and smell
        their food.
    food
        Species that they smell as food, with a mind of your own; the engine's know their own.
    variation
        By how much of its size each differs from the others, 0 to 0.9; a tenth if not given.
    body
        `muscle_swimmer`, moved by muscles that pull springs in water, or `swimmer`, by geometric
        flight; the former with a mind of the engine's, the latter without, if not given.
    reaction
        Seconds from one decision to the next, 0 to 2; 0 for one in every tick. Between decisions
        they notice nothing new and go on as they wanted; real fishes answer what they see after
        about a tenth of a second. Large populations cost less with it.
    females
        Share of females among fishes with a mind of the engine's; the mind's habit if not given.
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
        mind: AnyMind | None = None,
        females: float | None = None,
        food: Sequence[str] = (),
        variation: float | None = None,
        body: Literal["swimmer", "muscle_swimmer"] | None = None,
        reaction: float = 0.0,
        **parameters: float,
    ) -> None:
        options: dict[str, Any] = {
            "species": _species(species),
            "count": count,
            "center": center,
            "radius": radius,
            "home": home,
            "females": females,
            "food": list(food),
            "variation": variation,
            "body": body,
            "reaction": reaction,
        }
        _with_mind(self, options, mind, parameters)


def _with_mind(
    fish: Asked, options: dict[str, Any], mind: AnyMind | None, parameters: dict[str, float]
) -> None:
    """Make single fishes with a mind of the engine's, of the user's own, or a roamer's."""
    if mind is not None and not isinstance(mind, (str, minds.FishMind)):
        text = asked_text(options)
        Native.__init__(fish, _engine.fish_with_minds(text, mind, minds.kinds()))
        return
    if mind is not None:
        options["mind"] = minds.asked(mind).request
    Asked.__init__(fish, "roaming_fish", options, parameters)
