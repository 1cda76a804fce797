"""The command line as its user meets it: output, messages, exit status, whole files."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

import bioscope as bio


def test_version_and_list(bioscope):
    assert bioscope("--version").stdout.strip() == f"bioscope {bio.__version__}"
    listed = bioscope("list").stdout
    assert "reef" in listed
    assert "kelp" in listed


def test_who_has_read_enough_hears_no_complaint():
    command = f"{sys.executable} -m bioscope.cli list | head -1"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True)
    assert len(done.stdout.splitlines()) == 1
    assert done.stderr == ""


def test_run_prints_the_hash_last_and_repeats_it(bioscope, script):
    first = bioscope("run", script, "--seconds", 1, "--seed", 4, "--hash")
    again = bioscope("--quiet", "run", script, "--seconds", 1, "--seed", 4, "--hash")
    assert first.returncode == 0, first.stderr
    digits = first.stdout.strip().splitlines()[-1]
    assert len(digits) == 64
    assert again.stdout.strip() == digits
    assert "seed 4" in first.stderr
    assert again.stderr == ""


def test_a_saved_run_goes_on_as_one_run(bioscope, script, tmp_path):
    whole = bioscope("run", script, "--seconds", 2, "--seed", 4, "--hash").stdout
    loader = tmp_path / "again.py"
    loader.write_text(
        script.read_text().replace(
            "return small_world(seed)",
            f"import bioscope; return bioscope.World.restore({str(tmp_path / 'half.world')!r})",
        )
    )
    bioscope("run", script, "--seconds", 1, "--seed", 4, "--save", "half.world")
    rest = bioscope("run", loader, "--seconds", 1, "--hash")
    assert rest.stdout == whole, rest.stderr


@pytest.mark.parametrize("suffix", ["jsonl", "parquet"])
def test_events_go_to_a_file(bioscope, script, tmp_path, suffix):
    path = tmp_path / f"events.{suffix}"
    done = bioscope("run", script, "--seconds", 1, "--seed", 4, "--events", path)
    assert done.returncode == 0, done.stderr
    if suffix == "jsonl":
        rows = [json.loads(line) for line in path.read_text().splitlines()]
    else:
        import pyarrow.parquet

        rows = pyarrow.parquet.read_table(path).to_pylist()
    assert [row["tick"] for row in rows] == [20, 40, 60]
    assert {row["kind"] for row in rows} == {"born"}


BROKEN = {
    "syntax.py": ("def world(seed)\n    pass\n", r"syntax\.py:1:.*expected ':'"),
    "raises.py": ("def world(seed):\n    x = 1\n    return 1 / 0\n", r"raises\.py:3: ZeroDiv"),
    "nothing.py": ("x = 1\n", r"nothing\.py: expected a function world"),
    "other.py": ("def world(seed):\n    return 5\n", r"returned int: expected a bioscope\.World"),
    "import.py": ("import no_such_module\n", r"import\.py:1: ModuleNotFoundError"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_script_is_told_by_file_and_line(bioscope, tmp_path, name):
    text, message = BROKEN[name]
    (tmp_path / name).write_text(text)
    done = bioscope("run", tmp_path / name)
    assert done.returncode == 1
    import re

    assert re.search(message, done.stderr), done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["run", "no_such_world"], 1, "unknown world 'no_such_world'; known: "),
        (["run", "missing.py"], 1, "missing.py: no such file"),
        (["run", "reef", "--seconds", "-3"], 2, "--seconds"),
        (["run", "reef", "--seconds", "nan"], 2, "--seconds"),
        (["run"], 2, "WORLD"),
        (["dance"], 2, "dance"),
        (["film", "reef"], 2, "--output"),
        (["film", "reef", "-o", "x.mp4", "--size", "12x"], 1, "expected WIDTHxHEIGHT"),
        (["film", "reef", "-o", "x.mp4", "--size", "17x20"], 1, "even numbers"),
        (["film", "reef", "-o", "x.mp4", "--renderer", "oil"], 1, "preview or path"),
        (["film", "reef", "-o", "nowhere/x.mp4"], 1, "nowhere does not exist"),
        (["export", "reef", "-o", "x.fbx"], 1, "x.fbx"),
        (["derive", "missing.l"], 1, "missing.l"),
        (["live", "reef", "--host", "0.0.0.0", "--no-open"], 1, "--token"),
    ],
)
def test_wrong_usage_and_failures(bioscope, tmp_path, arguments, status, message):
    done = bioscope(*arguments)
    assert done.returncode == status, done.stderr
    assert message in done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["run", "live", "film", "export", "derive", "grow", "bench"])
def test_help_shows_an_example(bioscope, command):
    done = bioscope(command, "--help")
    assert done.returncode == 0
    assert f"Example: bioscope {command}" in done.stdout


def test_interrupting_a_run_keeps_its_events_and_gives_130(script, tmp_path):
    events = tmp_path / "events.jsonl"
    command = [sys.executable, "-m", "bioscope.cli", "run", str(script), "--seconds", "100000"]
    process = subprocess.Popen([*command, "--events", str(events)], stderr=subprocess.PIPE)
    while not list(tmp_path.glob(".events.partial*")):
        time.sleep(0.1)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 130
    assert [json.loads(line) for line in events.read_text().splitlines()]
    assert list(tmp_path.glob(".*partial*")) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_an_unwritable_folder_is_named(bioscope, script, tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o500)
    done = bioscope("run", script, "--seconds", 0.1, "--save", folder / "x.world")
    assert done.returncode == 1
    assert "locked" in done.stderr


FULL = "/dev/full"


@pytest.mark.skipif(not os.path.exists(FULL), reason="needs /dev/full")  # noqa: PTH110
def test_a_full_disk_loses_nothing_that_was_there(world, tmp_path, monkeypatch):
    path = tmp_path / "small.world"
    world.save(path)
    before = path.read_bytes()

    from pathlib import Path

    def fill(self, data):
        with open(FULL, "wb") as file:  # noqa: PTH123
            file.write(data)
            file.flush()

    monkeypatch.setattr(Path, "write_bytes", fill)
    with pytest.raises(OSError, match="No space left"):
        world.save(path)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == ["small.world"]


def test_a_run_killed_while_saving_leaves_the_old_file(script, tmp_path):
    path = tmp_path / "small.world"
    path.write_bytes(b"the old file")
    code = (
        "import sys, os, signal, pathlib; from bioscope import worlds\n"
        f"w = worlds.load({str(script)!r}, 1)\n"
        "pathlib.Path.replace = lambda *a: os.kill(os.getpid(), signal.SIGKILL)\n"
        f"w.save({str(path)!r})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], check=False)
    assert done.returncode == -signal.SIGKILL
    assert path.read_bytes() == b"the old file"


def test_derive_prints_the_string(bioscope, tmp_path):
    model = tmp_path / "algae.l"
    model.write_text(
        "lsystem: algae\nderivation length: 4\naxiom: A\nA --> AB\nB --> A\nendlsystem\n"
    )
    assert bioscope("derive", model).stdout == "ABAABABA\n"
    assert bioscope("derive", model, "--steps", 2).stdout == "ABA\n"
    parts = json.loads(bioscope("derive", model, "--steps", 1, "--format", "json").stdout)
    assert parts == {"symbols": ["A", "B"], "parameters": []}


def test_a_wrong_model_is_told_by_line_and_column(bioscope, tmp_path):
    model = tmp_path / "wrong.l"
    model.write_text("lsystem: wrong\naxiom: A(1\nA --> B\nendlsystem\n")
    done = bioscope("derive", model)
    assert done.returncode == 1
    assert "wrong.l:2:" in done.stderr


@pytest.mark.parametrize("suffix", ["obj", "png", "glb"])
def test_grow_writes_a_plant(bioscope, tmp_path, suffix):
    model = tmp_path / "bush.l"
    model.write_text(
        "lsystem: bush\nderivation length: 3\naxiom: !(0.1)F\nF --> F[+F]F[-F]F\nendlsystem\n"
    )
    output = tmp_path / f"bush.{suffix}"
    done = bioscope("grow", model, "-o", output)
    assert done.returncode == 0, done.stderr
    head = {"obj": b"v ", "png": b"\x89PNG", "glb": b"glTF"}[suffix]
    assert output.read_bytes().startswith(head)
