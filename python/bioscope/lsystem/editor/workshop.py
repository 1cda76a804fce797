"""The processes that grow plants for a page: none can block or end the server."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from typing import TYPE_CHECKING

import msgspec

from bioscope.lsystem.editor.growing import Palette, gave_up
from bioscope.lsystem.editor.worker import framed, length_of

if TYPE_CHECKING:
    from asyncio.subprocess import Process
    from collections.abc import AsyncGenerator

    from bioscope.lsystem.editor.messages import Grow

SECONDS = 15.0
"""Time that a plant may take to grow."""
_PROGRAM = "from bioscope.lsystem.editor import worker; worker.main()"
PATIENCE = 0.3
"""Seconds that a plant may still take once a newer one is asked for."""


class Workshop:
    """Grows the newest order; older ones are given up, if need be by ending their process.

    Parameters
    ----------
    file, palette
        See `growing.Grower`.
    seconds
        Time that a plant may take to grow.
    """

    def __init__(self, file: str, palette: Palette, seconds: float = SECONDS) -> None:
        self._start_with = framed(msgspec.msgpack.encode((file, palette)))
        self._seconds = seconds
        self._order: Grow | None = None
        self._asked = asyncio.Event()
        self._spare: asyncio.Task[Process] | None = None

    def ask(self, order: Grow) -> None:
        """Ask for a plant, instead of any that was asked for and is not grown yet."""
        self._order = order
        self._asked.set()

    async def answers(self) -> AsyncGenerator[bytes, None]:
        """Yield the messages that answer orders, until cancelled."""
        worker = await self._started()
        try:
            while True:
                await self._asked.wait()
                self._asked.clear()
                order, self._order = self._order, None
                if order is None:
                    continue
                # One is kept ready, for a page that cannot wait for a new one to start.
                self._spare = self._spare or asyncio.create_task(self._started())
                answer, alive = await self._grown(worker, order)
                if answer is not None:
                    yield answer
                if not alive:
                    await _end(worker)
                    worker, self._spare = await self._spare, None
        finally:
            await _end(worker)
            if self._spare is not None:
                with contextlib.suppress(asyncio.CancelledError, OSError):
                    await _end(await self._spare)

    async def _grown(self, worker: Process, order: Grow) -> tuple[bytes | None, bool]:
        """Return the answer, if there is one, and whether the worker can go on."""
        growing = asyncio.ensure_future(_exchange(worker, msgspec.msgpack.encode(order)))
        newer = asyncio.ensure_future(self._asked.wait())
        try:
            await asyncio.wait(
                {growing, newer}, timeout=self._seconds, return_when=asyncio.FIRST_COMPLETED
            )
            if newer.done():
                await asyncio.wait({growing}, timeout=PATIENCE)
            if growing.done():
                return growing.result(), True
            if newer.done():
                return None, False
            text = f"not grown after {self._seconds:g} s: take fewer steps, or a smaller plant"
        except (ConnectionError, asyncio.IncompleteReadError):
            text = "the process that grows it ended, probably for want of memory: take fewer steps"
        finally:
            growing.cancel()
            newer.cancel()
        return msgspec.msgpack.encode(gave_up(order, text)), False

    async def _started(self) -> Process:
        process = await asyncio.create_subprocess_exec(
            *(
                sys.executable,
                "-P",
                "-c",
                "from bioscope.lsystem.editor import worker; worker.main()",
            ),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for the server, which ends its workers
        )
        assert process.stdin is not None  # asked for above
        process.stdin.write(self._start_with)
        return process


async def _exchange(worker: Process, order: bytes) -> bytes:
    assert worker.stdin is not None  # pipes, see _started
    assert worker.stdout is not None
    worker.stdin.write(framed(order))
    await worker.stdin.drain()
    head = await worker.stdout.readexactly(4)
    return await worker.stdout.readexactly(length_of(head))


async def _end(worker: Process) -> None:
    with contextlib.suppress(ProcessLookupError):
        worker.kill()
    await worker.wait()
