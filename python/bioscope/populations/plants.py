"""Plants: grown from L-system texts, swaying in current and wind, growing while the world runs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope import gallery
from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.populations.native import Asked

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from bioscope.environments import Environment
    from bioscope.populations.place import Habitat

_WORLDS = Path(__file__).parents[1] / "worlds"
_NUMBER = r"\(?-?\d[\d.eE+-]*\)?"


class Plants(Asked):
    """A stand of plants grown by an L-system, no two alike.

    With a `rate` the plants grow while the world runs: each is a derivation of its own that goes
    on, and all of them share one environment, in which they compete (for light, space, water).
    Without one they are planted as grown plants of a few distinct shapes. Both bend in wind and
    current.

    What happens to growing plants is told by events: `germinated`, `eaten` (by an animal that has
    `bitten` one: the nearest small branch is gone), `pruned` (with the number of `modules` lost;
    an event `cut` of any population with `position` and `radius` cuts what is in that ball off) and
    `died` (nothing of it is left). Their `values` are `id`, `position`, `height_m`, `segments`,
    `leaves`, `steps` and `string`.

    Parameters
    ----------
    model
        Path of an L-system file (`.l` or `.lsys`; a `.colors` file beside it names its colours),
        the name of a model from `bioscope list` (`kelp`), or the text itself.
    count
        How many.
    habitat
        Where they grow.
    species
        Their species in the scene; the model's name if not given.
    steps
        Derivation steps of a complete plant; as many as the file says if not given.
    size
        Least and greatest size relative to the text's; of growing plants, which live in one space,
        metres per unit of the text.
    variants
        How many distinct shapes are planted, 1 to 64; for plants without `rate`.
    room
        Distance that a plant of size 1 keeps from others, metres.
    variety
        How much their colours differ, 0 to 1.
    rate
        Growth steps per second; the plants grow while the world runs.
    environment
        What surrounds growing plants: one of `bioscope.environments`, your own or a `Pipe` among
        them; what the model asks for if not given.
    start
        Steps that they have grown before the world begins.
    numbers
        Other values of numbers that the text defines (`#define VD 0.95`): one for all or, of
        growing plants, one per plant.
    seeds, litter
        Symbols of modules that leave the plant as seeds, which fall and germinate, and as leaves.
    season
        Seeds germinate in steps that are multiples of this, as in spring.
    most
        How many plants there may be.
    clip
        Shape that every plant is cut to, in metres from its foot: one of `ball` (x, y, z, radius),
        `box` (two corners), `cone`, `cylinder` (x, y, z, radius, height) each.
    origin
        Where the middle of the environment is; the middle of the plants if not given.
    lying
        Whether the plane in which the turtle begins is the ground.
    turned
        Whether each plant looks in another direction.
    unfold
        Whether plants turn into what a step makes of them while it lasts, rather than at once: for
        models of few large steps.
    levels
        Amounts of what the environment keeps (water in the soil) that are seen: of a deep field
        the surfaces of these amounts, through which one looks; a flat one is painted behind the
        plants, from black for nothing to blue for the greatest of them.
    colors
        A file of colours; the one beside the model if not given.
    **parameters
        `flexibility`, `yielding`, `period`, `damping`, `flutter`; of growing plants also
        `germination`, `dispersal`, `falling`; see `World.parameters`.

    Raises
    ------
    UnknownNameError
        If there is no such model, or the text defines no such number.
    InvalidValueError
        For arguments that make no sense, alone or together.

    Examples
    --------
    >>> import bioscope as bio
    >>> world = bio.World(seed=3, dt=1 / 30)
    >>> sky = bio.environments.SkyLight()
    >>> trees = world.add(bio.Plants("light_tree", 5, rate=30.0, environment=sky, room=2.0))
    >>> world.run(seconds=3)
    >>> int(trees.values("segments").min()) > 2
    True
    """

    def __init__(
        self,
        model: str | Path,
        count: int = 40,
        *,
        habitat: Habitat | None = None,
        species: str | None = None,
        steps: int | None = None,
        size: float | tuple[float, float] | None = None,
        variants: int | None = None,
        room: float | None = None,
        variety: float | None = None,
        rate: float | None = None,
        environment: Environment | None = None,
        start: int | None = None,
        numbers: Mapping[str, ArrayLike] | None = None,
        seeds: str | None = None,
        litter: str | None = None,
        season: int | None = None,
        most: int | None = None,
        clip: Mapping[str, Sequence[float]] | None = None,
        origin: tuple[float, float, float] | None = None,
        lying: bool | None = None,
        turned: bool | None = None,
        unfold: bool | None = None,
        levels: Sequence[float] | None = None,
        colors: str | Path | None = None,
        **parameters: float,
    ) -> None:
        name, text, palette = _read(model, colors)
        options: dict[str, Any] = {
            "species": species or Path(name).stem,
            "file_name": name,
            "palette": palette,
            "steps": steps,
            "count": count,
            "habitat": habitat and habitat.asked(),
            "room": room,
            "variety": variety,
        }
        growing = {
            "environment": environment and environment.asked(),
            "start": start,
            "seeds": seeds,
            "litter": litter,
            "season": season,
            "most": most,
            "clip": clip and [(key, _told(value)) for key, value in clip.items()],
            "origin": origin,
            "lying": lying,
            "turned": turned,
            "unfold": unfold,
            "levels": levels and [float(level) for level in levels],
        }
        if rate is None:
            said = [key for key, value in growing.items() if value is not None]
            if said:
                raise InvalidValueError(
                    f"{', '.join(said)}: for plants that grow; give them a rate"
                )
            texts = _with_numbers(name, text, numbers or {})
            if len(texts) > 1:
                raise InvalidValueError("numbers: one value each, for plants without rate")
            pair = (size, size) if isinstance(size, int | float) else size
            options |= {"source": texts[0], "size": pair, "variants": variants}
            super().__init__("plants", options, parameters)
            return
        if variants is not None or not isinstance(size, int | float | None):
            raise InvalidValueError(
                "variants and pairs of sizes: for plants without rate; growing ones differ anyway"
            )
        options |= growing | {"size": size, "sources": _with_numbers(name, text, numbers or {})}
        asked = options["environment"] or {}
        foreign = environment.engine if environment and asked.get("foreign") else None
        super().__init__("stand", options, parameters | {"rate": rate}, environment=foreign)


def _read(model: str | Path, colors: str | Path | None) -> tuple[str, str, str | None]:
    """Return name, text and palette of a model."""
    if isinstance(model, str) and "\n" in model:
        name, text, beside = "plant.lsys", model, None
    else:
        path = model_path(str(model))
        name, text = str(path), path.read_text(encoding="utf-8", errors="replace")
        beside = path.with_suffix(".colors")
    file = Path(colors) if colors is not None else beside
    known = file is not None and (colors is not None or file.is_file())
    return name, text, file.read_text(encoding="utf-8") if file is not None and known else None


def _told(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _with_numbers(name: str, text: str, numbers: Mapping[str, ArrayLike]) -> list[str]:
    """Return the text with other numbers: one text, or one per plant."""
    columns = {key: np.atleast_1d(np.asarray(value, float)) for key, value in numbers.items()}
    lengths = {len(column) for column in columns.values() if len(column) != 1}
    if len(lengths) > 1 or any(not np.isfinite(column).all() for column in columns.values()):
        raise InvalidValueError("numbers: one finite value each, or one per plant")
    texts = []
    for row in range(max(lengths, default=1)):
        own = text
        for key, column in columns.items():
            value = float(column[row % len(column)])
            line = re.compile(rf"^([ \t]*#define[ \t]+{re.escape(key)}[ \t]+){_NUMBER}", re.M)
            own, found = line.subn(rf"\g<1>({value!r})", own)
            if not found:
                raise UnknownNameError(f"{name} defines no number '{key}'")
        texts.append(own)
    return texts


def models() -> dict[str, Path]:
    """Return the plant models that come with the package, by name: of worlds and gallery."""
    of_worlds = {path.stem: path for path in sorted(_WORLDS.glob("*/plants/*.l*"))}
    return of_worlds | gallery.files()


def marine() -> list[Path]:
    """Return the files of the plants that live in water."""
    return sorted(_WORLDS.glob("*/plants/*.l"))


def leaves_of(model: Path) -> int | None:
    """Return how many leaves a plant (or each of its fronds) has, if its text says: `LEAVES`."""
    line = re.compile(rf"^[ \t]*#define[ \t]+LEAVES[ \t]+({_NUMBER})", re.M)
    found = line.search(model.read_text(encoding="utf-8", errors="replace"))
    return int(float(found[1].strip("()"))) if found else None


def model_path(model: str) -> Path:
    """Return the file of a model.

    Parameters
    ----------
    model
        A path, if it has a folder or an ending (`kelp.l`); else a name from `bioscope list`.

    Raises
    ------
    UnknownNameError
        If there is no model of this name.
    """
    if Path(model).suffix or len(Path(model).parts) > 1:
        return Path(model)
    known = models() | gallery.animations()
    if model not in known:
        names = ", ".join(known)
        raise UnknownNameError(
            f"unknown plant model '{model}'; known: {names}, or a path to a .l or .lsys file"
        )
    return known[model]
