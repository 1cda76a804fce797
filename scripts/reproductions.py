"""Write docs/reproductions from their tables, the tests' markers and bench/results.json.

Each NAME.toml lists a source's rows; the tests that prove a row are found by their
`@pytest.mark.capability` markers, measured figures by their names in the results of `make bench`.
A row whose criterion is a speed, which tests do not assert, is `proved` by `make bench`.
"""

import ast
import json
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs/reproductions"
RESULTS = ROOT / "bench/results.json"


def claims() -> dict[str, list[str]]:
    """Return the tests that claim each capability, as `file::test`."""
    found: dict[str, list[str]] = {}
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.FunctionDef):
                continue
            for decorator in node.decorator_list:
                if isinstance(decorator, ast.Call) and "mark.capability" in ast.unparse(decorator):
                    name = f"{path.relative_to(ROOT)}::{node.name}"
                    for one in decorator.args:
                        found.setdefault(str(ast.literal_eval(one)), []).append(name)
    return found


def figures() -> dict[str, str]:
    """Return the measured figures by name, as text; empty before `make bench`."""
    if not RESULTS.is_file():
        return {}
    rows = [json.loads(line) for line in RESULTS.read_text(encoding="utf-8").splitlines()]
    return {row["name"]: f"{row['value']:,.4g} {row['unit']}" for row in rows if "name" in row}


def page(table: dict, proofs: dict[str, list[str]], measured: dict[str, str]) -> str:
    """Return the page of one source."""
    lines = [
        f"# {table['title']}",
        "",
        f"Source: {table['source']}.",
        "",
        table["text"].strip(),
        "",
    ]
    lines += ["| id | what | published | proved by | measured |", "|---|---|---|---|---|"]
    for row in table["row"]:
        tests = "<br>".join(f"`{one}`" for one in proofs.get(row["id"], []))
        values = [
            f"{name}: {measured[name]}" for name in row.get("figures", []) if name in measured
        ]
        remark = row.get("remark", "")
        cells = (
            row["id"],
            row["about"],
            row["published"],
            tests or row.get("proved", "not yet"),
            "; ".join([*values, remark]).strip("; "),
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write all pages and their overview."""
    proofs, measured = claims(), figures()
    overview = ["# Reproductions", "", "Which published models live here, by which tests.", ""]
    overview += ["| source | rows | proved |", "|---|---|---|"]
    for path in sorted(PAGES.glob("*.toml")):
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        (PAGES / f"{path.stem}.md").write_text(page(table, proofs, measured), encoding="utf-8")
        rows = table["row"]
        proved = sum(row["id"] in proofs or "proved" in row for row in rows)
        overview.append(f"| [{table['title']}]({path.stem}.md) | {len(rows)} | {proved} |")
    (PAGES / "index.md").write_text("\n".join(overview) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
