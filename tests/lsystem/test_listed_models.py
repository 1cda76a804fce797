"""The listed L-systems of the course notes give the strings and figures known of them."""

import math
import re

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError


def model(text: str) -> bio.LSystem:
    return bio.LSystem(text, "listed.lsys")


def strings(text: str, steps: int, seed: int = 1) -> list[str]:
    system = model(text)
    return [system.derive(step, seed).string() for step in range(steps + 1)]


def rounded(text: str) -> str:
    return re.sub(r"-?\d+\.\d+(e[+-]\d+)?", lambda m: f"{round(float(m[0]), 4) + 0.0:g}", text)


@pytest.mark.capability("PL-101", "PL-106", "PL-107", "PL-108", "PL-111")
def test_parametric_words():
    text = """lsystem: L01_parametric
derivation length: 4
axiom: B(2)A(4,4)
p1: A(x,y) : y <= 3 --> A(x*2,x+y)
p2: A(x,y) : y > 3 --> B(x)A(x/y,0)
p3: B(x) : x < 1 --> C
p4: B(x) : x >= 1 --> B(x-1)
endlsystem
"""
    assert strings(text, 5) == [
        "B(2)A(4,4)",
        "B(1)B(4)A(1,0)",
        "B(0)B(3)A(2,1)",
        "CB(2)A(4,3)",
        "CB(1)A(8,7)",
        "CB(0)B(8)A(1.14285719,0)",
    ]
    assert model("axiom: A(9)\np1: A(t) : t>5 --> B(t+1)CD(t^0.5,t-2)").derive(1).string() == (
        "B(10)CD(3,7)"
    )


@pytest.mark.capability("PL-102")
def test_sequential_and_parallel_rewriting_differ():
    text = "axiom: B\np1: A --> AB\np2: B --> A\n"
    lengths = [len(model(text).derive(step)) for step in range(7)]
    assert lengths == [1, 1, 2, 3, 5, 8, 13]
    one_by_one = [len(model("order: leftmost\n" + text).derive(step)) for step in range(7)]
    assert one_by_one == [1, 1, 2, 3, 4, 5, 6]


@pytest.mark.capability("PL-109", "PL-114")
def test_contexts():
    text = "axiom: A(4)B(5)C(6)\np1: A(x) < B(y) > C(z) : x+y+z > 10 --> E((x+y)/2)F((y+z)/2)"
    assert model(text).derive(1).string() == "A(4)E(4.5)F(5.5)C(6)"
    both = "axiom: A[B(1)C][B(2)]D\np1: A > [B(x)][B(y)]D --> E(x,y)"
    assert model(both).derive(1).string() == "E(1,2)[B(1)C][B(2)]D"


@pytest.mark.capability("PL-110")
def test_chances_follow_their_factors():
    count = 4000
    text = f"""axiom: {"A(1)B(3)A(5)X" * count}
p1: A(x) --> A(x+1) : 2
p2: A(x) --> B(x-1) : 3
p3: A(x) : x > 3 --> C(x) : x
p4: A(x) < B(y) > A(z) : y < 4 --> B(x+z)A(y)
"""
    parts = model(text).derive(1, 5).string().split("X")[:count]
    assert all("B(6)A(3)" in part for part in parts)
    firsts = [part.split("B(6)A(3)")[0] for part in parts]
    lasts = [part.split("B(6)A(3)")[1] for part in parts]
    chances = [
        (firsts, {"A(2)": 0.4, "B(0)": 0.6}),
        (lasts, {"A(6)": 0.2, "B(4)": 0.3, "C(5)": 0.5}),
    ]
    for found, expected in chances:
        assert set(found) == set(expected)
        chi = sum(
            (found.count(one) - count * chance) ** 2 / (count * chance)
            for one, chance in expected.items()
        )
        # The 0.999 quantile of chi squared with two degrees of freedom.
        assert chi < 13.8


