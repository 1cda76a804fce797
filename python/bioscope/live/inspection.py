"""What the inspector shows of one individual, its retina among it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.live.messages import encode

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene
    from bioscope.live.messages import Select
    from bioscope.senses import View
    from bioscope.world import World

_TRIES = 3
"""How often it is looked again if a tick was made meanwhile."""
_APART = 0.12
"""Distance of the eyes, own body lengths."""


def inspection(world: World, selection: Select) -> bytes:
    """Return the message about one individual; its values are empty if it is no more."""
    individual = selection.id
    for _ in range(_TRIES):
        tick, time = world.tick, world.time
        found = world.inspect(individual)
        if world.tick == tick:
            break
    if found is None:
        return encode(
            "inspection",
            tick=tick,
            time=time,
            id=individual,
            species="",
            population="",
            behavior=None,
            values={},
            traits={},
            percepts={},
            retina=None,
        )
    eye = found.pop("eye")
    retina = None
    if eye is not None:
        # The eye of an actor is within its body, which it does not see.
        scene = world.scene if eye.fisheye else _without(world.scene, individual)
        retina = _retina(scene, _looking(found, eye, selection), selection)
    return encode("inspection", tick=tick, time=time, **found, retina=retina)


def _without(scene: Scene, individual: int) -> Scene:
    from bioscope._engine import Publication

    return Publication().scene(scene, without=[individual])


def _looking(found: dict[str, Any], eye: Camera, selection: Select) -> list[Camera]:
    """Return the eyes as they are turned: one in the middle, or the left and the right one."""
    from bioscope.senses.eye import turned

    apart = _APART * float(found["values"].get("body_length_m", 0.0)) if selection.both else 0.0
    sides = (0.5, -0.5) if selection.both else (0.0,)
    return [turned(eye, selection.pan, selection.tilt, side * apart) for side in sides]


def _retina(scene: Scene, eyes: list[Camera], selection: Select) -> dict[str, Any]:
    from bioscope.senses import View, look

    width, height = selection.retina
    views = [look(scene, eye, (max(1, width // len(eyes)), height)) for eye in eyes]
    view = View(*(np.concatenate(parts, axis=1) for parts in zip(*map(_parts, views), strict=True)))
    height, width = view.depth.shape
    return {
        "width": width,
        "height": height,
        "eyes": len(eyes),
        "color": view.picture(alpha=True).tobytes(),
        "depth": np.ascontiguousarray(view.depth).tobytes(),
        "identity": np.ascontiguousarray(view.identity).tobytes(),
        "field_of_view": eyes[0].field_of_view,
    }


def _parts(view: View) -> tuple[Any, Any, Any]:
    return view.color, view.depth, view.identity
