"""Definition files as they run: one shared world, frame by frame (thesis, section 2.1.1)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from bioscope.errors import FormatError, LimitError, UnknownNameError
from bioscope.files import written_whole
from bioscope.lsystem.animation.automata import Actor, read_behavior
from bioscope.lsystem.animation.derivation import Crew, Derivation
from bioscope.lsystem.animation.directives import scene
from bioscope.lsystem.animation.files import located, read_surface, surface_text
from bioscope.lsystem.animation.frame import Frame
from bioscope.lsystem.animation.functions import SENSES
from bioscope.lsystem.animation.machine import Compiler
from bioscope.lsystem.animation.meshes import Meshes
from bioscope.lsystem.animation.options import MOST_ACTORS, Options
from bioscope.lsystem.animation.particles import advance
from bioscope.lsystem.animation.placement import placements
from bioscope.lsystem.animation.sight import Eyes
from bioscope.lsystem.animation.sounds import USER, VOCABULARY, Air
from bioscope.lsystem.animation.vectors import ZERO, Pose, Vector, length
from bioscope.lsystem.animation.viewing import Camera, Device, Light
from bioscope.lsystem.animation.walk import TABLE, Walk, touched
from bioscope.lsystem.definition.grammar import pointing, read

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from os import PathLike

    import numpy as np
    from numpy.typing import NDArray

    from bioscope.lsystem.animation.meshes import Part
    from bioscope.lsystem.animation.particles import Particle
    from bioscope.lsystem.animation.shapes import Shape
    from bioscope.lsystem.animation.window import Window

INTERVAL = 0.04
"""Seconds of a frame if the file says nothing."""
PARTS, SEED = 4, 34743
"""Parts of a frame for particles, and the seed, if the file says nothing."""
MOST_PARTICLES = 1000
MOST_PARTS = 1000
MOST_REMARKS = 1000
LED = 5
"""First parameter of a `C` that an actor leads."""
STROKE = 0.02
"""Thickness of strokes as eyes see them, units of the model, if nothing is said of it."""


class Source(NamedTuple):
    """A definition file."""

    text: str
    file: str = "<text>.lm"
    """What errors call it."""
    folder: Path | None = None
    """Where the files are that it names; none forbids them."""


class Animation:
    """A world of behavioral L-systems.

    H. Noser, "A Behavioral Animation System Based on L-systems and Synthetic Sensors for Actors",
    EPFL thesis 1609 (1997). Frame 0 shows the axioms at time 0; every `advance` lets all strings
    grow older, moves the particles and draws anew.

    Parameters
    ----------
    *sources
        Definitions; all share time, particles, sounds, actors and memories, and the first says how
        long a frame is and where the camera stands.
    seed
        Of everything that is chance; the first definition's if not given.
    senses
        What actors answer instead of what they see, by name: functions of the number of the actor.
        Names are `distance` (`?30`), `obstacle`, `looks_at_goal`, `near_goal`, `automaton` (`?35`;
        the active one of the actor's stack, if not given), `interest`, `color_of_interest`,
        `color_of_interest_as_goal` and `at_goal`. Without actors that the definitions declare
        (`NBR_actors`), nobody else answers.
    scripts
        What `E` and the command files 0 and 1 run: it is called with the words of the command,
        the script first. Nothing is ever run without it.
    sounds
        Seconds by number of sound.
    stroke
        Thickness of strokes as eyes see them, units of the model.
    kept
        What the actors saw when this was made before, `eyes.kept`: it is not looked for again.

    Raises
    ------
    FormatError
        With file, line and column, if a definition or a file that it names is wrong, or it asks
        for a sense that is not given.
    UnknownNameError
        For a sense that nothing asks.

    Examples
    --------
    >>> import bioscope as bio
    >>> animation = bio.lsystem.Animation.read("fish.lm")  # doctest: +SKIP
    >>> animation.run(seconds=10)  # doctest: +SKIP
    """

    def __init__(
        self,
        *sources: Source | str,
        seed: int | None = None,
        senses: Mapping[str, Callable[[int], float]] | None = None,
        scripts: Callable[[list[str]], None] | None = None,
        sounds: Mapping[int, float] | None = None,
        stroke: float = STROKE,
        kept: NDArray[np.float64] | None = None,
    ) -> None:
        if not sources:
            raise FormatError("an animation needs a definition")
        given = [Source(one) if isinstance(one, str) else one for one in sources]
        self.definitions = [read(one.text, one.file) for one in given]
        self._scripts = scripts
        self.remarks: list[str] = []
        """What was tolerated but is doubtful."""
        first = self.definitions[0].camera
        parts, chance = first.get("nbrCalcStep_seed", [PARTS, SEED])
        self.seed = int(chance) if seed is None else seed
        self._parts = int(min(max(parts, 1), MOST_PARTS))
        end, interval = first.get("t_final_interval", [0.0, INTERVAL])
        if interval <= 0:
            raise FormatError(f"{self.definitions[0].file}: a frame lasts longer than 0 seconds")
        self.end = end
        """Seconds after which the first definition ends; 0 if it does not."""
        self.interval = interval
        """Seconds of a frame."""
        self.camera = Camera.of(self.definitions[0])
        """The camera of the user's window."""
        self.light = Light()
        """Light number 3."""
        self.frame = Frame(0, 0.0)
        """What the last frame shows."""
        self.produced: dict[str, str] = {}
        """Files that the last frame made, by name: scenes of the offline renderer, boxes."""
        self.orders: list[tuple[int, int, float]] = []
        """What the last frame orders bodies to do (`H`): actor, what, how much."""
        self.racket, self.shape, self.generic = ZERO, 0.0, 0.0
        self.positions: list[Vector] = [ZERO] * TABLE
        self.states: list[Pose] = [Pose()] * TABLE
        self.look_at = ZERO
        self.captured: int | None = None
        self.device = Device()
        """What moves the camera in the next frame, by hand (`use_device`)."""
        self.words: list[str] = []
        """Words that were spoken since the last frame (`say`)."""
        self._meshes, self._stroke = Meshes(), stroke
        self.air = Air(sounds or {})
        """What is heard."""
        self._tables(given)
        self.eyes = Eyes(self._options.windows, kept)
        """What the declared actors see."""
        self.senses = self._answers(senses or {})
        self._begin(given)

    @classmethod
    def read(cls, *files: str | PathLike[str], **options: Any) -> Animation:
        """Read definition files, which may name others of their folders; options as above."""
        texts = [Path(one).read_text(encoding="utf-8", errors="replace") for one in files]
        named = zip(texts, files, strict=True)
        return cls(*(Source(text, str(one), Path(one).parent) for text, one in named), **options)

    @classmethod
    def check(cls, file: str | PathLike[str]) -> list[str]:
        """Return what is doubtful in a definition file, whatever eyes its actors may have.

        Raises
        ------
        FormatError
            If it is wrong.
        """
        return cls.read(file, senses=dict.fromkeys(SENSES.values(), lambda actor: 0.0)).remarks

    def _tables(self, given: Sequence[Source]) -> None:
        """Read the options, and the files that the definitions name."""
        self.arrays = [one.arrays for one in self.definitions]
        self.surfaces: list[dict[int, Shape]] = []
        self._options = options = Options()
        for number, (definition, source) in enumerate(zip(self.definitions, given, strict=True)):
            self.arrays[number][-1] = [*definition.constants.get("P", ())]
            self.surfaces.append(
                {
                    named: read_surface(located(name, source.folder, definition.file))
                    for named, name in definition.surfaces.items()
                }
            )
            with pointing(source.text, source.file):
                options.read(definition, source.folder)
        self.recognizer = options.recognizer
        """Port and host of the recognizer of speech whose words the host hands on (`say`)."""
        self.traces: dict[int, list[str]] = {actor: [] for actor in options.traces}
        """Trajectories of the actors that are traced, as lines."""
        self.actors: dict[int, Actor] = {actor: Actor() for actor in range(options.actors)}
        """Actors by number."""
        for actor, behavior in options.behaviors:
            self.actor(actor).push(behavior)
        if options.sound_log is not None:
            self.air.declare(options.sounds)

    def _answers(
        self, given: Mapping[str, Callable[[int], float]]
    ) -> dict[str, Callable[[int], float]]:
        """Return who answers rules: the host, else the actors that are declared."""
        if unknown := set(given) - set(SENSES.values()):
            known = ", ".join(SENSES.values())
            raise UnknownNameError(f"unknown senses {', '.join(sorted(unknown))}; known: {known}")
        seeing = self.eyes.senses(self.actor, self.remark) if self.windows else {}
        return {"automaton": self._automaton, **seeing, **given}

    def _begin(self, given: Sequence[Source]) -> None:
        self.crew = Crew(self, self._options.most_particles or MOST_PARTICLES, self._push)
        self.layers: list[Derivation] = []
        for number, (one, source) in enumerate(zip(self.definitions, given, strict=True)):
            with pointing(source.text, source.file):
                self.layers.append(Derivation(one, Compiler(one, self.senses), number))
        self._placements = [
            placements(one, self.seed, number, self.remark)
            for number, one in enumerate(self.definitions)
        ]
        self.air.tick(0.0)
        for layer in self.layers:
            layer.begin(self.crew)
        self._draw()

    @property
    def time(self) -> float:
        """Global time in seconds: how many frames were made, times their length."""
        return self.frame.number * self.interval

    @property
    def tick(self) -> int:
        """Number of the frame."""
        return self.frame.number

    @property
    def particles(self) -> list[Particle]:
        """All particles."""
        return self.crew.particles

    @property
    def windows(self) -> dict[int, Window]:
        """What the declared actors see, by their numbers: `windows[0].depth`."""
        return self.eyes.windows

    @property
    def offline(self) -> bool:
        """Whether this frame is written for the offline renderer."""
        told = self._options
        shown = any(low <= self.frame.number <= high for low, high in told.shown)
        return told.scene is not None and (shown or not told.shown)

    def advance(self) -> None:
        """Make the next frame."""
        number = self.frame.number + 1
        self.frame = Frame(number, number * self.interval)
        self.produced, self.orders = {}, []
        self.crew.time = self.time
        self.run_script(0)
        self.air.tick(self.time)
        for layer, definition in zip(self.layers, self.definitions, strict=True):
            stop = definition.repetition.get("time_const", [0.0])[0]
            if stop <= 0 or self.time <= stop:
                scale = definition.repetition.get("time_scale", [1.0])[0]
                layer.step(self.crew, max(0.0, scale) * self.interval)
        held = {one.particle for layer in self.layers for one in layer.string} - {None}
        self.crew.particles = [one for one in self.crew.particles if one in held]
        advance(self.crew.particles, self, self.time - self.interval, self._parts)
        self._draw()
        self.run_script(1)

    def run(self, seconds: float, folder: str | PathLike[str] | None = None) -> None:
        """Make frames for some seconds; what they make is written to the folder, if any."""
        for _ in range(round(seconds / self.interval)):
            self.advance()
            if folder is not None:
                self.write(folder)

    def write(self, folder: str | PathLike[str]) -> None:
        """Write what the last frame made, and the sound log and trajectories so far."""
        files = dict(self.produced)
        if self._options.sound_log is not None:
            files[self._options.sound_log] = self.sound_log
        for actor, name in self._options.traces.items():
            files[name] = "".join(f"{one}\n" for one in self.traces[actor])
        for name, text in files.items():
            with written_whole(Path(folder) / name) as path:
                path.write_text(text, encoding="utf-8")

    def _draw(self) -> None:
        self.captured = None
        for layer, places in zip(self.layers, self._placements, strict=True):
            for index, at in enumerate(places):
                Walk(self, layer, index, at).run()
        for word in self.words:
            self.air.begin(VOCABULARY[word], USER, self.camera.eye)
        self.device, self.words = Device(), []
        if self.offline:
            name = f"{self._options.scene}.{self.frame.number:04d}.ray"
            self.produced[name] = scene(self.frame, self.camera)
        if self.windows:
            self.eyes.look(self.frame.number, self.parts(), self.actors)

    def parts(self) -> list[Part]:
        """Return what the last frame shows as meshes: one per material, and per body of an actor.

        A mesh is the same object as in the frame before if nothing of it has changed.
        """
        return self._meshes.of(self.frame, self._stroke)

    def string(self, layer: int = 0) -> str:
        """Return the string of a definition: symbols with age, parameters and growth values."""
        return " ".join(
            f"{one.symbol}({','.join(f'{n:.9g}' for n in (one.age, *one.parameters, *one.growth))})"
            for one in self.layers[layer].string
        )

    @property
    def sound_log(self) -> str:
        """All sounds, one line per frame, as a sound track is made from them."""
        return "".join(" ".join(line) + "\n" for line in self.air.log)

    def surface(self) -> str:
        """Return all that the last frame shows as one surface file (SM)."""
        return surface_text(*self.frame.surface())

    def actor(self, number: int) -> Actor:
        """Return an actor; a new one if nobody has this number.

        Raises
        ------
        LimitError
            If there are too many.
        """
        if number not in self.actors and len(self.actors) >= MOST_ACTORS:
            raise LimitError(f"there are at most {MOST_ACTORS} actors")
        return self.actors.setdefault(number, Actor())

    def use_device(self, device: Device) -> None:
        """Move the camera in the next frame, if a symbol `l` lets devices do so."""
        self.device = device

    def say(self, words: str) -> None:
        """Speak to the world, as a recognizer of speech does.

        A word of the vocabulary is a sound where the camera is, heard from the next frame on; but
        commands move the camera instead, if a symbol `l` lets voices do so.
        """
        if words in VOCABULARY:
            self.words.append(words)
        else:
            self.remark(f"nobody knows the word '{words}'")

    def remark(self, text: str) -> None:
        """Keep a remark, once."""
        if text not in self.remarks and len(self.remarks) < MOST_REMARKS:
            self.remarks.append(text)

    # What symbols and expressions ask.

    def channel(self, number: float, at: float) -> float:
        """Return the value of a data channel at a time."""
        if 0 <= number < len(self._options.channels):
            return self._options.channels[int(number)].at(at)
        self.remark(f"data channel {number:g} is not declared")
        return 0.0

    def field(self, place: Vector, particles: list[Particle]) -> Vector:
        """Return the sum of the fields of particles at a place."""
        return touched(particles, self, place)

    def touch(self, place: Vector, actor: int) -> float:
        """Return how strong the fields are, but for that of the actor's own particle."""
        others = [
            one
            for one in self.crew.particles
            if one.owner.mode(1) != LED or round(one.owner.growth[0]) != actor
        ]
        return length(self.field(place, others))

    def trajectory(self, number: int) -> tuple[Vector, Vector] | None:
        """Return place and direction of an imported trajectory."""
        found = self._options.trajectories.get(number)
        return found.at(self.time) if found is not None else None

    def run_script(self, number: int, *arguments: str) -> None:
        """Run a command file with the number of the frame and its own two words."""
        command = self._options.commands.get(number)
        if command is not None and self._scripts is not None:
            script, *words = command
            self._scripts([script, str(self.frame.number), *words, *arguments])
        elif command is None and arguments:
            self.remark(f"command file {number} of 'E' is not declared")

    def _automaton(self, number: int) -> float:
        active = self.actor(number).automaton
        return float(active) if active is not None else -1.0

    def _push(self, words: str, place: str) -> None:
        if words:
            behavior = read_behavior(words, place)
            self.actor(behavior.actor).push(behavior)
