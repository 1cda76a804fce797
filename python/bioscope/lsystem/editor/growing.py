"""From a text to a plant that a page can show."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from bioscope.errors import BioscopeError, LimitError
from bioscope.lsystem.editor.problems import Problem, problems
from bioscope.lsystem.lsystem import LSystem
from bioscope.lsystem.turtle import Turtle

if TYPE_CHECKING:
    from bioscope._engine import Mesh
    from bioscope.lsystem.editor.messages import Grow
    from bioscope.lsystem.lsystem import ModuleString

MOST_MODULES = 2_000_000
"""Length of a string that is shown; longer ones take too long to follow a hand that types."""
MOST_TRIANGLES = 2_000_000
STRING_SHOWN = 100_000
"""Letters of the string that a page is told."""
_FIRST_STAGE = 6
_SIDES = ((40_000, 10), (120_000, 6), (math.inf, 3))
"""Up to so many segments: sides of the thickest axis."""

Palette = list[tuple[float, float, float]] | None


class Grower:
    """Grows what pages ask for; keeps the last text compiled.

    Parameters
    ----------
    file
        What errors call the text; it may include others of this one's folder.
    palette
        Linear colours by number.
    """

    def __init__(self, file: str, palette: Palette) -> None:
        self._file = file
        self._folder = Path(file).parent
        self._palette = palette
        self._compiled: tuple[str, LSystem] | None = None

    def grow(self, order: Grow) -> dict[str, Any]:
        """Return the message that answers: `grown`, or `failed` with what is wrong where."""
        started = time.perf_counter()
        try:
            return {**self._grown(order), "seconds": time.perf_counter() - started}
        except BioscopeError as error:
            found = problems(str(error), self._file, "error")
            return _failed(order, found, too_large=isinstance(error, LimitError))
        except Exception as error:
            # A fault of the program, not of the text: the page says so, and the worker goes on.
            found = [Problem("error", f"{type(error).__name__}: {error}")]
            return _failed(order, found, too_large=False)

    def _grown(self, order: Grow) -> dict[str, Any]:
        system = self._system(order.text)
        steps = system.steps if order.steps is None else order.steps
        string = self._derived(system, steps, order)
        told = string.appearance() if order.homomorphism else string
        letters = told.string()
        mesh, segments = self._mesh(string)
        found = [one for text in system.warnings for one in problems(text, self._file, "warning")]
        return {
            "type": "grown",
            "number": order.number,
            "steps": steps,
            "length": system.steps,
            "modules": len(told),
            "string": letters[:STRING_SHOWN],
            "letters": len(letters),
            "segments": segments,
            "problems": [msgspec.to_builtins(one) for one in found],
            "mesh": _packed(mesh),
        }

    def _system(self, text: str) -> LSystem:
        if self._compiled is None or self._compiled[0] != text:
            self._compiled = (text, LSystem(text, self._file, self._folder))
        return self._compiled[1]

    def _derived(self, system: LSystem, steps: int, order: Grow) -> ModuleString:
        """Return the string after so many steps, or say early that it explodes.

        A string that grows by a factor at each step would fill the memory before the engine's own
        limits end it. So it is derived in stages, each only as far as the growth so far lets
        expect a string within the limit.
        """
        around = {} if order.environment is None else {"environment": order.environment}

        def after(step: int) -> ModuleString:
            return system.derive(step, order.seed, **around)

        reached = min(steps, _FIRST_STAGE)
        before, string, since = after(max(0, reached - 1)), after(reached), 1
        while reached < steps and len(string) <= MOST_MODULES:
            growth = math.log(max(1.0, len(string) / max(1, len(before)))) / since
            room = math.log(MOST_MODULES / max(1, len(string)))
            since = int(min(steps - reached, 2 * reached, max(1.0, room / max(growth, 1e-9))))
            reached += since
            before, string = string, after(reached)
        if len(string) > MOST_MODULES:
            symbol = _growing_most(before, string)
            raise LimitError(
                f"{self._file}:{_line_of(symbol, order.text)}:1: more than {MOST_MODULES} modules "
                f"at step {reached}; the modules '{symbol}' grow most: take fewer steps, or let "
                "them grow less"
            )
        return string

    def _mesh(self, string: ModuleString) -> tuple[Mesh, int]:
        drawn = Turtle().interpret(string)
        segments = len(drawn.segments.axis)
        sides = next(sides for most, sides in _SIDES if segments <= most)
        mesh = drawn.mesh(sides=sides, palette=self._palette)
        if len(mesh.triangles) > MOST_TRIANGLES:
            raise LimitError(
                f"{len(mesh.triangles)} triangles are more than a page can show "
                f"({MOST_TRIANGLES}): take fewer steps"
            )
        return mesh, segments


def _growing_most(before: ModuleString, string: ModuleString) -> str:
    """Return the symbol of which a string has gained most."""
    gained = np.bincount(string.kinds, minlength=256) - np.bincount(before.kinds, minlength=256)
    return string.symbols[int(gained.argmax())]


def _line_of(symbol: str, text: str) -> int:
    """Return the line of the first production of a symbol; 1 if there is none."""
    for number, line in enumerate(text.splitlines(), 1):
        head, arrow, _ = line.partition("-->")
        if arrow and head.strip().startswith(symbol):
            return number
    return 1


def _packed(mesh: Mesh) -> dict[str, bytes]:
    """Return a mesh as the live stream packs it: docs/reference/stream.md."""
    colors = mesh.colors
    return {
        "positions": np.ascontiguousarray(mesh.positions, "<f4").tobytes(),
        "normals": np.ascontiguousarray(mesh.normals, "<f4").tobytes(),
        "triangles": np.ascontiguousarray(mesh.triangles, "<u4").tobytes(),
        **({} if colors is None else {"colors": np.ascontiguousarray(colors, "<f4").tobytes()}),
    }


def gave_up(order: Grow, message: str) -> dict[str, Any]:
    """Return the message that answers when no plant came of an order."""
    return _failed(order, [Problem("error", message)], too_large=True)


def _failed(order: Grow, found: list[Problem], *, too_large: bool) -> dict[str, Any]:
    return {
        "type": "failed",
        "number": order.number,
        "problems": [msgspec.to_builtins(one) for one in found],
        "too_large": too_large,
    }
