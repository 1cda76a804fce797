"""The wheel, in a clean virtual environment without compiler or node."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """Build the wheel and install it, with the extra `film`, into an empty environment."""
    if shutil.which("cargo") is None:
        pytest.skip("needs cargo to build the wheel")
    folder = tmp_path_factory.mktemp("wheel")
    maturin = Path(sys.executable).with_name("maturin")
    subprocess.run(
        [maturin, "build", "--release", "--quiet", "--out", folder], cwd=ROOT, check=True
    )
    (wheel,) = folder.glob("*.whl")
    assert "abi3" in wheel.name
    subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
    programs = folder / "venv/bin"
    install = [programs / "python", "-m", "pip", "install", "--quiet"]
    subprocess.run([*install, wheel], check=True)
    listing = subprocess.run(
        [programs / "python", "-m", "pip", "list", "--format=freeze"],
        capture_output=True,
        text=True,
        check=True,
    )
    packages = [
        line for line in listing.stdout.splitlines() if not line.startswith(("pip", "setup"))
    ]
    subprocess.run([*install, f"bioscope[film] @ {wheel.as_uri()}"], check=True)
    return programs, packages, folder


def without_tools(programs):
    """Return an environment whose path holds nothing but the environment's programs."""
    kept = {name: os.environ[name] for name in ("HOME", "LANG") if name in os.environ}
    return kept | {"PATH": str(programs)}


def test_the_base_install_is_small(clean):
    _, packages, _ = clean
    assert len(packages) <= 20, packages


def test_it_films_the_reef(clean):
    programs, _, folder = clean
    command = [programs / "bioscope", "film", "reef", "-o", "reef.mp4", "--seconds", "0.2"]
    done = subprocess.run(
        [*command, "--size", "320x180"],
        cwd=folder,
        env=without_tools(programs),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (folder / "reef.mp4").stat().st_size > 2000


def test_it_serves_the_reef_with_its_page(clean):
    import urllib.request

    programs, _, folder = clean
    command = [programs / "bioscope", "live", "reef", "--no-open", "--port", "18765"]
    process = subprocess.Popen(
        command, cwd=folder, env=without_tools(programs), stderr=subprocess.PIPE, text=True
    )
    try:
        address = next(line.split()[2] for line in process.stderr if line.startswith("live at"))
        deadline = time.monotonic() + 60
        while True:
            try:
                page = urllib.request.urlopen(address).read()
                break
            except OSError:
                assert time.monotonic() < deadline
                time.sleep(0.3)
        assert len(page) > 100_000
        assert b"<title>" in page
    finally:
        process.terminate()
        process.wait(20)
