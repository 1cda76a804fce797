"""The command line: `bioscope --help`."""

from __future__ import annotations

import math
import secrets
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import bioscope
from bioscope import worlds
from bioscope.errors import BioscopeError, UnknownNameError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Sequence

    from bioscope.world import World


class Commands(click.Group):
    """The commands, with failures turned into one message and an exit status."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command: status 1 if the work failed, 130 if it was interrupted."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            raise click.exceptions.Exit(130) from None
        except BrokenPipeError:
            # Whoever read the output has seen enough; click ends quietly.
            raise
        except (BioscopeError, OSError, MemoryError) as error:
            print(f"bioscope: {_told(error)}", file=sys.stderr)
            raise click.exceptions.Exit(1) from None

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the commands in the order in which they are written."""
        del ctx
        return list(self.commands)


def positive(_ctx: click.Context, _param: click.Parameter, value: float) -> float:
    """Refuse what is no finite number above 0."""
    if not 0 < value < math.inf:
        raise click.BadParameter(f"{value}: expected more than 0")
    return value


def command(name: str, example: str) -> Callable[[Callable[..., None]], click.Command]:
    """Declare a command with an example at the end of its help."""
    epilog = f"Example: {example}"
    return app.command(name, epilog=epilog, no_args_is_help=False)


def path_option(*names: str, **settings: Any) -> Callable[[Any], Any]:
    """Declare an option that is a file or folder."""
    return click.option(*names, type=click.Path(path_type=Path), **settings)


def say(*words: object) -> None:
    """Print a message for people: to standard error, unless `--quiet`."""
    if not _quiet:
        print(*words, file=sys.stderr, flush=True)


_quiet = False


@click.group(
    cls=Commands,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
)
@click.option("-q", "--quiet", is_flag=True, help="Only results and errors.")
@click.version_option(bioscope.__version__, prog_name="bioscope", message="%(prog)s %(version)s")
def app(quiet: bool) -> None:
    """Bring virtual worlds to life, watch, film and export them."""
    global _quiet
    _quiet = quiet


world_name = click.argument("world")
model_name = click.argument("model")
seed_option = click.option(
    "--seed", type=click.IntRange(0, 2**64 - 1), help="Seed; drawn if not given."
)
steps_option = click.option(
    "--steps", type=click.IntRange(0), help="Derivation steps; as the file says, if not given."
)


def seconds_option(default: float) -> Callable[[Any], Any]:
    """Declare `--seconds`."""
    return click.option(
        "--seconds",
        type=float,
        callback=positive,
        default=default,
        help="World time to run, in seconds.",
    )


def opened(name: str, seed: int | None) -> World:
    """Make the world and say its seed."""
    seed = secrets.randbits(32) if seed is None else seed
    world = worlds.load(name, seed)
    say(f"{world.title}: seed {world.seed}, tick {world.dt * 1000:.3g} ms")
    return world


@command("list", "bioscope list")
def list_() -> None:
    """List the ready-made worlds and models, each with a line."""
    from bioscope import gallery
    from bioscope.populations.plants import models

    for name, summary in worlds.names().items():
        print(f"{name:21} World: {summary}")
    for name, path in models().items():
        is_in_gallery = name in gallery.files()
        summary = gallery.description(name) if is_in_gallery else f"plant of a world, {path}"
        print(f"{name:21} Model: {summary}")
    for name in gallery.animations():
        print(f"{name:21} Animation: {gallery.description(name)}")


@command("run", "bioscope run reef --seconds 60 --seed 7 --events reef.jsonl --hash")
@world_name
@seconds_option(10.0)
@seed_option
@path_option("--events", metavar="FILE", help="Events to a .jsonl or .parquet file.")
@path_option("--save", metavar="FILE", help="Save the world at the end.")
@click.option("--hash", "show_hash", is_flag=True, help="Print the state hash as the last line.")
def run(
    world: str,
    seconds: float,
    seed: int | None,
    events: Path | None,
    save: Path | None,
    show_hash: bool,
) -> None:
    """Run a world without watching it."""
    from bioscope.run import run_world

    made = opened(world, seed)
    run_world(made, seconds, events, save, say)
    if show_hash:
        print(made.state_hash())


