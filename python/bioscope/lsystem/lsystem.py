"""L-systems and their strings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bioscope import _engine

if TYPE_CHECKING:
    from os import PathLike

    import numpy as np
    from numpy.typing import NDArray

    from bioscope.lsystem.turtle import ViewFile


class LSystem:
    r"""A parametric, stochastic, bracketed, conditional and context-sensitive L-system.

    P. Prusinkiewicz and A. Lindenmayer, "The Algorithmic Beauty of Plants", 1990; the notation of
    cpfg.

    Parameters
    ----------
    source
        The text of the model.
    file
        What errors call it; a name that ends in `.lsys` says that the text is in the notation of
        our own rather than in the cpfg dialect.
    folder
        Where files are that it includes; none forbids them.

    Raises
    ------
    FormatError
        With file, line, column, the offending line and what was expected, for everything that is
        wrong.

    Examples
    --------
    >>> import bioscope as bio
    >>> algae = bio.LSystem("lsystem: algae\naxiom: A\nA --> AB\nB --> A\nendlsystem\n")
    >>> algae.derive(steps=4).string()
    'ABAABABA'
    """

    def __init__(
        self, source: str, file: str = "<text>", folder: str | PathLike[str] | None = None
    ) -> None:
        self._engine = _engine.LSystem(source, file, folder)

    @classmethod
    def read(cls, path: str | PathLike[str]) -> LSystem:
        """Read a model from a file, which may include others of its folder."""
        text = Path(path).read_text(encoding="utf-8", errors="replace")
        if Path(path).suffix == ".lm":
            return cls.from_definition(text, str(path))
        return cls(text, str(path), Path(path).parent)

    @classmethod
    def from_definition(cls, text: str, file: str = "<text>.lm") -> LSystem:
        """Read a definition file of a behavioral L-system (.lm), see `docs/reference/lsystem.md`.

        Raises
        ------
        FormatError
            If it is wrong, or a rule depends on actors, particles, senses, memories or cuts.
        """
        from bioscope.lsystem.definition import translated

        return cls(translated(text, file), f"{file} in our own notation.lsys")

    @property
    def steps(self) -> int:
        """Number of steps after which the model is complete, as its file says; 0 if it does not."""
        return self._engine.steps

    @property
    def constants(self) -> dict[str, float]:
        """The numbers that the file defines, by name."""
        return dict(self._engine.constants)

    @property
    def warnings(self) -> list[str]:
        """What is doubtful in the file but not wrong."""
        return self._engine.warnings

    @property
    def environment(self) -> str | None:
        """Name and parameters of the environment that the file asks for."""
        return self._engine.environment

    def derive(
        self, steps: int | None = None, seed: int | None = None, **options: Any
    ) -> ModuleString:
        """Return the string after `steps` steps.

        Parameters
        ----------
        steps
            How many; as many as the model says, if not given.
        seed
            Of the random numbers. Without one, a file of the cpfg dialect gives the string of the
            reference program, whatever the `seed:` line of the file says.
        **options
            `environment` (one of `bio.environments`, which keeps its state, or a name with
            parameters, as "leaf_discs rho=0.89", or an .e file), `view` (a `ViewFile` or the path
            of one, for functions and the turtle), `start` (a string of this model in place of its
            axiom), `time` (seconds of a timed model, in place of steps; any time, so that growth
            can be shown continuously), `folder` (where the model may read and write files),
            `seconds` (after which it is stopped), `threads` (False for one).

        Raises
        ------
        FormatError
            If a production cannot be evaluated, or the string outgrows the limits (500 million
            modules, 2 GiB); the message names the production.
        UnknownNameError
            For an unknown option.
        """
        return ModuleString(self._engine.derive(steps, seed, **_for_engine(options)))


def _for_engine(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options with what the engine knows in place of our own objects."""
    inner = {"environment": "engine", "view": "_engine", "start": "_engine"}
    return {
        name: getattr(value, inner[name], value) if name in inner else value
        for name, value in options.items()
    }


@dataclass(frozen=True, slots=True)
class Fragment:
    """One of the words that a string falls into, and where it grows on."""

    word: ModuleString
    """Its modules; `derive(start=word)` lets it grow on alone."""
    position: tuple[float, ...]
    """Where the turtle was at the break, metres."""
    heading: tuple[float, ...]
    """Where it looked."""
    up: tuple[float, ...]
    """What was up for it."""
    width: float
    """Width of its strokes, metres."""
    color: int
    """Number of its colour."""

    @property
    def stance(self) -> dict[str, Any]:
        """Options of a `Turtle` that goes on from the break."""
        names = ("position", "heading", "up", "width", "color")
        return {name: getattr(self, name) for name in names}


class ModuleString:
    """A string of modules, each a symbol with numbers."""

    def __init__(self, engine: _engine.ModuleString) -> None:
        self._engine = engine

    def __len__(self) -> int:
        return len(self._engine)

    def string(self) -> str:
        """Return the canonical text: symbols with their numbers in parentheses."""
        return self._engine.string()

    def appearance(self) -> ModuleString:
        """Return the string after the model's homomorphism, as the turtle reads it."""
        return ModuleString(self._engine.appearance())

    def fragments(self, dead: str, view: ViewFile | None = None, **options: Any) -> list[Fragment]:
        """Return the words that the string falls into at the modules `dead`, which are left out.

        What stands above a dead module in its branch becomes a word of its own, which begins where
        the turtle is after it has obeyed the dead module.

        Parameters
        ----------
        dead
            Symbol of the dead modules, of any number of parameters.
        view, **options
            How the turtle walks, as for `bioscope.Turtle`.
        """
        found = self._engine.fragments(dead, options, view._engine if view is not None else None)
        return [
            Fragment(ModuleString(word), tuple(at), tuple(heading), tuple(up), width, color)
            for word, at, heading, up, width, color in found
        ]

    @property
    def ids(self) -> NDArray[np.uint64]:
        """Identity of each module of a timed model, which it has for life; empty for others."""
        return self._engine.ids

    @property
    def output(self) -> str:
        """What the model has printed (`printf`)."""
        return self._engine.output

    @property
    def remarks(self) -> list[str]:
        """What was tolerated but is doubtful, such as divisions by zero."""
        return self._engine.remarks

    @property
    def symbols(self) -> list[str]:
        """The alphabet; `kinds` holds indices into it."""
        return self._engine.symbols

    @property
    def arities(self) -> NDArray[np.uint8]:
        """How many numbers a module of each kind of the alphabet has."""
        return self._engine.arities

    @property
    def kinds(self) -> NDArray[np.uint8]:
        """Symbol number of each module (n,)."""
        return self._engine.kinds

    @property
    def parameters(self) -> NDArray[np.float32]:
        """All numbers of all modules, one after the other."""
        return self._engine.parameters
