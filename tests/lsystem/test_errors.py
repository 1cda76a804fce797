"""What is wrong in a file is told with its place, the line and what might help."""

from pathlib import Path

import pytest

import bioscope as bio
from bioscope.errors import BioscopeError, FormatError
from bioscope.lsystem import Animation

BEGIN = "Lsystem: 1\nderivation length: 3\n"
NONE = "() () () () () () ()"

# By name of the file: its text, where the error is, what is said, what helps.
BROKEN = {
    "axiom.l": (f"{BEGIN}A --> AB\nendlsystem\n", "4:11", "expected 'axiom:'", ""),
    "section.l": (
        "derivaton length: 3\naxiom: A\nA --> AB\n",
        "1:1",
        "unknown section",
        "did you mean 'derivation length:'?",
    ),
    "arrow.l": (
        f"{BEGIN}axiom: A\nA -> AB\n",
        "4:3",
        "expected '-->', found '->'",
        "predecessor --> successor",
    ),
    "parenthesis.l": (f"{BEGIN}axiom: A(1\nA --> AB\n", "3:11", "expected ',' or ')'", ""),
    "condition.l": (f"{BEGIN}axiom: A(1)\nA(x) : x > --> A(x)\n", "4:12", "found '-->'", ""),
    "function.l": (
        f"{BEGIN}axiom: A(1)\nA(x) --> A(sinn(x))\n",
        "4:12",
        "unknown function 'sinn'",
        "did you mean 'sin'?",
    ),
    "missing.l": ('#include "no.h"\naxiom: A\nA --> B\n', "1:2", "there is no such file in", ""),
    "outside.l": ('#include "../no.h"\naxiom: A\nA --> B\n', "1:2", "outside the folder", ""),
    "macro.l": (
        '#include "good.h"\naxiom: A(1)\nA(x) --> A(BAD(x))\n',
        "3:12",
        "found '*'",
        "in the expansion of macro 'BAD'",
    ),
    "arguments.l": (
        "#define F(a,b) a+b\naxiom: A(1)\nA(x) --> A(F(x))\n",
        "3:12",
        "macro 'F' has 2 parameters, found 1",
        "",
    ),
    "directive.l": (
        "#defin N 3\naxiom: A\nA --> B\n",
        "1:2",
        "unknown directive '#defin': did you mean '#define'?",
        "",
    ),
    "endless.l": ("#if 1\naxiom: A\nA --> B\n", "1:2", "expected '#endif'", ""),
    "text.l": ('start: { printf("no); }\naxiom: A\nA --> B\n', "1:17", "a text in quotes", ""),
    "probability.l": ("axiom: A\nseed: 1\nA --> B : 0.7x\n", "3:14", "found 'x'", ""),
    "context.l": ("axiom: A\nA < B < C --> D\n", "2:7", "expected '-->', found '<'", ""),
    "letter.l": ("axiom: A\nA --> Bé\n", "2:8", "found 'é'", ""),
    "twice.l": ("axiom: A(1,2)\nA(x,x) --> B\n", "2:5", "has a namesake", ""),
    "zeros.l": ("\0\1\2", "1:1", "expected a module", "\ufffd"),
    "array.lsys": ("axiom: A\nA --> B(t[2])\n", "2:9", "unknown array 't'", ""),
    "few.lm": ("Axiom\nb () () ()\nProductions\n", "3:1", "'b' has 3 of 7", ""),
    "stack.lm": (
        f"Axiom\nb () (1+) {NONE[6:]}\nProductions\nEndProductions\n",
        "2:6",
        "too few numbers",
        "",
    ),
    "probability.lm": (
        f"Axiom\nb {NONE}\nProductions\nb (1) () () ()\n1.0\nb {NONE}\nEnd\nEndProductions\n",
        "7:1",
        "expected 'EndProb'",
        "",
    ),
    "keyword.lm": (f"Axiomm\nb {NONE}\n", "1:1", "expected 'Axiom', found 'Axiomm'", ""),
    "option.lm": ("Options\nMaxParts 3\n", "2:1", "did you mean 'MaxPart'?", ""),
    "number.lm": ("Options\nMaxPart few\n", "2:9", "expected a whole number of 'MaxPart'", ""),
    "constant.lm": (
        "Axiom\nb () () () () (a) () ()\nProductions\nEndProductions\n",
        "2:15",
        "constant 'a' is not declared",
        "",
    ),
}


