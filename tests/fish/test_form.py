"""The shape of fishes: skin that follows the body, fins that row or flap, mouths that eat."""

import numpy as np
import pytest

import bioscope as bio


class Errand(bio.Mind):
    """Swims as it is told."""

    def __init__(self, orders=None):
        self.orders = orders or {}

    def decide(self, percepts):
        return {"heading": (0, 0, 1), "speed": 1.0, **self.orders}


def aquarium(species, *, body="swimmer", **orders):
    world = bio.World(seed=4, dt=1 / 60)
    world.environment.water(surface=30.0)
    world.add(bio.RoamingFish(species, mind=lambda: Errand(orders), body=body), "fish")
    world.step()
    return world


def batch_of(world, species):
    return next(one for one in world.scene.batches if one.species == species)


def turned(rotation, points):
    """Turn points by a quaternion (x, y, z, w)."""
    axis, w = np.asarray(rotation[:3]), rotation[3]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points)


def skinned(batch):
    """Return the skin of the first one of a batch in the frame of its body."""
    mesh, poses = batch.mesh, np.asarray(batch.poses[0], float)
    rest = np.array([one[2] for one in mesh.joints], float)
    whole = np.zeros_like(mesh.positions, dtype=float)
    for slot in range(4):
        joints, weights = mesh.joint_indices[:, slot], mesh.joint_weights[:, slot]
        for joint in np.unique(joints[weights > 0]):
            of = (joints == joint) & (weights > 0)
            local = mesh.positions[of] - rest[joint, :3]
            moved = turned(poses[joint, 4:8], local) + poses[joint, :3]
            whole[of] += weights[of, None] * moved
    return whole


def angle_of(batch, name):
    """Return by how many radians the joint is turned against the skull."""
    names = [one[0] for one in batch.mesh.joints]
    poses = np.asarray(batch.poses[0], float)
    joint, skull = poses[names.index(name), 4:8], poses[0, 4:8]
    return 2 * np.arccos(min(1.0, abs(float(joint @ skull))))


@pytest.mark.capability("TF-060")
def test_skin_at_rest_is_the_modelled_one_and_goes_with_the_body():
    world = aquarium("emperor_angelfish", body="muscle_swimmer", speed=0.0)
    batch = batch_of(world, "emperor_angelfish")
    length = float(np.ptp(batch.mesh.positions[:, 2]))
    fins = np.array([one[0].startswith("fin") for one in batch.mesh.joints])
    of_trunk = ~fins[batch.mesh.joint_indices[:, 0]]
    apart = np.linalg.norm(skinned(batch) - batch.mesh.positions, axis=1)[of_trunk]
    assert apart.max() < 1e-3 * length


@pytest.mark.capability("TF-061", "TF-059")
def test_skin_is_hardly_stretched_in_normal_swimming():
    world = aquarium("grey_reef_shark", body="muscle_swimmer")
    mesh = batch_of(world, "grey_reef_shark").mesh
    assert np.isfinite(mesh.uvs).all()
    assert (mesh.uvs >= 0).all()
    assert (mesh.uvs <= 1).all()
    # It starts from rest with strokes that bend it more than swimming does.
    world.step(70)
    worst = []
    for _ in range(30):
        world.step(4)
        batch = batch_of(world, "grey_reef_shark")
        # The texture is fixed to the vertices.
        assert (batch.mesh.uvs == mesh.uvs).all()
        before, after = (
            areas(points, mesh.triangles) for points in (mesh.positions, skinned(batch))
        )
        large = before > np.quantile(before, 0.3)
        change = np.abs(after[large] / before[large] - 1)
        worst.append(np.quantile(change, 0.99))
    assert max(worst) < 0.3


def areas(points, triangles):
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


