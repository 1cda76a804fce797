"""Models of the cpfg dialect give the strings of the reference program."""

import subprocess
import sys

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
    assert "model.l:3:1: more than 500000000 modules" in done.stderr
    assert "'B --> BBBBBBBBBB'" in done.stderr


def test_included_files_and_conditions(tmp_path):
    (tmp_path / "sizes.h").write_text("#define LENGTH 4\n#define WIDE\n")
    model = tmp_path / "model.l"
    model.write_text(
        '#include "sizes.h"\naxiom: A\n#ifdef WIDE\nA --> B(LENGTH)\n#else\nA --> C\n#endif\n'
    )
    assert bio.LSystem.read(model).derive(1).string() == "B(4)"


def test_letters_of_longer_symbols_are_rewritten_alone():
    flower = "axiom: A\nA --> [+~K(1)]A\nK(s) : s < 8 --> K(s*2)"
    system = bio.LSystem(flower, "flower.l")
    string = system.derive(4)
    assert string.string() == "[+~K(8)][+~K(4)][+~K(2)][+~K(1)]A"
    surfaces = bio.Turtle().interpret(string).surfaces
    assert [(name, scale[0]) for name, _, scale, _ in surfaces] == [
        ("K", 8),
        ("K", 4),
        ("K", 2),
        ("K", 1),
    ]
    # `~` and `K` are modules of their own there, and one module where nobody names `K` alone.
    assert len(system.derive(1)) == 6
    assert len(bio.LSystem("axiom: A\nA --> [+~K(1)]A", "flower.l").derive(1)) == 5
    # Contexts see single letters, and a symbol may come together from two successors.
    assert derive("axiom: @oA\no < A --> B", 1) == "@oB"
    assert derive("axiom: @oA\n@o < A --> B", 1) == "@oB"
    joined = bio.LSystem("axiom: ABf(2)C\nA --> @\nB --> O(3)\nC --> @O(1)", "balls.l").derive(1)
    assert joined.string() == "@O(3)f(2)@O(1)"
    balls = bio.Turtle().interpret(joined).balls
    assert balls.radius.tolist() == [3, 1]
    assert balls.center.tolist() == [[0, 0, 0], [0, 2, 0]]


@pytest.mark.parametrize(
    "drawn",
    [
        "!(0.2)@Gs F(1)@Gc +(30)F(1)!(0.1)@Ge(4)",
        "F(1)[+(40)@o(0.2)@c(0.3)f(2)@bo(1)@O(0.5)]@D(0.5)F(2)@Di(2)F(1)@Dd(4)F(1)",
        "@#(1)@!(12)F(1)@Tx(2)F(1)@Ts(0.3)@T(1)F@Td(0.1)F@Tp F@T",
        "@PS(1)@PC(1,0,0)F@PC(1,1,1)@PD(1,4,4)@R(1,0,0)F@v F@M(1,2,3)F(2);(2)~a(2)@L(3)F",
    ],
)
def test_what_is_drawn_does_not_depend_on_how_symbols_are_read(drawn: str):
    whole = f"axiom: {drawn}\nz --> z"
    # A production of every letter of the symbols that changes nothing.
    letters = "\n".join(f"{letter} --> {letter}" for letter in "GscePSCDObToxdpRvMaLz")
    one, other = (
        bio.LSystem(text, "drawn.l").derive(1) for text in (whole, f"axiom: {drawn}\n{letters}")
    )
    assert one.string() == other.string()
    assert len(other) > len(one)
    first, second = (bio.Turtle().interpret(string) for string in (one, other))
    assert first.mesh().positions.tolist() == second.mesh().positions.tolist()
    assert first.balls.center.tolist() == second.balls.center.tolist()
    assert first.discs.center.tolist() == second.discs.center.tolist()
    assert first.surfaces == second.surfaces
    assert first.labels == second.labels


def test_strings_of_hundreds_of_millions_of_modules(tmp_path):
    script = (
        "import resource, bioscope as bio\n"
        "system = bio.LSystem('axiom: F\\nF --> FF-[-F+F+F]+[+F-F-F]\\n', 'bush.l')\n"
        "first = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "count = len(system.derive(9))\n"
        "print(count, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - first)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    count, kibibytes = map(int, done.stdout.split())
    assert count == 364_305_260
    # One byte per module, and less than half as much again.
    assert kibibytes * 1024 < 1.5 * count
