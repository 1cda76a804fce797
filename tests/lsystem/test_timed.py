"""Timed modules: ages, growth functions and choices that do not depend on the length of steps."""

import re

import pytest

import bioscope as bio

TREE = """modules: p(x), q(x)
growth: p = 6*x*age
growth: q = 6*x+age
axiom: p(1)
p1: p(x) after 1 --> q(x)[+(90)p(x/2)][-(90)p(x/2)]
"""


def grown(text: str, seconds: float, step: float, seed: int = 7) -> bio.lsystem.ModuleString:
    system = bio.LSystem(f"timed: {step}\n{text}", "timed.lsys")
    return system.derive(round(seconds / step), seed)


def numbers(text: str, symbol: str) -> list[float]:
    return [float(one) for one in re.findall(rf"{symbol}\(([-\d.e]+)\)", text)]


@pytest.mark.capability("NA-021", "NA-025")
def test_a_tree_grows_continuously():
    def shown(seconds):
        return grown(TREE, seconds, seconds).appearance().string()

    assert numbers(shown(0.5), "p") == pytest.approx([3])
    assert numbers(shown(0.9), "p") == pytest.approx([5.4])
    assert numbers(shown(1.5), "q") == pytest.approx([6.5])
    assert numbers(shown(1.5), "p") == pytest.approx([1.5, 1.5])
    before, after = shown(0.999), shown(1.001)
    assert numbers(before, "p")[0] == pytest.approx(numbers(after, "q")[0], abs=0.01)


@pytest.mark.capability("NA-020")
def test_parameters_are_frozen_and_values_grow():
    text = """modules: a(x,y,z), b(x,y,z)
growth: a = y, z, age
growth: b = x, 2*y, x+z
axiom: a(2,1,3)
p1: a(x,y,z) after 1 --> b(x*2,x+3,x*y*z)
"""
    assert grown(text, 0.5, 0.5).appearance().string() == "a(1,3,0.5)"
    assert grown(text, 1.5, 0.5).string() == "b(0.5,4,5,6)"
    assert grown(text, 1.5, 0.5).appearance().string() == "b(4,10,10)"


@pytest.mark.capability("NA-026", "NA-027")
def test_one_long_step_equals_many_short_ones():
    for whole in range(6):
        once = grown(TREE, whole + 0.5, whole + 0.5).string()
        assert once == grown(TREE, whole + 0.5, 1 / 64).string()
        assert (once.count("p("), once.count("q(")) == (2**whole, 2**whole - 1)


@pytest.mark.capability("NA-023", "NA-024")
def test_choices_have_their_chances_and_stay():
    count = 10_000
    text = f"""modules: a, c, r
axiom: {"a" * count}
p1: a after 1 --> c : 0.7
p2: a after 1 --> r : 0.3
"""
    early = re.sub(r"\(.*?\)", "", grown(text, 1.5, 0.5).string())
    # Three standard deviations of a binomial share.
    assert abs(early.count("c") / count - 0.7) < 3 * (0.21 / count) ** 0.5
    assert early == re.sub(r"\(.*?\)", "", grown(text, 4.5, 0.25).string())
    assert early != re.sub(r"\(.*?\)", "", grown(text, 1.5, 0.5, seed=8).string())


@pytest.mark.capability("NA-022", "NA-028", "NA-029", "NA-030")
def test_conditions_and_contexts():
    text = """modules: a(x), b, s
ignore: + -
axiom: s+a(3)-b
p1: a(x) after 1 : T >= x --> b
p3: s > b after 1 --> *
p4: a(x) < b after 2 --> a(0)
"""
    assert grown(text, 1, 1).string() == "s(1)+a(1,3)-b(1)"
    assert grown(text, 2, 1).string() == "s(2)+a(2,3)-a(0,0)"
    assert grown(text, 3, 1).string() == "s(3)+b(2)-b(0)"
