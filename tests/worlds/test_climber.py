"""The world `climber`: vines that find poles and wind up them."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.climber.world import POLES, SIZE, vine


def stem(world: bio.World, name: str) -> np.ndarray:
    """Return the vertices of a vine, in world space."""
    batches = [one for one in world.scene.batches if one.species == name and len(one.ids) == 1]
    wood = next(one for one in batches if one.name.split("/")[1].isdigit())
    return wood.positions[0] + wood.mesh.positions * wood.scales[0]


@pytest.mark.capability("PL-323")
@pytest.mark.parametrize("angle", [1.2, 1.7, 2.2, 2.7])
def test_a_vine_touches_its_pole_and_winds_up_it(angle: float):
    world = bio.World(seed=1, dt=1 / 30)
    plant = world.add(vine((0.0, 0.0), angle=angle, start=2300), "vine")
    assert "R(1," not in plant.values("string")[0], "no joint is free any more"
    points = stem(world, "vine") / SIZE
    high = points[points[:, 1] > 2.5]
    order = high[np.argsort(high[:, 1])]
    heights = np.arange(order[0, 1], order[-1, 1], 0.15)
    middle = np.array([order[abs(order[:, 1] - height) < 0.12].mean(axis=0) for height in heights])
    turns = np.unwrap(np.arctan2(middle[:, 2], middle[:, 0]))
    assert abs(turns[-1] - turns[0]) / (2 * np.pi) >= 2
    distance = np.hypot(middle[:, 0], middle[:, 2])
    after_a_turn = distance[abs(turns - turns[0]) > 2 * np.pi]
    assert after_a_turn.std() < 0.05 * after_a_turn.mean()
    assert after_a_turn.mean() == pytest.approx(0.4, abs=0.06), "radius of the pole and the stem"


def test_free_stems_circle_and_each_pole_gets_its_vine():
    world = bio.load("climber", seed=1)
    tips = []
    for _ in range(40):
        world.step(3)
        tips.append(max(stem(world, "vine"), key=lambda place: place[1]))
    tips = np.array(tips)
    steps = np.linalg.norm(np.diff(tips, axis=0), axis=1)
    assert steps.max() < 0.12, "it moves without jumps"
    assert np.ptp(tips[:, 0]) > 0.03
    assert sum(name.startswith("vine-") for name in world.populations) == len(POLES)
