"""Actors that see: their windows are drawn once per frame, and rules ask what is found there.

H. Noser, EPFL thesis 1609 (1997), section 3.1 and table B5, `?30` to `?33` and `?36` to `?39`. What
a rule is answered is what the actor saw when the last frame was complete: it knows only the past.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bioscope._engine import Publication, Rasterizer
from bioscope.lsystem.animation.automata import Actor
from bioscope.lsystem.animation.vectors import add, times
from bioscope.lsystem.animation.viewing import Camera
from bioscope.lsystem.animation.window import Code, Window

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from bioscope._engine import Camera as Eye
    from bioscope._engine import Scene
    from bioscope.lsystem.animation.meshes import Part
    from bioscope.lsystem.animation.options import WindowSize
    from bioscope.lsystem.animation.vectors import Vector

FIRST = 0x8000_0000
"""Identity of the first part of an animation in the scenes of its actors, above all of a world."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The world that an animation lives in."""

    scene: Scene
    position: Vector = (0.0, 0.0, 0.0)
    """Where the origin of the model is, metres."""
    scale: float = 1.0
    """Metres per unit of the model."""
    without: tuple[int, ...] = ()
    """Individuals that are the animation itself."""


class Sighting(NamedTuple):
    """What an actor found in its window."""

    distance: float
    """Of what is in the middle, units of the model."""
    obstacle: float
    """0 for none ahead, −1 to the left, 1 to the right."""
    interest: float
    """1 if a thing of interest is seen, else −1."""
    found: Vector | None
    """Where what has the color of interest is, if it is seen."""

    @property
    def numbers(self) -> list[float]:
        """As numbers, to be kept."""
        return [*self[:3], *(self.found or (math.nan,) * 3)]

    @classmethod
    def of(cls, numbers: Sequence[float]) -> Sighting:
        """Return what was kept."""
        distance, obstacle, interest, x, y, z = (float(one) for one in numbers)
        return cls(distance, obstacle, interest, None if math.isnan(x) else (x, y, z))