@command("live", "bioscope live reef --seed 7")
@world_name
@click.option(
    "--port", type=click.IntRange(1, 65535), default=8765, help="Port; the next free one."
)
@click.option("--host", default="127.0.0.1", help="Address; others than loopback need a token.")
@click.option("--token", help="Word that a page must know.")
@seed_option
@click.option("--no-open", is_flag=True, help="Do not open a browser.")
def live(
    world: str, port: int, host: str, token: str | None, seed: int | None, no_open: bool
) -> None:
    """Watch a world live in the browser."""
    from bioscope.live import serve

    seed = secrets.randbits(32) if seed is None else seed
    serve(world, seed=seed, host=host, port=port, token=token, open_browser=not no_open, say=say)


@command("contour", "bioscope contour")
@click.option(
    "--port", type=click.IntRange(1, 65535), default=8775, help="Port; the next free one."
)
@click.option("--no-open", is_flag=True, help="Do not open a browser.")
def contour(port: int, no_open: bool) -> None:
    """Fit a mesh to a picture of a fish in the browser and save its texture coordinates."""
    from bioscope.live.contour import serve

    serve(port=port, open_browser=not no_open, say=say)


@command("film", "bioscope film reef -o reef.mp4 --seconds 10 --seed 7")
@world_name
@path_option("-o", "--output", metavar="FILE.mp4", help="What to write.")
@seconds_option(10.0)
@click.option("--size", metavar="WxH", default="1280x720", help="Pixels.")
@click.option("--fps", type=float, callback=positive, default=30.0, help="Pictures per second.")
@click.option("--renderer", default="preview", help="preview or path.")
@click.option("--camera", metavar="NAME", help="A camera of the world.")
@path_option("--frames", metavar="DIR", help="Pictures as PNG files in a folder.")
@click.option("--samples", type=click.IntRange(1), default=64, help="Samples per pixel (path).")
@seed_option
def film(
    world: str,
    output: Path | None,
    frames: Path | None,
    seed: int | None,
    **options: Any,
) -> None:
    """Film a world, with sound. An interrupted film goes on where it stopped."""
    from bioscope.film import FilmOptions, film_world, parse_size
    from bioscope.film.film import seed_of_partial

    if output is None and frames is None:
        raise click.BadParameter("expected a file to write", param_hint="--output")
    made = FilmOptions(
        seconds=options["seconds"],
        size=parse_size(options["size"]),
        frames_per_second=options["fps"],
        renderer=options["renderer"],
        camera=options["camera"],
        samples=options["samples"],
    )
    seed = seed_of_partial(output, frames, made) if seed is None else seed
    film_world(opened(world, seed), output, made, frames=frames, say=say)


def _still_to_make(
    what: str, names: Sequence[str], known: Collection[str], folder: Path, suffix: str
) -> Iterator[tuple[str, Path]]:
    """Yield names with their files in a folder, but for files that are there already."""
    for name in names:
        if name not in known:
            raise UnknownNameError(f"unknown {what} '{name}'; known: {', '.join(known)}")
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        path = folder / f"{name}{suffix}"
        if path.exists():
            say(f"{path} is there")
        else:
            yield name, path


@command("films", "bioscope films -o films")
@path_option("-o", "--output", metavar="DIR", required=True, help="Folder for the films.")
@click.option("--size", metavar="WxH", default="1280x720", help="Pixels.")
@click.option("--renderer", default="preview", help="preview or path.")
@click.argument("names", nargs=-1)
def films(output: Path, size: str, renderer: str, names: tuple[str, ...]) -> None:
    """Make the films of the artificial fishes, each from its seed.

    A trial run comes before the film, so that the camera is where something happens.

    NAMES are those to make; all if none. What is there already is not made again.
    """
    from bioscope.film import FilmOptions, film_world, parse_size

    seeds = worlds.films()
    for name, path in _still_to_make("film", names or list(seeds), seeds, output, ".mp4"):
        made = opened(name, seeds[name])
        shots = worlds.shots(name)
        seconds = sum(shot.seconds for shot in shots)
        options = FilmOptions(seconds=seconds, size=parse_size(size), renderer=renderer)
        film_world(made, path, options, shots=shots, say=say)


