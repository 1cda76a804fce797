"""Animations of definition files in a world, where they can be watched, filmed and exported."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.world.population import Population

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike

    from numpy.typing import NDArray

    from bioscope._engine import Publication
    from bioscope._engine import View as WorldView
    from bioscope.lsystem.animation import Animation

Vector = tuple[float, float, float]


class Animated(Population):
    """Definition files of behavioral L-systems (.lm) that run while the world does.

    An animation depends on its files, its seed, the time, and what its actors see of the world:
    these are the state, and after a restore the frames are made again. All that it draws is one
    individual, but the bodies of its actors (`NBR_actors`), each of which is one of its own.

    Parameters
    ----------
    *files
        Definition files; those that they name are in their folders.
    seed
        Of what is chance; the first file's if not given.
    position
        Where the origin of the model stands, metres.
    scale
        Metres per unit of the model.
    stroke
        Thickness of strokes (`R`, `S`), in units of the model.
    """

    transient: ClassVar[tuple[str, ...]] = ("_animation",)

    def __init__(
        self,
        *files: str | PathLike[str],
        seed: int | None = None,
        position: Vector = (0.0, 0.0, 0.0),
        scale: float = 1.0,
        stroke: float = 0.02,
    ) -> None:
        if not scale > 0:
            raise InvalidValueError(f"scale = {scale}: expected more than 0")
        self.sources = [
            (Path(one).read_text("utf-8", "replace"), str(one), str(Path(one).parent))
            for one in files
        ]
        self.seed, self.position, self.scale, self.stroke = seed, position, scale, stroke
        self.elapsed = 0.0
        self.seen: NDArray[np.float64] | None = None
        self.ids: NDArray[np.uint32] = np.empty(0, np.uint32)
        self._animation: Animation | None = self._started()

    @property
    def animation(self) -> Animation:
        """The animation, at the frame of the present time."""
        animation = self._animation
        wanted = int(self.elapsed / animation.interval + 1e-6) if animation is not None else 0
        if animation is None or animation.frame.number > wanted:
            animation = self._animation = self._started()
            wanted = int(self.elapsed / animation.interval + 1e-6)
        while animation.frame.number < wanted:
            animation.advance()
        return animation

    def _started(self) -> Animation:
        # Imported when needed: most worlds have no animation.
        from bioscope.lsystem.animation import Animation, Source

        sources = [Source(text, name, Path(folder)) for text, name, folder in self.sources]
        return Animation(*sources, seed=self.seed, stroke=self.stroke, kept=self.seen)

    def restore(self, values: dict[str, Any]) -> None:
        """Go back to a state; frames are made again when they are asked for."""
        super().restore(values)
        self._animation = None

    def settle(self) -> int:
        """Return how many individuals there are: what is drawn, and every actor that sees."""
        return 1 + len(self.animation.windows)

    def born(self, ids: NDArray[np.uint32]) -> None:
        """Keep their ids."""
        self.ids = ids

    def sense(self, view: WorldView) -> None:
        """Let actors see the world around."""
        from bioscope.lsystem.animation import Surroundings

        eyes = self.animation.eyes
        if eyes.windows:
            without = tuple(self.ids.tolist())
            eyes.surroundings = Surroundings(view.scene, self.position, self.scale, without)

    def move(self, dt: float) -> None:
        """Let the time pass."""
        self.elapsed += dt
        eyes = self.animation.eyes
        if eyes.windows:
            self.seen = eyes.kept

    def publish(self, scene: Publication) -> None:
        """Show the frame, one mesh per material and body."""
        bodies = dict(zip(self.animation.windows, self.ids[1:], strict=True))
        for number, (material, mesh, body) in enumerate(self.animation.parts()):
            one = self.ids[0] if body is None else bodies.get(body, self.ids[0])
            scene.instances(
                f"{self.name} {number}",
                mesh,
                material.surface(),
                ids=np.array([one], np.uint32),
                positions=np.array([self.position], np.float32),
                scales=np.array([self.scale], np.float32),
                species=material.name,
                alive=body in bodies,
            )

    def inspect(self, individual: int) -> Mapping[str, Any] | None:
        """Return what an actor is about, and its eye."""
        animation = self.animation
        for number, one in zip(animation.windows, self.ids[1:], strict=True):
            if one == individual:
                actor, seen = animation.actors[number], animation.eyes.sightings[number]
                return {
                    "actor": number,
                    "automaton": -1 if actor.automaton is None else actor.automaton,
                    "state": actor.state,
                    "distance": seen.distance,
                    "obstacle": seen.obstacle,
                    "interest": seen.interest,
                    "color_of_interest": -1.0 if seen.found is None else 1.0,
                    "position": [*actor.position],
                    "eye": animation.eyes.camera(animation.windows[number]),
                }
        return None
