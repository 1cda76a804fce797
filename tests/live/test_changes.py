"""Changing a live world through the stream: numbers, places, tempers, steering, scripts."""

import numpy as np
import pytest
from test_server import Server, free_port, page, run

import bioscope as bio

WORLD = """
import bioscope as bio

def world(seed):
    world = bio.World(seed=seed, dt=1 / 30, title="pond")
    world.environment.water(0.0, bio.Current(speed=0.05))
    mind = bio.minds.Intentions("pacifist", food=["plankton"])
    world.add(bio.RoamingFish("fusilier", 3, center=(0, -3, 0), mind=mind), "fish")
    world.add(bio.Plankton(30, low=(-2, -4, -2), high=(2, -2, 2)))
    return world
"""


@pytest.fixture(scope="module")
def pond(tmp_path_factory):
    path = tmp_path_factory.mktemp("changes") / "pond.py"
    path.write_text(WORLD)
    return path


@pytest.fixture(scope="module")
def server(pond):
    server = Server(pond, "--port", free_port())
    yield server
    server.close()


async def begin(one, tick=10):
    """Begin anew, paused at a tick."""
    await one.say("pause")
    await one.say("restart", seed=5, tick=tick)
    await one.until(lambda message: message["type"] == "hello")
    return await one.frame(lambda frame: frame["tick"] == tick)


async def saved(one, path):
    """Return the hash of the world as it is."""
    await one.say("snapshot")
    message = await one.until(lambda message: message["type"] == "snapshot")
    path.write_bytes(message["bytes"])
    return bio.World.restore(path).state_hash()


async def inspected(one, who, wanted=lambda _: True):
    await one.say("select", id=who, retina=[32, 32])
    return await one.until(
        lambda message: message["type"] == "inspection" and message["id"] == who and wanted(message)
    )


def counts(message):
    return {one["name"]: one["count"] for one in message["populations"]}


@pytest.mark.capability("TF-180")
def test_numbers_typed_are_the_numbers_there(server):
    async def scene():
        async with page(server) as one:
            await begin(one)
            hello = next(message for message in one.got if message["type"] == "hello")
            additions = [("fish", "clownfish"), ("plants", "kelp"), ("pillars", "")]
            for number, (kind, species) in enumerate(additions, start=3):
                addition = {"change": "add", "kind": kind, "count": 2, "position": [0, -3, 0]}
                await one.say("add", addition=addition | {"species": species})
                # The message of the world's beginning may come late.
                there = await one.until(
                    lambda message, number=number: (
                        message["type"] == "populations" and len(message["populations"]) == number
                    )
                )
            await one.say("resize", population="fish", count=5)
            await one.say("resize", population="plankton", count=44)
            numbers = await one.until(
                lambda message: (
                    message["type"] == "statistics"
                    and message["values"]["fish.count"] == 5
                    and message["values"]["plankton.count"] == 44
                )
            )
            return hello, there, numbers["values"]

    hello, there, numbers = run(scene())
    assert len(hello["catalog"]["fish"]) >= 8
    assert counts(there) == {"fish": 3, "plankton": 30, "clownfish": 2, "kelp": 2, "pillar": 2}
    assert (numbers["clownfish.count"], numbers["kelp.count"]) == (2, 2)


@pytest.mark.capability("TF-182", "TF-183")
def test_a_saved_script_makes_the_same_world_again(server, tmp_path):
    async def scene():
        async with page(server) as one:
            await begin(one)
            await one.say("place", id=2, position=[0.5, -2.5, 0.3])
            await one.say("trait", id=1, name="intentions_appetite", value=3.0)
            addition = {"change": "add", "kind": "pillars", "count": 2, "position": [1, -5, 0]}
            await one.say("add", addition=addition)
            await one.say("set", owner="fish", name="muscle_swimmer_water", value=0.7)
            await one.say("step", ticks=70)
            await one.frame(lambda frame: frame["tick"] == 80)
            await one.say("resize", population="fish", count=4)
            await one.say("set", owner="world", name="time_step", value=0.02)
            await one.say("step", ticks=20)
            await one.frame(lambda frame: frame["tick"] == 100)
            first = await saved(one, tmp_path / "first.world")
            await one.say("script")
            script = await one.until(lambda message: message["type"] == "script")
            await begin(one, tick=3)
            await one.say("play script", text=script["text"])
            await one.frame(lambda frame: frame["tick"] == 100)
            again = await saved(one, tmp_path / "again.world")
            await one.say("seek", tick=20)
            early = await one.frame(lambda frame: frame["tick"] == 20)
            await one.say("seek", tick=100)
            await one.frame(lambda frame: frame["tick"] == 100)
            return script, first, again, early, await saved(one, tmp_path / "third.world")

    script, first, again, early, third = run(scene())
    assert first == again == third
    assert early["tick"] == 20
    path = tmp_path / script["name"]
    path.write_text(script["text"])
    assert bio.load(str(path)).state_hash() == first


