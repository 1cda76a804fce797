"""The live server as pages and strangers meet it: stream, commands, trust."""

import asyncio
import contextlib
import json
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

import msgspec
import numpy as np
import pytest
import websockets

import bioscope as bio

VERSION = bio.__version__


class Server:
    """`bioscope live` in a process of its own."""

    def __init__(self, script, *arguments):
        command = [sys.executable, "-m", "bioscope.cli", "live", str(script), "--no-open"]
        self.process = subprocess.Popen(
            [*command, "--seed", "5", *map(str, arguments)], stderr=subprocess.PIPE, text=True
        )
        self.said = []
        for line in self.process.stderr:
            self.said.append(line)
            if found := re.search(r"live at (http://\S+)", line):
                self.address = found[1]
                break
        self.port = int(re.search(r":(\d+)/", self.address)[1])

    def close(self):
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(15)
        finally:
            self.process.kill()


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    from pathlib import Path

    from conftest import SCRIPT

    path = tmp_path_factory.mktemp("live") / "small.py"
    path.write_text(SCRIPT.format(tests=str(Path(__file__).parents[1])))
    server = Server(path, "--port", free_port())
    yield server
    server.close()


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def messages(received):
    """Return the messages in one that came: those of a bundle, or itself."""
    message = msgspec.msgpack.decode(received)
    if message["type"] != "bundle":
        return [message]
    return [msgspec.msgpack.decode(one) for one in message["messages"]]


class Page:
    """A page that speaks the stream's language."""

    def __init__(self, link):
        self.link = link
        self.got = []

    async def say(self, do, **fields):
        await self.link.send(json.dumps({"do": do, **fields}))

    async def until(self, wanted, seconds=60.0):
        async with asyncio.timeout(seconds):
            while True:
                for message in messages(await self.link.recv()):
                    self.got.append(message)
                    if message["type"] == "frame":
                        await self.say("seen", tick=message["tick"])
                    if message["type"] == "inspection":
                        await self.say("inspected")
                    if wanted(message):
                        return message

    async def frame(self, wanted=lambda _: True):
        return await self.until(lambda one: one["type"] == "frame" and wanted(one))

    async def until_closed(self):
        while True:
            await self.link.recv()


@contextlib.asynccontextmanager
async def page(server, *, join=True, **options):
    address = f"ws://127.0.0.1:{server.port}/stream"
    async with websockets.connect(address, max_size=None, **options) as link:
        page = Page(link)
        if join:
            await page.say("join", version=VERSION)
        yield page


def run(coroutine):
    return asyncio.run(coroutine)


def test_a_page_gets_everything_it_needs_in_order(server):
    async def scene():
        async with page(server) as one:
            await one.frame()
            return one.got

    got = run(scene())
    kinds = [message["type"] for message in got]
    assert kinds[:4] == ["hello", "parameters", "events", "timeline"]
    assert kinds.index("layout") < kinds.index("frame")
    hello, layout, frame = got[0], got[kinds.index("layout")], got[-1]
    assert (hello["version"], hello["seed"], hello["title"]) == (VERSION, 5, "small")
    assert [one["name"] for one in layout["points"]] == ["drifters"]
    assert frame["layout"] == layout["revision"]
    drifting = frame["drifting"]["drifters"]
    low, high = np.array(drifting["box"]).reshape(2, 3)
    steps = np.frombuffer(drifting["positions"], "<u2").reshape(-1, 3)
    places = low + steps / 65535 * (high - low)
    assert len(places) == 8
    assert (np.abs(places) < 20).all()


def test_pause_step_back_and_seek(server):
    async def scene():
        async with page(server) as one:
            await one.frame(lambda frame: frame["tick"] > 40)
            await one.say("pause")
            paused = await one.frame(lambda frame: not frame["running"])
            await one.say("step", ticks=3)
            stepped = await one.frame(lambda frame: frame["tick"] != paused["tick"])
            there = stepped["drifting"]["drifters"]["positions"]
            await one.say("back", ticks=2)
            back = await one.frame(lambda frame: frame["tick"] < stepped["tick"])
            await one.say("seek", tick=5)
            early = await one.frame(lambda frame: frame["tick"] == 5)
            await one.say("seek", tick=stepped["tick"])
            again = await one.frame(lambda frame: frame["tick"] == stepped["tick"])
            await one.say("play")
            await one.frame(lambda frame: frame["running"])
            return paused, stepped, back, early, again, there

    paused, stepped, back, early, again, there = run(scene())
    assert stepped["tick"] == paused["tick"] + 3
    assert back["tick"] == stepped["tick"] - 2
    assert not early["running"]
    assert again["drifting"]["drifters"]["positions"] == there


