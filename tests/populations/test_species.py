"""The ready-made species of fish: many, each with its own look, sound while they swim."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope.geometry.skinning import bent

TRUNK_ROWS = 160 / 256
"""Share of the texture, from the top, that is the trunk; fins and eyes are below."""


@pytest.fixture(scope="module")
def fishes():
    """Three swimming fishes of each species: batches by name."""
    with pytest.raises(bio.BioscopeError) as refused:
        bio.FishSchool("unicorn", 1)
    names = re.search(r"known: (.+)", str(refused.value))[1].split(", ")
    world = bio.World(seed=3)
    world.environment.water(surface=0.0)
    for number, name in enumerate(names):
        world.add(bio.FishSchool(name, 3, center=(30.0 * number, -20, 0)), name)
    world.run(seconds=2)
    return {batch.name: batch for batch in world.scene.batches}


def areas(mesh, positions):
    a, b, c = positions[mesh.triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


@pytest.mark.capability("TF-053")
def test_there_are_many_species_each_with_its_own_look(fishes):
    assert len(fishes) >= 8
    assert {"clownfish", "emperor_angelfish", "butterflyfish", "grey_reef_shark"} <= set(fishes)
    textures = {batch.material.texture.tobytes() for batch in fishes.values()}
    assert len(textures) == len(fishes)
    outlines = {batch.mesh.positions.tobytes() for batch in fishes.values()}
    assert len(outlines) == len(fishes)


@pytest.mark.capability("TF-059")
def test_texture_coordinates_are_within_the_texture(fishes):
    for name, batch in fishes.items():
        uvs = batch.mesh.uvs
        assert len(uvs) == len(batch.mesh.positions), name
        assert np.isfinite(uvs).all(), name
        assert uvs.min() >= 0, name
        assert uvs.max() <= 1, name


@pytest.mark.capability("TF-061")
def test_swimming_hardly_stretches_the_texture(fishes):
    for name, batch in fishes.items():
        mesh = batch.mesh
        rest = areas(mesh, mesh.positions)
        is_trunk = (mesh.uvs[mesh.triangles][:, :, 1] < TRUNK_ROWS).all(axis=1)
        is_seen = rest > 1e-4 * rest.max()
        for pose in batch.poses:
            positions, _ = bent(mesh, pose)
            change = np.abs(areas(mesh, positions) / np.maximum(rest, 1e-12) - 1)
            assert change[is_trunk & is_seen].max() < 0.3, name
            # In forked tails, slivers between two rays may change more.
            assert rest[change > 0.3].sum() < 0.01 * rest.sum(), name
