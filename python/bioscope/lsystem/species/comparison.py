"""A plant beside its photographs, age by age."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import FormatError
from bioscope.lsystem.lsystem import LSystem
from bioscope.lsystem.species.silhouette import (
    cut_out,
    laid_over,
    share,
    silhouette_of_picture,
    silhouette_of_plant,
)
from bioscope.lsystem.turtle import Turtle

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Mask = NDArray[np.bool_]

SIDES = tuple(15.0 * number for number in range(24))
"""Directions in degrees from which the plant is looked at to find that of the photographs."""
_NAME = re.compile(r"(\d+)(?:-(\d*\.?\d+)m)?\.png")
_PLANT, _PICTURE, _BOTH, _NEITHER = (60, 110, 230), (230, 90, 60), (40, 60, 40), (250, 248, 242)
_MARGIN = 12


@dataclass(frozen=True, slots=True)
class Match:
    """A plant and a photograph at one age."""

    age: int
    """Step of the model."""
    overlap: float
    """Intersection over union of the outlines, 0 to 1."""
    degrees: float
    """From where the plant is seen, the same at all ages: 0 is from +z, 90 from +x."""
    plant: Mask
    """Outline of the plant, on the canvas of both (rows, columns)."""
    picture: Mask
    """Outline of the photograph."""


def compare(folder: Path, seed: int = 1) -> list[Match]:
    """Return how well a species meets its photographs at each of their ages.

    The plant is turned to the side from which it meets all of them best. Outlines are brought to
    one height, or, where a photograph's name tells the height, compared in true size.

    Parameters
    ----------
    folder
        As `begin` writes it: a model, and PNG files named by their age in `photographs`.
    seed
        Of the plant.

    Raises
    ------
    FormatError
        If there is no model or no photograph, or one of them cannot be read.
    """
    models = sorted([*folder.glob("*.lsys"), *folder.glob("*.l")])
    if len(models) != 1:
        raise FormatError(f"{folder}: expected one model (.lsys or .l), found {len(models)}")
    pictures = _pictures(folder / "photographs")
    system = LSystem.read(models[0])
    found: list[list[tuple[Mask, Mask]]] = []
    for (age, height), picture in pictures.items():
        mesh = Turtle().interpret(system.derive(age, seed)).mesh()
        if not len(mesh.triangles):
            raise FormatError(f"{models[0]}: nothing to see after {age} steps")
        sights = silhouette_of_plant(mesh, SIDES)
        at_age = []
        for outline, row in sights:
            size = 1.0
            if height is not None and outline.any():
                size = len(cut_out(outline)) * row / height
            at_age.append(laid_over(outline, picture, size))
        found.append(at_age)
    shares = np.array([[share(*pair) for pair in at_age] for at_age in found])
    best = int(shares.mean(axis=0).argmax())
    ages = [age for age, _ in pictures]
    return [
        Match(age, float(shares[number, best]), SIDES[best], *found[number][best])
        for number, age in enumerate(ages)
    ]


def _pictures(folder: Path) -> dict[tuple[int, float | None], Mask]:
    pictures = {}
    for path in sorted(folder.glob("*.png"), key=lambda path: (len(path.stem), path.stem)):
        name = _NAME.fullmatch(path.name)
        if name is None:
            raise FormatError(f"{path}: expected a name that tells the age, as 12.png, 12-0.3m.png")
        height = float(name[2]) if name[2] else None
        if height == 0:
            raise FormatError(f"{path}: a plant of no height")
        pictures[int(name[1]), height] = silhouette_of_picture(
            _engine.decode_png(path.read_bytes())
        )
    if not pictures:
        raise FormatError(f"{folder}: no photographs (PNG files named by age, as 12.png)")
    return dict(sorted(pictures.items(), key=lambda item: item[0][0]))


def sheet(matches: list[Match]) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3) of all ages side by side.

    Dark where plant and photograph agree, blue where only the plant is, red where only the
    photograph is.
    """
    rows = max(len(match.plant) for match in matches) + 2 * _MARGIN
    panels = []
    for match in matches:
        height, width = match.plant.shape
        panel = np.full((rows, width + 2 * _MARGIN, 3), _NEITHER, np.uint8)
        inside = panel[rows - _MARGIN - height : rows - _MARGIN, _MARGIN : _MARGIN + width]
        inside[match.plant & ~match.picture] = _PLANT
        inside[match.picture & ~match.plant] = _PICTURE
        inside[match.plant & match.picture] = _BOTH
        panels.append(panel)
    return np.concatenate(panels, axis=1)
