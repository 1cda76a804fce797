"""What a page may send: docs/reference/stream.md, "From the page"."""

from __future__ import annotations

from typing import Annotated, TypeVar

import msgspec

from bioscope.errors import FormatError
from bioscope.world.changes import Addition

LARGEST_MESSAGE = 128 * 1024
"""Bytes; longer messages are refused."""

Ticks = Annotated[int, msgspec.Meta(ge=1, le=100_000)]
Tick = Annotated[int, msgspec.Meta(ge=0, le=10_000_000)]
Word = Annotated[str, msgspec.Meta(max_length=200)]
Id = Annotated[int, msgspec.Meta(ge=0, lt=2**32)]
Angle = Annotated[float, msgspec.Meta(ge=-180.0, le=180.0)]


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

    id: Id
    retina: tuple[
        Annotated[int, msgspec.Meta(ge=1, le=256)], Annotated[int, msgspec.Meta(ge=1, le=256)]
    ] = (96, 96)
    pan: Angle = 0.0
    """Degrees by which its eyes are turned to the left."""
    tilt: Angle = 0.0
    """Degrees by which they are turned up."""
    both: bool = False
    """Whether each eye is shown by itself, the left one at the left."""


class Set(Command, tag="set", frozen=True):
    """Change a parameter."""

    owner: Word
    name: Word
    value: float


class Resize(Command, tag="resize", frozen=True):
    """Let a population be this many."""

    population: Word
    count: Annotated[int, msgspec.Meta(ge=0, le=1_000_000)]


class Remove(Command, tag="remove", frozen=True):
    """Take an individual out of the world."""

    id: Id


class Place(Command, tag="place", frozen=True):
    """Put an individual elsewhere, and size it."""

    id: Id
    position: tuple[float, float, float]
    scale: float = 1.0


class Trait(Command, tag="trait", frozen=True):
    """Change a parameter of one individual."""

    id: Id
    name: Word
    value: float


class Steering(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Motor commands in place of a mind's; see `Population.steer`."""

    turn: float = 0.0
    pitch: float = 0.0
    speed: float = 0.0
    brake: float = 0.0
    mouth: float = 0.0


class Steer(Command, tag="steer", frozen=True):
    """Take the place of an animal's mind; null gives it back."""

    id: Id
    steering: Steering | None


class Add(Command, tag="add", frozen=True):
    """Let a new population live in the world."""

    addition: Addition


class Display(Command, tag="display", frozen=True):
    """Show every so many ticks; null for as many pictures as can be."""

    ticks: Annotated[int, msgspec.Meta(ge=1, le=10_000)] | None


class AskScript(Command, tag="script", frozen=True):
    """Ask for the script of the world: how it was made and what was done to it."""


class PlayScript(Command, tag="play script", frozen=True):
    """Make the world of a script."""

    text: Annotated[str, msgspec.Meta(max_length=LARGEST_MESSAGE)]


class Annotations(Command, tag="annotations", frozen=True):
    """Say whether frames carry annotations."""

    on: bool


class Snapshot(Command, tag="snapshot", frozen=True):
    """Ask for the saved world."""


class Seen(Command, tag="seen", frozen=True):
    """Acknowledge that a frame has been drawn."""

    tick: Annotated[int, msgspec.Meta(ge=0)]


class Inspected(Command, tag="inspected", frozen=True):
    """Acknowledge that an inspection has been shown: the next may come."""


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
    | Resize
    | Remove
    | Place
    | Trait
    | Steer
    | Add
    | Display
    | AskScript
    | PlayScript
    | Annotations
    | Snapshot
    | Seen
    | Inspected
)

_decoder = msgspec.json.Decoder(AnyCommand)
_Any = TypeVar("_Any")


def decode(text: str | bytes) -> AnyCommand:
    """Return the command in a message.

    Raises
    ------
    FormatError
        If it is too long or none of the table.
    """
    command: AnyCommand = decode_by(_decoder, text, LARGEST_MESSAGE)
    return command


def decode_by(decoder: msgspec.json.Decoder[_Any], text: str | bytes, longest: int) -> _Any:
    """Return the command in a message of at most so many bytes, as the decoder of a page reads it.

    Raises
    ------
    FormatError
        If it is too long or unknown to the decoder.
    """
    if len(text) > longest:
        raise FormatError(f"message of {len(text)} bytes: expected at most {longest}")
    try:
        return decoder.decode(text)
    except (msgspec.DecodeError, ValueError) as error:
        raise FormatError(f"malformed message: {error}") from None


def encode(type_: str, **fields: object) -> bytes:
    """Return a message from the world."""
    return msgspec.msgpack.encode({"type": type_, **fields})


def bundle(messages: list[bytes]) -> bytes:
    """Return several messages as one, which costs less to carry."""
    return messages[0] if len(messages) == 1 else encode("bundle", messages=messages)