def read(path: Path) -> object:
    return Animation.read(path) if path.suffix == ".lm" else bio.LSystem.read(path)


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files(name: str, tmp_path: Path):
    text, place, message, help_ = BROKEN[name]
    (tmp_path / "good.h").write_text("#define STEP 3\n#define BAD(x) x +* 2\n")
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(FormatError) as caught:
        read(path)
    said = str(caught.value)
    first, shown, mark, *rest = said.splitlines()
    assert first.startswith(f"{path}:{place}"), said
    assert message in first
    # The line itself, and a mark below its column.
    number, column = (int(one) for one in first[len(str(path)) + 1 :].split(":")[:2])
    line = text.split("\n")[number - 1] if number <= text.count("\n") + 1 else ""
    assert shown.startswith(f" {number} | ")
    if line.isprintable():
        assert shown.removeprefix(f" {number} | ") == line.rstrip()
    assert mark.index("^") == len(f" {number} | ") + column - 1
    assert help_ in "\n".join([shown, *rest])


def test_a_file_that_includes_itself(tmp_path: Path):
    (tmp_path / "a.h").write_text('#define X 1\n#include "b.h"\n')
    (tmp_path / "b.h").write_text('#include "a.h"\n')
    (tmp_path / "loop.l").write_text('#include "a.h"\naxiom: A\nA --> B\n')
    with pytest.raises(FormatError, match=r"b\.h:1:2: 'a\.h' includes itself\n 1 \| #include"):
        bio.LSystem.read(tmp_path / "loop.l")


def test_division_by_zero_names_its_production():
    for threads, count in [(True, 3), (False, 3), (True, 300_000)]:
        text = f"axiom: A({count})\nA(n) : n > 1 --> A(floor(n/2))A(n-floor(n/2))\n"
        text += "A(n) --> B(7/(n-1))\n"
        string = bio.LSystem(text, "zero.l").derive(25, threads=threads)
        assert string.remarks == [
            f"zero.l:3:1: division by zero in 'A(n) --> B(7/(n-1))' ({count} times)"
        ]
    with pytest.raises(
        FormatError, match=r"zero\.l:2:1: remainder of a division by zero at step 1"
    ):
        bio.LSystem("axiom: A(3)\nA(x) --> A(x % 0)\n", "zero.l").derive(1)


def test_what_grows_without_end_is_named():
    text = "axiom: A\nB --> B\nA --> AAAAAAAAAAAAAAAAAAAA\n"
    with pytest.raises(BioscopeError, match=r"big\.l:3:1: more than 500000000 modules at step 7"):
        bio.LSystem(text, "big.l").derive(40)
    text = "axiom: A\nA --> A\nhomomorphism\nmaximum depth: 1000000000\nA --> AA\nendlsystem\n"
    with pytest.raises(BioscopeError, match=r"deep\.l:5:1: .*'A --> AA'"):
        bio.LSystem(text, "deep.l").derive(1).appearance()
    text = "axiom: A\nA --> A\nhomomorphism\nmaximum depth: 1000000000\nA --> A\nendlsystem\n"
    with pytest.raises(BioscopeError, match=r"deep\.l:5:1: "):
        bio.LSystem(text, "deep.l").derive(1).appearance()


def test_names_that_are_nearly_declared():
    own = "modules: Apex(size)\naxiom: {}\nApex(size) --> Apex(size+1)\n"
    (warning,) = bio.LSystem(own.format("Apx(1)"), "own.lsys").warnings
    assert "own.lsys:2:8: 'Apx' is read as 3 modules of one letter" in warning
    assert "did you mean 'Apex'?" in warning
    (warning,) = bio.LSystem(own.format("Apex(1,2)"), "own.lsys").warnings
    assert "own.lsys:2:8: 'Apex' is declared with 1 parameter" in warning
    assert not bio.LSystem(own.format("Apex(1)F(2)fA"), "own.lsys").warnings
    (warning,) = bio.LSystem(own.format("Apex(1)").replace("size+1", "siz+1"), "own.lsys").warnings
    assert "unknown name 'siz' counts as 0" in warning
    assert "did you mean 'size'?" in warning


def test_the_command_checks_definitions_that_run(bioscope, tmp_path: Path):
    (tmp_path / "eyes.lm").write_text(
        "Axiom\nb () () () () (?30) (1'0/) ()\nProductions\nEndProductions\n"
    )
    done = bioscope("derive", tmp_path / "eyes.lm", "--check")
    assert done.returncode == 0
    assert "eyes.lm:2:21: division by 0 in '(1'0/)'; 0 is taken" in done.stderr
    (tmp_path / "eyes.lm").write_text(
        "Axiom\nb () () () () (?99) () ()\nProductions\nEndProductions\n"
    )
    done = bioscope("derive", tmp_path / "eyes.lm", "--check")
    assert done.returncode == 1
    assert "'?99' in '(?99)' means nothing" in done.stderr
    assert "\n 2 | b () () () () (?99) () ()\n   |               ^" in done.stderr
