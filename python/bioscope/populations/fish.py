"""Fish: schools, and single ones with minds of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from bioscope import _engine, minds
from bioscope.errors import InvalidValueError
from bioscope.fish.species import Species, asked_species
from bioscope.populations.native import Asked, asked_text
from bioscope.world.population import Native

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from bioscope.minds import Mind
    from bioscope.minds.own import Decision
    from bioscope.world.world import World

    AnyMind = Mind | Callable[[], Mind] | Decision | minds.FishMind | str

Vector = tuple[float, float, float]


class Fishes(Asked):
    """Fishes whose inner life can be asked for as arrays, in the order of their ids."""

    _mind_classes: tuple[type[Mind], ...] = ()

    @property
    def hunger(self) -> NDArray[np.float64]:
        """Hunger (n,), 0 to 1, of fishes with a mind of the engine's.

        Raises
        ------
        UnknownNameError
            If their minds know no hunger; so for the others.
        """
        return self.values("hunger").astype(np.float64)

    @property
    def libido(self) -> NDArray[np.float64]:
        """Libido (n,), 0 to 1."""
        return self.values("libido").astype(np.float64)

    @property
    def fear(self) -> NDArray[np.float64]:
        """Fear (n,), 0 to 1."""
        return self.values("fear").astype(np.float64)

    @property
    def intention(self) -> NDArray[np.str_]:
        """What they are about (n,): `wander`, `eat`, …, or the `behavior` of a mind of your own."""
        return self.values("intention").astype(np.str_)

    @property
    def target(self) -> NDArray[np.int64]:
        """Ids (n,) of what they are after; 0 for nobody."""
        return self.values("target").astype(np.int64)

    def _settled(self, world: World, name: str) -> None:
        super()._settled(world, name)
        world._minds.setdefault(name, self._mind_classes)


class FishSchool(Fishes):
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
        swims by its own muscles: whether they school is up to them. By its name alone
        (`intentions`, `behavior_network`, `free_flow`) it is a mind as fishes of this species have
        it: sharks hunt, anchovies school and flee, clownfishes court.
    **parameters
        Any of the school's parameters; see `World.parameters`.
    """

    def __init__(
        self,
        species: Species = "anchovy",
        count: int = 100,
        *,
        center: Vector = (0.0, -3.0, 0.0),
        half: Vector | None = None,
        home: Vector | None = None,
        mind: AnyMind | None = None,
        **parameters: float,
    ) -> None:
        if mind is not None:
            many = _count(count)
            radius = max(half) if half else 0.5 * many ** (1 / 3)
            place = {"center": center, "radius": radius, "home": home}
            body = {"species": asked_species(species), "count": many, "body": "muscle_swimmer"}
            _with_mind(self, body | place, mind, parameters)
            return
        options = {
            "species": asked_species(species),
            "count": _count(count),
            "center": center,
            "half": half,
            "home": home,
        }
        super().__init__("fish_school", options, parameters)


class RoamingFish(Fishes):
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
        A mind of the engine's by name (`intentions`, `behavior_network`, `free_flow`), as fishes of
        this species have it, or made by one of those classes of `bioscope.minds`. Or a mind of your
        own: a function of percepts that returns what the fish wants (see `Mind.decide`), a `Mind`
        class or what else makes one for each fish, or a `Mind` to be copied. A roamer's if not
        given. With a mind of the engine's the fishes have an artificial fish's senses: they see all
        within 15 times its size and smell their food.
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
        Share of females among fishes with a mind of the engine's; if not given the mind's habit,
        and half of those who have a mind by its name alone.
    **parameters
        Any of the population's parameters; see `World.parameters`.
    """

    def __init__(
        self,
        species: Species = "grey_reef_shark",
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
            "species": asked_species(species),
            "count": _count(count),
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


def _count(count: int) -> int:
    """Return the number, or raise if it is no whole number of 0 or more."""
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 0:
        raise InvalidValueError(f"count = {count!r}: expected a whole number, 0 or more")
    return int(count)


def _with_mind(
    fish: Fishes, options: dict[str, Any], mind: AnyMind | None, parameters: dict[str, float]
) -> None:
    """Make single fishes with a mind of the engine's, of the user's own, or a roamer's."""
    if mind is not None and not isinstance(mind, (str, minds.FishMind)):
        make = minds.maker(mind)
        made: dict[type[Mind], None] = {}

        def one() -> Mind:
            another = make()
            made[type(another)] = None
            return another

        Native.__init__(fish, _engine.fish_with_minds(asked_text(options), parameters, one))
        fish._mind_classes = tuple(made)
        return
    if mind is not None:
        asked = minds.asked(mind)
        # By its name alone it is a mind as fishes of the species have it.
        options["mind"] = {"kind": asked.kind} if isinstance(mind, str) else asked.request
    Asked.__init__(fish, "roaming_fish", options, parameters)
