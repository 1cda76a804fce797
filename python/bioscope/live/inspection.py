"""What the inspector shows of one individual, its retina among it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.live.messages import encode

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene
    from bioscope.world import World


def inspection(world: World, individual: int, size: tuple[int, int]) -> bytes:
    """Return the message about one individual; its values are empty if it is no more."""
    found = world.inspect(individual)
    if found is None:
        return encode(
            "inspection",
            id=individual,
            species="",
            population="",
            behavior=None,
            values={},
            percepts={},
            retina=None,
        )
    eye = found.pop("eye")
    retina = None if eye is None else _retina(world.scene, eye, size)
    return encode("inspection", **found, retina=retina)


def _retina(scene: Scene, eye: Camera, size: tuple[int, int]) -> dict[str, Any]:
    from bioscope.senses import look

    view = look(scene, eye, size)
    return {
        "width": size[0],
        "height": size[1],
        "color": view.picture(alpha=True).tobytes(),
        "depth": np.ascontiguousarray(view.depth).tobytes(),
        "identity": np.ascontiguousarray(view.identity).tobytes(),
        "field_of_view": eye.field_of_view,
    }
