"""What a page may send: docs/reference/stream.md, "From the page"."""

from __future__ import annotations

from typing import Annotated

import msgspec

from bioscope.errors import FormatError

LARGEST_MESSAGE = 64 * 1024
"""Bytes; longer messages are refused."""

Ticks = Annotated[int, msgspec.Meta(ge=1, le=100_000)]
Tick = Annotated[int, msgspec.Meta(ge=0, le=10_000_000)]
Word = Annotated[str, msgspec.Meta(max_length=200)]


class Command(msgspec.Struct, tag_field="do", forbid_unknown_fields=True, frozen=True):
    """Base of all commands."""


class Join(Command, tag="join", frozen=True):
    """First message of a page."""

    version: Word
    token: Word | None = None


class Play(Command, tag="play", frozen=True):
    """Run."""


class Pause(Command, tag="pause", frozen=True):
    """Stand still."""


class Step(Command, tag="step", frozen=True):
    """Pause and go forward."""

    ticks: Ticks = 1


class Back(Command, tag="back", frozen=True):
    """Pause and go back."""

    ticks: Ticks = 1


class Seek(Command, tag="seek", frozen=True):
    """Go to a tick between first and last."""

    tick: Tick


class Speed(Command, tag="speed", frozen=True):
    """Times real time; null for as fast as possible."""

    factor: Annotated[float, msgspec.Meta(ge=0.05, le=100.0)] | None


class Restart(Command, tag="restart", frozen=True):
    """Begin a new world of this seed, with these parameters, run to this tick."""

    seed: Annotated[int, msgspec.Meta(ge=0)] | None = None
    set: Annotated[list[tuple[Word, Word, float]], msgspec.Meta(max_length=500)] = []
    tick: Annotated[int, msgspec.Meta(ge=0, le=100_000)] = 0


class Select(Command, tag="select", frozen=True):
    """Inspect this individual."""

    id: Annotated[int, msgspec.Meta(ge=0, lt=2**32)]
    retina: tuple[
        Annotated[int, msgspec.Meta(ge=1, le=256)], Annotated[int, msgspec.Meta(ge=1, le=256)]
    ] = (96, 96)


class Set(Command, tag="set", frozen=True):
    """Change a parameter."""

    owner: Word
    name: Word
    value: float


class Annotations(Command, tag="annotations", frozen=True):
    """Say whether frames carry annotations."""

    on: bool


class Snapshot(Command, tag="snapshot", frozen=True):
    """Ask for the saved world."""


class Seen(Command, tag="seen", frozen=True):
    """Acknowledge that a frame has been drawn."""

    tick: Annotated[int, msgspec.Meta(ge=0)]


AnyCommand = (
    Join
    | Play
    | Pause
    | Step
    | Back
    | Seek
    | Speed
    | Restart
    | Select
    | Set
    | Annotations
    | Snapshot
    | Seen
)

_decoder = msgspec.json.Decoder(AnyCommand)


def decode(text: str | bytes) -> AnyCommand:
    """Return the command in a message.

    Raises
    ------
    FormatError
        If it is too long or none of the table.
    """
    if len(text) > LARGEST_MESSAGE:
        raise FormatError(f"message of {len(text)} bytes: expected at most {LARGEST_MESSAGE}")
    try:
        command: AnyCommand = _decoder.decode(text)
    except (msgspec.DecodeError, ValueError) as error:
        raise FormatError(f"malformed message: {error}") from None
    return command


def encode(type_: str, **fields: object) -> bytes:
    """Return a message from the world."""
    return msgspec.msgpack.encode({"type": type_, **fields})
