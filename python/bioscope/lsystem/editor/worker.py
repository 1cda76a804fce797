"""A process that grows plants, one at a time: orders come in, messages for the page go out.

Both are MessagePack behind their length (four bytes, big endian).
"""

from __future__ import annotations

import contextlib
import os
import struct
import sys
from typing import BinaryIO

import msgspec

from bioscope.lsystem.editor.growing import Grower, Palette
from bioscope.lsystem.editor.messages import Grow

MEMORY = 4 << 30
"""Bytes that the process may ask for."""
_LENGTH = struct.Struct(">I")


def framed(message: bytes) -> bytes:
    """Return a message behind its length."""
    return _LENGTH.pack(len(message)) + message


def length_of(head: bytes) -> int:
    """Return the length that stands before a message."""
    length: int = _LENGTH.unpack(head)[0]
    return length


def main() -> None:
    """Grow until the orders end."""
    # What a model prints must not get between the messages.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    _bound()
    orders = sys.stdin.buffer
    head = _message(orders)
    if head is None:
        return
    file, palette = msgspec.msgpack.decode(head, type=tuple[str, Palette])
    grower = Grower(file, palette)
    decoder = msgspec.msgpack.Decoder(Grow)
    while (order := _message(orders)) is not None:
        answers.write(framed(msgspec.msgpack.encode(grower.grow(decoder.decode(order)))))
        answers.flush()


def _message(stream: BinaryIO) -> bytes | None:
    head = stream.read(_LENGTH.size)
    return stream.read(length_of(head)) if len(head) == _LENGTH.size else None


def _bound() -> None:
    """Leave the machine to others: little memory, lower priority; where the system can."""
    with contextlib.suppress(ImportError, OSError, ValueError, AttributeError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        os.nice(5)
