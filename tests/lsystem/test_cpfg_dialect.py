"""Models of the cpfg dialect give the strings of the reference program."""

import pytest

import bioscope as bio
from bioscope.errors import FormatError


def derive(text: str, steps: int) -> str:
    return bio.LSystem(text, "model.l").derive(steps).string()


@pytest.mark.capability("PL-125")
@pytest.mark.parametrize("seed", [1, 2, 77])
def test_choices_are_those_of_drand48_whatever_the_seed(seed):
    # The first numbers are 0, 0.000985, 0.041631, 0.176643, 0.364602 and 0.091331.
    text = f"seed: {seed}\naxiom: AAAAAA\nA --> x : 0.04\nA --> y : 0.26\nA --> z : 0.7"
    assert derive(text, 1) == "xxyyzy"


def test_the_first_normal_number_is_the_mean():
    assert derive("axiom: A\nA --> B(nran(5,2))", 1) == "B(5)"


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("2^3^2", "64"),
        ("-2^2", "4"),
        ("5.5%2", "1"),
        ("-7%3", "-1"),
        ("sin(30)", "0.5"),
        ("7/0", "7"),
        ("log(0)", "-inf"),
        ("16777217", "16777216"),
        ("1 <> 2", "1"),
        (".5+1.", "1.5"),
        ("nothing", "0"),
    ],
)
def test_numbers(expression, value):
    assert derive(f"axiom: A\nA --> A({expression})", 1) == f"A({value})"


def test_parameters_are_single_precision():
    assert derive("axiom: A(0.1)\nA(x) : x == 0.1 --> B", 1) == "A(0.100000001)"


def test_a_remainder_by_zero_is_an_error_with_its_place():
    with pytest.raises(FormatError, match=r"model.l:2:1: remainder of a division by zero"):
        derive("axiom: A\nA --> B(3%0)", 1)


def test_matching():
    assert derive("axiom: AB\nA --> X\nA > B --> Y", 1) == "XB"
    assert derive("axiom: AB\nAB --> X", 1) == "X"
    assert derive("axiom: A[B][C]D\nA > [B][C]D --> X", 1) == "X[B][C]D"
    assert derive("axiom: A[B][C]D\nA > [C]D --> X", 1) == "A[B][C]D"
    assert derive("axiom: A[B]C\nA > C --> X", 1) == "X[B]C"
    assert derive("axiom: AA(1)A(1,2)\nA(x) --> B(x)", 1) == "AB(1)A(1,2)"
    assert derive("ring Lsystem\naxiom: ABC\nC < A --> X", 1) == "XBC"


def test_command_line(bioscope, tmp_path):
    model = tmp_path / "model.l"
    model.write_text(
        'lsystem: 1\nseed: 9\nderivation length: 2\nstart: { printf("begin %d\\n", 7); }\n'
        "axiom: A(1)\nA(x) --> A(x+ran(1))B : 1\nB --> C\nhomomorphism\nC --> +F\nendlsystem\n"
    )
    done = bioscope("derive", model, "--format", "string")
    # erand48 begins with 0.170828 and 0.749902.
    assert done.stdout.startswith("A(1.9207")
    assert done.stdout.endswith(")BC\n")
    assert "begin 7" in done.stderr
    assert bioscope("derive", model, "--homomorphism").stdout == done.stdout.replace("C", "+F")
    assert bioscope("derive", model, "--seed", 3).stdout != done.stdout
    assert (
        bioscope("derive", model, "--seed", 3).stdout
        == bioscope("derive", model, "--seed", 3).stdout
    )


def test_check_reports_what_is_doubtful(bioscope, tmp_path):
    model = tmp_path / "model.l"
    model.write_text("axiom: A(1)\nA(x) --> A(lenght)\nA --> B\n")
    done = bioscope("derive", model, "--check")
    assert done.returncode == 0
    assert done.stdout == ""
    assert "model.l:2:12: unknown name 'lenght' counts as 0" in done.stderr
    assert "model.l:3:1: this production is never applied: nothing makes 'A'" in done.stderr
    model.write_text("axiom: A(1)\nA(x) --> A(x\n")
    done = bioscope("derive", model, "--check")
    assert done.returncode == 1
    assert "model.l:2:13: expected" in done.stderr


def test_what_explodes_is_named(bioscope, tmp_path):
    model = tmp_path / "model.l"
    model.write_text("axiom: AB\nA --> A\nB --> BBBBBBBBBB\n")
    done = bioscope("derive", model, "--steps", 40)
    assert done.returncode == 1
    assert "model.l:3:1: more than 200000000 modules" in done.stderr
    assert "'B --> BBBBBBBBBB'" in done.stderr


def test_included_files_and_conditions(tmp_path):
    (tmp_path / "sizes.h").write_text("#define LENGTH 4\n#define WIDE\n")
    model = tmp_path / "model.l"
    model.write_text(
        '#include "sizes.h"\naxiom: A\n#ifdef WIDE\nA --> B(LENGTH)\n#else\nA --> C\n#endif\n'
    )
    assert bio.LSystem.read(model).derive(1).string() == "B(4)"
