"""The world `climber`: vines that find poles and wind up them."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.lsystem import Segments, Turtle
from bioscope.populations.plants import model_path
from bioscope.worlds.climber import world as climber
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


STEM, REACH, CROWD = 0.012, 0.16, 18
"""Of the ivy: from the bark to its stem's middle, how far it feels others, how many stop it."""


def off_the_wood(points: np.ndarray, wood: Segments) -> np.ndarray:
    """Return the distance of points from the surface of the nearest limb."""
    way = wood.end - wood.start
    along = ((points[:, None] - wood.start) * way).sum(axis=2) / (way**2).sum(axis=1)
    along = along.clip(0, 1)
    axis = wood.start + way * along[..., None]
    radius = wood.radii[:, 0] + np.diff(wood.radii)[:, 0] * along
    return (np.linalg.norm(points[:, None] - axis, axis=2) - radius).min(axis=1)


def creeping(wood: Segments, crowd: float, steps: int = 260) -> np.ndarray:
    """Return the joints of ivy on a tree; so many pieces near a tip stop it."""
    text = model_path("ivy").read_text().replace("#define CROWD 18", f"#define CROWD {crowd}")
    begin = f"axiom: -(90)f({wood.radii[0, 0] + STEM})+(90)A(0)"
    system = bio.LSystem(text.replace("axiom: A(0)", begin))
    limbs = bio.environments.Limbs(wood, stem=STEM, reach=REACH)
    string = bio.environments.derive(system, steps, environment=limbs)
    return Turtle().interpret(string).segments.end


def neighbors(points: np.ndarray) -> np.ndarray:
    distance = np.linalg.norm(points[:, None] - points, axis=2)
    return (distance < REACH).sum(axis=1) - 1


@pytest.mark.capability("PL-444")
def test_ivy_follows_trunk_and_branches_and_keeps_off_its_own():
    wood = Turtle().interpret(climber.tree(seed=1)).segments
    joints = creeping(wood, CROWD)
    trunk = float(wood.radii[0, 0])
    off = off_the_wood(joints, wood)
    assert off.min() > 0, "never in the wood"
    assert off.max() < 2 * trunk
    assert np.quantile(off, 0.99) < 2 * STEM
    # It has gone up the trunk, and out along branches.
    assert joints[:, 1].max() > 0.6 * wood.end[:, 1].max()
    assert np.hypot(joints[:, 0], joints[:, 2]).max() > 5 * trunk
    # A tip goes on where at most CROWD pieces are near, and others may come after it.
    assert neighbors(joints).max() < 3 * CROWD
    heedless = creeping(wood, 1e9, steps=60)
    heeding = creeping(wood, CROWD, steps=60)
    assert neighbors(heedless).max() > 2 * neighbors(heeding).max()


def test_the_ivy_of_the_world_climbs_its_tree():
    world = bio.World(seed=1, dt=1 / 30)
    grown = climber.tree(seed=1)
    world.add(climber.ivy(grown, climber.TREE, start=200), "ivy")
    wood = Turtle().interpret(grown).segments
    for batch in world.scene.batches:
        if batch.name.split("/")[1].isdigit():
            points = batch.positions[0] + batch.mesh.positions * batch.scales[0]
            own = (points - (climber.TREE[0], 0.0, climber.TREE[1])) / climber.TREE_SIZE
            assert off_the_wood(own[::7], wood).max() < 0.1
    assert world.statistics()["ivy.tallest_m"] > 1.0
