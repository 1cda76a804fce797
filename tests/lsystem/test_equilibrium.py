"""Plants that come to rest in parts, and those that do not."""

import re
from pathlib import Path

import pytest

import bioscope as bio
from bioscope.errors import InvalidValueError
from bioscope.lsystem import equilibrium

GALLERY = Path(bio.__file__).parent / "gallery"


def laterals(string: bio.ModuleString) -> tuple[int, ...]:
    """Return how many internodes stand on each branch of the trunk, sorted, without bare ones."""
    counts, depth = [], 0
    for symbol in re.findall(r"F\(1\)|[][]", string.string()):
        depth += (symbol == "[") - (symbol == "]")
        if symbol == "[" and depth == 1:
            counts.append(0)
        elif symbol == "F(1)" and depth:
            counts[-1] += 1
    return tuple(sorted(one for one in counts if one))


def fronds(string: bio.ModuleString) -> tuple[int, int]:
    """Return the numbers of fronds and of leaflets."""
    text = string.string()
    return text.count("X("), text.count("~l")


@pytest.mark.capability("PL-613")
def test_shedding_trees_and_palms_have_parts_that_rest():
    found = equilibrium(bio.LSystem.read(GALLERY / "branch_shedding.lsys"), laterals, 40, longest=4)
    assert found is not None
    assert found.period == 1
    assert found.step <= 6
    palm = bio.LSystem.read(GALLERY / "date_palm.lsys")
    found = equilibrium(palm, fronds, 104, longest=4)
    assert found is not None
    assert found.period == 1
    assert 41 <= found.step <= 52
    # The trunk itself grows for ever, and so does a tree that branches on.
    assert equilibrium(palm, len, 104, longest=4) is None
    tree = bio.LSystem.read(GALLERY / "borchert_slade.lsys")
    assert equilibrium(tree, lambda string: string.string().count("A("), 16, longest=4) is None


def test_cycles_have_their_period():
    text = "lsystem: x\naxiom: ABC\nA --> D\nD --> E\nE --> A\nB --> BF\nendlsystem\n"
    found = equilibrium(bio.LSystem(text), lambda one: one.string()[0], 24, longest=5)
    assert found == bio.lsystem.Equilibrium(0, 3)
    assert equilibrium(bio.LSystem(text), len, 24, longest=5) is None
    with pytest.raises(InvalidValueError, match="longest period"):
        equilibrium(bio.LSystem(text), len, 10)
