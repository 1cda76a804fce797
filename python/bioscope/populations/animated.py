"""Animations of definition files in a world, where they can be watched, filmed and exported."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.world.population import Population

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from bioscope._engine import Publication
    from bioscope.lsystem.animation import Animation

Vector = tuple[float, float, float]


class Animated(Population):
    """Definition files of behavioral L-systems (.lm) that run while the world does.

    An animation depends on its files, its seed and the time alone: these are the state, and after a
    restore the frames are made again.

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
        return Animation(*sources, seed=self.seed)

    def restore(self, values: dict[str, Any]) -> None:
        """Go back to a state; frames are made again when they are asked for."""
        super().restore(values)
        self._animation = None

    def settle(self) -> int:
        """Return 1: all that is drawn is one individual."""
        return 1

    def born(self, ids: NDArray[np.uint32]) -> None:
        """Keep its id."""
        self.ids = ids

    def move(self, dt: float) -> None:
        """Let the time pass."""
        self.elapsed += dt

    def publish(self, scene: Publication) -> None:
        """Show the frame, one mesh per material."""
        for number, (material, mesh) in enumerate(self.animation.frame.meshes(self.stroke)):
            scene.instances(
                f"{self.name} {number}",
                mesh,
                material.surface(),
                ids=self.ids,
                positions=np.array([self.position], np.float32),
                scales=np.array([self.scale], np.float32),
                species=material.name,
                alive=False,
            )