@pytest.mark.capability("PL-004", "PL-106")
def test_koch_snowflake():
    text = "axiom: F(1)-(120)F(1)-(120)F(1)\np1: F(s) --> F(s/3)+(60)F(s/3)-(120)F(s/3)+(60)F(s/3)"
    system = model(text)
    for steps in range(7):
        string = system.derive(steps)
        symbols = np.array(string.symbols)[string.kinds]
        assert (symbols == "F").sum() == 3 * 4**steps
    drawn = bio.Turtle().interpret(system.derive(3))
    lengths = np.linalg.norm(drawn.segments.end - drawn.segments.start, axis=1)
    assert np.allclose(lengths, 3.0**-3, atol=1e-6)
    points = drawn.segments.start[:, :2]
    following = np.roll(points, -1, axis=0)
    area = abs(np.sum(points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0])) / 2
    assert area == pytest.approx(0.67001, abs=1e-4)
    # One production makes thousands of modules.
    assert len(system.derive(6)) >= 12_288


@pytest.mark.capability("PL-209", "PL-106")
def test_compound_leaf():
    text = """angle: 45
axiom: !(3)F(1,1)
p1: F(s,t) : t == 1 --> F(s,2)[-!(1)F(s,1)][+!(1)F(s,1)]F(s,2)!(1)F(s,1)
p2: F(s,t) : t == 2 --> F(2*s,2)
p3: !(w) : w < 2 --> !(3)
"""
    for steps in range(6):
        string = model(text).derive(steps).string()
        apices = len(re.findall(r"F\([^,]*,1\)", string))
        assert (apices, string.count("F(")) == (3**steps, 2 * 3**steps - 1)


@pytest.mark.capability("PL-110")
def test_the_growing_tree_has_as_many_tips_as_expected():
    text = """derivation length: 18
#define phi 90
#define alpha 32
#define beta 20
axiom: FA(1)
p1: A(k) --> /(phi)[+(alpha)FA(k+1)]-(beta)FA(k+1) : min(1,(2*k+1)/k^2)
p2: A(k) --> /(phi)B-(beta)FA(k+1) : max(0,1-(2*k+1)/k^2)
"""
    system = model(text)
    tips = [system.derive(seed=seed).string().count("A(") for seed in range(200)]
    # The mean is 4 (19 / 3)^2 = 160.4, the deviation 42; four standard errors.
    assert abs(np.mean(tips) - 160.4) < 4 * 42 / math.sqrt(200)


@pytest.mark.capability("PL-206", "PL-108")
def test_flower():
    text = """axiom: /(154)B
p1: B --> [&(72)#F(5)!P]
p2: P --> [S/(72)S/(72)S/(72)S/(72)S]
p3: S --> [^(103)~s][^(72)~p][^(34)F(1)#[-F(1)][+F(1)]]
"""
    string = model(text).derive(3).string()
    counts = [string.count(part) for part in ("F(", "~s", "~p")]
    assert counts == [16, 5, 5]


@pytest.mark.capability("PL-116", "PL-115")
def test_cut_and_shedding():
    assert model("axiom: a[b%[cd]e[%f]]g[h[%i]j]k\np1: z --> z").derive(1).string() == (
        "a[b]g[h[]j]k"
    )
    text = """angle: 45
axiom: A
p1: A --> F(1)[-X(3)B][+X(3)B]A
p2: B --> F(1)B
p3: X(d) : d > 0 --> X(d-1)
p4: X(d) : d == 0 --> U%
p5: U --> F(0.3)
"""
    for step, string in enumerate(strings(text, 12)):
        lateral = string.count("F(1)") - step
        if step >= 5:
            assert lateral == 20
        if step >= 6:
            assert string.count("F(0.300000012)") == 2 * (step - 5)
    assert model("axiom: KP\np1: P --> *").derive(1).string() == "K"


