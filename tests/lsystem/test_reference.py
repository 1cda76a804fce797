"""Every example of the language reference does what the page says."""

import re
from pathlib import Path

import pytest

import bioscope as bio

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "lsystem.md"
EXAMPLE = re.compile(r"```(cpfg|lsys)\n(.*?)```\n\nAfter (\d+) steps?: `([^`]*)`", re.S)


def examples():
    return EXAMPLE.findall(PAGE.read_text(encoding="utf-8"))


def test_all_examples_are_found():
    text = PAGE.read_text(encoding="utf-8")
    assert len(examples()) == len(re.findall(r"```(?:cpfg|lsys)\n", text)) >= 20


@pytest.mark.capability("PL-125", "PL-124")
@pytest.mark.parametrize("example", examples(), ids=lambda one: one[1].split("\n")[0])
def test_example(example):
    notation, text, steps, expected = example
    ending = {"cpfg": "l", "lsys": "lsys"}[notation]
    string = bio.LSystem(text, f"example.{ending}").derive(int(steps)).string()
    assert re.sub(r"-?\d\.\d+e-\d+", "0", string) == expected
