"""Definition files of behavioral L-systems (.lm): the notation of the thesis, as it is printed."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError
from bioscope.lsystem.definition import read

FISH = """Camera_AnimationParameters
prefpos_x1_x2_y1_y2 0 721 0 576   observer 0 120 250   lookatPoint 0 0 0   twist 0
viewAngle 500  aspectRatio 1.25  near 1  far 10000  swapinterval 1
nbrCalcStep_seed 4 34743   t_final_interval 60 0.04
RepetitionParameters
Options
MaxPart 64
Splines
Constants
H 0 60 9
K 0 60 9
Surfaces
Axiom
f () () () (2) (0) (0) (0)
e () (10) () () (4'2500'3'0.005r2^*_^*-Xx-*) (4'2500'3'0.005r2^*_^*-Yy-*) (Zz-)
C () (1) () () (H) () (K)
x () () () () () () ()
Productions
x (1) [(T20.5-)<] () ()
1.0
f () () () (2) (50) (50) (50)
e () (11) () () (3_u*) (3_v*) (3_w*)
C () () (1) () (5) (3) (2)
x () () () () () () ()
EndProb
End
EndProductions
"""

EMPTY = "() () () () () () ()"

TREE = f"""/* A growing tree: R is both p and q. */
Axiom
+ () () () () (90) () ()
R () (1) () () (6xt**) () ()
Productions
R (1) [(z)=] () ()
1.0
R () (x) () (1) (6x*t+) () ()
[ {EMPTY}
+ () () () () (90) () ()
R () (x2/) () () (6xt**) () ()
] {EMPTY}
[ {EMPTY}
- () () () () (90) () ()
R () (x2/) () () (6xt**) () ()
] {EMPTY}
EndProb
End
EndProductions
"""

SCENE = """Camera_AnimationParameters
prefpos_x1_x2_y1_y2 0 721 0 576   observer 0 120 250   lookatPoint 0 0 0   twist 0
viewAngle 500  aspectRatio 1.25  near 1  far 10000  swapinterval 1
nbrCalcStep_seed 4 34743   t_final_interval 60 0.04
RepetitionParameters
rotate 0 0 0 rotate_max 0 360 0 startp_sidel_nbr_dist -50 100 9 0.5
Options
MaxPart 64
fConst 5 2 0 10 0 0 0 0 0
Splines
function time_spline 1 4 1 2 0 1 1 4 3 2 5 2 1e30 1e30
Constants
a 1 2
E 1 2 3
H 0 60 9
K 0 60 9
P 1 2 0.1
Surfaces
fig_sm 1 rock.sm
"""


def value(expression: str, *, seconds: float = 1.0, x: float = 0.0) -> float:
    """Return what a growth expression is worth at the end of a step of `seconds`."""
    scene = SCENE.replace("60 0.04", f"60 {seconds}")
    text = f"{scene}Axiom\nb () ({x}) () () ({expression}) () ()\n{RULE}EndProductions\n"
    system = bio.LSystem.from_definition(text)
    shown = system.derive(1).appearance()
    return float(shown.parameters[-3])


# A model has at least one production.
RULE = f"Productions\nu (1e9) () () ()\n1.0\nu {EMPTY}\nEndProb\nEnd\n".replace("1e9", "1000000000")


@pytest.mark.capability("NA-040")
def test_all_sections_are_read():
    rules = TREE[TREE.index("Axiom") :]
    found = read(SCENE + rules, "fish.lm")
    assert found.camera["observer"] == [0, 120, 250]
    assert found.camera["t_final_interval"] == [60, 0.04]
    assert found.repetition["startp_sidel_nbr_dist"] == [-50, 100, 9, 0.5]
    assert [(one.name, one.words) for one in found.options] == [
        ("MaxPart", ["64"]),
        ("fConst", ["5", "2", "0", "10", "0", "0", "0", "0", "0"]),
    ]
    assert found.splines == {1: [(0, 2), (1, 8), (3, 4), (5, 4)]}
    assert found.constants["H"] == [0, 60, 9]
    assert found.surfaces == {1: "rock.sm"}
    assert "".join(one.symbol for one in found.axiom) == "+R"
    (rule,) = found.rules
    assert "".join(one.symbol for one in rule.alternatives[0][1]) == "R[+R][-R]"
    assert bio.LSystem.from_definition(SCENE + rules).steps == 1500


@pytest.mark.capability("NA-040")
@pytest.mark.parametrize("text", [TREE, FISH], ids=["tree", "fish"])
def test_what_is_read_can_be_written(text: str):
    found = read(text, "a.lm")
    assert read(str(found), "b.lm") == found
    assert len(found.rules) == 1


@pytest.mark.capability("NA-040", "NA-025", "NA-021")
def test_the_growing_tree_of_the_thesis(tmp_path: Path):
    (tmp_path / "tree.lm").write_text(TREE)
    system = bio.LSystem.read(tmp_path / "tree.lm")
    lengths = lambda seconds: np.linalg.norm(  # noqa: E731
        np.subtract(*(getattr(drawn(seconds).segments, one) for one in ("end", "start"))), axis=1
    )
    drawn = lambda seconds: bio.Turtle().interpret(system.derive(time=seconds))  # noqa: E731
    assert lengths(0.5) == pytest.approx([3], abs=1e-4)
    assert lengths(0.9) == pytest.approx([5.4], abs=1e-4)
    assert lengths(1.5) == pytest.approx([6.5, 1.5, 1.5], abs=1e-4)
    # The turtle begins along x, so that +90 lets the trunk stand.
    assert drawn(1.5).segments.end[0] == pytest.approx((0, 6.5, 0), abs=1e-4)
    for whole in range(1, 5):
        string = system.derive(time=whole + 0.5).string()
        assert len(re.findall(r"R_1\(", string)) == 2**whole
        assert len(re.findall(r"R_2\(", string)) == 2**whole - 1


@pytest.mark.capability("NA-041")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("", 0.0),
        ("1'2+", 3.0),
        ("2'3-", -1.0),
        ("2'3*4+", 10.0),
        ("3'4/", 0.75),
        ("3'0/", 0.0),
        ("2'10^", 1024.0),
        ("7_3%", 2.0),
        ("2'3~", 0.0),
        ("3'2~", 1.0),
        ("1_2_~", 0.0),
        ("3_|", 3.0),
        ("30$", 0.5),
        ("60&", 0.5),
        ("0.5:", 30.0),
        ('0.5"', math.tanh(0.5)),
        ("3?08", 1.0),
        ("3_?08", 0.0),
        ("0.5?29", 1.5625),
        ("xx*t+T+", 11.0),
        ("4'2500'3'0.005'34.234'2^*_^*-", 0.0),
    ],
)
def test_operators(expression: str, expected: float):
    found = value(expression, x=3.0)
    assert found == pytest.approx(expected, rel=1e-6, abs=2e-3 if "2500" in expression else 1e-6)


@pytest.mark.capability("NA-046", "NA-047")
def test_functions_of_time():
    time = 2.5
    for name, expected in {
        "a": 1 + 2 * time,
        "E": 1 + 2 * time + 3 * time**2,
        "H": 60 * math.cos(math.radians(9 * time)),
        "K": 60 * math.sin(math.radians(9 * time)),
        "P": 1 + 2 * math.exp(0.1 * time),
    }.items():
        assert value(name, seconds=time) == pytest.approx(expected, rel=1e-6), name
    # A spline goes through its keys (0, 2), (1, 8), (3, 4), (5, 4) and stays outside.
    for at, expected in [(0.001, 2), (1, 8), (3, 4), (5, 4), (9, 4)]:
        assert value("?01", seconds=at) == pytest.approx(expected, abs=0.02), at
    third = SCENE.replace("time_spline 1", "time_spline 3")
    for at in (1, 3):
        text = f"{third}Axiom\nb () () () () ({at}?03) () ()\n{RULE}EndProductions\n"
        shown = bio.LSystem.from_definition(text).derive(0).appearance()
        assert shown.parameters[-3] == {1: 8, 3: 4}[at]
    # Hermite of constant array 5 by age: half way up at half the time, flat at the end.
    for at, expected in [(0.5, 1.5625), (1.0, 5.0), (1.5, 8.4375), (3.0, 10.0)]:
        assert value("?28", seconds=at) == pytest.approx(expected, rel=1e-5)


@pytest.mark.capability("NA-045")
def test_random_numbers_are_uniform():
    text = TREE.replace("(1) () () (6xt**)", "(!) () () (6xt**)").replace(
        "R (1) [(z)=]", "R (9) ()"
    )
    system = bio.LSystem.from_definition("Constants\n# 5 2\n" + text.replace("(9)", "(99)"))
    drawn = np.array([system.derive(0, seed=seed).parameters[-3] for seed in range(400)])
    assert drawn.min() >= 0
    assert drawn.max() < 1
    assert abs(drawn.mean() - 0.5) < 3 / math.sqrt(12 * len(drawn))
    ranged = bio.LSystem.from_definition("Constants\n# 5 2\n" + text.replace("(!)", "(#)"))
    drawn = np.array([ranged.derive(0, seed=seed).parameters[-3] for seed in range(400)])
    assert drawn.min() >= 5
    assert drawn.max() < 7
    assert abs(drawn.mean() - 6) < 6 / math.sqrt(12 * len(drawn))


def letters(system: bio.LSystem, steps: int, seed: int = 0) -> str:
    return re.sub(r"_\d+|\([^)]*\)|@R", "", system.derive(steps, seed=seed).string())


def rule(head: str, *alternatives: tuple[float, str]) -> str:
    made = "".join(
        f"{chance}\n{''.join(f'{one} {EMPTY} ' for one in symbols)}\nEndProb\n"
        for chance, symbols in alternatives
    )
    return f"{head}\n{made}End\n"


def model(axiom: str, *rules: str) -> bio.LSystem:
    symbols = "\n".join(f"{one} {EMPTY}" for one in axiom)
    text = f"Axiom\n{symbols}\nProductions\n{''.join(rules)}EndProductions\n"
    return bio.LSystem.from_definition(text.replace("60 0.04", "60 1"))


@pytest.mark.capability("NA-028", "NA-029", "NA-030")
def test_contexts_of_the_thesis():
    def replaced(symbol: str, context: str, word: str = "A[B[C]D]E") -> bool:
        head = f"{symbol} (0.01) () {context}"
        return "Z" in letters(model(word, rule(head, (1.0, "Z"))), 1)

    assert replaced("B", "(A) ()")
    assert replaced("C", "(B) ()")
    assert replaced("D", "(B) ()")
    assert replaced("E", "(A) ()")
    assert not replaced("E", "(D) ()")
    assert replaced("A", "() (B)")
    assert replaced("A", "() (E)")
    assert replaced("B", "() (C)")
    assert replaced("B", "() (D)")
    assert not replaced("C", "() (D)")
    assert not replaced("D", "() (E)")
    # What only turns the turtle is no context.
    for word in ("A+[&B]/$C", "A[+-]B"):
        assert replaced("A", "() (B)", word)


@pytest.mark.capability("NA-056", "NA-022")
@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("()", True),
        ("[(x)<]", False),
        ("[(x)>]", True),
        ("[(x3-)=]", True),
        ("[(x3-)!]", False),
        ("[(x3-)p]", True),
        ("[(x3-)g]", True),
        ("[(x)>] [(x5-)<] &", True),
        ("[(x)<] [(x5-)>] |", False),
        ("[(x)<]!", True),
        ("[(?41'7-)=]", True),
    ],
)
def test_conditions(condition: str, holds: bool):
    head = f"b (0.01) {condition} () ()"
    text = f"Axiom\nb () (3) () () (7) () ()\nProductions\n{rule(head, (1.0, 'h'))}EndProductions\n"
    assert letters(bio.LSystem.from_definition(text), 1) == ("h" if holds else "b")


@pytest.mark.capability("NA-023")
def test_alternatives_have_their_probabilities():
    count = 3000
    head = "b (0.01) () () ()"
    system = model("b" * count, rule(head, (0.7, "h"), (0.3, "i")))
    share = letters(system, 1, seed=5).count("h") / count
    assert abs(share - 0.7) < 3 * math.sqrt(0.21 / count)
    assert letters(system, 1, seed=5) == letters(system, 4, seed=5)


def drawn(*symbols: str) -> bio.lsystem.Interpretation:
    body = "\n".join(symbols)
    text = f"Axiom\n{body}\n{RULE}EndProductions\n"
    return bio.Turtle().interpret(bio.LSystem.from_definition(text).derive(0))


LINE = "R () () () () (2) () ()"


def test_moves():
    for move, expected in {
        "f () () () () (3) () ()": (3, 0, 0),
        "f () () () (2) (3) (4) (5)": (3, 4, 5),
        "f () () () (3) (3) (4) (5)": (3, 4, 5),
    }.items():
        assert drawn(move, LINE).segments.start[0] == pytest.approx(expected, abs=1e-5)


# By symbol: the lowest and highest corner of what is drawn, and where the turtle ends.
SHAPES = {
    "c": ((0, -1.5, -2), (2, 1.5, 2), 2),
    "d": ((0, -1.5, -2), (2, 1.5, 2), 2),
    "p": ((0, -1.5, -2), (2, 1.5, 2), 2),
    "q": ((0, -1.5, -2), (2, 1.5, 2), 2),
    "s": ((-1, -1.5, -2), (1, 1.5, 2), 0),
}


@pytest.mark.capability("NA-073")
def test_shapes_have_their_bounds_and_ends():
    for symbol, (low, high, end) in SHAPES.items():
        shape = drawn(f"{symbol} () () () () (2) (3) (4)", LINE)
        corners = np.vstack([one for one, _ in shape.polygons])
        assert corners.min(axis=0) == pytest.approx(low, abs=1e-5), symbol
        assert corners.max(axis=0) == pytest.approx(high, abs=1e-5), symbol
        assert shape.segments.start[-1] == pytest.approx((end, 0, 0), abs=1e-5), symbol
    ball = drawn("f () () () () (3) () ()", "a () () () () (4) () ()", LINE)
    assert ball.balls.center[0] == pytest.approx((3, 0, 0))
    assert ball.balls.radius[0] == 2
    assert ball.segments.start[-1] == pytest.approx((3, 0, 0))
    for symbol, radii, caps in [
        ("O", (1.5, 1.5), (1.5, 1.5)),
        ("N", (1.5, 1.5), (1.5, 1.5)),
        ("o", (1.5, 1.5), ()),
        ("P", (1.5, 2), (1.5, 2)),
        ("Q", (1.5, 2), (1.5, 2)),
    ]:
        shape = drawn(f"{symbol} () () () () (5) (3) (4)", LINE)
        assert shape.segments.radii[0] == pytest.approx(radii), symbol
        assert shape.balls.radius == pytest.approx(caps), symbol
        assert shape.segments.end[0] == pytest.approx((5, 0, 0)), symbol
        assert shape.segments.start[1] == pytest.approx((5, 0, 0)), symbol
    for symbol in "RS":
        assert drawn(f"{symbol} () () () () (5) () ()").segments.end[0, 0] == 5


@pytest.mark.capability("NA-074")
def test_resolution_of_cylinders():
    coarse, fine = (
        len(drawn(f"n () ({sides}) () () () () ()", "o () () () () (5) (2) (2)").mesh().triangles)
        for sides in (4, 16)
    )
    assert fine > 2 * coarse


@pytest.mark.capability("NA-070")
def test_turns_of_the_thesis():
    def heading(symbols: str, ask: str = "?H") -> list[float]:
        turns = "\n".join(f"{one} () () () () (90) () ()" for one in symbols)
        text = f"Axiom\n{turns}\nR () () () () (1) () ()\n{RULE}EndProductions\n"
        drawn = bio.Turtle().interpret(bio.LSystem.from_definition(text).derive(0))
        return (drawn.segments.end[0] - drawn.segments.start[0]).round(5).tolist()

    assert heading("+") == [0, 1, 0]  # H' = L
    assert heading("-") == [0, -1, 0]
    assert heading("&") == [0, 0, -1]  # H' = -U
    assert heading("^") == [0, 0, 1]
    assert heading("$+") == [0, 0, 1]  # L' = U
    assert heading("/+") == [0, 0, -1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Axiom\nb () ()\n", "x.lm:4:1: expected an expression"),
        ("Axiom\nb () (1+) () () () () ()\n" + RULE + "EndProductions", "x.lm:2:6: too few"),
        ("Axiom\nb () (1'2) () () () () ()\n" + RULE + "EndProductions", "x.lm:2:6: 2 numbers"),
        (f"Axiom\nb {EMPTY}\nProductions\nb (1) () () ()\n0.5\nEndProb\nEnd\n", "sum to 0.5"),
        ("Options\nMaxParts 4\n", "x.lm:2:1: unknown option 'MaxParts'"),
        (f"Axiom\n] () (100) () () () () ()\n{RULE}EndProductions", "a cut in the axiom"),
        (f"Axiom\n[ () (3) () () () () ()\n{RULE}EndProductions", "stored positions"),
        ("Axiom\nb () () () () (?35) () ()\n" + RULE + "EndProductions", "'?35'.*actors"),
        ("Splines\nfunction time_spline 1 3 1 1 0 0 1 1 1e30 1e30\n", "has 2 pairs, not 3"),
    ],
)
def test_errors_name_the_place(text: str, message: str):
    with pytest.raises(FormatError, match=message):
        bio.LSystem.from_definition(text + "\nEndProductions\n", "x.lm")


@pytest.mark.capability("NA-032")
def test_a_query_is_told_where_the_turtle_is():
    text = "Axiom\nf () () () () (3) () ()\n+ () () () () (90) () ()\nf () () () () (t1+) () ()\n"
    system = bio.LSystem.from_definition(f"{text}? {EMPTY}\n{RULE}EndProductions\n")
    for seconds in (0.0, 0.5, 2.0):
        place = system.derive(time=seconds).string().split("?P(")[1].rstrip(")").split(",")
        assert [float(one) for one in place] == pytest.approx((3, 1 + seconds, 0), abs=1e-6)


@pytest.mark.capability("NA-038")
def test_the_string_of_every_step_reads_back():
    text = "lsystem: x\naxiom: {}\nA(s) --> F(s,0.1)[+(30)A(s/3)]A(s*1.1)\nendlsystem\n"
    system = bio.LSystem(text.format("A(1)"))
    for step in range(8):
        string = system.derive(step).string()
        assert bio.LSystem(text.format(string)).derive(0).string() == string


@pytest.mark.capability("NA-031")
@pytest.mark.parametrize(
    ("word", "cut", "rest", "expected"),
    [
        ("[a[bZc]d]", "100", "[Y]", "[a[Y]d]"),
        ("[a[bZc]d]", "1_", "", "[a[b]d]"),
        ("[a[bZc]d]", "9_", "Y", "[a[bY]d]"),
        ("a[bZ[cd]e[f]]g", "2_", "", "a[b[f]]g"),
        ("a[b[c]Z[d]e]g[h]", "100_", "Y", "aYg[h]"),
        ("aZb", "100", "Y", "aYb"),
    ],
)
def test_cuts(word: str, cut: str, rest: str, expected: str):
    symbols = "\n".join(f"{one} {EMPTY}" for one in word)
    made = f"] () ({cut}) () () () () ()\n" + "\n".join(f"{one} {EMPTY}" for one in rest)
    text = f"Axiom\n{symbols}\nProductions\nZ (0.01) () () ()\n1.0\n{made}\nEndProb\nEnd\n"
    system = bio.LSystem.from_definition(f"{text}EndProductions\n")
    assert letters(system, 1) == expected
    assert letters(system, 5) == expected