@command("stills", "bioscope stills -o stills --size 640x360")
@path_option("-o", "--output", metavar="DIR", required=True, help="Folder for the pictures.")
@click.option("--size", metavar="WxH", default="1280x720", help="Pixels.")
@click.option("--renderer", default="preview", help="preview or path.")
@click.argument("names", nargs=-1)
def stills(output: Path, size: str, renderer: str, names: tuple[str, ...]) -> None:
    """Take the color plates of the fish worlds: a moment of a film each, from its seed.

    NAMES are those to take; all if none. What is there already is not taken again.
    """
    from bioscope.film import parse_size, take_still

    plates = worlds.plates()
    for name, path in _still_to_make("still", names or list(plates), plates, output, ".png"):
        plate = worlds.plate(name)
        made = opened(plate.world, plate.seed)
        made.run(plate.time)
        take_still(made, path, plate.shot, size=parse_size(size), renderer=renderer)
        say(f"{path}")


@command("export", "bioscope export reef -o reef.usdc --seconds 4")
@world_name
@path_option("-o", "--output", required=True, metavar="FILE.usdc|.usda|.glb", help="What to write.")
@seconds_option(2.0)
@click.option("--fps", type=float, callback=positive, default=24.0, help="Samples per second.")
@seed_option
def export(world: str, output: Path, seconds: float, fps: float, seed: int | None) -> None:
    """Export a world's scene and motion to USD or glTF."""
    from bioscope.export import export_world

    export_world(opened(world, seed), output, seconds, fps, say=say)


@command("derive", "bioscope derive maple --steps 3")
@model_name
@steps_option
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), help="Seed; none: cpfg's own numbers.")
@path_option("--view", metavar="FILE.v", help="View file: functions, curves, the turtle's angles.")
@click.option("--environment", metavar="NAME [P=X…]|FILE.e", help="What surrounds the plant.")
@click.option("--homomorphism", is_flag=True, help="The string as the turtle reads it.")
@click.option("--check", is_flag=True, help="Only say what is wrong or doubtful.")
@click.option("--format", "form", type=click.Choice(["string", "json"]), default="string")
def derive(
    model: str,
    steps: int | None,
    seed: int | None,
    view: Path | None,
    environment: str | None,
    homomorphism: bool,
    check: bool,
    form: str,
) -> None:
    """Print the string that an L-system derives.

    MODEL is a file (bush.l, ./bush) or, without folder and ending, a name from `bioscope list`.
    """
    from bioscope.lsystem import Animation, LSystem
    from bioscope.populations.plants import model_path

    path = model_path(model)
    if check and path.suffix == ".lm":
        doubtful = Animation.check(path)
        for remark in doubtful:
            say(remark)
        say(f"{model}: {len(doubtful) or 'no'} doubtful places")
        return
    system = LSystem.read(path)
    for warning in system.warnings:
        say(warning)
    if check:
        say(f"{model}: {len(system.warnings) or 'no'} doubtful places")
        return
    given = {"view": view, "environment": environment}
    options = {name: value for name, value in given.items() if value is not None}
    string = system.derive(steps, seed, **options)
    for line in [*string.output.splitlines(), *string.remarks]:
        say(line)
    string = string.appearance() if homomorphism else string
    if form == "string":
        print(string.string())
        return
    import msgspec

    symbols = string.symbols
    parts = {
        "symbols": [symbols[kind] for kind in string.kinds],
        "parameters": string.parameters.tolist(),
    }
    print(msgspec.json.encode(parts).decode())


