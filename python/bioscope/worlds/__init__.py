"""Ready-made worlds, one folder each, and the way to one's own."""

from __future__ import annotations

import functools
import importlib
import importlib.util
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from bioscope import gallery
from bioscope.errors import BioscopeError, FormatError, UnknownNameError
from bioscope.world import World
from bioscope.world.changes import read_script
from bioscope.worlds import landscape as landscape  # its populations are known to saved worlds

if TYPE_CHECKING:
    from types import ModuleType

    from bioscope.film.direction import Shot

_FOLDER = Path(__file__).parent


def names() -> dict[str, str]:
    """Return the ready-made worlds by name, each with its one-line description."""
    folders = sorted(one.parent.name for one in _FOLDER.glob("*/world.py"))
    return {name: _summary(_FOLDER / name / "world.py") for name in folders}


def films() -> dict[str, int]:
    """Return the ready-made worlds that are made to be filmed, each with the seed of its film.

    Those name it in their module as `FILM_SEED`.
    """
    seeds = {name: getattr(_module(name), "FILM_SEED", None) for name in names()}
    return {name: int(seed) for name, seed in seeds.items() if seed is not None}


def shots(name: str) -> list[Shot]:
    """Return the shot list of a film.

    A world whose module has a function `direct` is watched for `TRIAL` seconds first, and films
    what happens when and where it happens; of others the world's own list is taken.

    Raises
    ------
    BioscopeError
        If what the film is about did not happen.
    """
    from bioscope.film.direction import Shot

    module = _module(name)
    if hasattr(module, "direct"):
        return list(_directed(name, films()[name], module.TRIAL))
    return [Shot(seconds, camera) for camera, seconds in load(name, films()[name]).shots]


@functools.cache
def _directed(name: str, seed: int, seconds: float) -> tuple[Shot, ...]:
    """Return the shots of a story; one is watched only once, for it is always the same."""
    from bioscope.film.direction import Story

    try:
        return tuple(_module(name).direct(Story(load(name, seed), seconds)))
    except (LookupError, StopIteration, ValueError) as error:
        story = f"{seconds} s from seed {seed}"
        raise BioscopeError(f"{name}: what the film shows did not happen in {story}") from error


@dataclass(frozen=True)
class Plate:
    """A moment of a ready-made world that is worth a picture."""

    world: str
    seed: int
    time: float
    """Seconds from its beginning."""
    shot: Shot


def plates() -> dict[str, str]:
    """Return the color plates by name, each with the world that it is of.

    Worlds name theirs in their module as `PLATES`: a dict of seed, time and camera by name, or only
    the names, if `direct` says when and how they are taken.
    """
    return {plate: name for name in names() for plate in getattr(_module(name), "PLATES", ())}


def plate(name: str) -> Plate:
    """Return a color plate; a story is watched for it where the world has one."""
    from bioscope.film.direction import Shot

    world = plates()[name]
    listed = _module(world).PLATES
    if isinstance(listed, dict):
        seed, time, camera = listed[name]
        return Plate(world, seed, time, Shot(1.0, camera))
    begin = 0.0
    for shot in shots(world):
        if shot.plate == name:
            return Plate(world, films()[world], begin + shot.moment, shot)
        begin += shot.seconds
    raise UnknownNameError(f"no shot of the film '{world}' is for the still '{name}'")


def _module(name: str) -> ModuleType:
    return importlib.import_module(f"bioscope.worlds.{name}.world")


def _summary(path: Path) -> str:
    """Return the first line of a module's docstring without running it."""
    first = path.read_text(encoding="utf-8").lstrip().splitlines()[0]
    return first.strip('"').rstrip(".")


def load(name: str, seed: int | None = None) -> World:
    """Make a world.

    Parameters
    ----------
    name
        A ready-made world (see `names`), or the path of a Python file that defines
        `world(seed: int) -> bioscope.World`, or of a saved world or its script (`.json`); or an
        animation of the gallery, or a definition file (`.lm`), on a floor of its own.
    seed
        Its seed; one is drawn if not given.

    Raises
    ------
    UnknownNameError
        If there is no such world.
    FormatError
        If the file is no world script, or it fails; the message says where.
    """
    if seed is None:
        import secrets

        seed = secrets.randbits(32)
    if name in names():
        return _made(_module(name), name, seed)
    path = gallery.animations().get(name, Path(name))
    if path.suffix == ".lm" and path.is_file():
        return _animated(path, seed)
    if path.suffix == ".world" and path.is_file():
        return World.restore(path)
    if path.suffix == ".json" and path.is_file():
        return _played(path)
    if path.is_file():
        return _made(_script(path), name, seed)
    if path.suffix or len(path.parts) > 1:
        raise UnknownNameError(f"{name}: no such file")
    known = ", ".join(names())
    raise UnknownNameError(f"unknown world '{name}'; known: {known}, or the path of a Python file")


def _animated(path: Path, seed: int) -> World:
    # Imported when needed: few worlds are animations.
    from bioscope.lsystem.showing import stage
    from bioscope.populations.animated import Animated

    return stage(Animated(path, seed=seed), path.stem)


def _played(path: Path) -> World:
    """Return the world of a script, as it was when the script was saved."""
    script = read_script(path.read_bytes(), str(path))
    if Path(script.world).suffix == ".json":
        raise FormatError(f"{path}: a script of the script {script.world}: expected a world's")
    made = load(script.world, script.seed)
    script.play(made)
    return made


def _script(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"bioscope_script_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise FormatError(f"{path}: expected a Python file that defines world(seed)")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    sys.path.insert(0, str(path.parent))
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise FormatError(_place(path, error)) from error
    finally:
        sys.path.remove(str(path.parent))
    return module


def _made(module: ModuleType, name: str, seed: int) -> World:
    make = getattr(module, "world", None)
    if not callable(make):
        raise FormatError(f"{name}: expected a function world(seed) that returns a bioscope.World")
    path = Path(str(module.__file__))
    try:
        world = make(seed)
    except BioscopeError as error:
        raise type(error)(_place(path, error)) from error
    except Exception as error:
        raise FormatError(_place(path, error)) from error
    if not isinstance(world, World):
        found = type(world).__name__
        raise FormatError(f"{name}: world(seed) returned {found}: expected a bioscope.World")
    return world


def _place(path: Path, error: BaseException) -> str:
    """Return `file:line: ErrorType: message` for the innermost line of the script itself."""
    if isinstance(error, SyntaxError):
        column = f":{error.offset}" if error.offset else ""
        return f"{error.filename or path}:{error.lineno}{column}: {error.msg}"
    frames = traceback.extract_tb(error.__traceback__)
    lines = [
        one.lineno for one in frames if Path(one.filename) == path or one.filename == str(path)
    ]
    line = f":{lines[-1]}" if lines else ""
    kind = "" if isinstance(error, BioscopeError) else f"{type(error).__name__}: "
    return f"{path}{line}: {kind}{error}"