@pytest.mark.capability("TF-187")
def test_pictures_show_every_so_many_ticks_of_the_length_set(server):
    async def scene():
        async with page(server) as one:
            await begin(one)
            await one.say("set", owner="world", name="time_step", value=0.05)
            await one.say("display", ticks=7)
            await one.say("play")
            await one.frame()
            frames = [await one.frame(lambda frame: frame["running"]) for _ in range(6)]
            await one.say("display", ticks=None)
            return frames

    frames = run(scene())
    ticks = np.diff([frame["tick"] for frame in frames])
    times = np.diff([frame["time"] for frame in frames])
    assert set(ticks % 7) == {0}
    assert np.allclose(times, 0.05 * ticks)


@pytest.mark.capability("TF-188")
def test_drives_and_intention_are_those_of_the_world(server, pond):
    async def scene():
        async with page(server) as one:
            await begin(one)
            return [await inspected(one, 2), *[await at(one, tick) for tick in (30, 55)]]

    async def at(one, tick):
        await one.say("seek", tick=tick)
        await one.say("step", ticks=tick - 10)
        return await inspected(one, 2, lambda message: message["tick"] >= tick)

    alone = bio.load(str(pond), 5)
    for found in run(scene()):
        alone.step(found["tick"] - alone.tick)
        fish = [int(one) for one in alone._engine.values("fish", "id")].index(2)
        for name in ("hunger", "libido", "fear"):
            assert found["values"][name] == alone._engine.values("fish", name)[fish]
        assert found["behavior"] == alone._engine.values("fish", "intention")[fish]
        assert found["time"] == pytest.approx(alone.time)


@pytest.mark.capability("TF-194", "TF-195")
def test_eyes_are_turned_and_shown_singly(server, pond):
    async def scene():
        async with page(server) as one:
            await begin(one)
            ahead = await inspected(one, 1)
            await one.say("select", id=1, retina=[32, 32], pan=80.0, tilt=20.0)
            turned = await one.until(
                lambda message: (
                    message["type"] == "inspection"
                    and message["retina"]["color"] != ahead["retina"]["color"]
                )
            )
            await one.say("select", id=1, retina=[64, 32], both=True)
            both = await one.until(
                lambda message: message["type"] == "inspection" and message["retina"]["eyes"] == 2
            )
            return ahead["retina"], turned["retina"], both["retina"]

    ahead, turned, both = run(scene())
    assert (ahead["width"], both["width"], both["height"]) == (32, 64, 32)
    assert ahead["color"] != turned["color"]
    world = bio.load(str(pond), 5)
    world.step(10)
    view = bio.look(world.scene, world.inspect(1)["eye"], (32, 32))
    assert view.picture(alpha=True).tobytes() == ahead["color"]
    assert view.identity.tobytes() == ahead["identity"]
    picture = np.frombuffer(both["color"], np.uint8).reshape(32, 64, 4).astype(int)
    assert np.abs(picture[:, :32] - picture[:, 32:]).max() > 0


@pytest.mark.capability("TF-196")
def test_a_steered_fish_is_released_when_its_page_goes(server):
    async def scene():
        async with page(server) as watcher:
            await begin(watcher)
            async with page(server) as driver:
                steering = {"turn": 0.5, "pitch": 0.0, "speed": 2.0, "brake": 0.0, "mouth": 0.0}
                await driver.say("steer", id=1, steering=steering)
                await watcher.say("play")
                steered = await inspected(
                    watcher, 1, lambda message: message["behavior"] == "steered"
                )
            free = await inspected(watcher, 1, lambda message: message["behavior"] != "steered")
            return steered, free

    steered, free = run(scene())
    assert steered["values"]["steered"]
    assert not free["values"]["steered"]


REFUSED = [
    {"do": "resize", "population": "fish", "count": 500_000},
    {"do": "resize", "population": "nobody", "count": 1},
    {"do": "place", "id": 1, "position": [1e9, 0, 0]},
    {"do": "place", "id": 4_000_000, "position": [0, 0, 0]},
    {"do": "remove", "id": 4_000_000},
    {"do": "trait", "id": 1, "name": "courage", "value": 1},
    {"do": "steer", "id": 1, "steering": {"turn": 99.0}},
    {"do": "set", "owner": "world", "name": "time_step", "value": 0},
    {"do": "play script", "text": "no script"},
    {
        "do": "add",
        "addition": {"change": "add", "kind": "fish", "count": 9000, "position": [0, 0, 0]},
    },
    {
        "do": "add",
        "addition": {
            "change": "add",
            "kind": "fish",
            "count": 1,
            "position": [0, 0, 0],
            "species": "dragon",
        },
    },
]


@pytest.mark.parametrize("command", REFUSED, ids=lambda one: one["do"])
def test_what_makes_no_sense_is_refused_with_a_notice(server, tmp_path, command):
    async def scene():
        async with page(server) as one:
            await begin(one)
            before = await saved(one, tmp_path / "before.world")
            fields = {name: value for name, value in command.items() if name != "do"}
            await one.say(command["do"], **fields)
            notice = await one.until(lambda message: message["type"] == "notice")
            return notice, before, await saved(one, tmp_path / "after.world")

    notice, before, after = run(scene())
    assert notice["level"] == "error"
    assert len(notice["text"]) > 10
    assert before == after
