"""The files that make a fish, and how tests change a line of them."""

import re
from pathlib import Path

CRATES = Path(__file__).parents[2] / "crates"
SPECIES = CRATES / "stage/bioscope_populations/species/anthias.toml"
DESIGN = CRATES / "organism/bioscope_motion/tables/calibrated.toml"


def changed(source: Path, target: Path, old: str, new: str) -> str:
    """Write `source` with its first match of `old` replaced to `target`; return the path."""
    text = source.read_text(encoding="utf-8")
    other = re.sub(old, new, text, count=1, flags=re.M)
    assert other != text
    target.write_text(other, encoding="utf-8")
    return str(target)
