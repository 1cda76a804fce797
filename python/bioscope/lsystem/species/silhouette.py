"""Outlines of plants and of pictures, and how much two of them overlap."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import InvalidValueError
from bioscope.lsystem.specimen import Specimen
from bioscope.world import World

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from bioscope._engine import Mesh

    Mask = NDArray[np.bool_]

PIXELS = 320
"""Width and height of the picture from which a plant's outline is taken."""
AWAY = 40.0
"""Distance of the camera in plant sizes: so far that nothing is foreshortened."""
ROWS = 200
"""Rows of an outline that is compared."""
SHIFT = 0.1
"""How far outlines are moved sideways to find the best overlap, as a share of their height."""
_OPAQUE = 128
_LARGEST = 600


def silhouette_of_plant(mesh: Mesh, degrees: Sequence[float] = (0.0,)) -> list[tuple[Mask, float]]:
    """Return the outlines of a plant seen level from the side, and the height of a row in metres.

    Parameters
    ----------
    mesh
        The plant.
    degrees
        From where: 0 is from +z, 90 from +x.
    """
    points = np.asarray(mesh.positions)
    low, high = points.min(axis=0), points.max(axis=0)
    reach = float(np.hypot(points[:, 0], points[:, 2]).max())
    size = 1.05 * max(float(high[1] - low[1]), 2 * reach, 1e-6)
    world = World(seed=1, title="outline")
    world.add(Specimen(mesh, "plant", 1 / size))
    middle = float(low[1] + high[1]) / 2 / size
    angle = 2 * math.atan(0.5 / AWAY)
    cameras = []
    for one in degrees:
        turn = math.radians(one)
        place = (AWAY * math.sin(turn), middle, AWAY * math.cos(turn))
        cameras.append(_engine.Camera.looking_at(place, (0.0, middle, 0.0), angle))
    looks = _engine.Rasterizer().look(world.scene, cameras, PIXELS, PIXELS)
    return [(identity > 0, size / PIXELS) for _, _, identity in looks]


def silhouette_of_picture(pixels: NDArray[np.uint8]) -> Mask:
    """Return which pixels (height, width, 4) show the plant.

    Those that are opaque, if any are not; else those that differ from the border's color, by the
    threshold that parts the differences best (N. Otsu, 1979).

    Raises
    ------
    InvalidValueError
        If nothing stands out.
    """
    step = max(1, math.ceil(max(pixels.shape[:2]) / _LARGEST))
    pixels = pixels[::step, ::step]
    opacity = pixels[..., 3]
    if int(opacity.min()) < _OPAQUE:
        mask = opacity >= _OPAQUE
    else:
        colors = pixels[..., :3].astype(np.float64)
        border = np.concatenate([colors[0], colors[-1], colors[:, 0], colors[:, -1]])
        away = np.linalg.norm(colors - np.median(border, axis=0), axis=-1)
        mask = away > _threshold(away)
    if not mask.any() or mask.all():
        raise InvalidValueError("picture: nothing stands out from the background")
    return np.asarray(mask)


def _threshold(values: NDArray[np.float64]) -> float:
    """Return the threshold with the greatest variance between the two classes."""
    counts, edges = np.histogram(values, 128)
    middles = (edges[:-1] + edges[1:]) / 2
    below = np.cumsum(counts)
    above = below[-1] - below
    sums = np.cumsum(counts * middles)
    with np.errstate(divide="ignore", invalid="ignore"):
        between = below * above * (sums / below - (sums[-1] - sums) / above) ** 2
    return float(edges[1:][np.nanargmax(between)])


def cut_out(mask: Mask) -> Mask:
    """Return the part of a mask that holds all of it."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        raise InvalidValueError("an outline without a single pixel")
    return mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


def _scaled(mask: Mask, rows: int) -> Mask:
    """Return a mask in another size, its foot in the middle of the lowest row."""
    height, width = mask.shape
    columns = max(1, round(width * rows / height))
    down = np.minimum((np.arange(rows) + 0.5) * height / rows, height - 1).astype(int)
    across = np.minimum((np.arange(columns) + 0.5) * width / columns, width - 1).astype(int)
    scaled = mask[down][:, across]
    foot = np.flatnonzero(scaled[-max(1, rows // 40) :].any(axis=0))
    middle = int(foot[0] + foot[-1]) // 2
    half = max(middle, columns - 1 - middle)
    return np.pad(scaled, ((0, 0), (half - middle, half - (columns - 1 - middle))))


def laid_over(plant: Mask, picture: Mask, size: float = 1.0) -> tuple[Mask, Mask]:
    """Return two outlines on one canvas, foot on foot, where they overlap most.

    Parameters
    ----------
    plant, picture
        The outlines.
    size
        How high the plant is beside what the picture shows.
    """
    size = min(max(size, 0.1), 10.0)
    one = _scaled(cut_out(picture), ROWS)
    if not plant.any():
        # A flat plant, seen edge on.
        return np.zeros_like(one), one
    other = _scaled(cut_out(plant), max(1, round(ROWS * size)))
    reach = round(SHIFT * ROWS)
    rows = max(len(one), len(other))
    half = max(one.shape[1], other.shape[1]) // 2 + reach
    canvases = []
    for mask in (one, other):
        side = half - mask.shape[1] // 2
        canvases.append(np.pad(mask, ((rows - len(mask), 0), (side, side))))
    first, second = canvases
    shifts = range(-reach, reach + 1, 2)
    best = max(shifts, key=lambda shift: share(np.roll(second, shift, axis=1), first))
    return np.roll(second, best, axis=1), first


def overlap(plant: Mask, picture: Mask, size: float = 1.0) -> float:
    """Return intersection over union of two outlines: 1 where they are the same, 0 apart.

    They are brought to one height (or their heights to the ratio `size`), foot on foot.
    """
    return share(*laid_over(plant, picture, size))


def share(one: Mask, other: Mask) -> float:
    """Return intersection over union of two masks of one canvas."""
    return float((one & other).sum() / max(int((one | other).sum()), 1))
