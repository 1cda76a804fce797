"""Plants: grown from L-system texts, swaying in current and wind."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bioscope import gallery
from bioscope.errors import UnknownNameError
from bioscope.populations.native import Asked

if TYPE_CHECKING:
    from bioscope.populations.place import Habitat

_WORLDS = Path(__file__).parents[1] / "worlds"


class Plants(Asked):
    """A stand of plants grown by an L-system, no two alike.

    Parameters
    ----------
    model
        Path of an L-system file (`.l` or `.lsys`; a `.colors` file beside it names its colours), or
        the name of a model from `bioscope list` (`kelp`).
    count
        How many.
    habitat
        Where they grow.
    species
        Their species in the scene; the model's name if not given.
    steps
        Derivation steps; as many as the file says if not given.
    size
        Least and greatest size relative to the text's.
    variants
        How many distinct shapes are grown, 1 to 64.
    room
        Distance that a plant of size 1 keeps from others, metres.
    variety
        How much their colours differ, 0 to 1.
    **parameters
        `flexibility`, `yielding`, `period`, `damping`, `flutter`; see `World.parameters`.
    """

    def __init__(
        self,
        model: str,
        count: int = 40,
        *,
        habitat: Habitat | None = None,
        species: str | None = None,
        steps: int | None = None,
        size: tuple[float, float] | None = None,
        variants: int | None = None,
        room: float | None = None,
        variety: float | None = None,
        **parameters: float,
    ) -> None:
        path = model_path(model)
        palette = path.with_suffix(".colors")
        options = {
            "species": species or path.stem,
            "source": path.read_text(encoding="utf-8", errors="replace"),
            "file_name": str(path),
            "palette": palette.read_text(encoding="utf-8") if palette.is_file() else None,
            "steps": steps,
            "count": count,
            "habitat": habitat and habitat.asked(),
            "size": size,
            "variants": variants,
            "room": room,
            "variety": variety,
        }
        super().__init__("plants", options, parameters)


def models() -> dict[str, Path]:
    """Return the plant models that come with the package, by name: of worlds and gallery."""
    of_worlds = {path.stem: path for path in sorted(_WORLDS.glob("*/plants/*.l"))}
    return of_worlds | gallery.files()


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
    known = models()
    if model not in known:
        names = ", ".join(known)
        raise UnknownNameError(
            f"unknown plant model '{model}'; known: {names}, or a path to a .l or .lsys file"
        )
    return known[model]