class Eyes:
    """The eyes of all actors of an animation.

    Parameters
    ----------
    sizes
        How finely which actors see.
    kept
        Sightings that were seen before, per frame and actor, which are not looked for again.
    """

    def __init__(
        self, sizes: Mapping[int, WindowSize], kept: NDArray[np.float64] | None = None
    ) -> None:
        self.windows = {actor: Window(*size) for actor, size in sorted(sizes.items())}
        self.sightings: dict[int, Sighting] = {}
        self.surroundings: Surroundings | None = None
        """The world around the animation, which is seen too."""
        width = len(Sighting(0, 0, 0, None).numbers)
        self.kept = np.empty((0, len(self.windows), width)) if kept is None else kept
        """What was seen in a world, from frame 1 on (frames, actors, 6)."""
        self._rasterizer = Rasterizer()

    def look(self, number: int, parts: Sequence[Part], actors: Mapping[int, Actor]) -> None:
        """Let all actors look at a frame.

        Parameters
        ----------
        number
            Of the frame.
        parts
            What it shows.
        actors
            Where they are, and what interests them.
        """
        for index, window in self.windows.items():
            window.camera = eye_of(actors[index])
        if 0 < number <= len(self.kept):
            rows = zip(self.windows, self.kept[number - 1], strict=True)
            self.sightings = {actor: Sighting.of(row.tolist()) for actor, row in rows}
            return
        shared: Scene | None = None
        for index, window in self.windows.items():
            actor = actors[index]
            hidden = any(part.body == index for part in parts)
            if hidden or shared is None:
                scene = self._scene(parts, index)
                shared = shared if hidden else scene
            else:
                scene = shared
            self._show(window, actor, scene, parts)
            self.sightings[index] = sighted(window, actor)
        if number > 0 and self.surroundings is not None:
            row = [self.sightings[index].numbers for index in self.windows]
            self.kept = np.concatenate([self.kept, np.array([row])])

    def _scene(self, parts: Sequence[Part], actor: int) -> Scene:
        """Return what an actor may see: all but its own body."""
        shown = Publication()
        around = self.surroundings
        place = np.array([around.position if around else (0.0, 0.0, 0.0)], np.float32)
        scale = np.array([around.scale if around else 1.0], np.float32)
        for index, part in enumerate(parts):
            if part.body != actor:
                shown.instances(
                    str(index),
                    part.mesh,
                    part.material.surface(),
                    ids=np.array([FIRST + index], np.uint32),
                    positions=place,
                    scales=scale,
                )
        if around is None:
            return shown.scene()
        return shown.scene(around.scene, without=list(around.without))

    def _show(self, window: Window, actor: Actor, scene: Scene, parts: Sequence[Part]) -> None:
        """Fill a window with what its actor sees."""
        scale = self.surroundings.scale if self.surroundings else 1.0
        (seen,) = self._rasterizer.look(scene, [self.camera(window)], window.edge, window.edge)
        color, depth, ids = seen
        window.color, window.depth = color.copy(), np.asarray(depth / np.float32(scale), np.float32)
        found, inverse = np.unique(ids, return_inverse=True)
        codes = _codes(found, parts, scene)
        window.codes = _told_apart(codes, actor, window.most)
        numbers = {code: index for index, code in enumerate(window.codes, 1)}
        coded = [numbers.get(code, 0) if code is not None else 0 for code in codes]
        window.identity = np.array(coded, np.uint32)[inverse].reshape(ids.shape)
        for index, part in enumerate(parts):
            if not part.material.lit:
                window.color[ids == FIRST + index] = part.material.diffuse

    def camera(self, window: Window) -> Eye:
        """Return the eye of a window as a camera of the world around."""
        around = self.surroundings
        if around is None:
            return window.camera.view()
        camera = window.camera
        eye = add(around.position, times(camera.eye, around.scale))
        placed = Camera(
            eye,
            add(eye, camera.axes()[2]),
            camera.angle,
            camera.aspect,
            near=camera.near * around.scale,
            far=camera.far * around.scale,
        )
        return placed.view()

    def senses(
        self, actor: Callable[[int], Actor], remark: Callable[[str], None]
    ) -> dict[str, Callable[[int], float]]:
        """Return what rules can ask, by name, as functions of the number of the actor."""

        def sighting(number: int) -> Sighting:
            if number not in self.windows:
                remark(f"actor {number} has no eye: 'NBR_actors' does not declare it")
            return self.sightings.get(number, BLIND)

        def said(yes: object) -> float:
            return 1.0 if yes else -1.0

        def go_for(number: int) -> float:
            found = sighting(number).found
            if found is not None:
                actor(number).set_local_goal(1, found)
            return said(found)

        return {
            "distance": lambda number: sighting(number).distance,
            "obstacle": lambda number: sighting(number).obstacle,
            "looks_at_goal": lambda number: said(actor(number).looks_at_goal),
            "near_goal": lambda number: said(actor(number).is_at_goal),
            "interest": lambda number: sighting(number).interest,
            "color_of_interest": lambda number: said(sighting(number).found),
            "color_of_interest_as_goal": go_for,
            "at_goal": lambda number: said(actor(number).is_at_goal),
        }


def eye_of(actor: Actor) -> Camera:
    """Return the eye of an actor: its window is square, its left horizontal."""
    near, far = actor.vision_range
    target = add(actor.position, actor.heading)
    return Camera(actor.position, target, actor.angle, 1.0, near=near, far=far)


def sighted(window: Window, actor: Actor) -> Sighting:
    """Return what an actor finds in its window."""
    things = window.showing(names=actor.things)
    colored = window.showing(color=actor.color_of_interest)
    return Sighting(
        window.distance,
        window.obstacle(actor.size, actor.reach),
        1.0 if things.any() else -1.0,
        window.center(colored),
    )


BLIND = Sighting(Actor().vision_range[1], 0.0, -1.0, None)
"""What is found before the first look, or without an eye."""


def _codes(ids: NDArray[np.uint32], parts: Sequence[Part], scene: Scene) -> list[Code | None]:
    """Return what identities of the scene are recognized by; 0 is nothing."""
    found: dict[int, Code] = {}
    others = {int(one) for one in ids if 0 < one < FIRST}
    for batch in scene.batches if others else ():
        seen = others.intersection(batch.ids.tolist())
        red, green, blue = (round(255 * min(1.0, max(0.0, one))) for one in batch.material.color)
        found.update(dict.fromkeys(seen, Code(batch.species, (red, green, blue))))
    for one in ids.tolist():
        if one >= FIRST:
            material = parts[one - FIRST].material
            found[one] = Code(material.name, material.written)
    return [found.get(one) for one in ids.tolist()]


def _told_apart(codes: Sequence[Code | None], actor: Actor, most: int) -> list[Code]:
    """Return what an actor recognizes: what interests it, then what was drawn first."""
    seen = dict.fromkeys(code for code in codes if code is not None)

    def indifferent(code: Code) -> bool:
        return not (code.name in actor.things or code.color == actor.color_of_interest)

    return sorted(seen, key=indifferent)[:most]
