"""A tank of still or flowing water with one muscle-driven fish."""

from __future__ import annotations

import math
import operator
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from bioscope import _engine
from bioscope.errors import InvalidValueError
from bioscope.fish.species import Species, asked_species
from bioscope.world.field import Current

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Preset: TypeAlias = Literal["calibrated", "published"]
"""The calibrated body, or the constants that were published."""

_MOST_STEPS = 2**32 - 1


class Tank:
    """One fish of 23 masses, 91 viscoelastic units and 12 muscles in water.

    X. Tu, "Artificial Animals for Computer Animation: Biomechanics, Locomotion, Perception and
    Behavior", 1999, chapter 4. The fish begins at the origin, at rest, looking along +Z, with +X to
    its left and +Y up; it weighs as much as the water that it takes the place of.

    The verbs (`swim`, `turn`, `glide`, `ascend`, …) tell the motor controllers what to do; they act
    together, in every `step`, until told otherwise.

    Parameters
    ----------
    species
        A species by name, or the path of a species file (.toml), for its length and its cruising
        speed.
    preset
        `calibrated`: shape, muscles and water by measurement, so that the fish swims as fishes do.
        `published`: the constants and the water force of the source; its controllers run blindly,
        as there. Or the path of a design file of your own (.toml), made by changing those of
        `crates/organism/bioscope_motion/tables`.
    dt
        Seconds per step; by default that for which the design is calibrated: 0.165 time units, or
        the published 0.055.
    length
        Metres from snout to tail; by default that of the species.
    integrator
        `implicit` (default), `semi_implicit` (the published scheme, which holds in ordinary
        swimming only), `symplectic` or `explicit`.
    water
        Thickness of the medium for skin and fins: 0 is air, 1 water, more is oil.

    Examples
    --------
    >>> tank = Tank("anthias")
    >>> tank.swim(0.1)
    >>> tank.run(5)
    >>> bool(abs(np.linalg.norm(tank.velocity) - 0.1) < 0.02)
    True
    """

    def __init__(
        self,
        species: Species = "anthias",
        preset: Preset | str | PathLike[str] = "calibrated",
        *,
        dt: float | None = None,
        length: float | None = None,
        integrator: str | None = None,
        water: float = 1.0,
    ) -> None:
        if not isinstance(preset, str | PathLike):
            expected = "calibrated, published, or the path of a design file (.toml)"
            raise InvalidValueError(f"preset = {preset!r}: expected {expected}")
        name = fspath(preset)
        design: str | tuple[str, str] = name
        if name.endswith(".toml"):
            design = (name, Path(name).read_text(encoding="utf-8"))
        step = None if dt is None else _finite("dt", dt)
        size = None if length is None else _finite("length", length)
        thickness = _finite("water", water)
        self._engine = _engine.Tank(
            asked_species(species), design, step, size, integrator, thickness
        )
        self._engine.set_feedback(name != "published")

    def step(self, activations: ArrayLike | None = None, steps: int = 1) -> None:
        """Advance by `steps` steps of `dt`.

        With `activations` (12 numbers, 0 at rest to 1 fully contracted) these drive the muscles in
        place of the motor controllers, as fast as muscles can follow. Muscle 4 k + j belongs to
        segment k, from head to tail; j is left top, left bottom, right bottom, right top.

        Raises
        ------
        InvalidValueError
            For other than 12 numbers of 0 to 1, and steps that are no whole number of 0 or more.
        LimitError
            If the body came apart; it has been put back into its shape, at rest.
        """
        if activations is not None:
            activations = _numbers("activations", activations).ravel()
        self._engine.step(activations, _whole("steps", steps))

    def run(self, seconds: float) -> None:
        """Advance by this time, in steps of `dt`, as the motor controllers want."""
        self.step(steps=round(_finite("seconds", seconds, least=0.0) / self.dt))

    def swim(self, speed: float) -> None:
        """Swim ahead at this speed through the water, m/s; the top speed if it is more."""
        self._engine.command(speed=_finite("speed", speed, least=0.0), brake=0.0, backward=0.0)

    def glide(self) -> None:
        """Let the muscles return to rest and coast."""
        self._engine.command(speed=0.0, brake=0.0, backward=0.0)

    def turn(self, angle: float) -> None:
        """Turn by this angle in radians, positive to the left: a fast bend, a slow recovery.

        Angles beyond the steering map are turned in equal parts. `turning` tells whether it goes
        on. The fish should swim: a turn takes its force from the water that passes.
        """
        if abs(_finite("angle", angle)) > 2 * math.pi:
            raise InvalidValueError(f"angle = {angle}: expected radians, -2 pi to 2 pi")
        self._engine.turn(angle)

    def ascend(self, angle: float) -> None:
        """Climb at this angle in radians, 0 to pi/2, by the pectoral fins."""
        self._engine.command(climb=_finite("angle", angle, least=0.0, most=math.pi / 2))

    def descend(self, angle: float) -> None:
        """Dive at this angle in radians, 0 to pi/2, by the pectoral fins."""
        self._engine.command(climb=-_finite("angle", angle, least=0.0, most=math.pi / 2))

    def balance(self) -> None:
        """Keep level and upright by the pectoral fins, as a fish does unless told otherwise."""
        self._engine.command(climb=0.0)

    def brake(self, share: float = 1.0) -> None:
        """Stop the tail and spread the pectoral fins against the water, 0 to 1."""
        share = _finite("share", share, least=0.0, most=1.0)
        self._engine.command(speed=0.0, brake=share, backward=0.0)

    def backward(self, speed: float) -> None:
        """Row backward with the pectoral fins at this speed, m/s."""
        speed = _finite("speed", speed, least=0.0)
        self._engine.command(speed=0.0, brake=0.0, backward=speed)

    def kick(self, velocity: Sequence[float]) -> None:
        """Add this velocity (x, y, z), m/s, to the whole body."""
        self._engine.kick(_velocity(velocity))

    def place(self, *, yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> None:
        """Set the fish down at the origin, at rest, turned by these angles in radians."""
        angles = {"yaw": yaw, "pitch": pitch, "roll": roll}
        self._engine.place(*(_finite(name, angle) for name, angle in angles.items()))

    def deform(self, nodes: ArrayLike) -> None:
        """Put the nodes at these places (23, 3) in metres, at rest."""
        self._engine.deform(_numbers("nodes", nodes))

    def flow(self, velocity: Sequence[float] | Current) -> None:
        """Let the water flow with this velocity (x, y, z), m/s, or as a `bioscope.Current` has it.

        A current is taken at the place of the fish, at the time since the fish was put in.
        """
        if isinstance(velocity, Current):
            self._engine.set_current(velocity._field)
            return
        self._engine.set_flow(_velocity(velocity))

    def feedback(self, watched: bool) -> None:
        """Let the controllers watch heading and speed, or run blindly as in the source."""
        self._engine.set_feedback(watched)

    @property
    def dt(self) -> float:
        """Seconds per step."""
        return self._engine.dt

    @property
    def time_unit(self) -> float:
        """Seconds in a time unit of the source; the published step is 0.055 of it."""
        return self._engine.time_unit

    @property
    def length(self) -> float:
        """Metres from snout to tail."""
        return self._engine.length

    @property
    def mass(self) -> float:
        """Kilograms."""
        return self._engine.mass

    @property
    def cruise(self) -> float:
        """Speed of easy swimming, m/s."""
        return self._engine.speeds[0]

    @property
    def top_speed(self) -> float:
        """Greatest speed, m/s."""
        return self._engine.speeds[1]

    @property
    def nodes(self) -> NDArray[np.float64]:
        """Places (23, 3), metres: snout, five rings of four, upper and lower tip of the tail."""
        return self._engine.nodes

    @property
    def node_velocities(self) -> NDArray[np.float64]:
        """Velocities (23, 3) of the nodes over ground, m/s."""
        return self._engine.node_velocities

    @property
    def center(self) -> NDArray[np.float64]:
        """Center of mass (3,), metres."""
        return self._engine.center

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity (3,) of the center of mass over ground, m/s."""
        return self._engine.velocity

    @property
    def yaw(self) -> float:
        """Heading of the trunk, radians: 0 along +Z, positive to the left."""
        return self._engine.attitude[0]

    @property
    def pitch(self) -> float:
        """Climb of the trunk, radians."""
        return self._engine.attitude[1]

    @property
    def roll(self) -> float:
        """Lean of the trunk to the right, radians."""
        return self._engine.attitude[2]

    @property
    def energy(self) -> float:
        """Kinetic and elastic energy, joules."""
        return self._engine.energy

    @property
    def work(self) -> float:
        """Work that the muscles have done, joules."""
        return self._engine.work

    @property
    def turning(self) -> bool:
        """Whether a turn goes on."""
        return self._engine.turning

    @property
    def fins(self) -> tuple[float, float]:
        """Angles of the left and right pectoral fin, radians: pi/2 is edge-on, pi brakes."""
        left, right = self._engine.fins
        return left, right

    @property
    def contraction(self) -> NDArray[np.float64]:
        """Present contraction (12,) of the muscles, 0 to 1."""
        return self._engine.contraction

    @property
    def masses(self) -> NDArray[np.float64]:
        """Masses (23,) of the nodes, kg."""
        return self._engine.masses

    @property
    def units(self) -> NDArray[np.float64]:
        """The units (91, 5), muscles first.

        Two nodes, rest length (m), stiffness (N/m), damping (N s/m).
        """
        return self._engine.units

    @property
    def faces(self) -> NDArray[np.int64]:
        """Surface triangles (42, 3), counterclockwise from outside."""
        return self._engine.faces

    @property
    def half_bandwidth(self) -> int:
        """Half-bandwidth of the matrices of the body, in nodes."""
        return self._engine.skyline[0]

    @property
    def stored_entries(self) -> int:
        """Entries stored of these matrices, in pairs of nodes."""
        return self._engine.skyline[1]

    @property
    def strokes(self) -> NDArray[np.float64]:
        """The swim table (n, 4): speed (m/s), beats per second, amplitude of both swim segments."""
        return self._engine.strokes

    @property
    def bends(self) -> NDArray[np.float64]:
        """The steering map (n, 3): angle (radians), depth of the bend, time it is held (s)."""
        return self._engine.bends


def _finite(name: str, value: float, *, least: float = -math.inf, most: float = math.inf) -> float:
    """Return the number, or raise if it is none, not finite or out of range."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number) or not least <= number <= most:
        bounds = "" if least == -math.inf else f", {least:g} or more"
        bounds = bounds if most == math.inf else f" of {least:g} to {most:g}"
        raise InvalidValueError(f"{name} = {value!r}: expected a finite number{bounds}")
    return number


def _whole(name: str, value: int) -> int:
    """Return the whole number, or raise."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not 0 <= number <= _MOST_STEPS:
        expected = f"a whole number of 0 to {_MOST_STEPS}"
        raise InvalidValueError(f"{name} = {value!r}: expected {expected}")
    return number


def _numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return the array, or raise."""
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidValueError(f"{name} = {values!r}: expected an array of numbers") from None


def _velocity(velocity: Sequence[float]) -> tuple[float, float, float]:
    """Return the three numbers, or raise."""
    numbers = _numbers("velocity", velocity)
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise InvalidValueError(f"velocity = {velocity!r}: expected three finite numbers")
    x, y, z = numbers.tolist()
    return x, y, z
