"""Commands to the automata of actors, as text (thesis, appendix A and table B6).

A definition, or the symbol `e`, pushes such a text on the stack of an actor. What the automata do
is the host's; here their state variables are set. Variables that are not told keep their values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from bioscope.errors import FormatError
from bioscope.lsystem.animation.vectors import ZERO, Vector

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
    variables: dict[str, tuple[Argument, ...]] = field(default_factory=dict)
    """What commands have set, by the name of the variable."""

    @property
    def automaton(self) -> int | None:
        """The active automaton."""
        return self.stack[-1].automaton if self.stack else None

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
            self.local_goals[int(numbers[0])] = numbers[1], numbers[2], numbers[3]
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


def read_behavior(text: str, place: str) -> Behavior:
    """Return a behavior as it is written: actor, automaton, commands with their arguments.

    Raises
    ------
    FormatError
        For an unknown command, or arguments that are missing or none.
    """
    words = text.split()
    if len(words) < 2 or not (words[0].isdecimal() and words[1].isdecimal()):
        raise FormatError(f"{place}: a behavior begins with the numbers of actor and automaton")
    commands = []
    at = 2
    while at < len(words):
        name = words[at]
        if name not in COMMANDS:
            raise FormatError(f"{place}: unknown command '{name}'; known: {', '.join(COMMANDS)}")
        kinds = COMMANDS[name]
        given = words[at + 1 : at + 1 + len(kinds)]
        if len(given) < len(kinds):
            raise FormatError(f"{place}: '{name}' has {len(kinds)} arguments, found {len(given)}")
        made = tuple(
            _argument(kind, word, name, place) for kind, word in zip(kinds, given, strict=True)
        )
        commands.append((name, made))
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
