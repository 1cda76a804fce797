"""The camera of the user's window, and what the symbol `l` does to it (thesis, appendix C).

Device and voice move it too: a device with six degrees of freedom, and the words of section 6.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bioscope._engine import Camera as Eye
from bioscope._engine import cosine, sine
from bioscope.lsystem.animation.vectors import (
    UP,
    ZERO,
    Vector,
    add,
    around,
    cross,
    dot,
    subtract,
    times,
    unit,
)

if TYPE_CHECKING:
    from bioscope.lsystem.definition.grammar import Definition

STRONGER = 1.5
"""Factor by which buttons and words change how fast the camera moves and turns."""
STEP, TURN = 1.0, 5.0
"""Units by which a word moves the camera each frame, and degrees by which it turns it."""


@dataclass(frozen=True, slots=True)
class Device:
    """What a device with six degrees of freedom says in one frame."""

    translation: Vector = ZERO
    """To the right, up, and ahead, in units of the model."""
    rotation: Vector = ZERO
    """Nose up, to the left, and rolled to the right, degrees."""
    buttons: frozenset[int] = frozenset()
    """1, 2: move more, less; 3, 4: turn more, less; 7, 8: height free, locked."""


@dataclass(slots=True)
class Camera:
    """A perspective camera."""

    eye: Vector = (0.0, 15.0, 130.0)
    target: Vector = (0.0, 15.0, 0.0)
    angle: float = 50.0
    """Vertical, degrees."""
    aspect: float = 1.25
    """Width by height."""
    twist: float = 0.0
    """Degrees by which it is turned to the right about its line of sight."""
    near: float = 1.0
    far: float = 10000.0
    window: tuple[int, int, int, int] = (0, 721, 0, 576)
    """Left, right, bottom and top of the window on the screen, pixels."""
    pace: float = 1.0
    """Factor of translations."""
    agility: float = 1.0
    """Factor of rotations."""
    locked: bool = False
    """Whether its height stays."""
    going: str = ""
    """The word that still moves it."""

    @classmethod
    def of(cls, definition: Definition) -> Camera:
        """Return the camera that a file begins with."""
        told = definition.camera
        camera = cls()
        eye, target = told.get("observer", camera.eye), told.get("lookatPoint", camera.target)
        camera.eye, camera.target = _vector(eye), _vector(target)
        camera.angle = told.get("viewAngle", [camera.angle * 10])[0] / 10
        for name, values in told.items():
            if name in ("aspect", "twist", "near", "far"):
                setattr(camera, name, values[0])
        camera.aspect = told.get("aspectRatio", [camera.aspect])[0]
        window = told.get("prefpos_x1_x2_y1_y2") or told.get("pref_pos_x1_x2_y1_y2")
        if window:
            left, right, bottom, top = (int(one) for one in window)
            camera.window = left, right, bottom, top
        return camera

    def axes(self) -> tuple[Vector, Vector, Vector]:
        """Return what is right, up and ahead in the picture."""
        ahead = unit(subtract(self.target, self.eye)) or (0.0, 0.0, -1.0)
        right = unit(cross(ahead, UP)) or (1.0, 0.0, 0.0)
        right = around(right, ahead, math.radians(self.twist))
        return right, cross(right, ahead), ahead

    def project(self, point: Vector) -> tuple[float, float] | None:
        """Return where a point is in the picture; None behind the near or far clipping plane.

        Returns
        -------
        tuple
            To the right and up, −1 to 1 from edge to edge.
        """
        right, up, ahead = self.axes()
        way = subtract(point, self.eye)
        deep = dot(way, ahead)
        if not self.near <= deep <= self.far:
            return None
        half = math.radians(self.angle) / 2
        scale = cosine(half) / (sine(half) * deep)
        return dot(way, right) * scale / self.aspect, dot(way, up) * scale

    def view(self) -> Eye:
        """Return it as a camera of the engine, which looks along −Z."""
        right, up, ahead = self.axes()
        turned = np.array([right, up, times(ahead, -1.0)]).T
        field_of_view = math.radians(min(max(self.angle, 0.01), 179.0))
        return Eye(
            self.eye, _quaternion(turned), field_of_view, near=max(self.near, 1e-6), far=self.far
        )

    def follow(self, device: Device) -> None:
        """Move and turn as a device says."""
        for button, factor in ((1, STRONGER), (2, 1 / STRONGER)):
            self.pace *= factor if button in device.buttons else 1.0
        for button, factor in ((3, STRONGER), (4, 1 / STRONGER)):
            self.agility *= factor if button in device.buttons else 1.0
        if device.buttons & {7, 8}:
            self.locked = 8 in device.buttons
        self.move(times(device.translation, self.pace))
        pitch, yaw, roll = times(device.rotation, self.agility)
        self.turn(yaw, pitch)
        self.twist += roll

    def hear(self, words: list[str]) -> None:
        """Obey spoken commands; moving and turning goes on until `stop`."""
        for word in words:
            if word in _FACTORS:
                name, factor = _FACTORS[word]
                setattr(self, name, getattr(self, name) * factor)
            elif word in ("block", "free it"):
                self.locked = word == "block"
            elif word == "stop":
                self.going = ""
            elif word in VOICE:
                self.going = word
        if self.going in _MOVES:
            self.move(times(_MOVES[self.going], STEP * self.pace))
        elif self.going in _TURNS:
            yaw, pitch = _TURNS[self.going]
            self.turn(yaw * TURN * self.agility, pitch * TURN * self.agility)

    def move(self, way: Vector) -> None:
        """Move to the right, up and ahead, and look at what is as far away as before."""
        right, up, ahead = self.axes()
        shift = add(add(times(right, way[0]), times(up, way[1])), times(ahead, way[2]))
        if self.locked:
            shift = shift[0], 0.0, shift[2]
        self.eye, self.target = add(self.eye, shift), add(self.target, shift)

    def turn(self, yaw: float, pitch: float) -> None:
        """Turn to the left about the vertical, then nose up; degrees."""
        way = around(subtract(self.target, self.eye), UP, math.radians(yaw))
        right = unit(cross(way, UP)) or (1.0, 0.0, 0.0)
        way = around(way, right, math.radians(pitch))
        self.target = add(self.eye, way)


_FACTORS = {
    "faster": ("pace", STRONGER),
    "slow down": ("pace", 1 / STRONGER),
    "turn faster": ("agility", STRONGER),
    "turn less": ("agility", 1 / STRONGER),
}
_MOVES: dict[str, Vector] = {
    "move right": (1.0, 0.0, 0.0),
    "move left": (-1.0, 0.0, 0.0),
    "move up": (0.0, 1.0, 0.0),
    "move down": (0.0, -1.0, 0.0),
    "move": (0.0, 0.0, 1.0),
    "go back": (0.0, 0.0, -1.0),
}
_TURNS = {
    "turn left": (1.0, 0.0),
    "turn right": (-1.0, 0.0),
    "turn up": (0.0, 1.0),
    "turn down": (0.0, -1.0),
}
VOICE = frozenset([*_FACTORS, *_MOVES, *_TURNS, "block", "free it", "stop"])
"""Spoken commands to the camera."""


@dataclass(slots=True)
class Light:
    """A light of the scene."""

    position: Vector = field(default=(0.0, 1000.0, 0.0))


def _vector(values: list[float] | Vector) -> Vector:
    x, y, z = values
    return x, y, z


def _quaternion(matrix: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vector4:
    """Return a rotation matrix as a unit quaternion x, y, z, w."""
    # Each row of this symmetric matrix is a multiple of the quaternion: the longest is taken.
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    rows = [
        (1 + a - e - i, b + d, c + g, h - f),
        (b + d, 1 - a + e - i, f + h, c - g),
        (c + g, f + h, 1 - a - e + i, d - b),
        (h - f, c - g, d - b, 1 + a + e + i),
    ]
    x, y, z, w = max(rows, key=lambda row: sum(one * one for one in row))
    size = math.sqrt(x * x + y * y + z * z + w * w)
    return x / size, y / size, z / size, w / size


if TYPE_CHECKING:
    Vector4 = tuple[float, float, float, float]
