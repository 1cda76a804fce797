"""The notes on rewriting: what the page shows has been run, and what it says of it is so."""

import math
import re
from pathlib import Path

import pytest

import bioscope as bio

PAGE = Path(__file__).parents[2] / "docs" / "concepts" / "rewriting.md"
TEXT = PAGE.read_text(encoding="utf-8")
EXAMPLE = re.compile(r"```(cpfg|lsys)\n(.*?)```\n\nAfter (\d+) steps?: `([^`]*)`", re.S)
EXAMPLES = EXAMPLE.findall(TEXT)


def system(beginning: str) -> bio.LSystem:
    """Return the model of the listing whose text contains these words."""
    (found,) = [one for one in EXAMPLES if beginning in one[1]]
    return bio.LSystem(found[1], f"note.{'lsys' if found[0] == 'lsys' else 'l'}")


@pytest.mark.capability("PL-609", "PL-616")
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda one: one[1].split("\n")[0])
def test_listing(example):
    notation, text, steps, expected = example
    model = bio.LSystem(text, f"note.{'lsys' if notation == 'lsys' else 'l'}")
    assert model.warnings == []
    assert model.derive(int(steps)).string() == expected


def test_all_listings_are_found():
    assert len(EXAMPLES) == len(re.findall(r"```(?:cpfg|lsys)\n", TEXT)) >= 9


@pytest.mark.capability("PL-609", "PL-610", "PL-616")
def test_the_page_runs_as_written():
    for block in re.findall(r"```python\n(.*?)```", TEXT, re.S):
        exec(compile(block, PAGE.name, "exec"), {})


@pytest.mark.capability("PL-609")
def test_finitely_many_values_are_letters():
    values, letters = system("A(0)\np1: A(n) : n < 2"), system("modules: A0")
    for step in range(12):
        renamed = re.sub(r"\((\d)\)", r"\1", values.derive(step).string())
        assert renamed == letters.derive(step).string()


@pytest.mark.capability("PL-609")
def test_values_count_without_bound():
    root, collatz = system("axiom: A(1,1)"), system("axiom: A(6)")
    for step in range(60):
        count = root.derive(step).string().count("F")
        assert count == math.floor((math.sqrt(8 * step + 1) - 1) / 2)
    assert collatz.derive(9).string() == collatz.derive(20).string()
    text = next(one[1] for one in EXAMPLES if "axiom: A(6)" in one[1])
    longest = bio.LSystem(text.replace("A(6)", "A(27)"), "note.lsys")
    assert longest.derive(112).string() == "S" + 111 * "F"


@pytest.mark.capability("PL-616")
def test_a_signal_is_a_letter_or_a_state():
    letter, state = system("axiom: SFFFF"), system("axiom: C(1)")
    for step in range(4):
        signal = letter.derive(step).string().index("S")
        cells = re.findall(r"\d", state.derive(step).string())
        assert cells.index("1") == signal


@pytest.mark.capability("PL-616")
def test_a_copied_description_is_inherited_and_a_lost_organ_is_not():
    text = next(one[1] for one in EXAMPLES if "axiom: [C(3,0)]" in one[1])
    bodies = re.findall(r"F+(?=K)", bio.LSystem(text, "note.lsys").derive(25).string())
    assert set(bodies) == {"FFF"}
    changed = text.replace("K[C(n,0)]", "K[C(n+1,0)]")
    bodies = re.findall(r"F+(?=K)", bio.LSystem(changed, "note.lsys").derive(25).string())
    assert [len(one) for one in bodies] == [3, 4, 5, 6]
    maimed = text.replace("axiom: [C(3,0)]", "axiom: [FC(3,2)]")
    bodies = re.findall(r"F+(?=K)", bio.LSystem(maimed, "note.lsys").derive(25).string())
    assert [len(one) for one in bodies][:3] == [2, 3, 3]
