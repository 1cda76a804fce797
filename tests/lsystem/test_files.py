"""The files that belong to cpfg models: read as they are, errors with file and line."""

from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope.lsystem import read_colors

LEAF = """-30 30 0 43 -17 0
CONTACT POINT  X: 0.00 Y: 0.00 Z: 0.00
END POINT  X: 0 Y: 20 Z: 0
HEADING  X: 0.00 Y: 1.00 Z: 0.00
UP  X: 0.0 Y: 0.00 Z: 1.00
SIZE: 40
Leaf_1
TOP COLOR: 0 DIFFUSE: 0.00 BOTTOM COLOR: 0 DIFFUSE: 0.00
AL: ~ A: ~ AR: ~
L: ~ R: ~
BL: ~ B: ~ BR: ~
-5 0 0  -15 10 0  -15 25 0  0 40 0
-2 0 0  -6 10 0  -6 25 0  0 40 0
2 0 0  6 10 0  6 25 0  0 40 0
5 0 0  15 10 0  15 25 0  0 40 0
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Return a folder with a view and what it names."""
    (tmp_path / "leaf.s").write_text(LEAF)
    (tmp_path / "star.con").write_text("4 2 closed\n1 0\n0 1\n-1 0\n0 -1\n")
    (tmp_path / "bend.func").write_text(
        "fver 1 1\nname: bend\nsamples: 50\nflip: off\npoints: 4\n"
        "0 0.2 1\n0.3 0.4\n0.6 0.8 1\n1 1\n"
    )
    (tmp_path / "plant.v").write_text(
        "angle factor: 8\ninitial color: 5\ninitial line width: 0.2 /* metres */\n"
        "line style: cylinder\ncontour sides: 16\nsurface: l leaf.s 2\ncontour: 3 star.con\n"
        "function: bend.func 100\ntropism: T: 0,-1,0 E: 0.1\nviewpoint: 1,-60,0\n"
        "sparkle: on\nbox: x: 0,1 y: 0,1 z: 0,1\nsurface: m missing.s 1\n"
    )
    return tmp_path


def test_a_view_sets_the_turtle_and_names_what_it_does_not_know(model: Path):
    view = bio.ViewFile(model / "plant.v")
    assert view.sides == 16
    assert (view.surfaces, view.contours) == (["l"], [3])
    assert view.function(1, 0.0) == pytest.approx(0.2, abs=2e-3)
    assert view.function(2, 0.0) is None
    unknown, missing = view.warnings
    assert f"{model}/plant.v:11:1: unknown view command" in unknown
    assert "plant.v:13:1: cannot read missing.s" in missing


def test_surfaces_and_contours_are_drawn(model: Path):
    view = bio.ViewFile(model / "plant.v")
    word = "lsystem: x\naxiom: ~l;(7)F(1)\nZ --> Z\nendlsystem\n"
    drawn = bio.Turtle(view).interpret(bio.LSystem(word).derive(steps=0))
    # The leaf is two high, and the turtle goes on from its end, one ahead.
    assert np.allclose(drawn.segments.start[0], (0, 1, 0), atol=1e-6)
    assert drawn.segments.color.tolist() == [7]
    leaf = drawn.mesh().positions
    assert leaf[:, 1].max() == pytest.approx(2.0 + 0.0, abs=0.15)
    contour = "lsystem: x\naxiom: !(2)@#(3)F(3)\nZ --> Z\nendlsystem\n"
    mesh = bio.Turtle(view).interpret(bio.LSystem(contour).derive(steps=0)).mesh(sides=16)
    radii = np.linalg.norm(mesh.positions[:, [0, 2]], axis=1)
    assert radii.max() == pytest.approx(2 / 3, rel=0.02), "a B-spline stays inside its points"
    assert np.isfinite(mesh.normals).all()


def test_files_outside_the_folder_are_not_read(model: Path):
    (model / "inner").mkdir()
    inner = model / "inner" / "a.v"
    inner.write_text("surface: l ../leaf.s 2\nsurface: m /etc/passwd 1\n")
    assert all("outside the folder" in one for one in bio.ViewFile(inner).warnings)


def test_color_maps_become_linear(tmp_path: Path):
    levels = np.arange(256, dtype=np.uint8)
    path = tmp_path / "a.map"
    path.write_bytes(np.stack([levels] * 3, axis=1).tobytes())
    colors = np.array(read_colors(path))
    assert colors.shape == (256, 3)
    assert colors[128, 0] == pytest.approx(0.2158, abs=1e-3)
    path.write_bytes(b"short")
    with pytest.raises(bio.BioscopeError, match=r"a\.map: a color map has 768 bytes"):
        read_colors(path)


@pytest.mark.parametrize("seed", range(20))
def test_any_bytes_are_survived(tmp_path: Path, seed: int):
    random = np.random.default_rng(seed)
    pieces = [
        "surface: l x.s 1\n",
        "contour: 1 x.con\n",
        "function: x.func 9\n",
        "box: x:",
        "0,0,0",
    ]
    noise = bytes(random.integers(0, 256, 200, dtype=np.uint8))
    for name in ("x.s", "x.con", "x.func"):
        (tmp_path / name).write_bytes(bytes(random.integers(0, 256, 300, dtype=np.uint8)))
    text = "".join(random.choice(pieces, 12)).encode()
    (tmp_path / "x.v").write_bytes(text + noise + text)
    assert bio.ViewFile(tmp_path / "x.v").sides >= 3
