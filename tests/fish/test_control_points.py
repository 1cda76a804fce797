"""Bodies of control points: halves that meet, fins on the edge, a picture that becomes a fish."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import InvalidValueError
from bioscope.fish.nurbs import even_knots, through

SIZE = (640, 420)


def fitted():
    """Return a mesh as `bioscope contour` fits it to an oval fish with a pointed snout."""
    down, along = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 21), indexing="ij")
    across = along * np.sqrt(1 - 0.5 * down**2)
    high = down * np.sqrt(1 - 0.5 * along**2) * (1 - 0.25 * along)
    return np.stack([0.5 + 0.36 * across, 0.5 + 0.3 * high], axis=2)


@pytest.fixture(scope="module")
def tank():
    return bio.fish.Tank("anthias", length=0.3)


@pytest.fixture(scope="module")
def form(tank):
    return bio.fish.Form.of_picture(fitted(), SIZE, length=tank.length, snout=tank.nodes[0])


@pytest.fixture(scope="module")
def swimming(tank, form):
    """Return the form in some moments of swimming and turning, with the body's bend in each."""
    skin = bio.fish.Skin(form, tank.nodes, tank.faces)
    forms = []
    tank.swim(0.5)
    for moment in range(40):
        if moment == 25:
            tank.turn(0.8)
        tank.run(0.07)
        forms.append(skin.posed(tank.nodes))
    return forms


def test_a_surface_of_few_points_is_what_the_textbook_says():
    # A quarter of a cylinder, exactly: Piegl and Tiller, example 7.2 (weights 1, 1/sqrt 2, 1).
    arc = np.array([[1.0, 0, 0], [1, 1, 0], [0, 1, 0]])
    points = np.stack([arc, arc + np.array([0, 0, 2])], axis=1)
    weights = np.repeat(np.array([[1], [np.sqrt(0.5)], [1]]), 2, axis=1)
    quarter = bio.fish.Nurbs(points, (2, 1), weights=weights)
    grid = quarter.grid(31, 5)
    assert np.allclose(np.hypot(grid[..., 0], grid[..., 1]), 1, atol=1e-12)
    assert np.allclose(grid[:, :, 2], np.linspace(0, 2, 5))
    with pytest.raises(InvalidValueError, match="degrees"):
        bio.fish.Nurbs(points, (3, 1))
    with pytest.raises(InvalidValueError, match="weights"):
        bio.fish.Nurbs(points, (2, 1), weights=0 * weights)


def test_a_surface_can_be_led_through_points():
    points = np.random.default_rng(3).normal(size=(9, 21, 3))
    surface = through(points)
    places = [
        [even_knots(count, 3)[one + 1 : one + 4].mean() for one in range(count)]
        for count in (9, 21)
    ]
    assert np.allclose(surface.at(*places), points, atol=1e-9)


@pytest.mark.capability("TF-050")
def test_the_halves_of_a_body_meet_without_gap(form, swimming):
    assert form.left.points.shape == form.right.points.shape == (9, 21, 3)
    assert form.left.degrees == (3, 3)
    assert np.ptp(form.left.points[..., 0]) > 0.03
    for one in [form, *swimming]:
        for side in (0.0, 1.0):
            along = np.linspace(0, 1, 301)
            gap = one.left.at([side], along) - one.right.at([side], along)
            assert np.abs(gap).max() == 0
            gap = one.left.at(along, [side]) - one.right.at(along, [side])
            assert np.abs(gap).max() == 0
    bends = [np.ptp(one.left.points[0, :, 0]) for one in swimming]
    assert max(bends) > 0.01, "the body bends meanwhile"


@pytest.mark.capability("TF-051")
def test_fins_stand_on_the_edge_without_gap_while_the_body_deforms(form, swimming):
    for one in [form, *swimming]:
        for fin, border in ((one.dorsal, 0.0), (one.ventral, 1.0)):
            surface = fin.surface
            assert surface.points.shape == (2, 12, 3)
            assert surface.degrees == (1, 3)
            along = np.linspace(*surface.domain(1), 301)
            edge = surface.at([0.0], along)
            assert np.abs(edge - one.left.at([border], along)).max() < 1e-15
            assert np.linalg.norm(surface.at([1.0], along) - edge, axis=2).max() > 0.02
    rest, others = form.dorsal.surface.points[1], [one.dorsal.surface.points[1] for one in swimming]
    assert max(np.abs(one - rest).max() for one in others) > 0.02


@pytest.mark.capability("TF-052")
def test_the_root_of_a_pectoral_fin_stays_on_its_control_point(form, swimming):
    for one in [form, *swimming]:
        assert one.pectorals.shape == (2, 5, 3)
        for corners, half in zip(one.pectorals, (one.left, one.right), strict=True):
            assert (corners[0] == half.points[bio.fish.form.PECTORAL]).all()
    moved = [np.abs(one.pectorals[0] - form.pectorals[0]).max() for one in swimming]
    assert max(moved) > 0.02


@pytest.mark.capability("TF-060", "AA-007")
def test_the_skin_is_exact_at_rest_and_rigid_with_a_rigid_body(form):
    rest = bio.fish.Tank("anthias", length=0.3)
    skin = bio.fish.Skin(form, rest.nodes, rest.faces)
    assert np.abs(skin.posed(rest.nodes).points() - form.points()).max() < 1e-9 * rest.length
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    shift = [1.0, -2.0, 0.5]
    moved = skin.posed(rest.nodes @ turn.T + shift).points()
    assert np.abs(moved - (form.points() @ turn.T + shift)).max() < 1e-9 * rest.length


@pytest.mark.capability("TF-059")
def test_a_picture_becomes_a_fish_with_its_outline_and_texture(form):
    mesh = form.mesh()
    half = 17 * 41
    assert np.isfinite(mesh.positions).all()
    assert np.isfinite(mesh.uvs).all()
    assert (mesh.uvs >= 0).all()
    assert (mesh.uvs <= 1).all()
    # Where the body is seen from its side, the picture lies on it as it was taken.
    places = mesh.positions[:half, [2, 1]].astype(float)
    pictured = mesh.uvs[:half] * SIZE
    scale = -0.3 / (np.ptp(fitted()[..., 0]) * SIZE[0])
    off = places - pictured * scale
    assert np.ptp(off, axis=0).max() < 0.02 * 0.3
    assert np.isclose(np.ptp(mesh.positions[:half, 2]), 0.3, rtol=0.02)


def test_the_guide_runs_as_written(tmp_path, monkeypatch):
    guide = Path(__file__).parents[2] / "docs/guides/fish-from-a-picture.md"
    code = re.findall(r"```python\n(.*?)```", guide.read_text(encoding="utf-8"), re.S)[0]
    (tmp_path / "tang-body.json").write_text(json.dumps({"coordinates": fitted().tolist()}))
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    assert len(names["mesh"].triangles) > 2000


@pytest.mark.parametrize(
    ("coordinates", "options"),
    [(np.zeros((9, 21, 2)), {}), (fitted()[:8], {}), (np.nan * fitted(), {}), (fitted(), -1)],
)
def test_meshes_that_make_no_fish_are_refused(coordinates, options):
    with pytest.raises(InvalidValueError, match="expected"):
        bio.fish.Form.of_picture(coordinates, SIZE, length=options or 0.3)