@pytest.mark.capability("TF-062")
@pytest.mark.parametrize("body", ["swimmer", "muscle_swimmer"])
def test_pectorals_flap_more_when_they_work_and_never_rest(body):
    def beat(**orders):
        world = aquarium("barracuda", body=body, **orders)
        angles = []
        for _ in range(180):
            world.step()
            angles.append(angle_of(batch_of(world, "barracuda"), "fin_0_left"))
        return np.ptp(angles[60:])

    cruising, braking = beat(), beat(speed=0.0, brake=1.0)
    assert 0.005 < cruising < braking


@pytest.mark.capability("TF-063", "TF-064")
@pytest.mark.parametrize("species", ["butterflyfish", "emperor_angelfish"])
@pytest.mark.parametrize("body", ["swimmer", "muscle_swimmer"])
def test_flat_fishes_row_oppositely_in_turns_and_backward_to_brake(species, body):
    def strokes(**orders):
        """Return the turns that the tips of the left and right fin make on their cones."""
        world = aquarium(species, body=body, **orders)
        world.step(30)
        tracks = []
        for _ in range(120):
            world.step()
            tracks.append(tips(batch_of(world, species)))
        return np.array([winding(track) for track in np.swapaxes(tracks, 0, 1)])

    ahead, turning = strokes(), strokes(heading=(1.0, 0, 0.4), urgency=1.0)
    braking = strokes(speed=0.0, brake=1.0)
    assert np.abs(ahead).min() > 0.5
    # Left and right mirror each other: seen from outside they row alike.
    assert ahead[0] * ahead[1] < 0
    assert turning[0] * turning[1] > 0
    assert np.sign(braking[0]) == -np.sign(ahead[0])
    assert np.sign(braking[1]) == -np.sign(ahead[1])


def tips(batch):
    """Return the directions of the left and right pectoral fin in the frame of the skull."""
    names = [one[0] for one in batch.mesh.joints]
    poses = np.asarray(batch.poses[0], float)
    found = []
    for side in ("left", "right"):
        joint = names.index({"left": "fin_0_left", "right": "fin_1_right"}[side])
        of = batch.mesh.joint_indices[:, 0] == joint
        rest = np.asarray(batch.mesh.joints[joint][2][:3])
        tip = batch.mesh.positions[of] - rest
        tip = tip[np.argmax(np.linalg.norm(tip, axis=1))]
        away = turned(poses[joint, 4:8], tip)
        found.append(turned(poses[0, 4:8] * [-1, -1, -1, 1], away))
    return found


def winding(track):
    """Return how many turns a track of directions makes round its middle."""
    middle = track.mean(axis=0)
    middle /= np.linalg.norm(middle)
    aside = np.cross(middle, [0.0, 1.0, 0.0])
    aside /= np.linalg.norm(aside)
    across = np.cross(middle, aside)
    angles = np.unwrap(np.arctan2(track @ across, track @ aside))
    return (angles[-1] - angles[0]) / (2 * np.pi)


@pytest.mark.capability("TF-065")
def test_the_mouth_opens_before_it_eats_and_shuts_afterwards():
    world = bio.World(seed=3, dt=1 / 30)
    world.environment.water(surface=30.0)
    box = (1.2, 0.6, 1.2)
    mind = bio.minds.Intentions("pacifist", food=["plankton"], appetite=2.0)
    world.add(bio.RoamingFish("emperor_angelfish", mind=mind, center=(0, 0, 0), radius=0.2), "fish")
    world.add(bio.Plankton(60, low=tuple(-one for one in box), high=box), "food")
    gape, meals = [], []
    for tick in range(30 * 60):
        world.step()
        gape.append(angle_of(batch_of(world, "emperor_angelfish"), "jaw"))
        meals += [tick for event in world.events if event.kind == "eaten"]
        if len(meals) >= 3 and tick > meals[-1] + 60:
            break
    assert len(meals) >= 3
    shut, wide = 0.02, 0.15
    assert gape[0] < shut
    for meal in meals[:3]:
        assert max(gape[max(meal - 6, 0) : meal + 1]) > wide
    assert min(gape[meals[0] : meals[0] + 90]) < shut or min(gape[meals[-1] :]) < shut
