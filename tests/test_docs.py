"""What the documents show has been run."""

import doctest
import importlib
import pkgutil
import re
import runpy
from pathlib import Path

import pytest

import bioscope

ROOT = Path(__file__).parents[1]


def modules():
    names = ["bioscope"]
    skipped = ("bioscope.cli", "bioscope.film.path", "bioscope._engine")
    for one in pkgutil.walk_packages(bioscope.__path__, "bioscope."):
        if not one.name.startswith(skipped):
            names.append(one.name)
    return names


@pytest.mark.parametrize("name", modules())
def test_docstring_examples(name):
    outcome = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert outcome.failed == 0


def test_some_docstrings_have_examples():
    with_examples = [
        name
        for name in modules()
        if doctest.DocTestFinder(exclude_empty=True).find(importlib.import_module(name))
        and any(one.examples for one in doctest.DocTestFinder().find(importlib.import_module(name)))
    ]
    assert len(with_examples) >= 4


def blocks(path, language):
    text = (ROOT / path).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.S)


def test_the_tutorials_world_runs_as_written(tmp_path, bioscope):
    script = tmp_path / "lanterns.py"
    script.write_text(blocks("docs/start/own-world.md", "python")[0])
    assert len(script.read_text().splitlines()) <= 50
    first = bioscope("run", script, "--seconds", 2, "--seed", 3, "--hash")
    again = bioscope("run", script, "--seconds", 2, "--seed", 3, "--hash")
    assert first.returncode == 0, first.stderr
    assert first.stdout == again.stdout
    film = bioscope("film", script, "-o", "x.mp4", "--seconds", 0.2, "--size", "64x48")
    assert film.returncode == 0, film.stderr


def test_the_readmes_ten_lines_run_as_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = blocks("README.md", "python")[0].replace("seconds=10)", "seconds=0.1)")
    script = tmp_path / "readme.py"
    script.write_text(text)
    runpy.run_path(str(script))
    assert (tmp_path / "school.mp4").stat().st_size > 1000


def test_the_guide_to_training_runs_as_written(tmp_path):
    for number, text in enumerate(blocks("docs/guides/train.md", "python")):
        script = tmp_path / f"train_{number}.py"
        script.write_text(text)
        runpy.run_path(str(script))


def test_the_guide_to_agents_runs_as_written(tmp_path):
    script = tmp_path / "agents.py"
    script.write_text("\n".join(blocks("docs/guides/agents-without-code.md", "python")))
    runpy.run_path(str(script))


def test_one_version_number():
    import json
    import tomllib

    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    page = json.loads((ROOT / "web/package.json").read_text())["version"]
    assert bioscope.__version__ == cargo == page


def test_the_guide_to_growing_plants_runs_as_written():
    names = {}
    for block in blocks("docs/guides/grow-plants.md", "python"):
        exec(compile(block, "grow-plants.md", "exec"), names)
    assert names["world"].populations["trees"] >= 10
    assert names["world"].statistics()["trees.segments"] > 100


def test_events_that_happen_are_on_their_page():
    page = (ROOT / "docs/reference/events.md").read_text(encoding="utf-8")
    rows = [line.split("|") for line in page.splitlines() if line.startswith("| `")]
    known = {kind: row[4] for row in rows for kind in re.findall(r"`(.*?)`", row[1])}
    assert len(known) >= 18
    for name, seconds in [("go_fish", 24), ("reef", 20)]:
        world = bioscope.load(name, seed=4)
        world.run(seconds)
        for event in world.drain_events():
            assert event.kind in known
            assert all(f"`{one}`" in known[event.kind] for one in event.data), event


def test_a_story_of_ones_own_is_filmed_as_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (source,) = (one for one in blocks("docs/start/film.md", "python") if "Story(" in one)
    small = source.replace("seconds=seconds)", "seconds=1, size=(64, 36))")
    assert small != source
    exec(compile(small, "film.md", "exec"), {"bio": bioscope})
    assert (tmp_path / "kill.mp4").stat().st_size > 1000
