"""Figures of plants that grow in a world: 200 trees that compete for light, on a page."""

import asyncio
import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import msgspec
import numpy as np
import websockets

import bioscope as bio
from bioscope import __version__
from bioscope.bench import Figure

TREES = 200
YEAR = 31
"""Steps of a year of the model."""

START = 4
"""Age of the trees in years when the measurement begins."""

RATE = 10.0
"""Growth steps per second of world time."""

SECONDS = 8.0


def world(seed: int) -> bio.World:
    """Make a wood of 200 young trees, 3 m apart, that make 10 growth steps a second."""
    wood = bio.World(seed=seed, dt=1 / 30, title="grow.live")
    wood.environment.terrain(np.zeros((9, 9), np.float32), spacing=20.0)
    wood.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=(0.17, 0.20, 0.07)))
    wood.environment.add(bio.Current(speed=1.5, turbulence=0.5), "wind")
    places = [(3.0 * (number % 20) - 28.5, 3.0 * (number // 20) - 13.5) for number in range(TREES)]
    trees = bio.Plants(
        "sun_tree",
        TREES,
        species="tree",
        habitat=bio.Habitat(area=places),
        rate=RATE,
        start=START * YEAR,
        flexibility=0.05,
    )
    wood.add(trees, "trees")
    wood.cameras.orbit("round", target=(0.0, 2.5, 0.0), radius=38.0, height=14.0, period=90)
    return wood


def tick() -> Iterator[Figure]:
    """One year of the wood: processor time of a tick on all cores together."""
    wood = world(seed=1)
    times = []
    for _ in range(3 * YEAR):
        start = time.process_time()
        wood.step()
        times.append(time.process_time() - start)
    said = wood.statistics()
    note = f"{said['trees.segments']:,.0f} segments, {said['trees.leaves']:,.0f} leaves at the end"
    yield Figure("grow.tick", 1000 * float(np.mean(times)), "ms", target=1000 / 30, note=note)


def frames_in(message: bytes) -> list[dict]:
    """Return the frames that a message carries, by itself or in a bundle."""
    decoded = msgspec.msgpack.decode(message)
    if decoded["type"] != "bundle":
        return [decoded] if decoded["type"] == "frame" else []
    # A frame comes last, after what it needs.
    return frames_in(decoded["messages"][-1])


async def watch(port: int) -> tuple[float, float, float]:
    """Watch as one page; return frames, growth steps and megabytes per second."""
    address = f"ws://127.0.0.1:{port}/stream"
    frames, received, first, last, end = 0, 0, 0.0, 0.0, None
    async with websockets.connect(address, max_size=None) as link:
        await link.send(json.dumps({"do": "join", "version": __version__}))
        while end is None or time.monotonic() < end:
            message = await link.recv()
            received += len(message)
            for frame in frames_in(message):
                await link.send(json.dumps({"do": "seen", "tick": frame["tick"]}))
                if end is None:
                    end, first, received = time.monotonic() + SECONDS, frame["time"], 0
                frames, last = frames + 1, frame["time"]
    return (frames - 1) / SECONDS, RATE * (last - first) / SECONDS, received / SECONDS / 1e6


def live() -> Iterator[Figure]:
    """The wood with a page that takes every frame."""
    command = [sys.executable, "-m", "bioscope.cli", "live", __file__, "--no-open", "--seed", "1"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        lines = iter(process.stderr)
        port = next(int(one[1]) for line in lines if (one := re.search(r"live at .*:(\d+)/", line)))
        frames, steps, megabytes = asyncio.run(watch(port))
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(20)
    note = f"{megabytes:.0f} MB/s"
    yield Figure("grow.live", frames, "frames/s", target=29.5, better="higher", note=note)
    yield Figure("grow.live.steps", steps, "growth steps/s", target=9.8, better="higher")


BENCHMARKS = {"grow": tick, "grow.live": live}
