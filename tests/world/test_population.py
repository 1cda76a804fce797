"""Populations and fields of one's own."""

import numpy as np
import pytest
from conftest import Drifters, small_world

import bioscope as bio


class Failing(Drifters):
    """Fails in a chosen verb at a chosen tick."""

    verb = ""

    def _maybe(self, verb):
        if self.verb == verb and self.ticks == 10:
            raise ZeroDivisionError(f"in {verb}")

    def sense(self, view):
        super().sense(view)
        self._maybe("sense")

    def decide(self):
        self._maybe("decide")

    def move(self, dt):
        super().move(dt)
        self._maybe("move")

    def grow(self):
        self._maybe("grow")
        return super().grow()


@pytest.mark.parametrize("verb", ["sense", "decide", "move", "grow"])
def test_a_failing_verb_leaves_the_world_at_the_last_tick(verb):
    world = small_world()
    failing = Failing(3)
    failing.verb = verb
    world.add(failing, "failing")
    world.step(10)
    before, others = world.state_hash(), world.scene.points[0].positions.copy()
    with pytest.raises(ZeroDivisionError, match=f"in {verb}") as caught:
        world.step(5)
    assert "_maybe" in {entry.name for entry in caught.traceback}
    assert "Failing" in caught.value.__notes__[0]
    assert world.tick == 10
    assert world.state_hash() == before
    assert (world.scene.points[0].positions == others).all()
    failing.verb = ""
    world.step(5)
    assert world.tick == 15


def test_a_population_that_keeps_what_is_no_data_is_told_which(world, tmp_path):
    class Odd(bio.Population):
        def __init__(self):
            self.socket = object()

    world.add(Odd())
    with pytest.raises(ValueError, match=r"Odd\.socket = object.*transient"):
        world.save(tmp_path / "odd.world")


def test_transient_attributes_are_not_saved(world):
    class Cached(bio.Population):
        transient = ("cache",)

        def __init__(self):
            self.cache = object()

    world.add(Cached())
    assert world.state_hash()


def test_a_verb_that_reaches_into_its_world_is_told_so(world):
    class Nosy(bio.Population):
        transient = ("home",)

        def sense(self, view):
            self.seen = self.home.tick

    nosy = Nosy()
    nosy.home = world
    world.add(nosy)
    with pytest.raises(ValueError, match="in the middle of a tick"):
        world.step()


class Whirl(bio.Field):
    """Water that turns about the vertical."""

    def __init__(self, rate: float) -> None:
        self.rate = rate

    def at(self, points, time):
        flow = np.stack([points[:, 2], 0 * points[:, 0], -points[:, 0]], axis=1) * self.rate
        return {"flow": flow.astype(np.float32)}


def test_a_field_of_ones_own_moves_things_and_is_saved(tmp_path):
    world = bio.World(seed=1)
    world.environment.add(Whirl(0.5), "whirl")
    drifters = world.add(Drifters(5), "drifters")
    world.set("drifters", "wander", 0.0)
    radius = np.hypot(drifters.places[:, 0], drifters.places[:, 2])
    start = np.arctan2(drifters.places[:, 0], drifters.places[:, 2])
    world.step(15)
    turned = np.arctan2(drifters.places[:, 0], drifters.places[:, 2]) - start
    assert np.mod(turned, 2 * np.pi) == pytest.approx(np.full(5, 15 / 60 * 0.5), abs=2e-3)
    assert np.hypot(drifters.places[:, 0], drifters.places[:, 2]) == pytest.approx(radius, rel=2e-2)
    world.save(tmp_path / "whirl.world")
    restored = bio.World.restore(tmp_path / "whirl.world")
    world.step(4)
    restored.step(4)
    assert world.state_hash() == restored.state_hash()


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ({"flow": np.zeros((1, 3), np.float32)}, "flow = 1 rows.*5 rows"),
        ({"wind": np.zeros(5)}, "unknown influence 'wind'"),
        ({"flow": np.full((5, 3), np.nan, np.float32)}, "finite"),
    ],
)
def test_a_field_that_answers_nonsense_is_told(answer, message):
    class Nonsense(bio.Field):
        def at(self, points, time):
            return answer

    world = bio.World(seed=1)
    world.environment.add(Nonsense())
    world.add(Drifters(5))
    with pytest.raises(bio.BioscopeError, match=message):
        world.step()
    assert world.tick == 0


def test_publishing_nonsense_is_refused_and_named():
    class Wrong(bio.Population):
        def settle(self):
            return 2

        def born(self, ids):
            self.ids = ids

        def publish(self, scene):
            places = np.zeros((3, 3), np.float32)
            scene.points("wrong", ids=self.ids, positions=places, radii=np.ones(2, np.float32))

    world = bio.World(seed=1)
    with pytest.raises(ValueError, match=r"positions = 3 rows.*2 rows"):
        world.add(Wrong())


def test_meshes_check_their_arrays():
    corners = np.eye(3, dtype=np.float32)
    mesh = bio.Mesh(corners, np.array([[0, 1, 2]], np.uint32))
    assert mesh.normals == pytest.approx(np.full((3, 3), 3**-0.5), rel=1e-5)
    with pytest.raises(ValueError, match="triangles = 3"):
        bio.Mesh(corners, np.array([[0, 1, 3]], np.uint32))
    with pytest.raises(ValueError, match="finite"):
        bio.Mesh(corners * np.float32("nan"), np.array([[0, 1, 2]], np.uint32))


def test_a_batch_of_nobody_has_empty_arrays():
    class Nobody(bio.Population):
        def publish(self, scene):
            mesh = bio.Mesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32))
            none = np.empty((0, 3), np.float32)
            scene.instances(
                "nobody", mesh, bio.Material(), ids=np.empty(0, np.uint32), positions=none
            )

    world = bio.World(seed=1)
    world.add(Nobody())
    (batch,) = world.scene.batches
    assert batch.positions.shape == batch.velocities.shape == (0, 3)
    assert batch.transforms.shape == (0, 8)
    assert batch.rotations.shape == (0, 4)
    assert batch.scales.shape == (0,)
