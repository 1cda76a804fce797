"""What the options of definitions declare for the world that they share (thesis, appendix B)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from bioscope.errors import LimitError
from bioscope.lsystem.animation.automata import Behavior, read_behavior
from bioscope.lsystem.animation.files import CHANNELS, Channel, Trajectory, located, plain

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from bioscope.lsystem.definition.grammar import Definition, Option

MOST_ACTORS = 64
EDGE, COLORS = 40, 27
"""Edge of a window in pixels, and the colors that it tells apart, if nothing is said of it."""
MOST_PIXELS = 512
"""Of the edge of a window."""


class WindowSize(NamedTuple):
    """How finely an actor sees."""

    edge: int
    """Pixels."""
    colors: int
    """How many colors it tells apart."""


@dataclass(slots=True)
class Options:
    """The options of all definitions of an animation."""

    most_particles: int = 0
    commands: dict[int, list[str]] = field(default_factory=dict)
    """Command files: script and its own words, by number."""
    recognizer: tuple[int, str] | None = None
    actors: int = 0
    """Actors 0 to here are declared, each with a window."""
    windows: dict[int, WindowSize] = field(default_factory=dict)
    behaviors: list[tuple[int, Behavior]] = field(default_factory=list)
    """Actors and what they begin with, the last on top of their stacks."""
    sound_log: str | None = None
    sounds: list[str] = field(default_factory=list)
    """Commands with which the sound log begins."""
    scene: str | None = None
    """Name of the scenes for the offline renderer."""
    shown: list[tuple[int, int]] = field(default_factory=list)
    """First and last frames that it renders; all if there are none."""
    channels: list[Channel] = field(default_factory=list)
    trajectories: dict[int, Trajectory] = field(default_factory=dict)
    traces: dict[int, str] = field(default_factory=dict)
    """By actor the file of its trajectory."""

    def read(self, definition: Definition, folder: Path | None) -> None:
        """Take in the options of a definition, and the files of its folder that they name.

        Raises
        ------
        FormatError, LimitError
            For what cannot be, with its place.
        """
        for option in definition.options:
            if option.name in _READERS:
                _READERS[option.name](self, option, folder)
        eyes = [one for one in definition.options if one.name.startswith("iVisionWinSize")]
        for option in eyes:
            self._window(option)

    def _actors(self, option: Option, folder: Path | None) -> None:
        number = _whole(option, 0)
        if number < 0:
            raise option.error(f"expected 0 to {MOST_ACTORS} actors, found {number}", 0)
        if number > MOST_ACTORS:
            raise LimitError(f"{option.places[1]}: there are at most {MOST_ACTORS} actors")
        self.actors = max(self.actors, number)
        for actor in range(number):
            self.windows.setdefault(actor, WindowSize(EDGE, COLORS))

    def _window(self, option: Option) -> None:
        actor, edge, colors = (_whole(option, word) for word in range(3))
        if not 0 <= actor < self.actors:
            known = f"0 to {self.actors - 1}" if self.actors else "none"
            message = f"expected an actor that 'NBR_actors' declares ({known}), found {actor}"
            raise option.error(message, 0)
        if not 1 <= edge <= MOST_PIXELS:
            raise option.error(f"expected an edge of 1 to {MOST_PIXELS} pixels, found {edge}", 1)
        if colors < 1:
            raise option.error(f"expected at least 1 color to tell apart, found {colors}", 2)
        self.windows[actor] = WindowSize(edge, colors)

    def _behavior(self, option: Option, folder: Path | None) -> None:
        behavior = read_behavior(" ".join(option.words[1:]), option.places[0], option.places[2:])
        self.behaviors.append((_whole(option, 0), behavior))

    def _channels(self, option: Option, folder: Path | None) -> None:
        number, names = _whole(option, 0), option.words[1:]
        if not 0 <= number <= CHANNELS or len(names) != number:
            raise option.error(f"up to {CHANNELS} data channels, and as many names")
        self.channels += [Channel(located(one, folder, option.places[0])) for one in names]

    def _trajectory(self, option: Option, folder: Path | None) -> None:
        number, path = _whole(option, 0), located(option.words[1], folder, option.places[0])
        self.trajectories[number] = Trajectory(path, number)

    def _particles(self, option: Option, folder: Path | None) -> None:
        self.most_particles += max(0, _whole(option, 0))

    def _command(self, option: Option, folder: Path | None) -> None:
        self.commands[_whole(option, 0)] = option.words[1:]

    def _recognizer(self, option: Option, folder: Path | None) -> None:
        self.recognizer = _whole(option, 0), option.words[1]

    def _sounds(self, option: Option, folder: Path | None) -> None:
        self.sound_log, self.sounds = plain(option.words[0]), option.words[1:]

    def _scene(self, option: Option, folder: Path | None) -> None:
        self.scene = plain(option.words[1])

    def _frames(self, option: Option, folder: Path | None) -> None:
        ends = [_whole(option, word) for word in range(len(option.words))]
        self.shown = list(zip(ends[::2], ends[1::2], strict=True))

    def _trace(self, option: Option, folder: Path | None) -> None:
        self.traces[_whole(option, 0)] = plain(option.words[1])


def _whole(option: Option, word: int) -> int:
    return int(float(option.words[word]))


_READERS: dict[str, Callable[[Options, Option, Path | None], None]] = {
    "MaxPart": Options._particles,
    "command_file": Options._command,
    "AUDIOport_host": Options._recognizer,
    "NBR_actors": Options._actors,
    "actorNbr_automata": Options._behavior,
    "Sound_event_file": Options._sounds,
    "rs_file_path_name": Options._scene,
    "rs_switch": Options._frames,
    "NbrChannels_listOfNames": Options._channels,
    "trace_actor": Options._trace,
    "import_trace": Options._trajectory,
}
"""Constant arrays are read by the definition itself, windows after all actors are known."""
