"""Write docs/reference/parameters.md from the parameters of the ready-made worlds."""

from pathlib import Path

import bioscope as bio
from bioscope import worlds

PAGE = Path(__file__).resolve().parents[1] / "docs/reference/parameters.md"
HEAD = """# Parameters

Every tunable number of the ready-made worlds, as the engine describes it. Set one with `world.set(owner, name, value)`, as a keyword of its population, or on the page.
"""  # noqa: E501 - a paragraph of the page is a line


def main() -> None:
    """Write the page."""
    parts = [HEAD]
    for name in worlds.names():
        owners: dict[str, list[str]] = {}
        for row in bio.load(name, seed=1).parameters():
            range_ = f"{row.minimum:g} to {row.maximum:g}"
            cells = (row.name, row.unit, range_, f"{row.default:.4g}", row.meaning, row.source)
            owners.setdefault(row.owner, []).append("| " + " | ".join(cells) + " |")
        for owner, rows in owners.items():
            parts.append(f"\n## {name}: {owner}\n")
            parts.append("| name | unit | range | default | meaning | source |")
            parts.append("|---|---|---|---|---|---|")
            parts += rows
    PAGE.write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
