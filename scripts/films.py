"""Write docs/films/: the page of the films, with stills of each.

Only needed to build the documentation; what it writes is not kept in the repository.
"""

import importlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import bioscope as bio
from bioscope import _engine, worlds
from bioscope.film import FilmOptions
from bioscope.film.direction import Shot
from bioscope.film.operator import Operator
from bioscope.film.renderer import renderer

FOLDER = Path(__file__).resolve().parents[1] / "docs/films"
SIZE = (1280, 720)
MOMENTS = {"schooling": (8.0, 18.5)}
"""Seconds of a film at which its two stills are taken; of others their plates or longest shots."""
HEAD = """# Films

Five stories of artificial fishes. Nothing in them is animated by hand: each runs from a seed, and
its camera follows a shot list, as a nature film does. A trial run comes first: it tells what will
happen, and the camera is there in time.

```sh
bioscope films -o films                  # all five, with sound
bioscope films -o films mating --size 1920x1080
bioscope live mating --seed 4            # the same, to walk about in
```

The stories are those of X. Tu, *Artificial Animals for Computer Animation* (1996), chapter 8. The
tests in `tests/worlds/` run each from its seed to its events.
"""


def main() -> None:
    """Write the page and its pictures."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    parts = [HEAD]
    for name, seed in worlds.films().items():
        world, shots = bio.load(name, seed=seed), worlds.shots(name)
        parts.append(section(name, sum(shot.seconds for shot in shots)))
        moments = MOMENTS.get(name) or longest(shots)
        for number, picture in enumerate(stills(world, shots, moments), start=1):
            (FOLDER / f"{name}-{number}.png").write_bytes(_engine.encode_png(picture))
    (FOLDER / "index.md").write_text("\n".join(parts), encoding="utf-8")


def section(name: str, seconds: float) -> str:
    """Return what the page says of one film: the text of its module."""
    text = importlib.import_module(f"bioscope.worlds.{name}.world").__doc__ or ""
    stills = "\n".join(f"![{name}]({name}-{number}.png)" for number in (1, 2))
    return f"\n## {name} ({seconds:.0f} s)\n\n{text.strip()}\n\n{stills}\n"


def longest(shots: list[Shot]) -> tuple[float, ...]:
    """Return the middles of the two longest shots, or of those that make plates, in order."""
    ends = np.cumsum([shot.seconds for shot in shots])
    ranked = sorted(range(len(shots)), key=lambda one: (not shots[one].plate, -shots[one].seconds))
    return tuple(
        float(ends[one] - shots[one].seconds + (shots[one].moment or shots[one].seconds / 2))
        for one in sorted(ranked[:2])
    )


def stills(
    world: bio.World, shots: list[Shot], moments: tuple[float, ...]
) -> list[NDArray[np.uint8]]:
    """Return the pictures of the film at these moments."""
    painter = renderer(FilmOptions(seconds=1, size=SIZE))
    operator, rate, pictures = Operator(world, None, shots), 15, []
    for frame in range(round(max(moments) * rate) + 1):
        while world.time < frame / rate:
            world.step()
        camera, _ = operator.camera(frame / rate, 1 / rate)
        if any(frame == round(moment * rate) for moment in moments):
            pictures.append(painter.render(world.scene, camera))
    return pictures


if __name__ == "__main__":
    main()
