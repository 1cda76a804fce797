"""What a page of the editor may send."""

from __future__ import annotations

from typing import Annotated

import msgspec

from bioscope.live.messages import Command, Join, Word, decode_by

LONGEST_TEXT = 500_000
"""Letters of a model."""
LARGEST_MESSAGE = 2 * 1024 * 1024
"""Bytes; longer messages are refused."""

Text = Annotated[str, msgspec.Meta(max_length=LONGEST_TEXT)]


class Grow(Command, tag="grow", frozen=True):
    """Grow the plant of this text. What was asked for before and is not done yet is given up."""

    number: Annotated[int, msgspec.Meta(ge=0)]
    text: Text
    steps: Annotated[int, msgspec.Meta(ge=0, le=100_000)] | None = None
    """As many as the text says, if none."""
    seed: Annotated[int, msgspec.Meta(ge=0, lt=2**53)] = 1
    homomorphism: bool = False
    """Whether the string is told as the turtle reads it."""
    environment: Word | None = None
    """Name of the surroundings in which the plant grows."""


class Save(Command, tag="save", frozen=True):
    """Write this text to the file that is edited."""

    text: Text


AnyCommand = Join | Grow | Save

_decoder = msgspec.json.Decoder(AnyCommand)


def decode(text: str | bytes) -> AnyCommand:
    """Return the command in a message.

    Raises
    ------
    FormatError
        If it is too long or none of the table.
    """
    command: AnyCommand = decode_by(_decoder, text, LARGEST_MESSAGE)
    return command
