"""Plants that grow while the world runs: competition, loss, offspring, and exact continuation."""

import re

import numpy as np
import pytest

import bioscope as bio

YEAR = 31
"""Steps of a year of the tree in light."""

SPROUT = """lsystem: sprout
derivation length: 40
axiom: A(0)
p1: A(n) : n % 5 == 4 --> !(0.05)F(0.2)[+(50)F(0.1)~l(0.3)][-(50)F(0.1)~l(0.3)]S/(137)A(n+1)
p2: A(n) --> !(0.05)F(0.2)[+(50)F(0.1)~l(0.3)][-(50)F(0.1)~l(0.3)]/(137)A(n+1)
endlsystem
"""


def land(seed: int = 4) -> bio.World:
    world = bio.World(seed=seed, dt=1 / 30)
    world.environment.terrain(np.zeros((9, 9), np.float32), spacing=10.0)
    return world


def trees(places: list[tuple[float, float]], years: int, **options) -> bio.Plants:
    """Return trees in light that begin at these places, `years` old."""
    habitat = bio.Habitat(area=places)
    start = years * YEAR
    return bio.Plants("light_tree", len(places), habitat=habitat, rate=31.0, start=start, **options)


def leaves(world: bio.World, plant: int) -> np.ndarray:
    """Return the places of all leaves of one plant."""
    found = [
        batch.positions[np.asarray(batch.ids) == plant]
        for batch in world.scene.batches
        if re.search(r"/l\d", batch.name)
    ]
    return np.concatenate(found)


def sprouts(count: int = 1, **options) -> bio.Plants:
    area = [(3.0 * number, 0.0) for number in range(count)]
    return bio.Plants(SPROUT, count, habitat=bio.Habitat(area=area), rate=10.0, **options)


@pytest.mark.capability("PL-401", "PL-445")
def test_neighbors_grow_away_from_each_other():
    def centroid(places: list[tuple[float, float]], index: int) -> float:
        world = land()
        stand = world.add(trees(places, years=11, turned=False), "trees")
        plant = int(stand.values("id")[index])
        return float(leaves(world, plant)[:, 0].mean()) - places[index][0]

    pair = [(-1.5, 0.0), (1.5, 0.0)]
    left, right = centroid(pair, 0), centroid(pair, 1)
    # With the same seeds each tree alone: far away the other one takes no light.
    far = [(-150.0, 0.0), (150.0, 0.0)]
    alone_left, alone_right = centroid(far, 0), centroid(far, 1)
    assert left - alone_left <= -0.5
    assert right - alone_right >= 0.5


def test_crowded_trees_make_fewer_leaves_than_lone_ones():
    crowd, alone = land(), land()
    near = [(x * 1.2, z * 1.2) for x in range(3) for z in range(3)]
    dense = crowd.add(trees(near, years=8))
    free = alone.add(trees([(60.0 * x, 60.0 * z) for x, z in near], years=8))
    assert dense.values("leaves").sum() < 0.75 * free.values("leaves").sum()


def test_plants_grow_at_their_rate_and_without_jumps():
    world = land()
    stand = world.add(sprouts(unfold=True, flexibility=0.0))
    heights = []
    for _ in range(90):
        world.step()
        heights.append(float(stand.values("height_m")[0]))
    assert stand.values("steps")[0] == 30
    rises = np.diff(heights)
    assert rises.min() > -1e-4
    assert rises.max() < 0.2, "a step of 0.2 m unfolds over three ticks"
    world.set("plant", "rate", 0.0)
    world.run(seconds=1)
    assert stand.values("steps")[0] == 30


def test_continues_after_a_restore_to_the_bit(tmp_path):
    world = land()
    world.environment.add(bio.Current(speed=3.0), "wind")
    world.add(trees([(0.0, 0.0), (2.0, 0.5), (0.5, 2.0)], years=3, litter="D"))
    world.run(seconds=0.7)
    world.save(tmp_path / "stand.world")
    again = bio.World.restore(tmp_path / "stand.world")
    assert again.state_hash() == world.state_hash()
    for one in (world, again):
        one.run(seconds=1.1)
    assert again.state_hash() == world.state_hash()
    for mine, yours in zip(world.scene.batches, again.scene.batches, strict=True):
        assert mine.name == yours.name
        np.testing.assert_array_equal(mine.positions, yours.positions)


class Grazer(bio.Population):
    """A mouth that bites one plant in a given tick."""

    def __init__(self, plant: int, place: tuple[float, float, float], ticks: list[int]) -> None:
        self.plant, self.place, self.ticks = plant, list(place), ticks

    def settle(self) -> int:
        return 1

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        mesh = bio.Mesh(
            positions=np.eye(3, dtype=np.float32) * 0.01,
            triangles=np.array([[0, 1, 2]], np.uint32),
        )
        places = np.array([self.place], np.float32)
        scene.instances("grazer", mesh, bio.Material(), ids=self.ids, positions=places)
        if scene.tick in self.ticks:
            scene.event("bitten", self.plant, object=int(self.ids[0]))