def test_what_was_changed_is_changed_again_in_a_replay(server):
    async def scene():
        async with page(server) as one:
            await one.say("pause")
            await one.frame(lambda frame: not frame["running"])
            await one.say("restart", seed=8, set=[["drifters", "wander", 1.9]], tick=20)
            hello = await one.until(lambda one: one["type"] == "hello")
            first = await one.frame(lambda frame: frame["tick"] == 20)
            await one.say("set", owner="drifters", name="wander", value=0.0)
            await one.until(
                lambda one: one["type"] == "parameters" and wander(one["owners"]) == 0.0
            )
            await one.say("step", ticks=30)
            end = await one.frame(lambda frame: frame["tick"] == 50)
            await one.say("seek", tick=20)
            await one.frame(lambda frame: frame["tick"] == 20)
            await one.say("seek", tick=50)
            again = await one.frame(lambda frame: frame["tick"] == 50)
            await one.say("play")
            return hello, first, end, again

    def wander(owners):
        rows = next(owner["parameters"] for owner in owners if owner["name"] == "drifters")
        return next(row["value"] for row in rows if row["name"] == "wander")

    hello, first, end, again = run(scene())
    assert hello["seed"] == 8
    assert end["drifting"]["drifters"] == again["drifting"]["drifters"]
    assert end["drifting"]["drifters"] != first["drifting"]["drifters"]


def test_the_same_seed_lives_the_same_live_and_alone(server, script):
    async def scene():
        async with page(server) as one:
            await one.say("pause")
            await one.frame(lambda frame: not frame["running"])
            await one.say("restart", seed=11, tick=90)
            await one.frame(lambda frame: frame["tick"] == 90)
            await one.say("snapshot")
            saved = await one.until(lambda one: one["type"] == "snapshot")
            await one.say("play")
            return saved

    saved = run(scene())
    from conftest import small_world

    alone = small_world(11)
    alone.step(90)
    restored = script.parent / "live.world"
    restored.write_bytes(saved["bytes"])
    assert bio.World.restore(restored).state_hash() == alone.state_hash()


def test_inspection_of_a_selected_individual(server):
    async def scene():
        async with page(server) as one:
            await one.say("pause")
            await one.say("restart", seed=5)
            await one.until(lambda one: one["type"] == "hello")
            await one.say("select", id=3)
            return await one.until(lambda one: one["type"] == "inspection" and one["values"])

    found = run(scene())
    assert found["population"] == "drifters"
    assert found["values"]["height_m"] == pytest.approx(-1.3)


def test_each_page_has_its_own_selection_and_a_refused_value_is_said(server):
    async def scene():
        async with page(server) as one, page(server) as two:
            await one.say("play")
            await one.say("select", id=2)
            await one.until(lambda one: one["type"] == "inspection")
            await two.frame()
            await two.frame()
            await two.say("set", owner="drifters", name="wander", value=77.0)
            notice = await two.until(lambda one: one["type"] == "notice")
            return notice, two.got

    notice, got = run(scene())
    assert "wander = 77" in notice["text"]
    assert not [one for one in got if one["type"] == "inspection"]


MALFORMED = [
    "not json",
    '{"do": "dance"}',
    '{"do": "step", "ticks": -1}',
    '{"do": "step", "ticks": 1e99}',
    '{"do": "speed", "factor": NaN}',
    '{"do": "set", "owner": 3, "name": "x", "value": 1}',
    '{"do": "select", "id": 99999999999}',
    '{"do": "pause", "why": "because"}',
    "[]",
    '"' + "x" * 60000 + '"',
]


@pytest.mark.parametrize("text", MALFORMED)
def test_malformed_messages_end_that_page_only(server, text):
    async def scene():
        async with page(server) as good, page(server) as bad:
            await good.say("play")
            await bad.frame()
            await bad.link.send(text)
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await asyncio.wait_for(bad.until_closed(), 10)
            await good.frame()
            return closed.value.rcvd.code

    assert run(scene()) == 4000


