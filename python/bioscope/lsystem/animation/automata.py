"""Commands to the automata of actors, as text (thesis, appendix A and table B6).

A definition, or the symbol `e`, pushes such a text on the stack of an actor. What the automata do
is the host's; here their state variables are set. Variables that are not told keep their values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from bioscope.errors import FormatError
from bioscope.lsystem.animation.vectors import ZERO, Vector, dot, length, subtract, unit

if TYPE_CHECKING:
    from collections.abc import Sequence

COMMANDS = {
    "KEYFRAMEdef": "iw",
    "coll_test_func": "i",
    "heuristic": "i",
    "rel_search_level": "i",
    "goal": "fff",
    "local_goal": "ifff",
    "rgb_interest": "iiii",
    "eps_arrived": "if",
    "eps_look_at_goal": "if",
    "eps_look_at": "if",
    "reset_goal": "",
    "turtle": "i",
    "mem_displ_cubes": "",
    "mem_displ_points": "",
    "mem_no_displ": "",
    "vis_mem_on": "",
    "vis_mem_off": "",
    "obs": "fff",
    "lat": "fff",
    "align": "fff",
    "init": "ifff",
    "fov": "i",
    "interest": "ii",
    "size_actor": "f",
    "dist_coll": "f",
    "tennis_state": "i",
    "state": "i",
    "optim_rate": "i",
    "speed": "f",
    "inertia": "f",
    "ahead": "i",
    "optim_ahead": "i",
    "vision_range": "fff",
    "motor_init": "ffi",
}
"""By command the kinds of its arguments: whole numbers, numbers, words."""

EVER = math.inf
LIMITS: dict[str, list[tuple[float, float]]] = {
    "fov": [(1, 1790)],
    "vision_range": [(1e-6, EVER), (1e-6, EVER), (0, EVER)],
    "size_actor": [(0, EVER)],
    "dist_coll": [(0, EVER)],
    "eps_arrived": [(0, EVER), (0, EVER)],
    "eps_look_at": [(0, EVER), (-1, 1)],
    "eps_look_at_goal": [(0, EVER), (-1, 1)],
    "rgb_interest": [(0, 255), (0, 255), (0, 255), (0, 1)],
    "interest": [(0, 1), (0, 2)],
}
"""By command the least and the greatest of its arguments."""

THINGS = ("ball", "actor1", "actor2")
"""Materials of the things that `interest` numbers (thesis, table B6)."""
ANGLE, NEAR, FAR = 60.0, 0.01, 10000.0
"""Degrees of the angle of view, and the clipping planes, if no command tells them."""
SIZE, REACH = 1.0, 1.0
"""Edge of an actor, and how far ahead it minds obstacles, if no command tells them."""
ARRIVED, LOOKING = 1.0, 0.95
"""Distance from a goal that counts as arrived, and cosine of the angle that counts as looking."""

Argument = float | str


@dataclass(frozen=True, slots=True)
class Behavior:
    """An entry of the stack of an actor."""

    actor: int
    automaton: int
    commands: tuple[tuple[str, tuple[Argument, ...]], ...]


@dataclass(slots=True)
class Actor:
    """What definitions and their host know of an actor."""

    position: Vector = ZERO
    heading: Vector = (1.0, 0.0, 0.0)
    state: int = 0
    stack: list[Behavior] = field(default_factory=list)
    """The behavior at its end is the active one."""
    goals: list[Vector] = field(default_factory=list)
    """A stack too."""
    local_goals: dict[int, Vector] = field(default_factory=dict)
    aim: int | None = None
    """Number of the local goal that was set last, which is the actual one."""
    variables: dict[str, tuple[Argument, ...]] = field(default_factory=dict)
    """What commands have set, by the name of the variable."""

    @property
    def automaton(self) -> int | None:
        """The active automaton."""
        return self.stack[-1].automaton if self.stack else None

    @property
    def goal(self) -> Vector | None:
        """Where it wants to be: its actual local goal, else the top of its stack of goals."""
        if self.aim is not None:
            return self.local_goals[self.aim]
        return self.goals[-1] if self.goals else None

    @property
    def angle(self) -> float:
        """Its angle of view, degrees."""
        return self._number("fov", 0, 10 * ANGLE) / 10

    @property
    def vision_range(self) -> tuple[float, float]:
        """The clipping planes of its eye, units of the model."""
        return self._number("vision_range", 0, NEAR), self._number("vision_range", 1, FAR)

    @property
    def size(self) -> float:
        """Its greatest edge, units of the model."""
        return self._number("size_actor", 0, SIZE)

    @property
    def reach(self) -> float:
        """How far ahead what it sees is an obstacle, units of the model."""
        return self._number("dist_coll", 0, REACH)

    @property
    def things(self) -> tuple[str, ...]:
        """Materials of the things that interest it."""
        return tuple(
            name
            for number, name in enumerate(THINGS)
            if self._number(f"interest {number}", 0, 0) == 1
        )

    @property
    def color_of_interest(self) -> tuple[int, int, int] | None:
        """Red, green and blue that interest it, 0 to 255."""
        red, green, blue, on = (self._number("rgb_interest", part, 0) for part in range(4))
        return (int(red), int(green), int(blue)) if on == 1 else None

    @property
    def looks_at_goal(self) -> bool:
        """Whether it looks at its goal."""
        way = None if self.goal is None else unit(subtract(self.goal, self.position))
        ahead = unit(self.heading)
        if way is None or ahead is None:
            return False
        return dot(ahead, way) >= self._number(f"eps_look_at_goal {self.aim or 0}", 1, LOOKING)

    @property
    def is_at_goal(self) -> bool:
        """Whether it is nearer to its goal than it must be to have arrived."""
        if self.goal is None:
            return False
        enough = self._number(f"eps_arrived {self.aim or 0}", 1, ARRIVED)
        return length(subtract(self.goal, self.position)) < enough

    def set_local_goal(self, number: int, place: Vector) -> None:
        """Make a place the actual goal."""
        self.local_goals[number], self.aim = place, number

    def _number(self, name: str, index: int, otherwise: float) -> float:
        value = self.variables.get(name, ())[index : index + 1]
        return float(value[0]) if value else otherwise

    def push(self, behavior: Behavior) -> None:
        """Activate a behavior; the one before it waits."""
        self.stack.append(behavior)
        self.obey(behavior)

    def pop(self) -> Behavior:
        """End the active behavior; the one before it goes on, its commands obeyed again.

        Raises
        ------
        IndexError
            If there is none.
        """
        ended = self.stack.pop()
        if self.stack:
            self.obey(self.stack[-1])
        return ended

    def obey(self, behavior: Behavior) -> None:
        """Set the state variables that a behavior tells."""
        for command, arguments in behavior.commands:
            self._set(command, arguments)

    def _set(self, command: str, arguments: tuple[Argument, ...]) -> None:
        numbers = [one for one in arguments if isinstance(one, float)]
        if command == "goal":
            self.goals.append((numbers[0], numbers[1], numbers[2]))
        elif command == "reset_goal":
            self.goals.clear()
        elif command == "local_goal":
            self.set_local_goal(int(numbers[0]), (numbers[1], numbers[2], numbers[3]))
        elif command == "state":
            self.state = int(numbers[0])
        elif command in ("eps_arrived", "KEYFRAMEdef", "interest", "eps_look_at_goal"):
            # One variable per goal, track or thing.
            key = numbers[-1] if command == "interest" else numbers[0]
            self.variables[f"{command} {int(key)}"] = arguments
        elif command == "eps_look_at":
            self.variables[f"eps_look_at_goal {int(numbers[0])}"] = arguments
        elif command in ("vis_mem_on", "vis_mem_off"):
            self.variables["vis_mem"] = (float(command == "vis_mem_on"),)
        elif command.startswith("mem_"):
            self.variables["mem_displ"] = (command.removeprefix("mem_").removeprefix("displ_"),)
        else:
            self.variables[command] = arguments
            if command == "obs":
                self.position = numbers[0], numbers[1], numbers[2]
            elif command == "lat":
                target = numbers[0], numbers[1], numbers[2]
                self.heading = unit(subtract(target, self.position)) or self.heading


def read_behavior(text: str, place: str, places: Sequence[str] = ()) -> Behavior:
    """Return a behavior as it is written: actor, automaton, commands with their arguments.

    Parameters
    ----------
    text
        The words, with blanks between them.
    place
        Where they stand, for errors.
    places
        Where each word stands, if that is known.

    Raises
    ------
    FormatError
        For an unknown command, or arguments that are missing, none, or cannot be.
    """
    words = text.split()
    if len(words) < 2 or not (words[0].isdecimal() and words[1].isdecimal()):
        raise FormatError(f"{place}: a behavior begins with the numbers of actor and automaton")
    where = [*places, *[place] * (len(words) - len(places))]
    commands = []
    at = 2
    while at < len(words):
        name = words[at]
        if name not in COMMANDS:
            known = ", ".join(COMMANDS)
            raise FormatError(f"{where[at]}: unknown command '{name}'; known: {known}")
        kinds = COMMANDS[name]
        given = words[at + 1 : at + 1 + len(kinds)]
        if len(given) < len(kinds):
            message = f"'{name}' has {len(kinds)} arguments, found {len(given)}"
            raise FormatError(f"{where[at]}: {message}")
        made: list[Argument] = []
        for index, (kind, word) in enumerate(zip(kinds, given, strict=True)):
            value = _argument(kind, word, name, where[at + 1 + index])
            _check(name, index, value, where[at + 1 + index])
            made.append(value)
        if name == "vision_range" and not float(made[0]) < float(made[1]):
            message = f"'{name}' expects a far plane beyond the near one, found {given[1]}"
            raise FormatError(f"{where[at + 2]}: {message}")
        commands.append((name, tuple(made)))
        at += 1 + len(kinds)
    return Behavior(int(words[0]), int(words[1]), tuple(commands))


def _argument(kind: str, word: str, command: str, place: str) -> Argument:
    if kind == "w":
        return word
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or (kind == "i" and value != int(value)):
        raise FormatError(f"{place}: '{command}' expects a number, found '{word}'")
    return value


def _check(command: str, index: int, value: Argument, place: str) -> None:
    """Refuse what an argument cannot be."""
    if command not in LIMITS or isinstance(value, str):
        return
    low, high = LIMITS[command][index]
    if not low <= value <= high:
        expected = f"{low:g} to {high:g}" if high < EVER else f"at least {low:g}"
        message = f"'{command}' expects {expected} as argument {index + 1}, found {value:g}"
        raise FormatError(f"{place}: {message}")
