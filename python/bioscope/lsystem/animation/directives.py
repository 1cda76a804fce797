"""The scene of a frame for an offline renderer, in the words of Rayshade (thesis, appendix C).

Shapes are written as polygons with the colors of their materials; the words of `D` stand where
the symbol stood among them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope.lsystem.animation.frame import Directive, Frame, Piece

if TYPE_CHECKING:
    from bioscope.lsystem.animation.vectors import Pose, Vector
    from bioscope.lsystem.animation.viewing import Camera

PLANE_MODEL = "plane.ray"
"""The included model of an airplane; the thesis names one on its author's machine."""


def directive(mode: int, z: float, growth: Vector, pose: Pose, camera: Camera) -> str | None:
    """Return what a symbol `D` says to the renderer; None if it says nothing.

    Parameters
    ----------
    mode, z, growth
        Its first and third parameter, and its growth values.
    pose
        Of the turtle.
    camera
        Whose place is told to a light.
    """
    a, b, c = (_told(one) for one in growth)
    named = f"obj{_told(growth[0])}"
    if mode in (17, 60):
        model = PLANE_MODEL if mode == 17 else f"actor{round(z)}.ray"
        return f'#include "{model}" {_transform(pose, growth)}'
    words = {
        0: f"grid {a} {b} {c} ",
        1: "end ",
        2: f"plane 0 {a} 0 0 1 0",
        4: f"scale {a} {b} {c}",
        5: "window 0 180 0 144",
        6: f"name {named} list",
        7: f"object {named}",
        8: f"translate {a} {b} {c}",
        9: f"rotate {a} {b} {c}",
        10: "texture marble",
        11: "texture bump",
        12: f"window {_told(z)} {a} {b} {c}",
        13: f"name {named}",
        14: "list ",
        15: "sphere ambient 0.9 0.9 0.9 6000 0 0 0 texture sky 1 0.5 2.0 6 0.85 0.45 "
        f"scale {a} {b} {c}",
        16: "list sphere ambient 0.1 0.25 0.05 1 0 0 0 texture cloud 1 0.5 2 6 0.1 0.9 10.3 "
        "scale 0.5 1 1 end",
        18: f"light 0.5 0.5 0.5 point {_vector(camera.eye)} noshadow",
    }
    return words.get(mode)


def scene(frame: Frame, camera: Camera) -> str:
    """Return a frame as a file of the renderer."""
    width, height = (camera.window[at + 1] - camera.window[at] for at in (0, 2))
    lines = [
        f"screen {max(width, 1)} {max(height, 1)}",
        f"eyep {_vector(camera.eye)}",
        f"lookp {_vector(camera.target)}",
        "up 0 1 0",
        f"fov {_told(camera.angle * camera.aspect)} {_told(camera.angle)}",
    ]
    surfaces = {piece.material for piece in frame.pieces}
    for material in sorted(surfaces, key=lambda one: (one.name, one.diffuse, one.lit)):
        lines.append(
            f"surface {_surface(piece_material=material.name, diffuse=material.diffuse)} "
            f"ambient {_vector(material.ambient)} diffuse {_vector(material.diffuse)}"
        )
    for item in frame.items:
        if isinstance(item, Directive):
            lines.append(item.text)
        elif isinstance(item, Piece):
            name = _surface(piece_material=item.material.name, diffuse=item.material.diffuse)
            lines += [
                f"triangle {name} " + " ".join(_vector(item.corners[at]) for at in triangle)
                for triangle in item.triangles()
            ]
    return "\n".join(lines) + "\n"


def _surface(*, piece_material: str, diffuse: Vector) -> str:
    """Return the name of a material with this color: an animated one differs from its origin."""
    return (
        piece_material + "_" + "".join(f"{round(255 * min(1, max(0, one))):02x}" for one in diffuse)
    )


def _transform(pose: Pose, size: Vector) -> str:
    axes = zip((pose.heading, pose.left, pose.up), size, strict=True)
    rows = " ".join(_vector((x * s, y * s, z * s)) for (x, y, z), s in axes)
    return f"transform {rows} {_vector(pose.position)}"


def _vector(vector: Vector) -> str:
    return " ".join(map(_told, vector))


def _told(number: float) -> str:
    # Adding 0 makes −0 to 0.
    return f"{number + 0.0:.9g}"
