"""Surfaces of control points: rational B-splines in two directions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import InvalidValueError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def even_knots(count: int, degree: int) -> NDArray[np.float64]:
    """Return knots (count + degree + 1,) from 0 to 1: even inside, with both ends held."""
    inside = np.linspace(0.0, 1.0, count - degree + 1)
    return np.concatenate([np.zeros(degree), inside, np.ones(degree)])


def basis(knots: NDArray[np.float64], degree: int, at: ArrayLike) -> NDArray[np.float64]:
    """Return the weights (len(at), n) of n control points at some parameters (Cox and de Boor).

    Parameters
    ----------
    knots
        n + degree + 1 numbers that do not fall.
    degree
        Of the pieces.
    at
        Parameters from `knots[degree]` to `knots[n]`.
    """
    count = len(knots) - degree - 1
    at = np.atleast_1d(np.asarray(at, float))
    span = np.clip(np.searchsorted(knots, at, side="right") - 1, degree, count - 1)
    weights = np.zeros((len(at), len(knots) - 1))
    weights[np.arange(len(at)), span] = 1.0
    for order in range(1, degree + 1):
        last = len(knots) - 1 - order
        rising = at[:, None] - knots[:last]
        falling = knots[order + 1 : order + 1 + last] - at[:, None]
        before = knots[order : order + last] - knots[:last]
        after = knots[order + 1 : order + 1 + last] - knots[1 : 1 + last]
        # Where knots coincide, the term is absent.
        left = np.where(before > 0, rising / np.where(before > 0, before, 1.0), 0.0)
        right = np.where(after > 0, falling / np.where(after > 0, after, 1.0), 0.0)
        weights = left * weights[:, :last] + right * weights[:, 1 : 1 + last]
    return weights


class Nurbs:
    """A surface of control points, a rational B-spline in either direction.

    L. Piegl & W. Tiller, "The NURBS Book", 1997, section 4.4.

    Parameters
    ----------
    points
        Control points (rows, columns, dimensions).
    degrees
        Down the rows and along the columns.
    knots
        For rows and columns; even ones with held ends if not given.
    weights
        Of the control points (rows, columns); all the same if not given.

    Raises
    ------
    InvalidValueError
        For arrays that do not fit together, or numbers that are not finite.

    Examples
    --------
    >>> flat = np.stack(np.meshgrid([0.0, 1, 2], [0.0, 1, 2, 3], indexing="ij"), axis=2)
    >>> surface = Nurbs(flat, degrees=(2, 3))
    >>> surface.at([0.5], [1.0])[0, 0].tolist()
    [1.0, 3.0]
    """

    def __init__(
        self,
        points: ArrayLike,
        degrees: tuple[int, int] = (3, 3),
        knots: tuple[ArrayLike, ArrayLike] | None = None,
        weights: ArrayLike | None = None,
    ) -> None:
        self.points = np.array(points, float)
        self.degrees = degrees
        shape = self.points.shape[:2]
        if self.points.ndim != 3 or any(
            count <= degree or degree < 1 for count, degree in zip(shape, degrees, strict=True)
        ):
            raise InvalidValueError(
                f"points {self.points.shape}: expected (rows, columns, dimensions), more of rows "
                f"and columns than the degrees {degrees}"
            )
        if knots is None:
            knots = (even_knots(shape[0], degrees[0]), even_knots(shape[1], degrees[1]))
        self.knots = (np.asarray(knots[0], float), np.asarray(knots[1], float))
        for axis in (0, 1):
            one, wanted = self.knots[axis], shape[axis] + degrees[axis] + 1
            if one.shape != (wanted,) or not (np.diff(one) >= 0).all():
                raise InvalidValueError(f"knots: expected {wanted} numbers that do not fall")
        self.weights = np.ones(shape) if weights is None else np.array(weights, float)
        if self.weights.shape != shape or not (self.weights > 0).all():
            raise InvalidValueError(f"weights: expected {shape} numbers above 0")
        if not np.isfinite(self.points).all():
            raise InvalidValueError("points: expected finite numbers")

    def moved(self, points: ArrayLike) -> Nurbs:
        """Return the same surface with other control points."""
        return Nurbs(points, self.degrees, self.knots, self.weights)

    def domain(self, axis: int) -> tuple[float, float]:
        """Return the least and greatest parameter down the rows (0) or along the columns (1)."""
        degree, knots = self.degrees[axis], self.knots[axis]
        return float(knots[degree]), float(knots[-degree - 1])

    def at(self, rows: ArrayLike, columns: ArrayLike) -> NDArray[np.float64]:
        """Return the points (len(rows), len(columns), dimensions) of a grid of parameters."""
        down = basis(self.knots[0], self.degrees[0], rows)
        along = basis(self.knots[1], self.degrees[1], columns)
        whole = np.einsum("ai,bj,ijd->abd", down, along, self.points * self.weights[..., None])
        share = down @ self.weights @ along.T
        return np.asarray(whole / share[..., None])

    def grid(self, rows: int, columns: int) -> NDArray[np.float64]:
        """Return an even grid of points (rows, columns, dimensions) over the whole surface."""
        return self.at(np.linspace(*self.domain(0), rows), np.linspace(*self.domain(1), columns))


def through(points: ArrayLike, degrees: tuple[int, int] = (3, 3)) -> Nurbs:
    """Return the surface that passes through all these points (rows, columns, dimensions)."""
    points = np.asarray(points, float)
    for axis, degree in enumerate(degrees):
        count = points.shape[axis]
        knots = even_knots(count, degree)
        # Greville's abscissae: where each control point has most to say.
        places = np.array([knots[one + 1 : one + degree + 1].mean() for one in range(count)])
        solved = np.linalg.solve(
            basis(knots, degree, places), np.moveaxis(points, axis, 0).reshape(count, -1)
        )
        shape = np.moveaxis(points, axis, 0).shape
        points = np.moveaxis(solved.reshape(shape), 0, axis)
    return Nurbs(points, degrees)