@pytest.mark.capability("PL-113", "PL-111")
def test_mesotonic_branching_by_a_signal():
    text = """derivation length: 60
#define m 3
#define n 4
#define u 4
#define v 2
ignore: + - /
axiom: S(0)F(1,0)A(0)
p9: S(i) < B(j) --> *
p1: A(i) : i < m-1 --> A(i+1)
p2: A(i) : i == m-1 --> [+(60)F(1,1)B(0)]F(1,0)/(180)A(0)
p3: B(i) : i < n-1 --> B(i+1)
p4: B(i) : i == n-1 --> F(1,1)B(0)
p5: S(i) : i < u+v --> S(i+1)
p6: S(i) : i == u+v --> *
p7: S(i) < F(l,o) : (o == 0) && (i == u-1) --> #F(l,o)!S(0)
p8: S(i) < F(l,o) : (o == 1) && (i == v-1) --> #F(l,o)!S(0)
"""
    known = {
        12: (5, "1 2* 1* 1*", 6),
        24: (9, "1 2 2 3 3* 2* 1* 1*", 16),
        36: (13, "1 2 2 3 3 4 4* 4* 3* 2* 1* 1*", 30),
        60: (21, "1 2 2 3 3 4 4 5 5 6 6 7* 6* 5* 4* 4* 3* 2* 1* 1*", 68),
    }
    for steps, (internodes, branches, wide) in known.items():
        string = model(text).derive(steps).string()
        found = []
        for branch in re.findall(r"\[(.*?)\]", string):
            found.append(f"{branch.count('F(')}{'*' if 'B(' in branch else ''}")
        main = re.sub(r"\[.*?\]", "", string)
        assert (main.count("F("), " ".join(found), string.count("#F(")) == (
            internodes,
            branches,
            wide,
        )


@pytest.mark.capability("PL-119")
def test_queries_are_filled_after_each_step():
    text = "angle: 90\naxiom: A\np1: A --> F(1)?P(0,0)-A\np2: F(k) --> F(k+1)"
    assert [rounded(one) for one in strings(text, 3)[1:]] == [
        "F(1)?P(0,1)-A",
        "F(2)?P(0,2)-F(1)?P(1,2)-A",
        "F(3)?P(0,3)-F(2)?P(2,3)-F(1)?P(2,2)-A",
    ]


PRUNED = """angle: 45
context: tree
#define LB 6.2
#define prune(x,y) ((x < -LB/2) || (x > LB/2) || (y < 0) || (y > LB))
ignore: + - /
axiom: FA?P(0,0)
p1: A > ?P(x,y) : !prune(x,y) --> @oF/(180)A
p2: A > ?P(x,y) : prune(x,y) --> %
p3: F > A?P(x,y) : prune(x,y) --> S
p4: F > S --> SF
p5: S --> *
p6: @o > S --> [+FA?P(0,0)]
"""


@pytest.mark.capability("PL-119", "PL-116", "PL-114")
def test_pruning_in_a_square():
    system = model(PRUNED)
    known = {
        6: (7, 6, 1, 0),
        7: (6, 6, 0, 1),
        8: (7, 5, 1, 0),
        9: (6, 5, 0, 1),
        12: (8, 5, 1, 0),
        17: (9, 6, 0, 1),
        40: (17, 8, 0, 1),
        75: (29, 11, 0, 1),
        94: (39, 17, 0, 1),
    }
    for steps, counts in known.items():
        string = system.derive(steps)
        symbols = list(np.array(string.symbols)[string.kinds])
        assert tuple(symbols.count(one) for one in ("F", "@o", "A", "S")) == counts, steps


