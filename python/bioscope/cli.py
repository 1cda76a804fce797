"""The command line: `bioscope --help`."""

from __future__ import annotations

import secrets
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
import typer.core

import bioscope
from bioscope import worlds
from bioscope.errors import BioscopeError, InvalidValueError

if TYPE_CHECKING:
    from bioscope.world import World


class Commands(typer.core.TyperGroup):
    """The commands, with failures turned into one message and an exit status."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command: status 1 if the work failed, 130 if it was interrupted."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            raise typer.Exit(130) from None
        except (BioscopeError, OSError, MemoryError) as error:
            print(f"bioscope: {_told(error)}", file=sys.stderr)
            raise typer.Exit(1) from None


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

WorldName = Annotated[
    str, typer.Argument(metavar="WORLD", help="A name from `bioscope list`, or a Python file.")
]
Seed = Annotated[int | None, typer.Option(min=0, max=2**64 - 1, help="Seed; drawn if not given.")]
Seconds = Annotated[float, typer.Option(help="World time to run, in seconds.")]


def say(*words: object) -> None:
    """Print a message for people: to standard error, unless `--quiet`."""
    if not _quiet:
        print(*words, file=sys.stderr, flush=True)


_quiet = False


def _version(wanted: bool) -> None:
    if wanted:
        print(f"bioscope {bioscope.__version__}")
        raise typer.Exit


@app.callback()
def options(
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only results and errors.")] = False,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Bring virtual worlds to life, watch, film and export them."""
    global _quiet
    _quiet = quiet


def opened(name: str, seed: int | None) -> World:
    """Make the world and say its seed."""
    seed = secrets.randbits(32) if seed is None else seed
    world = worlds.load(name, seed)
    say(f"{world.title}: seed {world.seed}, tick {world.dt * 1000:.3g} ms")
    return world


def positive(name: str, value: float) -> float:
    """Refuse what is no positive finite number."""
    if not 0 < value < float("inf"):
        raise typer.BadParameter(f"{value}: expected more than 0", param_hint=f"--{name}")
    return value


@app.command("list")
def list_() -> None:
    """List the ready-made worlds and models, each with a line.

    Example: bioscope list
    """
    from bioscope.populations.plants import models

    for name, summary in worlds.names().items():
        print(f"{name:16} {summary}")
    for name, path in models().items():
        print(f"{name:16} Plant model, {path}")


@app.command()
def run(
    world: WorldName,
    seconds: Seconds = 10.0,
    seed: Seed = None,
    events: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Events to a .jsonl or .parquet file.")
    ] = None,
    save: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Save the world at the end.")
    ] = None,
    show_hash: Annotated[
        bool, typer.Option("--hash", help="Print the state hash as the last line.")
    ] = False,
) -> None:
    """Run a world without watching it.

    Example: bioscope run reef --seconds 60 --seed 7 --events reef.jsonl --hash
    """
    from bioscope.run import run_world

    made = opened(world, seed)
    run_world(made, positive("seconds", seconds), events, save, say)
    if show_hash:
        print(made.state_hash())


@app.command()
def live(
    world: WorldName,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port; the next free one.")] = 8765,
    host: Annotated[str, typer.Option(help="Address; others than loopback need a token.")] = (
        "127.0.0.1"
    ),
    token: Annotated[str | None, typer.Option(help="Word that a page must know.")] = None,
    seed: Seed = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser.")] = False,
) -> None:
    """Watch a world live in the browser.

    Example: bioscope live reef --seed 7
    """
    from bioscope.live import serve

    seed = secrets.randbits(32) if seed is None else seed
    serve(world, seed=seed, host=host, port=port, token=token, open_browser=not no_open, say=say)


