"""What an environment keeps in its cells, made visible: water around roots, painted soil."""

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery
from bioscope.lsystem.specimen import portrait

STEPS = 120
SIZE = 160


@pytest.fixture(scope="module")
def deep():
    """Two root systems in a deep soil, and the soil."""
    system = gallery.read("roots_3d")
    soil = bio.environments.named(system.environment)
    return bio.environments.derive(system, STEPS, environment=soil), soil


def between(amounts: bio.environments.Amounts, places: np.ndarray) -> np.ndarray:
    """Return the amounts at places (n, 3), linear between the middles of cells."""
    at = (places - np.array(amounts.low)) / amounts.cell - 0.5
    first = np.clip(np.floor(at).astype(int), 0, np.array(amounts.values.shape)[::-1] - 2)
    share = at - first
    found = np.zeros(len(at))
    for corner in np.ndindex(2, 2, 2):
        x, y, z = (first + corner).T
        weight = np.prod(np.where(np.array(corner) == 1, share, 1 - share), axis=1)
        found += weight * amounts.values[z, y, x]
    return found


@pytest.mark.capability("PL-213")
def test_a_surface_is_where_the_water_has_one_amount(deep):
    string, soil = deep
    amounts = soil.amounts
    assert amounts.deep
    least, most = float(amounts.values.min()), float(amounts.values.max())
    level = (least + most) / 2
    surface = amounts.surface(level)
    places = np.asarray(surface.positions)
    assert len(surface.triangles) > 100
    assert np.abs(between(amounts, places) - level).max() < 0.1 * (most - least)
    # It looks to where there is less, and roots that drink are inside.
    inward = places + 0.3 * amounts.cell * np.asarray(surface.normals)
    assert np.mean(between(amounts, inward) < between(amounts, places)) > 0.95
    roots = bio.Turtle().interpret(string).segments.end
    low, high = places.min(axis=0), places.max(axis=0)
    assert ((roots > low) & (roots < high)).all(axis=1).mean() > 0.2


@pytest.mark.capability("PL-213")
def test_one_looks_through_the_surfaces_at_the_roots(deep):
    string, soil = deep
    mesh = bio.Turtle().interpret(string).mesh()
    bare = portrait(mesh, SIZE, SIZE).astype(float)
    wet = portrait(mesh, SIZE, SIZE, around=soil).astype(float)
    veiled = np.abs(wet - bare).sum(axis=-1) > 20
    assert veiled.mean() > 0.02
    bluer = (wet - bare)[veiled]
    assert np.mean(bluer[:, 2] - bluer[:, 0]) > 10
    # What is behind is still to be seen.
    light = np.corrcoef(bare[veiled].mean(axis=1), wet[veiled].mean(axis=1))[0, 1]
    assert light > 0.6


@pytest.mark.capability("PL-213")
def test_a_flat_field_is_painted_black_where_it_is_dry_and_blue_where_it_is_wet():
    system = gallery.read("roots")
    soil = bio.environments.SoilWater((40, 30), amount=1.0, sources=[(5, -9, -1, 12, -2, 1, 3.0)])
    bio.environments.derive(system, STEPS, environment=soil)
    amounts = soil.amounts
    assert not amounts.deep
    assert amounts.values.shape == (1, 30, 40)
    sheet = amounts.sheet(3.0)
    colors = np.asarray(sheet.colors).reshape(30, 40, 3)
    shares = np.clip(amounts.values[0] / 3.0, 0, 1)
    np.testing.assert_allclose(
        colors, shares[..., None] * colors.reshape(-1, 3).max(axis=0), atol=1e-5
    )
    assert shares.max() == 1 > 3 * shares.min()
    brightest = colors.reshape(-1, 3).max(axis=0)
    assert brightest[2] > 4 * brightest[0]
    middles = np.asarray(sheet.positions).reshape(30, 40, 3)
    np.testing.assert_allclose(middles[0, 0, :2], np.array(amounts.low[:2]) + 0.5)
    empty = bio.environments.SkyLight().amounts
    assert empty is None


@pytest.mark.capability("PL-213")
def test_a_growing_stand_shows_its_water(tmp_path):
    world = bio.World(seed=3, dt=0.1)
    soil = bio.environments.SoilWater((16, 20, 16), cell=4.0, diffusion=1.0, amount=2.0)
    stand = bio.Plants(
        "roots_3d",
        1,
        rate=10.0,
        start=40,
        environment=soil,
        levels=(1.7, 1.9),
        habitat=bio.Habitat(area=[(0.0, 0.0)]),
        origin=(0.0, -10.0, 0.0),
        turned=False,
    )
    world.add(stand, "roots")
    shown = [batch for batch in world.scene.batches if "water" in batch.name]
    assert shown
    assert all(0 < batch.material.opacity < 1 for batch in shown)
    before = len(shown[0].mesh.triangles)
    world.run(seconds=3)
    shown = [batch for batch in world.scene.batches if "water" in batch.name]
    assert len(shown) == 2
    assert len(shown[-1].mesh.triangles) > before, "they have drunk more"
    world.save(tmp_path / "soil.world")
    again = bio.World.restore(tmp_path / "soil.world")
    for mine, yours in zip(world.scene.batches, again.scene.batches, strict=True):
        np.testing.assert_array_equal(mine.mesh.positions, yours.mesh.positions)
