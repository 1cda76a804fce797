"""Captured motion, replayed."""

import numpy as np
import pytest

import bioscope as bio


@pytest.mark.capability("TF-224", "AA-402", "AA-404")
def test_a_replayed_fish_swims_as_the_muscle_driven_one_does():
    kinds = [bio.fish.Shoal("anthias", 1, replayed=replayed) for replayed in (False, True)]
    length = bio.fish.Tank("anthias").length
    ways, swings = [], []
    for shoal in kinds:
        shoal.step(1 / 60, ticks=240)
        start = shoal.nodes[0, 5:9].mean(axis=0)
        tails = []
        for _ in range(120):
            shoal.step(1 / 60)
            nodes = shoal.nodes[0]
            tails.append((nodes[-2:].mean(axis=0) - nodes[5:9].mean(axis=0))[0])
        ways.append(np.linalg.norm(shoal.nodes[0, 5:9].mean(axis=0) - start))
        swings.append(np.ptp(tails))
    assert ways[1] == pytest.approx(ways[0], rel=0.1)
    assert abs(swings[1] - swings[0]) < 0.05 * length


@pytest.mark.capability("AA-403")
def test_a_segment_is_a_rigid_motion_and_a_deformation_that_make_the_nodes_again():
    tank = bio.fish.Tank("anthias")
    tank.swim(tank.cruise)
    tank.run(3)
    places, begun = [], tank.center

    def control(tank: bio.fish.Tank) -> None:
        places.append(tank.nodes)
        if len(places) == 40:
            tank.turn(np.pi / 2)

    segment = bio.fish.capture(tank, 3.0, control)
    recorded = np.array([*places, tank.nodes])
    nodes = segment.nodes()
    assert nodes.shape == recorded.shape
    assert np.abs(nodes - recorded).max() < 1e-6
    # The deformation holds nothing of the way, the frame nothing of the beat but its sway.
    local = segment.deformations
    ahead = local[:, 1:5].mean(axis=1) - local[:, 9:13].mean(axis=1)
    assert np.abs(local.mean(axis=1)).max() < 1e-9
    assert np.abs(np.arctan2(ahead[:, 0], ahead[:, 2])).max() < 1e-9
    assert np.ptp(local, axis=0).max() < 0.6 * tank.length
    assert np.degrees(segment.yaws[-1] - segment.yaws[0]) == pytest.approx(90, abs=25)
    assert np.linalg.norm(segment.centers[-1] - begun) > 2 * tank.length
    for wrong in (np.zeros((0, 23, 3)), np.zeros((4, 22, 3)), np.full((2, 23, 3), np.nan)):
        with pytest.raises(bio.BioscopeError, match="nodes"):
            bio.fish.Segment.split(wrong, 0.01)


def joints(world: bio.World) -> np.ndarray:
    """Places (n, j, 3) of the joints of all fishes of the first batch in the world, metres."""
    batch = world.scene.batches[0]
    places = np.asarray(batch.poses)[..., :3].reshape(len(batch.ids), -1, 3)
    x, y, z, w = (part[:, None] for part in np.asarray(batch.rotations).T)
    axis = np.stack([x, y, z], axis=-1)
    turned = places + 2 * np.cross(axis, np.cross(axis, places) + w[..., None] * places)
    return np.asarray(batch.positions)[:, None] + batch.scales[:, None, None] * turned


def school(**options: float) -> tuple[bio.World, bio.FishSchool]:
    """Return a school in open water that replays captured motion."""
    world = bio.World(seed=3, dt=1 / 60)
    world.environment.water(surface=20.0)
    fishes = bio.FishSchool("anthias", 150, center=(0, 0, 0), replayed=1.0, **options)
    return world, world.add(fishes)


@pytest.mark.capability("TF-224", "AA-405")
def test_who_comes_near_the_observer_swims_by_muscles_without_a_jump():
    world, fishes = school(driven=12)
    world.run(seconds=2)
    assert fishes.statistics["driven"] == 12
    before, steps = joints(world), []
    for tick in range(120):
        # The observer comes and goes, so fishes take up and leave their muscles all the time.
        fishes.set(observer_x=2.0 * np.sin(tick / 6), observer_z=2.0 * np.cos(tick / 9))
        world.step()
        now = joints(world)
        steps.append(np.linalg.norm(now - before, axis=-1).max(axis=1))
        before = now
        assert fishes.statistics["driven"] == 12
    steps = np.array(steps)
    length = bio.fish.Tank("anthias").length
    # In a sixtieth of a second no part of any fish moves farther than a tail beats.
    assert steps.max() < 0.3 * length
    assert np.median(steps) > 0.005 * length
    speeds = np.linalg.norm(world.scene.batches[0].velocities, axis=1) / length
    assert 0.5 < np.median(speeds) < 3


def test_nobody_looks_elsewhere_when_the_observer_leaps_away():
    world, fishes = school(driven=40)
    world.run(seconds=2)

    def ahead() -> np.ndarray:
        x, y, z, w = np.asarray(world.scene.batches[0].rotations).T
        return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)

    before = ahead()
    for leap in range(6):
        fishes.set(observer_x=50.0 * (leap % 2))
        for _ in range(15):
            world.step()
            now = ahead()
            assert (now * before).sum(axis=1).min() > np.cos(np.radians(25))
            before = now


def test_a_school_with_muscles_goes_on_as_it_was_saved(tmp_path):
    world, _ = school(driven=5)
    world.step(40)
    world.save(tmp_path / "school.world")
    again = bio.World.restore(tmp_path / "school.world")
    for one in (world, again):
        one.step(30)
    assert world.state_hash() == again.state_hash()


def test_odd_numbers_of_driven_fishes_are_refused_or_met():
    world, fishes = school(driven=1000)
    world.step(2)
    assert fishes.statistics["driven"] == 150
    fishes.set(driven=0)
    world.step(2)
    assert fishes.statistics["driven"] == 0
    for wrong in ({"driven": -1.0}, {"driven": 1e9}, {"observer_x": float("nan")}):
        with pytest.raises(bio.BioscopeError, match=next(iter(wrong))):
            bio.FishSchool("anthias", 3, replayed=1.0, **wrong)
    empty = bio.World(seed=1)
    empty.add(bio.FishSchool("anthias", 0, replayed=1.0, driven=3))
    empty.step(3)
