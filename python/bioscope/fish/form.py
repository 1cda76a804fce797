"""The body of a fish as surfaces of control points, and how it goes with the nodes of a `Tank`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import InvalidValueError
from bioscope.fish.nurbs import Nurbs, even_knots, through

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

BODY = (9, 21)
"""Control points of half a body: from back to belly, and from snout to tail."""
FIN = (2, 12)
"""Control points of a dorsal or ventral fin: edge and rim, from front to back."""
PECTORAL = (4, 6)
"""Row and column of the control point of the body at which a pectoral fin is rooted."""

_NEARNESS = 6.0
"""How quickly the say of a face in the skin fades with distance: a power, our choice."""


@dataclass(frozen=True)
class Fin:
    """A fin on the edge of a body, with the edge's own control points and knots: without a gap."""

    surface: Nurbs
    """2 x 12 control points, straight and cubic; the first row is that of the edge."""
    row: int
    """Of the body's control points: 0 at the back, -1 at the belly."""
    first: int
    """Column of the first of them."""

    @classmethod
    def grown(cls, body: Nurbs, row: int, first: int, height: float) -> Fin:
        """Return a fin that is high in front, low behind and swept back."""
        edge = body.points[row, first : first + FIN[1]]
        share = np.linspace(0, 1, FIN[1])
        rise = height * np.sqrt(np.sin(np.pi * share**0.8))
        rim = edge + np.stack([0 * rise, rise, -0.5 * np.abs(rise)], axis=1)
        knots = body.knots[1][first : first + FIN[1] + body.degrees[1] + 1]
        both = (even_knots(FIN[0], 1), knots)
        return cls(Nurbs(np.stack([edge, rim]), (1, body.degrees[1]), both), row, first)

    def moved(self, rim: NDArray[np.float64], body: NDArray[np.float64]) -> Fin:
        """Return the fin with another rim (12, 3), on a body with these control points."""
        edge = self.edge_of(body)
        return replace(self, surface=self.surface.moved(np.stack([edge, rim])))

    def edge_of(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what belongs to the fin's edge of anything said of the body's points."""
        return points[self.row, self.first : self.first + FIN[1]]


@dataclass(frozen=True)
class Form:
    """Two halves that share their border, fins that share the edge of the body, pectoral fins.

    X. Tu, "Artificial Animals for Computer Animation", 1999, section 5.1. The frame is that of a
    `Tank`: snout toward +Z, +X to the left of the fish, +Y up; metres.
    """

    left: Nurbs
    """Cubic, 9 x 21 control points; the other half is `right`."""
    right: Nurbs
    dorsal: Fin
    ventral: Fin
    pectorals: NDArray[np.float64]
    """Corners (2, 5, 3) of the left and right pectoral fin, from the root round."""
    coordinates: NDArray[np.float64]
    """Texture coordinates (9, 21, 2) of the control points of either half: from the left and the
    top of a picture whose fish looks to the left."""

    @classmethod
    def of_picture(
        cls,
        coordinates: ArrayLike,
        size: tuple[int, int],
        *,
        length: float,
        snout: ArrayLike = (0.0, 0.0, 0.0),
        thickness: float = 0.45,
        fins: tuple[float, float] = (0.18, 0.12),
    ) -> Form:
        """Model a fish from a picture to which a mesh has been fitted with `bioscope contour`.

        The surface passes through the crossings of the mesh, so that outline and texture of the
        picture are those of the fish. (The source modelled the body by hand, beside the picture.)

        Parameters
        ----------
        coordinates
            `coordinates` (9, 21, 2) of the file that `bioscope contour` saves; the fish looks to
            the left.
        size
            Width and height of the picture, pixels.
        length
            Metres from snout to tail.
        snout
            Where the snout is, metres: `Tank.nodes[0]`.
        thickness
            Greatest width of the body, relative to its depth.
        fins
            Heights of dorsal and ventral fin relative to the length.

        Raises
        ------
        InvalidValueError
            For a mesh of another size, or one without extent.
        """
        crossings = np.asarray(coordinates, float)
        if crossings.shape != (*BODY, 2) or not np.isfinite(crossings).all():
            raise InvalidValueError(
                f"coordinates {crossings.shape}: expected finite ones of shape {(*BODY, 2)}"
            )
        extent = float(np.ptp(crossings[..., 0])) * size[0]
        if not extent > 0 or not length > 0 or not thickness > 0:
            raise InvalidValueError("expected a mesh with an extent, a length, a thickness above 0")
        flat = crossings * size * [-length / extent, -length / extent]
        flat -= flat[BODY[0] // 2, 0]
        down, along = (np.linspace(-1, 1, count) for count in BODY)
        round_ = np.sqrt(np.maximum(1 - down**2, 0))[:, None] * np.sqrt(1 - along**6)
        aside = 0.5 * thickness * (flat[0, :, 1] - flat[-1, :, 1]) * round_
        solved = through(np.concatenate([aside[..., None], flat[..., ::-1], crossings], axis=2))
        points = solved.points[..., :3]
        points[[0, -1], :, 0] = points[:, [0, -1], 0] = 0.0
        points += np.asarray(snout, float)
        return cls._of_half(points, solved.points[..., 3:], [one * length for one in fins])

    @classmethod
    def _of_half(
        cls, points: NDArray[np.float64], coordinates: NDArray[np.float64], fins: list[float]
    ) -> Form:
        left, right = Nurbs(points), Nurbs(points * [-1, 1, 1])
        dorsal = Fin.grown(left, 0, first=5, height=fins[0])
        ventral = Fin.grown(left, -1, first=8, height=-fins[1])
        root = points[PECTORAL]
        reach = 0.16 * float(np.ptp(points[..., 2]))
        corners = np.array([[0, 0, 0], [0.5, 0.3, -0.7], [0.6, 0, -1], [0.5, -0.35, -0.9]])
        last = np.array([[0.25, -0.4, -0.35]])
        pectoral = root + reach * np.concatenate([corners, last])
        pectorals = np.stack([pectoral, pectoral * [-1, 1, 1]])
        return cls(left, right, dorsal, ventral, pectorals, coordinates)

    def points(self) -> NDArray[np.float64]:
        """Return all control points and corners (n, 3), those that are shared as often as used."""
        fins = (self.dorsal.surface, self.ventral.surface)
        parts = [one.points for one in (self.left, self.right, *fins)]
        return np.concatenate([one.reshape(-1, 3) for one in [*parts, self.pectorals]])

    def moved(self, points: NDArray[np.float64]) -> Form:
        """Return the form with other places of its control points, in the order of `points`.

        Fins go along with the edge of the body, and pectoral fins with their roots, whatever is
        said of those points themselves.
        """
        half, fin = BODY[0] * BODY[1], FIN[0] * FIN[1]
        ends = np.cumsum([half, half, fin, fin])
        left, right, dorsal, ventral, corners = np.split(points, ends)
        sides = left.reshape(*BODY, 3), right.reshape(*BODY, 3)
        border = np.ones(BODY, bool)
        border[1:-1, 1:-1] = False
        sides[1][border] = sides[0][border]
        corners = corners.reshape(2, 5, 3)
        roots = np.stack([side[PECTORAL] for side in sides])
        return replace(
            self,
            left=self.left.moved(sides[0]),
            right=self.right.moved(sides[1]),
            dorsal=self.dorsal.moved(dorsal.reshape(*FIN, 3)[1], sides[0]),
            ventral=self.ventral.moved(ventral.reshape(*FIN, 3)[1], sides[0]),
            pectorals=corners + (roots - corners[:, 0])[:, None],
        )

    def mesh(self, rows: int = 17, columns: int = 41) -> _engine.Mesh:
        """Return the surface as triangles, with texture coordinates in 0 to 1."""
        texture = Nurbs(self.coordinates)
        sheets = [
            (self.left.grid(rows, columns), texture.grid(rows, columns), False),
            (self.right.grid(rows, columns), texture.grid(rows, columns), True),
        ]
        for fin in (self.dorsal, self.ventral):
            # They are colored as the body beside them, a row within its border.
            beside = self.coordinates[1 if fin.row == 0 else -2, fin.first : fin.first + FIN[1]]
            own = fin.surface.moved(np.stack([beside, beside]))
            sheets.append((fin.surface.grid(3, columns), own.grid(3, columns), False))
        places, uvs, triangles, count = [], [], [], 0
        for points, coordinates, flipped in sheets:
            corners = _triangles(*points.shape[:2])
            triangles.append((corners[:, ::-1] if flipped else corners) + count)
            places.append(points.reshape(-1, 3))
            uvs.append(coordinates.reshape(-1, 2))
            count += len(places[-1])
        fan = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4]])
        for corners in self.pectorals:
            triangles.append(fan + count)
            places.append(corners)
            uvs.append(np.repeat(self.coordinates[PECTORAL][None], len(corners), axis=0))
            count += len(corners)
        return _engine.Mesh(
            np.concatenate(places).astype(np.float32),
            np.concatenate(triangles).astype(np.uint32),
            uvs=np.clip(np.concatenate(uvs), 0, 1).astype(np.float32),
        )


class Skin:
    """Lets a form go with the nodes of a body of springs.

    As in the source, every control point keeps its place in the frames of faces of the body; there
    in that of the nearest face alone, here in all, the nearer the more, so that the skin has no
    kinks where faces meet.

    Parameters
    ----------
    form
        At rest, in the frame of the nodes.
    nodes, faces
        Of the body at rest: `Tank.nodes`, `Tank.faces`.

    Examples
    --------
    >>> import bioscope as bio
    >>> tank = bio.fish.Tank("anthias")
    >>> across, down = np.meshgrid(np.linspace(0, 1, 21), np.linspace(0.3, 0.7, 9))
    >>> box = np.stack([across, down], axis=2)
    >>> form = Form.of_picture(box, (640, 420), length=tank.length)
    >>> skin = Skin(form, tank.nodes, tank.faces)
    >>> bool(np.allclose(skin.posed(tank.nodes).points(), form.points(), atol=1e-12))
    True
    """

    def __init__(self, form: Form, nodes: ArrayLike, faces: ArrayLike) -> None:
        self.form = form
        self._faces = np.asarray(faces)
        middles, frames = self._framed(np.asarray(nodes, float))
        away = form.points()[:, None] - middles
        self._offsets = np.einsum("fij,pfj->pfi", frames, away)
        nearness = (np.linalg.norm(away, axis=2) + 1e-9) ** -_NEARNESS
        self._shares = nearness / nearness.sum(axis=1, keepdims=True)

    def posed(self, nodes: ArrayLike) -> Form:
        """Return the form of a body whose nodes (23, 3) are here."""
        middles, frames = self._framed(np.asarray(nodes, float))
        places = middles + np.einsum("fji,pfj->pfi", frames, self._offsets)
        return self.form.moved(np.einsum("pf,pfi->pi", self._shares, places))

    def _framed(
        self, nodes: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return middles (n, 3) of the faces, and their axes as rows (n, 3, 3)."""
        corners = nodes[self._faces]
        along = corners[:, 1] - corners[:, 0]
        normal = np.cross(along, corners[:, 2] - corners[:, 0])
        across = np.cross(normal, along)
        axes = np.stack([normal, along, across], axis=1)
        return corners.mean(axis=1), axes / np.linalg.norm(axes, axis=2, keepdims=True)


def _triangles(rows: int, columns: int) -> NDArray[np.int64]:
    """Return the triangles of a grid, counterclockwise seen from the left of the fish."""
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    halves = [np.stack([a, b, c], axis=2), np.stack([b, d, c], axis=2)]
    return np.concatenate([one.reshape(-1, 3) for one in halves])
