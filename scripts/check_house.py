"""Check the house rules that no linter knows: layers of crates, quoted paths, sizes of files.

Usage: python scripts/check_house.py        exits with 1 and a line for each broken rule
       python scripts/check_house.py --table  writes crates/README.md from the manifests
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LAYERS = ["core", "matter", "organism", "society", "stage", "tools"]
LARGEST_FILE = 800
LARGEST_ROOM = 80
"""Lines of code in a `mod.rs` or `__init__.py`."""

WITHIN_LAYER = {
    ("bioscope_geometry", "bioscope_core"),
    ("bioscope_senses", "bioscope_motion"),
    ("bioscope_populations", "bioscope_world"),
    ("bioscope_python", "bioscope_populations"),
    ("bioscope_python", "bioscope_stream"),
    ("bioscope_python", "bioscope_world"),
}
"""Edges inside a folder, each with its reason in ARCHITECTURE.md."""

TABLE_HEAD = """# The crates

The folders stand in the order of dependency: a crate may use crates in folders above its own, and inside its
folder only what this table says. `scripts/check_house.py --table` writes the table from the
manifests; `make lint` fails when it is not fresh.

| folder | crate | about | uses |
|---|---|---|---|
"""  # noqa: E501 - lines of the page


def tracked() -> list[Path]:
    """Return every file that git knows or would add."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listing = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for line in listing.stdout.splitlines() if (path := ROOT / line).is_file()]


def crates() -> list[tuple[str, str, str, list[str]]]:
    """Return (folder, crate, first sentence of its documentation, crates it uses)."""
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1", "--offline"]
    metadata = json.loads(
        subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    )
    names = {package["name"] for package in metadata["packages"]}
    found = []
    for package in metadata["packages"]:
        folder = Path(package["manifest_path"]).parents[1].name
        source = Path(package["manifest_path"]).parent / "src" / "lib.rs"
        about = re.findall(r"^//! ?(.*)$", source.read_text(encoding="utf-8"), re.M)
        first = " ".join(about).split(". ")[0].rstrip(".")
        uses = sorted(
            one["name"]
            for one in package["dependencies"]
            if one["name"] in names and one["kind"] != "dev"
        )
        found.append((folder, package["name"], first, uses))
    return sorted(found, key=lambda one: (LAYERS.index(one[0]), one[1]))


def table() -> str:
    """Return crates/README.md."""
    rows = [
        f"| {folder} | {name} | {about} | {', '.join(uses) or '-'} |"
        for folder, name, about, uses in crates()
    ]
    return TABLE_HEAD + "\n".join(rows) + "\n"


def check_layers() -> list[str]:
    """Crates use only what stands above them."""
    known = crates()
    layer = {name: LAYERS.index(folder) for folder, name, _, _ in known}
    wrong = []
    for _, name, _, uses in known:
        for used in uses:
            same_allowed = layer[used] == layer[name] and (name, used) in WITHIN_LAYER
            if layer[used] >= layer[name] and not same_allowed:
                wrong.append(f"{name} uses {used}, which does not stand above it")
    if (ROOT / "crates/README.md").read_text(encoding="utf-8") != table():
        wrong.append("crates/README.md is not fresh: run scripts/check_house.py --table")
    return wrong


def check_paths() -> list[str]:
    """Every path that a document quotes exists."""
    quoted = re.compile(
        r"`((?:crates|python|web|docs|tests|bench|scripts|examples|fuzz)/[\w./\-]*)`"
    )
    wrong = []
    for path in tracked():
        if path.suffix != ".md":
            continue
        for line, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for match in quoted.findall(text):
                built = match.startswith(("python/bioscope/live/page", "bench/results.json"))
                if not built and not (ROOT / match).exists():
                    wrong.append(f"{path.relative_to(ROOT)}:{line}: {match} does not exist")
    return wrong


def check_sizes() -> list[str]:
    """Files stay readable; the front doors of modules hold no logic."""
    wrong = []
    for path in tracked():
        if path.suffix not in {".rs", ".py", ".ts", ".pyi"}:
            if path.stat().st_size > 1_000_000:
                wrong.append(f"{path.relative_to(ROOT)}: more than 1 MB")
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > LARGEST_FILE and path.suffix != ".pyi":
            wrong.append(f"{path.relative_to(ROOT)}: {len(lines)} lines, at most {LARGEST_FILE}")
        if path.name in {"mod.rs", "__init__.py"} and "tests" not in path.parts:
            code = [one for one in lines if one.strip() and not one.lstrip().startswith("//")]
            if len(code) > LARGEST_ROOM and path.name == "mod.rs":
                wrong.append(f"{path.relative_to(ROOT)}: {len(code)} lines of code")
    return wrong


def check_speech() -> list[str]:
    """The project speaks of itself alone."""
    foreign = re.compile(r"\.\./shared|/work/|/root/|registry\.npmjs|pypi\.org|\bissue #?\d")
    wrong = []
    for path in tracked():
        if path == Path(__file__).resolve() or path.suffix in {".lock", ".png"}:
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for line, one in enumerate(text.splitlines(), 1):
            if match := foreign.search(one):
                wrong.append(f"{path.relative_to(ROOT)}:{line}: speaks of {match[0]}")
    return wrong


def main() -> int:
    """Run all checks."""
    if "--table" in sys.argv:
        (ROOT / "crates/README.md").write_text(table(), encoding="utf-8")
        return 0
    wrong = [*check_layers(), *check_paths(), *check_sizes(), *check_speech()]
    print("\n".join(wrong), file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