@app.command()
def film(
    world: WorldName,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE.mp4")] = None,
    seconds: Seconds = 10.0,
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.")] = "1280x720",
    fps: Annotated[float, typer.Option(help="Pictures per second.")] = 30.0,
    renderer: Annotated[str, typer.Option(help="preview or path.")] = "preview",
    camera: Annotated[str | None, typer.Option(help="A camera of the world.")] = None,
    frames: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Pictures as PNG files in a folder.")
    ] = None,
    samples: Annotated[int, typer.Option(min=1, help="Samples per pixel (path).")] = 64,
    seed: Seed = None,
) -> None:
    """Film a world, with sound. An interrupted film goes on where it stopped.

    Example: bioscope film reef -o reef.mp4 --seconds 10 --seed 7
    """
    from bioscope.film import FilmOptions, film_world, parse_size
    from bioscope.film.film import seed_of_partial

    if output is None and frames is None:
        raise typer.BadParameter("expected a file to write", param_hint="--output")
    options = FilmOptions(
        seconds=positive("seconds", seconds),
        size=parse_size(size),
        frames_per_second=positive("fps", fps),
        renderer=renderer,
        camera=camera,
        samples=samples,
    )
    seed = seed_of_partial(output, frames, options) if seed is None else seed
    film_world(opened(world, seed), output, options, frames=frames, say=say)


@app.command()
def export(
    world: WorldName,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE.usdc|.usda|.glb")],
    seconds: Seconds = 2.0,
    fps: Annotated[float, typer.Option(help="Samples per second.")] = 24.0,
    seed: Seed = None,
) -> None:
    """Export a world's scene and motion to USD or glTF.

    Example: bioscope export reef -o reef.usdc --seconds 4
    """
    from bioscope.export import export_world

    positive("seconds", seconds)
    export_world(opened(world, seed), output, seconds, positive("fps", fps), say=say)


@app.command()
def derive(
    file: Annotated[Path, typer.Argument(metavar="FILE.l", help="A model.")],
    steps: Annotated[
        int | None, typer.Option(min=0, help="As the file says, if not given.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**64 - 1)] = 1,
    homomorphism: Annotated[
        bool, typer.Option("--homomorphism", help="The string as the turtle reads it.")
    ] = False,
    form: Annotated[str, typer.Option("--format", help="string or json.")] = "string",
) -> None:
    """Print the string that an L-system derives.

    Example: bioscope derive kelp.l --steps 8
    """
    from bioscope.lsystem import LSystem

    if form not in ("string", "json"):
        raise typer.BadParameter(f"{form}: expected string or json", param_hint="--format")
    system = LSystem.read(file)
    for warning in system.warnings:
        say(warning)
    string = system.derive(steps, seed)
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


@app.command()
def grow(
    file: Annotated[Path, typer.Argument(metavar="FILE.l", help="A model.")],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="FILE.glb|.obj|.usdc|.png", help="What to write."),
    ],
    steps: Annotated[
        int | None, typer.Option(min=0, help="As the file says, if not given.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**64 - 1)] = 1,
) -> None:
    """Grow a plant and write its shape.

    Example: bioscope grow kelp.l -o kelp.glb --seed 3
    """
    from bioscope.lsystem.specimen import grow as grow_plant

    mesh = grow_plant(file, output, steps, seed)
    say(f"{output}: {len(mesh.triangles)} triangles")


@app.command()
def bench(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME…]", help="Beginnings of names; all if none."),
    ] = None,
    json: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Store the lines here too.")
    ] = None,
) -> None:
    """Measure: one JSON line per figure. Needs the source checkout.

    Example: bioscope bench reef.tick flock
    """
    from bioscope.bench import run as run_benchmarks

    run_benchmarks(names or [], json, say)


def main() -> None:
    """Run the command line; errors are one message and an exit status."""
    signal.signal(signal.SIGTERM, _terminated)
    app()


def _told(error: BaseException) -> str:
    """Return the message of an error with the file it is about."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{error.filename}: {error.strerror}"
    if isinstance(error, InvalidValueError) or str(error):
        return str(error)
    return type(error).__name__


def _terminated(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    main()