@pytest.mark.capability("PL-119", "PL-110", "PL-112")
def test_pruned_stochastic_tree():
    text = """context: tree
#define phi 90
#define alpha 32
#define beta 20
#define ca 0
#define cb 1
#define cc (-5)
#define E 6
#define prune(x,y,z) ((abs(x) > E) || (abs(z) > E) || (y < 0) || (y > 2*E))
ignore: + - /
axiom: FA(1)?P(0,0,0)
p1: A(k) > ?P(x,y,z) : !prune(x,y,z) -->
   /(phi)[+(alpha)FA(k+1)?P(0,0,0)]-(beta)FA(k+1) : max(0,min(1,(2*k+1)/k^2))
p2: A(k) > ?P(x,y,z) : !prune(x,y,z) -->
   /(phi)B(k+1,k+1)-(beta)FA(k+1) : max(0,1-(2*k+1)/k^2)
p3: A(k) > ?P(x,y,z) : prune(x,y,z) --> T%
p4: F > T --> S
p4b: T --> *
p5: F > S --> SF
p6: S --> *
p7: B(mm,nn) > S --> [+(alpha)FA(max(1,ca*mm+cb*nn+cc))?P(0,0,0)]
p8: B(mm,nn) > F --> B(mm+1,nn)
"""
    system = model(text)
    for seed in range(3):
        string = system.derive(27, seed)
        places = bio.Turtle().interpret(string).segments.end
        count = string.string().count("F")
        assert 400 <= count <= 1400
        # The box, and one internode.
        assert np.abs(places[:, [0, 2]]).max() <= 6.96
        assert places[:, 1].max() <= 12.96


@pytest.mark.capability("PL-120", "PL-403", "PL-410", "PL-411")
def test_branch_tiers_in_their_environment():
    text = """environment: leaf_discs rho=0.9
#define r1 0.94
#define r2 0.87
#define a1 24.4
#define a2 36.9
#define phi 138.5
ignore: + - /
axiom: -(90)[F(1)?E(1)A(1)]+(phi)[F(1)/(180)?E(1)A(1)]
   +(phi)[F(1)?E(1)A(1)]+(phi)[F(1)/(180)?E(1)A(1)]
   +(phi)[F(1)?E(1)A(1)]
p1: ?E(x) < A(v) : x == 1 -->
   [+(a2)F(v*r2)?E(r2)A(v*r2)]-(a1)F(v*r1)/(180)?E(r1)A(v*r1)
p2: ?E(x) --> *
"""
    counts = [one.count("F(") for one in strings(text, 6)]
    assert counts == [5, 15, 31, 47, 63, 79, 95]
    free = text.replace("environment: leaf_discs rho=0.9\n", "").replace("x == 1", "x > 0")
    assert [one.count("F(") for one in strings(free, 3)] == [5, 15, 35, 75]


@pytest.mark.capability("PL-112")
def test_arrays_and_local_assignments():
    text = """#define N 3
array Rate[N] = {0.5, 0.25, 0.125}
array Table[2][2] = {1, 2, 3, 4}
axiom: A(0)
p1: A(n) : n >= N || Rate[n] < 0 --> *
p2: A(n) : { h = Rate[n]*8; } h > 0 { w = h+Table[1][0]; } --> F(h,w)A(n+1)
"""
    assert strings(text, 4)[4] == "F(4,7)F(2,5)F(1,4)"
    with pytest.raises(FormatError, match="outside 0 to 2"):
        model(text.replace("n >= N || ", "")).derive(4)


@pytest.mark.capability("PL-121")
def test_tables_switch_with_the_season():
    text = """#define DAY 4
select: Q > DAY -> long_days
select: Q <= DAY -> short_days
axiom: A
table: short_days
p1: A --> L A
table: long_days
p2: A --> K
"""
    grown = strings(text, 6)
    assert grown[4] == "LLLLA"
    assert grown[5] == "LLLLK" == grown[6]


@pytest.mark.capability("PL-126", "PL-110")
def test_each_step_depends_only_on_seed_and_number():
    text = "axiom: A\np1: A --> F[+A]A : 1\np2: A --> FA : ran(2)"
    system = model(text)
    first = [system.derive(step, 3).string() for step in range(9)]
    assert [system.derive(step, 3).string() for step in range(8, -1, -1)] == first[::-1]
    assert system.derive(8, 3, threads=False).string() == first[8]
    assert any(system.derive(8, seed).string() != first[8] for seed in range(4, 8))
