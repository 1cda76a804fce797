"""The environments that are built in."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope import _engine
from bioscope.environments.environment import BuiltIn, Environment
from bioscope.errors import BioscopeError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from bioscope.lsystem.turtle import Segments


class SkyLight(BuiltIn):
    """Light of an overcast sky on clusters of leaves that shade each other.

    `?E(r)` puts a cluster of radius r here and gets the share of the light of an open sky;
    `?E(r,x,y,z)` the brightest direction too.

    Měch & Prusinkiewicz, SIGGRAPH 1996, section 4.4.

    Parameters
    ----------
    directions
        9 (the zenith and 8 at 45°), or any number spread over the whole upper half.
    transmittance
        Share of the light that a cluster lets through.
    """

    def __init__(self, directions: int = 9, transmittance: float = 0.25) -> None:
        super().__init__("sky_light", {"sources": directions, "tau": transmittance})


class PatchLight(BuiltIn):
    """Light on the ground in patches, under leaves that shade it.

    `?E(0,x)` asks for the light, `?E(1,r)` bears a leaf of radius r, `?E(2,r)` lets it die.

    Měch & Prusinkiewicz, SIGGRAPH 1996, section 4.2.

    Parameters
    ----------
    light
        Light from 0 to 1 (rows, columns), the lowest row first; the three patches of the clonal
        plant if not given.
    low, size
        Lowest corner of the map, and its width and height.
    """

    def __init__(
        self,
        light: ArrayLike | None = None,
        *,
        low: tuple[float, float] = (-30.0, -30.0),
        size: tuple[float, float] = (60.0, 60.0),
    ) -> None:
        if light is None:
            super().__init__("patch_light", {"map": "patches"})
        else:
            painted = np.ascontiguousarray(light, np.float32)
            super().__init__("patch_light", {}, map=painted, low=low, size=size)


class SoilWater(BuiltIn):
    """Water in the soil, which roots drink and which spreads.

    `?E(c,s)` asks for the amount c and gets what there is, and the angle to heading plus s times
    the gradient; `?E(c,s,t)` in a deep field amount, roll and angle.

    Měch & Prusinkiewicz, SIGGRAPH 1996, section 4.3.

    Parameters
    ----------
    size
        Cells in x, y (downward) and, for a deep field, z.
    cell
        Width of a cell.
    diffusion
        How fast water spreads, cell widths squared per step.
    amount
        Water in each cell at the start.
    obstacles
        Boxes (lowest and highest corner, six numbers) that hold no water.
    sources
        Boxes with a seventh number: the amount that they keep.
    """

    def __init__(
        self,
        size: tuple[int, ...] = (64, 64),
        *,
        cell: float = 1.0,
        diffusion: float = 0.1,
        amount: float = 1.0,
        obstacles: Sequence[Sequence[float]] = (),
        sources: Sequence[Sequence[float]] = (),
    ) -> None:
        settings: list[tuple[str, object]] = [
            ("size", size),
            ("cell", cell),
            ("D", diffusion),
            ("amount", amount),
        ]
        settings += [("obstacle", box) for box in obstacles]
        settings += [("source", box) for box in sources]
        entries = [(name, _numbers(value)) for name, value in settings]
        self._make("soil_water", entries)


class Collision(BuiltIn):
    """Clusters of leaves as discs: an apex stops inside one that is not its mother's.

    `?E(x)` puts a cluster of vigor x here and becomes 1 if it may grow on, else 0.

    Měch & Prusinkiewicz, SIGGRAPH 1996, section 4.1.

    Parameters
    ----------
    radius
        Radius of the clusters.
    centers
        Places of clusters that stand from the start (n, 3).
    """

    def __init__(self, radius: float = 0.89, centers: ArrayLike = ()) -> None:
        super().__init__("leaf_discs", {"rho": radius, "centers": np.asarray(centers, float)})


class Neighborhood(BuiltIn):
    """Circles of influence: `?E(r,s)` gets s = 1 where a larger one overlaps."""

    def __init__(self) -> None:
        super().__init__("neighborhood", {})


class Community(BuiltIn):
    """Plants of different ability.

    `?E(r,c,w,d)` gets the water w, and d = 1 where an abler one overlaps.
    """

    def __init__(self, *, middle: float = 30.0, width: float = 6.7) -> None:
        super().__init__("community", {"middle": middle, "width": width})


class LeafBalls(BuiltIn):
    """Photosynthesis of balls of sparse leaves: `?E(area,upkeep)` (the field program takenaka)."""

    def __init__(self, *, source: Sequence[float] = (0.0, 10_000.0, 0.0, 1.0)) -> None:
        super().__init__("takenaka", {"source": source})


class ShadowVoxels(BuiltIn):
    """Light in voxels that buds shade (Palubicki and others, SIGGRAPH 2009): `?E(s,x,y,z)`."""

    def __init__(self, *, cells: int = 201, span: float = 200.0, depth: int = 6) -> None:
        settings = {"grid size": cells, "grid span": span, "shadow depth": depth}
        super().__init__("shadowpyramid", dict(settings))


class Pole(BuiltIn):
    """A pole that a stem winds around: `?E(c,yaw,pitch)`."""

    def __init__(self, *, x: float = 1.0, z: float = 0.0, radius: float = 0.3) -> None:
        super().__init__("pole", {"px": x, "pz": z, "radius": radius})


class Obstacles(BuiltIn):
    """Solids that growth goes around: `?E(l,yaw,pitch)` gets the length it may have and the turns.

    Parameters
    ----------
    **shapes
        One of `ball` (x, y, z, radius), `box` (two corners), `cone` and `cylinder` (x, y, z,
        radius, height), `plane` (point and normal), each.
    """

    def __init__(self, **shapes: Sequence[float]) -> None:
        super().__init__("obstacles", dict(shapes))


class Limbs(BuiltIn):
    """Wood that a climber creeps along: `?E(l,yaw,pitch,roll,crowd)`.

    The answers turn a piece of length l along the surface, `+(yaw)&(pitch)/(roll)`, and tell how
    many pieces have begun near here before, so that a climber keeps off where it has been.

    Měch & Prusinkiewicz, SIGGRAPH 1996, section 8, figure 13.

    Parameters
    ----------
    segments
        What it climbs: `start`, `end` (n, 3) and `radii` (n, 2), as `bio.Turtle().interpret(tree)`
        gives them.
    stem
        From the surface to the middle of the climber's stem.
    reach
        Within which pieces crowd.
    up
        How much it looks upward, 0 not at all, 1 as much as ahead.
    """

    def __init__(
        self, segments: Segments, *, stem: float = 0.01, reach: float = 0.15, up: float = 0.35
    ) -> None:
        rows = np.concatenate([segments.start, segments.end, segments.radii], axis=1)
        entries = [("limb", _numbers(row)) for row in np.asarray(rows, np.float32)]
        own = {"stem": stem, "reach": reach, "up": up}
        entries += [(name, repr(float(value))) for name, value in own.items()]
        self._make("limbs", entries)


class Pruning(BuiltIn):
    """A shape that plants are cut to: `?E(x)` gets 1 outside and 0 inside.

    Shapes as in `Obstacles`.
    """

    def __init__(self, **shapes: Sequence[float]) -> None:
        super().__init__("pruning", dict(shapes))


class Field(BuiltIn):
    """A field program of cpfg by name, with the commands of its specification file as keywords.

    Spaces in the names of commands are written as underscores.
    """

    def __init__(self, program: str, **settings: object) -> None:
        super().__init__(program, settings)


class Pipe(Environment):
    """A program of one's own at the other end of a pipe.

    docs/reference/environments.md has the layout.

    Parameters
    ----------
    command
        The program and its arguments; it runs without a shell.
    seconds
        How long an answer may take.

    Around growing plants of a world it goes on when the world goes back to an earlier tick, and a
    world that was saved does not start it again: nothing in a saved world is ever run.

    Raises
    ------
    FormatError
        If it cannot be started. If it ends, babbles or is too slow later, the derivation raises it,
        and so does the step of a world, which is then at its last complete tick.
    """

    def __init__(self, command: str | Sequence[str], seconds: float = 10.0) -> None:
        words = shlex.split(command) if isinstance(command, str) else list(command)
        self._inner = _engine.Environment.pipe(words, seconds)

    def exchange(self, step: int, messages: dict[str, NDArray[Any]]) -> None:
        """Say that it is gone: the world was saved, and nothing in a saved world is ever run."""
        raise BioscopeError(
            "the program that surrounded these plants does not come back with a saved world; "
            "with rate = 0 they live on as they are"
        )


def _numbers(value: object) -> str:
    return " ".join(repr(float(one)) for one in np.atleast_1d(np.asarray(value)).ravel())