@command("grow", "bioscope grow maple -o maple.glb --seed 3")
@model_name
@path_option(
    "-o", "--output", required=True, metavar="FILE.glb|.obj|.usdc|.png|.mp4", help="What to write."
)
@steps_option
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), default=1, help="Seed.")
@path_option(
    "--view", metavar="FILE.v", help="View file: functions, surfaces, the turtle's angles."
)
@click.option("--environment", metavar="NAME [P=X…]|FILE.e", help="What surrounds the plant.")
@path_option(
    "--colors", metavar="FILE.map|.mat|.colors", help="Colours, if not those beside MODEL."
)
@seconds_option(8.0)
@click.option("--size", metavar="WxH", default="960x960", help="Pixels of a film.")
def grow(
    model: str, output: Path, steps: int | None, seed: int, seconds: float, size: str, **files: Any
) -> None:
    """Grow a plant and write its shape, or with .mp4 a film of its growth.

    MODEL is a file (bush.l, ./bush) or, without folder and ending, a name from `bioscope list`. A
    definition file that runs (.lm) is filmed, or shown in a .png, before its own camera.
    """
    from bioscope.populations.plants import model_path

    path = model_path(model)
    if path.suffix == ".lm":
        from bioscope.film import parse_size
        from bioscope.lsystem.showing import show_animation

        if steps is not None or any(files.values()):
            raise click.UsageError("--steps, --view, --environment, --colors: for plants alone")
        pixels = parse_size(size)
        show_animation(path, output, seconds=seconds, size=pixels, seed=seed, say=say)
        return
    if output.suffix == ".mp4":
        from bioscope.film import parse_size
        from bioscope.lsystem.growth import film_growth

        if any(files.values()):
            raise click.UsageError("--view, --environment, --colors: for shapes, not for films")
        pixels = parse_size(size)
        film_growth(path, output, seconds=seconds, size=pixels, steps=steps, seed=seed, say=say)
        return
    from bioscope.lsystem.specimen import grow as grow_plant

    mesh = grow_plant(path, output, steps, seed, **files)
    say(f"{output}: {len(mesh.triangles)} triangles")


@app.group("new", no_args_is_help=True)
def new() -> None:
    """Begin something of your own."""


@new.command("species", epilog="Example: bioscope new species snowdrop")
@click.argument("name")
@path_option("--folder", metavar="DIR", default=Path(), help="Where the new folder shall be.")
def new_species(name: str, folder: Path) -> None:
    """Begin a plant species: a commented model, its colors, and a place for photographs."""
    from bioscope.lsystem.species import begin

    for path in begin(name, folder):
        say(path)
    say(f"Next: read {folder / name / 'README.md'}, or bioscope edit {folder / name / name}.lsys")


@command("compare", "bioscope compare snowdrop -o sheet.png")
@click.argument("folder", type=click.Path(path_type=Path))
@path_option("-o", "--output", metavar="FILE.png", help="Show where the outlines differ.")
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), default=1, help="Seed of the plant.")
def compare(folder: Path, output: Path | None, seed: int) -> None:
    """Say how well a species meets its photographs, one line per age.

    FOLDER is one as `bioscope new species` writes it. The number is the overlap of the outlines
    (intersection over union), 1 where they are the same.
    """
    from bioscope import _engine
    from bioscope.files import written_whole
    from bioscope.lsystem.species import compare as compare_species
    from bioscope.lsystem.species import sheet

    matches = compare_species(folder, seed)
    for match in matches:
        print(f"{match.age}\t{match.overlap:.3f}")
    if output is not None:
        with written_whole(output) as temporary:
            temporary.write_bytes(_engine.encode_png(sheet(matches)))
        say(f"{output}: dark where they agree, blue the plant alone, red the photograph alone")


@command("edit", "bioscope edit kelp.l")
@click.argument("file", metavar="[FILE|NAME]", required=False)
@click.option(
    "--port", type=click.IntRange(1, 65535), default=8766, help="Port; the next free one."
)
@click.option("--host", default="127.0.0.1", help="Address; others than loopback need a token.")
@click.option("--token", help="Word that a page must know.")
@click.option("--no-open", is_flag=True, help="Do not open a browser.")
def edit(file: str | None, port: int, host: str, token: str | None, no_open: bool) -> None:
    """Edit an L-system in the browser beside its plant.

    FILE is made if it does not exist; NAME is a model of `bioscope list`, to look at and to play
    with; without either a small example comes up.
    """
    from bioscope.lsystem.editor import edit as serve_editor

    serve_editor(file, host=host, port=port, token=token, open_browser=not no_open, say=say)


@command("bench", "bioscope bench reef.tick flock")
@click.argument("names", nargs=-1)
@path_option("--json", metavar="FILE", help="Store the lines here too.")
def bench(names: tuple[str, ...], json: Path | None) -> None:
    """Measure: one JSON line per figure. Needs the source checkout.

    NAMES are the beginnings of figures' names; all if none.
    """
    from bioscope.bench import run as run_benchmarks

    run_benchmarks(list(names), json, say)


def main() -> None:
    """Run the command line; errors are one message and an exit status."""
    signal.signal(signal.SIGTERM, _terminated)
    app()


def _told(error: BaseException) -> str:
    """Return the message of an error with the file it is about."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error) or type(error).__name__


def _terminated(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    main()
