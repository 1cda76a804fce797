"""Lists of what is potentially visible: X. Tu 1996, section 5.4."""

import numpy as np
import pytest

import bioscope as bio

RANGE = 0.8
"""How far the witnesses see, metres."""
EYE = 0.44
"""How far the eye lies ahead of the middle, body lengths."""


class Onlooker(bio.Mind):
    """Swims about and tells what it sees."""

    told: dict[int, tuple[set[int], float]] = {}

    def decide(self, percepts):
        seen = {one["id"] for one in percepts["seen"]}
        Onlooker.told[percepts["id"]] = (seen, percepts["body_length"])
        turn = np.sin(3 * percepts["time"] + percepts["id"])
        return {"speed": 1.0 + 2.0 * (percepts["id"] % 3), "heading": (turn, 0.2 * turn, 1.0)}


def shoal(**options) -> tuple[bio.World, dict[str, bio.RoamingFish]]:
    """Return water with two kinds of fishes, by name, and plankton."""
    world = bio.World(seed=3, dt=1 / 30)
    world.environment.water(surface=2.0)
    box = {"low": (-1.5, -1.5, -1.5), "high": (1.5, 1.5, 1.5)}
    world.add(bio.Plankton(300, **box, swimming=0.3))
    place = {"center": (0, 0, 0), "radius": 1.2}
    kinds = {"anthias": 30, "chromis": 25}
    fishes = {
        species: world.add(bio.RoamingFish(species, count, **place, **options), species)
        for species, count in kinds.items()
    }
    return world, fishes


def disturb(fishes: dict[str, bio.RoamingFish], tick: int) -> None:
    """Let fishes jump, come and go now and then: what breaks any bound on speed."""
    first = int(fishes["anthias"].values("id")[0])
    if tick % 13 == 5:
        fishes["anthias"].place(first, (0.1 * (tick % 7) - 0.3, 0.4, -0.2))
    if tick % 17 == 8:
        fishes["chromis"].resize(23 + tick % 5)
    if tick % 19 == 9:
        fishes["anthias"].remove(first)


def ahead(rotations: np.ndarray) -> np.ndarray:
    """Return where those look that are turned so."""
    x, y, z, w = np.asarray(rotations, float).T
    return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)


@pytest.mark.capability("TF-078")
def test_lists_show_what_looking_at_all_shows():
    world, fishes = shoal(mind=Onlooker)
    for population in fishes.values():
        population.set(sight_attention=1000, sight_range=RANGE)
    in_view, compared = [], 0
    for tick in range(80):
        disturb(fishes, tick)
        batches = [one for one in world.scene.batches if one.species in fishes]
        ids = np.concatenate([one.ids for one in batches])
        places = np.concatenate([one.positions for one in batches]).astype(float)
        ways = np.concatenate([ahead(one.rotations) for one in batches])
        Onlooker.told.clear()
        world.step()
        assert set(Onlooker.told) == set(ids.tolist())
        for who, place, way in zip(ids.tolist(), places, ways, strict=True):
            seen, length = Onlooker.told[who]
            offsets = places - (place + EYE * length * way)
            far = np.linalg.norm(offsets, axis=1)
            turned = offsets @ way / np.maximum(far, 1e-9)
            others = ids != who
            sure = (abs(far - RANGE) > 1e-4) & (abs(turned - np.cos(np.radians(150))) > 1e-3)
            within = (far < RANGE) & (turned > np.cos(np.radians(150)))
            assert set(ids[others & sure & within].tolist()) <= seen, f"tick {tick}"
            assert not set(ids[others & sure & ~within].tolist()) & seen, f"tick {tick}"
            in_view.append(len(seen))
            compared += 1
    assert compared > 3000
    assert 2 < np.mean(in_view) < 40, "some are seen, some are not"


@pytest.mark.capability("TF-078")
@pytest.mark.parametrize("reaction", [0.0, 0.1])
def test_who_has_lists_lives_as_who_has_none(tmp_path, reaction):
    mind = bio.minds.Intentions("generic", food=["plankton"], habits=["school"], home_range=1.5)
    world, fishes = shoal(mind=mind, reaction=reaction)
    world.environment.cylinder((0.3, -2.0, 0.2), (0.3, 2.0, 0.2), 0.25)
    path = tmp_path / "again.world"
    for tick in range(60):
        disturb(fishes, tick)
        # Who comes out of a file has no lists yet: it looks at all.
        world.save(path)
        fresh = bio.World.restore(path)
        world.step()
        fresh.step()
        assert world.state_hash() == fresh.state_hash(), f"what is noticed is state; tick {tick}"
