"""Figures of the live view: bytes per second, and ticks per second with two pages attached."""

import asyncio
import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import msgspec
import websockets

from bioscope import __version__
from bioscope.bench import Figure

SECONDS = 8.0


async def watch(port: int) -> tuple[float, float]:
    """Watch as two pages; return megabytes per second to one of them and ticks per second."""

    async def page() -> tuple[int, int, int]:
        address = f"ws://127.0.0.1:{port}/stream"
        async with websockets.connect(address, max_size=None) as link:
            await link.send(json.dumps({"do": "join", "version": __version__}))
            first = last = received = 0
            end = None
            while end is None or time.monotonic() < end:
                message = await link.recv()
                decoded = msgspec.msgpack.decode(message)
                if decoded["type"] != "frame":
                    continue
                await link.send(json.dumps({"do": "seen", "tick": decoded["tick"]}))
                if end is None:
                    end, first = time.monotonic() + SECONDS, decoded["tick"]
                received, last = received + len(message), decoded["tick"]
            return received, first, last

    one, _ = await asyncio.gather(page(), page())
    return one[0] / SECONDS / 1e6, (one[2] - one[1]) / SECONDS


def stream() -> Iterator[Figure]:
    """The reef with two pages that take every frame."""
    command = [sys.executable, "-m", "bioscope.cli", "live", "reef", "--no-open", "--seed", "7"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        lines = iter(process.stderr)
        port = next(int(one[1]) for line in lines if (one := re.search(r"live at .*:(\d+)/", line)))
        megabytes, ticks = asyncio.run(watch(port))
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(20)
    yield Figure("live.stream", megabytes, "MB/s", target=3.0)
    yield Figure("live.ticks", ticks, "ticks/s", target=59.0, better="higher")


BENCHMARKS = {"live": stream}
