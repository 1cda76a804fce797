"""Write docs/gallery/: a page, a picture and a strip of growth for every model of the gallery.

Only needed to build the documentation; what it writes is not kept in the repository.
"""

import argparse
from pathlib import Path

import numpy as np

from bioscope import _engine, gallery
from bioscope.errors import FormatError
from bioscope.lsystem import LSystem, Turtle
from bioscope.lsystem.specimen import palette_beside, portrait

FOLDER = Path(__file__).resolve().parents[1] / "docs/gallery"
PICTURE = 720
STAGE = 240
STAGES = 6
THUMBNAIL = 160
COLUMNS = 9
GROUPS = {
    "Trees": ("tree",),
    "Ferns, grasses and vines": ("fern", "grass", "vine"),
    "Flowers and inflorescences": ("flower", "inflorescence"),
    "Kelps, corals and their kin": ("kelp", "coral"),
    "Roots, clones and stands": ("root", "clone", "stand"),
    "Fractals, diagrams and examples": ("fractal", "diagram", "example"),
}
HEAD = """# Gallery

Every model comes with Bioscope: `bioscope grow NAME -o plant.png` paints it, `bioscope derive NAME`
prints its string, `bio.gallery.read(NAME, LEAF=0.2)` changes a parameter. How a model is written is
told in [Models of the gallery](../concepts/gallery.md).
"""


def main() -> None:
    """Write the pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="only these models")
    chosen = parser.parse_args().names or gallery.names()
    FOLDER.mkdir(parents=True, exist_ok=True)
    thumbnails = []
    for name in chosen:
        stages = grown(name)
        if stages:
            full = stages[-1]
            save(f"{name}.png", portrait(full, PICTURE, PICTURE))
            strip = [portrait(one, STAGE, STAGE, full=full) for one in stages]
            save(f"{name}-growth.png", np.concatenate(strip, axis=1))
            thumbnails.append(portrait(full, THUMBNAIL, THUMBNAIL))
        (FOLDER / f"{name}.md").write_text(page(name, bool(stages)), encoding="utf-8")
    if chosen == gallery.names():
        save("overview.png", sheet(thumbnails))
        (FOLDER / "index.md").write_text(index(), encoding="utf-8")


def grown(name: str) -> list[_engine.Mesh]:
    """Return the plant at several ages, without those at which it shows nothing yet."""
    system = gallery.read(name)
    steps = np.unique(np.linspace(1, system.steps, STAGES).round().astype(int))
    meshes = [shape(name, system, int(step)) for step in steps]
    return [one for one in meshes if len(one.triangles)]


def shape(name: str, system: LSystem, step: int) -> _engine.Mesh:
    """Return the plant after so many steps."""
    try:
        return (
            Turtle().interpret(system.derive(step)).mesh(palette=palette_beside(gallery.path(name)))
        )
    except FormatError as error:
        raise FormatError(f"{name}, step {step}: {error}") from error


def page(name: str, has_pictures: bool) -> str:
    """Return the page of one model."""
    model = gallery.model(name)
    parts = [f"# {model.title}\n", f"{model.description[0].upper()}{model.description[1:]}.\n"]
    if has_pictures:
        parts.append(f"![{model.title}]({name}.png)\n")
    parts.append(f"**Watch:** {model.watch}.\n")
    if has_pictures:
        parts.append(f"![Stages of growth]({name}-growth.png)\n")
    if model.architecture:
        parts.append(f"**Architectural model:** {model.architecture}.\n")
    parts.append(f"**Source:** {model.source}.\n")
    parts.append(f"**Modules:** {model.modules}.\n")
    if model.parameters:
        parts.append("| parameter | value | range | unit | meaning |\n|---|---|---|---|---|")
        parts += [
            f"| `{one.name}` | {one.value:g} | {one.low:g} to {one.high:g} | {one.unit} "
            f"| {one.meaning} |"
            for one in model.parameters
        ]
    text = model.path.read_text(encoding="utf-8")
    parts.append(f'\n```c title="{model.path.name}"\n{text}```\n')
    return "\n".join(parts)


def index() -> str:
    """Return the page that lists all models."""
    parts = [HEAD, "![All models](overview.png)"]
    for title, kinds in GROUPS.items():
        parts.append(f"\n## {title}\n")
        for name in gallery.names():
            model = gallery.model(name)
            if model.kind in kinds:
                parts.append(f"- [{model.title}]({name}.md) (`{name}`): {model.description}")
    return "\n".join(parts) + "\n"


def sheet(pictures: list[np.ndarray]) -> np.ndarray:
    """Lay pictures of one size out in rows."""
    blank = np.full_like(pictures[0], 200)
    pictures = pictures + [blank] * (-len(pictures) % COLUMNS)
    rows = [pictures[start : start + COLUMNS] for start in range(0, len(pictures), COLUMNS)]
    return np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0)


def save(name: str, picture: np.ndarray) -> None:
    """Write a picture as PNG."""
    (FOLDER / name).write_bytes(_engine.encode_png(np.ascontiguousarray(picture)))


if __name__ == "__main__":
    main()