def test_a_bite_takes_the_nearest_branch_and_feeds_the_grazer():
    world = land()
    stand = world.add(sprouts())
    world.run(seconds=1)
    world.set("plant", "rate", 0.0)
    world.step()
    plant = int(stand.values("id")[0])
    before = leaves(world, plant)
    lowest = before[before[:, 1].argmin()]
    grazer = world.add(Grazer(plant, tuple(lowest), [world.tick + 2]))
    world.step(4)
    after = leaves(world, plant)
    assert len(after) == len(before) - 1
    assert after[:, 1].mean() > before[:, 1].mean(), "it was a low one"
    eaten = [event for event in world.events if event.kind == "eaten"]
    assert [(event.subject, event.object) for event in eaten] == [(plant, int(grazer.ids[0]))]


class Gardener(bio.Population):
    """Shears that cut what is in a ball, in one tick."""

    def __init__(self, center: tuple[float, float, float], radius: float, tick: int) -> None:
        self.center, self.radius, self.when = list(center), radius, tick

    def publish(self, scene):
        if scene.tick == self.when:
            scene.event("cut", 0, position=self.center, radius=self.radius)


def test_shears_prune_and_a_plant_cut_at_the_foot_dies():
    world = land()
    stand = world.add(sprouts(2))
    world.run(seconds=2)
    height = stand.values("height_m")
    world.add(Gardener((0.0, 3.0, 0.0), 1.0, world.tick + 2))
    world.step(4)
    cut = stand.values("height_m")
    assert cut[0] < 2.3
    assert cut[1] >= height[1]
    pruned = [event for event in world.events if event.kind == "pruned"]
    assert [event.subject for event in pruned] == [stand.values("id")[0]]
    assert pruned[0].data["modules"] > 5
    world.add(Gardener((0.0, 0.0, 0.0), 0.5, world.tick + 2))
    world.run(seconds=1)
    assert [event.kind for event in world.events][-1] == "died"
    assert world.populations["plant"] == 1


def test_seeds_fall_drift_with_the_wind_and_germinate_where_there_is_room():
    world = land()
    world.environment.add(bio.Current((1.0, 0.0, 0.0), speed=3.0, turbulence=0.0), "wind")
    options = {"seeds": "S", "germination": 1.0, "dispersal": 1.5, "most": 60}
    meadow = bio.Habitat(area=bio.Rectangle((-40.0, -40.0), (40.0, 40.0)))
    stand = world.add(bio.Plants(SPROUT, 1, habitat=meadow, rate=10.0, room=0.8, **options))
    mother = stand.values("position")[0]
    world.run(seconds=7)
    germinated = [event.subject for event in world.events if event.kind == "germinated"]
    assert len(germinated) >= 3
    places = stand.values("position")
    assert len(places) == 1 + len(germinated)
    assert places[1:, 0].mean() > mother[0] + 1.0, "down the wind"
    gaps = np.linalg.norm(places[:, None] - places[None], axis=-1)
    assert gaps[np.triu_indices(len(places), 1)].min() >= 0.8
    assert not any("S" in string for string in stand.values("string"))


def test_each_plant_may_have_its_own_numbers():
    text = SPROUT.replace("axiom:", "#define STEP 0.2\naxiom:").replace("F(0.2)", "F(STEP)")
    world = land()
    area = bio.Habitat(area=[(0.0, 0.0), (5.0, 0.0), (10.0, 0.0)])
    stand = world.add(
        bio.Plants(text, 3, habitat=area, rate=10.0, numbers={"STEP": [0.1, 0.2, 0.3]})
    )
    world.run(seconds=2)
    heights = stand.values("height_m")
    assert heights[0] < heights[1] < heights[2]
    assert heights[2] / heights[0] == pytest.approx(3.0, rel=0.15)


def test_asks_for_what_makes_sense(tmp_path):
    with pytest.raises(bio.BioscopeError, match="give them a rate"):
        bio.Plants("light_tree", 3, season=31)
    with pytest.raises(bio.BioscopeError, match="no number 'NOTHING'"):
        bio.Plants("light_tree", 3, rate=1.0, numbers={"NOTHING": 1.0})
    with pytest.raises(bio.BioscopeError, match="without rate"):
        bio.Plants("light_tree", 3, rate=1.0, variants=4)

    field = tmp_path / "field.e"
    field.write_text("executable: honda81\n")
    with pytest.raises(bio.BioscopeError, match="environment file"):
        bio.Plants("light_tree", 3, rate=1.0, environment=bio.environments.read(field))
    with pytest.raises(bio.BioscopeError, match="season"):
        bio.Plants("light_tree", 3, rate=1.0, season=0)
