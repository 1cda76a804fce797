"""What is heard: active sounds, and the log that a sound track is made from (section 3.11.3)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from bioscope.errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from bioscope.lsystem.animation.vectors import Vector

_NUMBERS = ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"]
_SPOKEN = [
    *("move right", "move left", "move up", "move down", "move", "go back"),
    *("turn up", "turn down", "turn left", "turn right", "faster", "slow down"),
    *("turn faster", "turn less", "block", "free it", "stop", "blue", "green"),
    *_NUMBERS,
    "exit",
]
VOCABULARY = {word: number for number, word in enumerate(_SPOKEN, 29)}
"""Numbers of the sounds that spoken words make (thesis, table D.2)."""
USER = 1000
"""The source of what the user says."""
LIBRARY = {
    0: "ball_racket",
    1: "ball_ground",
    2: "cricket",
    4: "frog",
    5: "foret",
    6: "start",
    7: "vivaldi",
    8: "avion",
    9: "ball_net",
    **dict(
        enumerate(
            [
                "advantage",
                "all",
                "deuce",
                "fault",
                "fifteen",
                "fourty",
                "game",
                "let",
                "love",
                "server",
                "striker",
                "thirty",
                "blue",
                "green",
                "out",
                "service",
                "left",
                "right",
                "wait02",
            ],
            10,
        )
    ),
    **{number: word.replace(" ", "_") for word, number in VOCABULARY.items()},
}
"""Sounds of the thesis (appendix D) by number."""
ITEMS = {
    "INIT_source": 7,
    "INIT_mic": 7,
    "PLAY": 2,
    "SP": 4,
    "SO": 4,
    "MP": 4,
    "MO": 4,
    "Time": 1,
    "TIME": 1,
    "CONST_S": 7,
    "INIT_dist_matrix": 0,
}
"""Commands of the log, and how many words follow each."""
DURATION = 1.0
"""Seconds of a sound of which the host does not tell how long it is."""


@dataclass(slots=True)
class Sound:
    """A sound that is heard."""

    number: int
    source: int
    start: float
    """Seconds."""
    duration: float
    """Seconds."""
    position: Vector


@dataclass(slots=True)
class Air:
    """All active sounds, and the log."""

    durations: Mapping[int, float] = field(default_factory=dict)
    """Seconds by number of sound."""
    sounds: list[Sound] = field(default_factory=list)
    log: list[list[str]] = field(default_factory=list)
    """Commands, one list per frame; the first says what there is."""
    time: float = 0.0

    def declare(self, words: Sequence[str]) -> None:
        """Keep the commands with which an option begins the log.

        Raises
        ------
        FormatError
            For an unknown command or too few words.
        """
        at = 0
        items = []
        while at < len(words):
            count = ITEMS.get(words[at])
            if count is None or at + count >= len(words):
                raise FormatError(
                    f"sound command '{words[at]}' is unknown or lacks words; "
                    f"known are {', '.join(ITEMS)}"
                )
            items.append(" ".join(words[at : at + count + 1]))
            at += count + 1
        self.log.append(items)

    def tick(self, time: float) -> None:
        """Begin a frame: what has ended is heard no more."""
        self.time = time
        self.sounds = [one for one in self.sounds if one.start + one.duration > time]
        self.log.append([f"TIME {time:.9g}"])

    def begin(self, number: int, source: int, position: Vector | None) -> None:
        """Let a sound begin; without a position it is heard everywhere."""
        name = LIBRARY.get(number, f"sound{number}")
        if position is not None:
            self.move(source, position)
        self.say(f"PLAY {source} {name}.aiff")
        duration = self.durations.get(number, DURATION)
        at = position or (0.0, 0.0, 0.0)
        self.sounds.append(Sound(number, source, self.time, duration, at))

    def move(self, source: int, position: Vector) -> None:
        """Put a source elsewhere, with all that it emits."""
        self.say(f"SP {source} {_numbers(position)}")
        for one in self.sounds:
            if one.source == source:
                one.position = position

    def microphone(self, number: int, position: Vector) -> None:
        """Put a microphone elsewhere."""
        self.say(f"MP {number} {_numbers(position)}")

    def say(self, item: str) -> None:
        """Write a command into the log of this frame."""
        if not self.log:
            self.log.append([])
        self.log[-1].append(item)

    def count(self) -> int:
        """Return how many sounds are active."""
        return len(self.sounds)

    def sound_of(self, source: float) -> int:
        """Return the sound that a source emits now; −1 if none."""
        return next((one.number for one in reversed(self.sounds) if one.source == source), -1)

    def source_of(self, number: float) -> int:
        """Return who emits a sound now; −1 if nobody."""
        return next((one.source for one in reversed(self.sounds) if one.number == number), -1)


def _numbers(vector: Vector) -> str:
    return " ".join(f"{one:.9g}" for one in vector)
