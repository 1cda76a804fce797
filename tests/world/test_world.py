"""The world: ticks, state hash, saving, parameters, recording."""

import pytest
from conftest import Drifters, small_world
from hypothesis import given, settings
from hypothesis import strategies as st

import bioscope as bio


def test_time_is_ticks_times_dt(world):
    world.run(seconds=0.5)
    assert (world.tick, world.time) == (30, pytest.approx(0.5))


def test_the_same_seed_gives_the_same_hash_and_another_seed_another():
    first, second, other = small_world(5), small_world(5), small_world(6)
    for one in (first, second, other):
        one.step(50)
    assert first.state_hash() == second.state_hash()
    assert first.state_hash() != other.state_hash()
    assert len(first.state_hash()) == 64


@pytest.mark.capability("RE-32")
@settings(max_examples=15, deadline=None)
@given(before=st.integers(0, 60), after=st.integers(0, 60))
def test_a_restored_world_continues_as_it_would_have(tmp_path_factory, before, after):
    path = tmp_path_factory.mktemp("saved") / "small.world"
    world = small_world()
    world.step(before)
    world.save(path)
    restored = bio.World.restore(path)
    assert restored.state_hash() == world.state_hash()
    world.step(after)
    restored.step(after)
    assert restored.state_hash() == world.state_hash()
    assert restored.populations == world.populations


def test_the_hash_covers_parameters_light_and_terrain(world):
    hashes = {world.state_hash()}
    world.set("drifters", "wander", 0.7)
    hashes.add(world.state_hash())
    world.environment.set(turbidity=2.0)
    hashes.add(world.state_hash())
    world.environment.terrain([[-3.0, -3.0], [-3.0, -2.0]], spacing=10.0)
    hashes.add(world.state_hash())
    world.set("current", "speed", 0.5)
    hashes.add(world.state_hash())
    assert len(hashes) == 5


def test_parameters_are_described_and_bounded(world):
    rows = {(row.owner, row.name): row for row in world.parameters()}
    speed = rows["current", "speed"]
    assert speed.value == pytest.approx(0.2)
    assert (speed.unit, speed.minimum) == ("m/s", 0.0)
    assert speed.meaning
    with pytest.raises(ValueError, match=r"speed = 99.*0 to 3 m/s"):
        world.set("current", "speed", 99)
    with pytest.raises(LookupError, match=r"unknown parameter 'sped'.*speed"):
        world.set("current", "sped", 1)
    with pytest.raises(LookupError, match="nobody"):
        world.set("nobody", "speed", 1)
    with pytest.raises(ValueError, match="wander"):
        world.set("drifters", "wander", float("nan"))


def test_a_recording_repeats_the_run_with_its_changes(world, tmp_path):
    world.step(10)
    world.record()
    world.step(15)
    world.set("drifters", "wander", 1.5)
    world.step(15)
    world.set("current", "speed", 0.0)
    world.step(5)
    world.save_recording(tmp_path / "run.recording")
    replayed = bio.World.replay(tmp_path / "run.recording")
    assert replayed.tick == world.tick == 45
    assert replayed.state_hash() == world.state_hash()


def test_events_carry_their_figures_and_make_a_table(world):
    world.step(60)
    born = [event for event in world.events if event.kind == "born"]
    assert [event.tick for event in born] == [20, 40, 60]
    assert born[0].data["height_m"] < 0
    table = world.events.table()
    assert table.num_rows == len(world.events)
    assert table.schema.field("time").metadata[b"unit"] == b"s"


def test_ids_are_never_given_twice(world):
    seen = set(world.scene.points[0].ids.tolist())
    for _ in range(30):
        world.step(20)
        now = set(world.scene.points[0].ids.tolist())
        assert max(now - seen, default=10**9) > max(seen, default=0)
        seen |= now
    assert len(seen) == 8 + 30


def test_a_scene_is_a_view_that_stays_as_it_was(world):
    world.step()
    scene = world.scene
    positions = scene.points[0].positions
    kept = positions.copy()
    world.step(20)
    assert (positions == kept).all()
    assert positions.base is not None
    with pytest.raises(ValueError, match="read-only"):
        positions[0, 0] = 1.0


def test_inspection_shows_live_values(world):
    individual = int(world.scene.points[0].ids[0])
    found = world.inspect(individual)
    assert found["population"] == "Drifters" or found["population"] == "drifters"
    assert found["values"]["height_m"] < 0
    assert world.inspect(4_000_000_000) is None


@pytest.mark.parametrize("dt", [0.0, -1.0, float("nan"), float("inf"), 100.0])
def test_an_impossible_tick_is_refused(dt):
    with pytest.raises(ValueError, match="dt"):
        bio.World(seed=1, dt=dt)


def test_a_name_is_given_once(world):
    second = world.add(Drifters())
    assert second.name == "Drifters"
    with pytest.raises(ValueError, match="drifters"):
        world.add(Drifters(), "drifters")


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda data: b"", "not a saved world"),
        (lambda data: b"GIF89a" + data, "not a saved world"),
        (lambda data: data[:-1], "damaged"),
        (lambda data: data[:40] + bytes([data[40] ^ 1]) + data[41:], "damaged"),
        (lambda data: data[:15] + b"\xff\xff\x00\x00" + data[19:], "format 65535"),
    ],
)
def test_a_damaged_file_is_refused_by_name(world, tmp_path, damage, message):
    path = tmp_path / "small.world"
    world.save(path)
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(bio.BioscopeError, match=f"small.world.*{message}"):
        bio.World.restore(path)


@settings(max_examples=60, deadline=None)
@given(data=st.binary(max_size=200))
def test_no_bytes_bring_a_restore_down(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("any") / "any.world"
    path.write_bytes(b"bioscope world\n\x01\x00\x00\x00" + data)
    with pytest.raises(bio.BioscopeError):
        bio.World.restore(path)