def test_oversized_messages_are_refused(server):
    async def scene():
        async with page(server) as one:
            await one.link.send("x" * 200_000)
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await asyncio.wait_for(one.until_closed(), 10)
            return closed.value.rcvd

    farewell = run(scene())
    # A link that is cut with half a message under way may lose the farewell.
    assert farewell is None or farewell.code == 1009


def test_nothing_is_done_before_join_and_other_versions_are_told(server):
    async def scene(first):
        async with page(server, join=False) as one:
            await one.link.send(json.dumps(first))
            notice = await one.until(lambda one: one["type"] == "notice")
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await one.link.recv()
            return notice["text"], closed.value.rcvd.code

    assert run(scene({"do": "pause"})) == ("expected join first", 4000)
    text, code = run(scene({"do": "join", "version": "0.0.0"}))
    assert code == 4002
    assert "0.0.0" in text


@pytest.mark.parametrize("origin", ["https://evil.example", "http://127.0.0.1:1"])
def test_foreign_origins_are_refused(server, origin):
    async def scene():
        async with page(server, origin=origin):
            pass

    with pytest.raises(websockets.InvalidStatus, match="403"):
        run(scene())


def test_foreign_host_names_are_refused(server):
    request = urllib.request.Request(
        f"http://127.0.0.1:{server.port}/", headers={"Host": "evil.example"}
    )
    with pytest.raises(urllib.error.HTTPError, match="421"):
        urllib.request.urlopen(request)


@pytest.mark.parametrize(
    "path", ["/../server.py", "/..%2fserver.py", "//etc/passwd", "/page/../../cli.py", "/server.py"]
)
def test_only_the_page_is_served(server, path):
    with socket.create_connection(("127.0.0.1", server.port)) as link:
        host = f"127.0.0.1:{server.port}"
        link.sendall(f"GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode())
        answer = b""
        while part := link.recv(65536):
            answer += part
    assert answer.startswith(b"HTTP/1.1 404")
    assert b"root:" not in answer


def test_slow_and_vanished_pages_do_not_slow_the_world(server):
    async def scene():
        async with page(server) as watcher:
            await watcher.say("play")
        async with page(server) as watcher, contextlib.AsyncExitStack() as stack:
            await watcher.say("speed", factor=1.0)
            for number in range(4):
                lazy = await stack.enter_async_context(page(server))
                if number % 2:
                    lazy.link.transport.abort()
            start = await watcher.frame()
            began = time.monotonic()
            while time.monotonic() < began + 3:
                end = await watcher.frame()
            return (end["tick"] - start["tick"]) / (time.monotonic() - began)

    assert run(scene()) > 20


def test_other_addresses_need_the_token(script):
    server = Server(script, "--port", free_port(), "--host", "0.0.0.0", "--token", "seahorse")
    assert "?token=seahorse" in server.address

    async def scene(token):
        async with page(server, join=False) as one:
            await one.say("join", version=VERSION, token=token)
            with contextlib.suppress(websockets.ConnectionClosed):
                await one.frame()
                return "in"
            return one.got[-1]["text"]

    assert run(scene("seahorse")) == "in"
    assert "token" in run(scene("wrong"))
    assert "token" in run(scene(None))
    assert server.close() == 130


def test_a_port_in_use_gives_way_to_the_next(script):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        server = Server(script, "--port", port)
        assert server.port > port
        assert any(f"port {port} is in use" in line for line in server.said)
        assert server.close() == 130


def test_a_world_that_fails_says_so_and_stays(tmp_path):
    path = tmp_path / "failing.py"
    path.write_text(
        "import bioscope as bio\n"
        "class Failing(bio.Population):\n"
        "    ticks = 0\n"
        "    def move(self, dt):\n"
        "        self.ticks = self.ticks + 1\n"
        "        if self.ticks == 30: raise ValueError('out of luck')\n"
        "def world(seed):\n"
        "    w = bio.World(seed=seed); w.add(Failing()); return w\n"
    )
    server = Server(path, "--port", free_port())

    async def scene():
        async with page(server) as one:
            notice = await one.until(lambda one: one["type"] == "notice")
            frame = await one.frame(lambda frame: not frame["running"])
            return notice, frame

    notice, frame = run(scene())
    assert "out of luck" in notice["text"]
    assert "failing.py:6" in notice["text"]
    assert frame["tick"] == 29
    server.close()
