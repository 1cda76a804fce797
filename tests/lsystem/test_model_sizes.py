"""The table of model sizes and times is made from what was measured."""

import json
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def results(bioscope, tmp_path):
    """Measure the two smallest models of the table."""
    path = tmp_path / "results.json"
    done = bioscope("bench", "models.tiers", "models.clone", "--json", path)
    assert done.returncode == 0, done.stderr
    return path


def cells(page: str, model: str) -> list[str]:
    """Return the cells of a model's row."""
    (row,) = [line for line in page.splitlines() if f"`{model}`" in line]
    return [cell.strip() for cell in row.strip("|").split("|")]


@pytest.mark.capability("PL-449")
def test_the_table_tells_what_was_measured_and_what_is_published(results):
    page = runpy.run_path(str(ROOT / "scripts/model_sizes.py"))["page"]
    text = page(results)
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    values = {row["name"]: row["value"] for row in rows if "name" in row}
    # As published, exactly.
    assert values["models.tiers.segments"] == 138
    assert values["models.tiers.organs"] == 140
    tiers = cells(text, "branch_tiers")
    assert tiers[1:3] == ["5", "5"]
    assert tiers[3] == "138 (published 138)"
    assert tiers[4] == "140 leaf clusters (published 140)"
    seconds = values["models.clone.simulation"]
    clone = cells(text, "clonal_plant")
    assert clone[5] == f"{seconds:.3g} s (published 50 s)"
    assert 0 < seconds < 50
    assert 300 < values["models.clone.segments"] < 3000
    # What was not measured is not made up.
    for model in ("roots", "roots_3d", "light_tree", "conifer"):
        assert all("not measured" in cell for cell in cells(text, model)[3:])
