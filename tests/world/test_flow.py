"""Currents composed from primitives, and what drifts, bends and rises in them."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.geometry.transforms import composed


class Leaf(bio.Population):
    """Tracers without will that go where the water goes."""

    def __init__(self, places):
        self.places = np.array(places, np.float32)

    def settle(self):
        return len(self.places)

    def born(self, ids):
        self.ids, self.count = ids, len(ids)

    def sense(self, view):
        self.flow = view.flow(self.places)

    def move(self, dt):
        self.places = (self.places + self.flow * dt).astype(np.float32)


def stream(*fields, places=((0.0, -2.0, 0.0),)):
    world = bio.World(seed=1, dt=0.02)
    world.environment.water()
    for field in fields:
        world.environment.add(field)
    return world, world.add(Leaf(places))


def flow_at(field, points):
    return field.at(np.array(points, np.float32), 0.0)["flow"]


def slopes(field, point, h=1e-2):
    """Return d flow_i / d x_j at a point."""
    steps = np.eye(3) * h
    rows = [
        (flow_at(field, [point + step]) - flow_at(field, [point - step]))[0] / (2 * h)
        for step in steps
    ]
    return np.array(rows).T


@pytest.mark.capability("TF-160")
def test_a_tracer_swings_with_the_period_of_the_current():
    world, leaf = stream(bio.flow.Uniform((3, 0, 0), 0.5, period=4.0))
    xs = []
    while world.time < 20:
        world.step()
        xs.append(float(leaf.places[0, 0]))
    # Amplitude a / ω about a / ω, five times in 20 s.
    assert max(xs) == pytest.approx(2 * 0.5 * 4 / (2 * np.pi), rel=0.02)
    spectrum = np.abs(np.fft.rfft(np.array(xs) - np.mean(xs)))
    assert np.argmax(spectrum) == 5


@pytest.mark.capability("TF-161")
def test_water_goes_round_a_pillar_and_straight_on_over_it():
    pillar = bio.flow.Source((0.0, 0.0), 0.5, -2.0, 0.1)
    outward = flow_at(pillar, [(1.0, -3, 0), (0, -3, -1.5), (0.1, -3, 0.1), (1.0, -1, 0)])
    assert outward[0] == pytest.approx((0.1 / 0.5**2, 0, 0))
    assert outward[1] == pytest.approx((0, 0, -0.1 / 1.0**2))
    assert not outward[2:].any(), "nothing within and above"
    assert np.isfinite(flow_at(pillar, [(0.5001, -3, 0)])).all()
    start = [(-2.0, -3.0, 0.15), (-2.0, -1.0, 0.15)]
    _, leaf = world = stream(bio.flow.Uniform((1, 0, 0), 0.5), pillar, places=start)
    nearest = np.inf
    for _ in range(500):
        world[0].step()
        nearest = min(nearest, np.hypot(leaf.places[0, 0], leaf.places[0, 2]))
    assert nearest > 0.5, "it does not pass through"
    assert leaf.places[0, 2] > 0.5
    assert leaf.places[1] == pytest.approx((3.0, -1.0, 0.15), abs=1e-3)


@pytest.mark.capability("TF-162")
def test_primitives_have_the_divergence_and_curl_that_they_should():
    rng = np.random.default_rng(3)
    for point in rng.uniform(0.8, 2.0, (12, 3)) * (1, -1, 1):
        uniform = slopes(bio.flow.Uniform((1, 0.2, 0), 0.7), point)
        assert not uniform.any()
        vortex = bio.flow.Vortex((0.0, 0.0), 2.0, core=0.01)
        turning = slopes(vortex, point)
        assert np.trace(turning) == pytest.approx(0, abs=1e-3)
        assert turning[0, 2] - turning[2, 0] == pytest.approx(0, abs=1e-3), "curl only in the core"
        source = slopes(bio.flow.Source((0.0, 0.0), 0.1, 0.0, 0.3), point)
        sink = slopes(bio.flow.Source((0.0, 0.0), 0.1, 0.0, -0.3), point)
        assert source[0, 2] == pytest.approx(source[2, 0], abs=1e-3), "without curl"
        assert sink == pytest.approx(-source)
    ring = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    points = np.stack([1.3 * np.sin(ring), 0 * ring - 1, 1.3 * np.cos(ring)], axis=1)
    along = np.stack([np.cos(ring), 0 * ring, -np.sin(ring)], axis=1)
    speed = (flow_at(bio.flow.Vortex((0.0, 0.0), 2.0, core=0.01), points) * along).sum(axis=1)
    assert speed.mean() * 2 * np.pi * 1.3 == pytest.approx(2.0, rel=1e-3), "its circulation"


@pytest.mark.capability("TF-162")
def test_what_is_added_superposes_and_is_saved(tmp_path):
    parts = [bio.flow.Uniform((0, 0, 1), 0.2), bio.flow.Vortex((1.0, 0.0), 0.5)]
    world, leaf = stream(*parts)
    world.step()
    expected = sum(flow_at(one, [(0.0, -2.0, 0.0)]) for one in parts)
    assert leaf.flow == pytest.approx(expected, abs=1e-6)
    world.save(tmp_path / "stream.world")
    again = bio.World.restore(tmp_path / "stream.world")
    for one in (world, again):
        one.step(20)
    assert again.state_hash() == world.state_hash()


@pytest.mark.capability("TF-165")
def test_plankton_drifts_with_the_current():
    world = bio.World(seed=2, dt=1 / 30)
    world.environment.water()
    world.environment.add(bio.flow.Uniform((1, 0, 0), 0.2))
    world.add(bio.Plankton(200, low=(-5, -3, -5), high=(5, -1, 5)))
    (points,) = world.scene.points
    before = dict(zip(points.ids.tolist(), np.array(points.positions), strict=True))
    world.run(seconds=2)
    (points,) = world.scene.points
    moved = [
        place - before[one]
        for one, place in zip(points.ids.tolist(), np.array(points.positions), strict=True)
        if one in before
    ]
    assert np.mean(moved, axis=0) == pytest.approx((0.4, 0, 0), abs=0.06)


@pytest.mark.capability("TF-166")
def test_bubbles_rise_to_the_surface_and_lean_with_the_current():
    def run(*fields):
        world = bio.World(seed=2, dt=1 / 30)
        world.environment.water()
        world.environment.terrain(np.full((2, 2), -2.0), spacing=20.0)
        for field in fields:
            world.environment.add(field)
        world.add(bio.Bubbles(1, area=[(0.0, 0.0)], rate=2.0))
        world.run(seconds=12)
        return np.concatenate([np.array(points.positions) for points in world.scene.points])

    still, carried = run(), run(bio.flow.Uniform((1, 0, 0), 0.1))
    for places in (still, carried):
        assert places[:, 1].max() > -0.4
        assert places[:, 1].min() < -1.5
        assert (places[:, 1] <= 0).all()
    assert abs(still[:, 0]).max() < 0.15
    assert carried[carried[:, 1] > -0.5, 0].mean() > 0.3


@pytest.mark.capability("TF-163")
def test_kelp_bends_most_at_its_tips_and_stands_up_again():
    world = bio.World(seed=4, dt=1 / 30)
    world.environment.water()
    world.environment.terrain(np.full((2, 2), -4.0), spacing=20.0)
    current = bio.Current(speed=0.0, surge=0.0, turbulence=0.0)
    world.environment.add(current, "current")
    world.add(bio.Plants("kelp", 4, flutter=0.0))

    def bend():
        """Angles by which lowest and highest joints are turned, degrees, mean over the plants."""
        lowest, highest = [], []
        for batch in world.scene.batches:
            for pose in batch.poses:
                angles = 2 * np.degrees(np.arccos(np.clip(np.abs(pose[:, 7]), 0, 1)))
                lowest.append(angles[0])
                highest.append(angles.max())
        return np.mean(lowest), np.mean(highest)

    world.run(seconds=4)
    upright = bend()
    world.set("current", "speed", 0.6)
    world.run(seconds=6)
    base, tip = bend()
    assert tip > upright[1] + 10
    assert tip - upright[1] > 3 * (base - upright[0])
    world.set("current", "speed", 0.0)
    world.run(seconds=12)
    assert bend()[1] == pytest.approx(upright[1], abs=4)


@pytest.mark.capability("AA-003")
def test_weed_leans_and_plankton_drifts_the_more_the_faster_the_water():
    world = bio.World(seed=4, dt=1 / 30)
    world.environment.water()
    world.environment.terrain(np.full((2, 2), -4.0), spacing=20.0)
    current = bio.Current(direction=(1, 0, 0), speed=0.0, surge=0.0, turbulence=0.0)
    world.environment.add(current, "current")
    world.add(bio.Plants("kelp", 4, flutter=0.0))
    world.add(bio.Plankton(200, low=(-8.0, -3.0, -2.0), high=(8.0, -1.0, 2.0)))

    def tips():
        """Places of the highest joints, metres."""
        found = []
        for batch in world.scene.batches:
            if len(batch.ids) and len(batch.poses):
                joints = composed(batch.transforms[:, None], batch.poses)[..., :3]
                # Those that are highest while the water rests.
                highest.setdefault(batch.name, joints[..., 1].argmax(axis=1))
                found += [one[row] for one, row in zip(joints, highest[batch.name], strict=True)]
        return np.array(found)

    def plankton():
        return next(np.array(one.positions) for one in world.scene.points)

    highest = {}
    speeds, leans, drifts = np.array([0.0, 0.15, 0.3, 0.45, 0.6]), [], []
    for speed in speeds:
        world.set("current", "speed", float(speed))
        world.run(seconds=6)
        leans.append(tips())
        before = plankton()
        world.run(seconds=1)
        drifts.append(np.median(plankton() - before, axis=0))
    along = [np.mean(lean[:, 0] - leans[0][:, 0]) for lean in leans]
    assert np.corrcoef(speeds, along)[0, 1] > 0.9
    assert along[-1] > 0.2, "metres"
    drifts = np.array(drifts)
    assert np.corrcoef(speeds, drifts[:, 0])[0, 1] > 0.99
    assert drifts[-1, 0] == pytest.approx(0.6, rel=0.15)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bio.flow.Uniform((0, 0, 0), 1.0), "direction"),
        (lambda: bio.flow.Uniform((1, 0, 0), float("nan")), "strength"),
        (lambda: bio.flow.Uniform((1, 0, 0), 1.0, period=0.0), "period"),
        (lambda: bio.flow.Source((0, 0), -1.0, 0.0, 1.0), "radius"),
        (lambda: bio.flow.Vortex((0, 0), 1.0, core=0.0), "core"),
    ],
)
def test_nonsense_is_refused_by_name(make, message):
    with pytest.raises(bio.BioscopeError, match=message):
        make()
