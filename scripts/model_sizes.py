"""Write docs/reproductions/model-sizes.md from bench/results.json: six models, size and time."""

import importlib.util
import json
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/reproductions/model-sizes.md"
RESULTS = ROOT / "bench/results.json"
HEAD = """# Sizes and times of models

The six models of table 1 in R. Měch and P. Prusinkiewicz, "Visual models of plants interacting
with their environment", SIGGRAPH 1996 (200 MHz Indigo² Extreme), and the same models of the gallery
as `bioscope bench models` measures them here, in processor time: the derivation, and one picture of
960x960 pixels from the turtle to the last pixel. Needles and generalized cylinders, which the paper
left out of the trees' times, are drawn. Growth is a matter of chance: sizes are those of one seed.

"""
COLUMNS = ("model", "fig.", "steps", "segments", "", "simulation", "picture")


def page(results: Path) -> str:
    """Return the page from the results of the benchmarks; what was not measured is left open."""
    spec = importlib.util.spec_from_file_location("bench_models", ROOT / "bench/models.py")
    models = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(models)
    values = {}
    if results.is_file():
        rows = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]
        values = {row["name"]: row["value"] for row in rows if "name" in row}

    def told(name: str, form: str) -> str:
        value = values.get(f"models.{name}")
        return "not measured" if value is None else format(value, form)

    lines = ["| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
    for name, model in models.MODELS.items():
        cells = (
            f"{model.title} (`{model.gallery}`)",
            str(model.figure),
            str(model.steps),
            f"{told(f'{name}.segments', ',.0f')} (published {model.segments:,})",
            f"{told(f'{name}.organs', ',.0f')} {model.organ} (published {model.organs:,})",
            f"{told(f'{name}.simulation', '.3g')} s (published {model.simulation})",
            f"{told(f'{name}.picture', '.3g')} s (published {model.rendering})",
        )
        lines.append("| " + " | ".join(cells) + " |")
    return HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(RESULTS), encoding="utf-8")
