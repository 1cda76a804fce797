"""Flocks alone: Reynolds' rules on arrays, without a world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector = tuple[float, float, float]


class Flock:
    """A flock by C. W. Reynolds, "Flocks, herds, and schools", SIGGRAPH 1987.

    Separation, velocity matching and centering with inverse-power weights in a sphere, obstacles
    steered round first of all, requests combined by prioritized allocation of a limited
    acceleration, geometric flight with banking.

    Parameters
    ----------
    count
        How many members.
    half
        Half axes of the ellipsoid in which they begin, metres; half sides of a box if `boxed`.
    seed
        Seed of places and headings.
    **parameters
        `body_length` (m), `radius` (body lengths), `exponent`, `separation`, `matching`,
        `centering`, `maximum_speed` (body lengths/s), … Unknown names are refused with the known
        ones.

    Examples
    --------
    >>> flock = Flock(80, half=(8, 8, 8), seed=1, boxed=True)
    >>> flock.step(1 / 30, 300)
    >>> flock.polarization() > 0.95
    True
    """

    def __init__(
        self,
        count: int,
        *,
        half: Vector = (8.0, 8.0, 8.0),
        seed: int = 1,
        boxed: bool = False,
        **parameters: float,
    ) -> None:
        self._engine = _engine.Flock(count, half, seed, parameters, boxed)

    def add_sphere(self, center: Vector, radius: float) -> None:
        """Add a ball to steer round."""
        self._engine.add_sphere(center, radius)

    def add_cylinder(self, base: Vector, top: Vector, radius: float) -> None:
        """Add a cylinder to steer round."""
        self._engine.add_cylinder(base, top, radius)

    def add_box(self, low: Vector, high: Vector) -> None:
        """Add a box to steer round."""
        self._engine.add_box(low, high)

    def add_plane(self, point: Vector, normal: Vector) -> None:
        """Add a wall to turn away from; `normal` points to the free side."""
        self._engine.add_plane(point, normal)

    def migrate_to(self, point: Vector | None) -> None:
        """Set the point towards which all migrate; none for no goal."""
        self._engine.migrate_to(point)

    def stay_within(self, center: Vector, radius: float) -> None:
        """Set the ball to which members return."""
        self._engine.stay_within(center, radius)

    def set(self, **parameters: float) -> None:
        """Set parameters by name."""
        for name, value in parameters.items():
            self._engine.set(name, value)

    def step(self, dt: float, ticks: int = 1) -> None:
        """Update all members `ticks` times by `dt` seconds; the same on any number of threads."""
        self._engine.step(dt, ticks)

    @property
    def positions(self) -> NDArray[np.float32]:
        """Places (n, 3) in metres."""
        return self._engine.positions

    @property
    def velocities(self) -> NDArray[np.float32]:
        """Velocities (n, 3) in m/s."""
        return self._engine.velocities

    @property
    def headings(self) -> NDArray[np.float32]:
        """Unit vectors ahead (n, 3)."""
        return self._engine.headings

    @property
    def ups(self) -> NDArray[np.float32]:
        """Unit vectors up (n, 3), banked in turns."""
        return self._engine.ups

    def polarization(self) -> float:
        """Return the length of the mean heading: 0 (all ways) to 1 (one way)."""
        return self._engine.polarization()

    def nearest(self, reach: float) -> NDArray[np.float32]:
        """Return each member's distance to its nearest neighbor within `reach` metres (n,)."""
        return self._engine.nearest(reach)

    def flockettes(self, link: float) -> int:
        """Return the number of groups whose members are linked by less than `link` metres."""
        return self._engine.flockettes(link)
