"""The house rules that no linter knows."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_layers_paths_and_sizes():
    done = subprocess.run(
        [sys.executable, ROOT / "scripts/check_house.py"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
