"""Experiments that the course proposes: vigor and signals, weather, two clocks, woken buds."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery


def lengths_of_branches(text: str) -> list[int]:
    return [branch.count("F") for branch in re.findall(r"\[(.*?)\]", text)]


@pytest.mark.capability("PL-314")
@pytest.mark.parametrize(
    ("vigor", "place"),
    [("1-i/20", "base"), ("1-abs(i-10)/10", "middle"), ("0.1+i/20", "top")],
)
def test_vigor_by_the_place_on_the_axis_gives_the_kind_of_branching(vigor, place):
    system = bio.LSystem(
        f"""#define vigor(i) ({vigor})
axiom: A(0)
p1: A(i) : i < 20 --> F[+B(vigor(i))]A(i+1)
p2: B(v) : v > 0.1 --> FB(v-0.1)
"""
    )
    lengths = np.array(lengths_of_branches(system.derive(40).string()))
    assert len(lengths) == 20
    longest = int(lengths.argmax()) / 19
    assert {"base": longest < 1 / 3, "middle": 1 / 3 < longest < 2 / 3, "top": longest > 2 / 3}[
        place
    ]
    assert lengths.max() > 2 * lengths.min() + 1


RACEME = """ignore: +
axiom: A(0)
p1: A(n) : n < 8 --> I[+K(0)]A(n+1)
p2: A(n) : n == 8 --> {signal}
{rules}
"""


@pytest.mark.capability("PL-313")
def test_flowers_open_upward_by_age_and_downward_by_a_signal():
    upward = RACEME.format(signal="*", rules="p3: K(t) : t < 3 --> K(t+1)\np4: K(t) --> O")
    downward = RACEME.format(
        signal="S", rules="p3: I > S --> SI\np4: S --> *\np5: S I < K(t) --> O"
    )
    orders = {}
    for name, text in {"upward": upward, "downward": downward}.items():
        opened: dict[int, int] = {}
        for step in range(40):
            string = bio.LSystem(text).derive(step).string()
            for number, flower in enumerate(re.findall(r"[KO]", string)):
                if flower == "O":
                    opened.setdefault(number, step)
        orders[name] = [opened[number] for number in sorted(opened)]
    assert len(orders["upward"]) == 8
    assert orders["upward"] == sorted(set(orders["upward"]))
    assert len(orders["downward"]) >= 7
    assert orders["downward"] == sorted(set(orders["downward"]), reverse=True)


class Weather(bio.environments.Environment):
    """The least and the greatest temperature of each day, degrees Celsius; the same everywhere."""

    days = ((4, 12), (6, 18), (10, 24), (14, 30), (2, 5), (9, 21))

    def exchange(self, step, messages):
        """Tell today's temperatures."""
        return np.tile(self.days[step % len(self.days)], (len(messages["positions"]), 1))


@pytest.mark.capability("PL-122", "PL-405")
def test_a_bean_grows_by_the_temperatures_of_the_day():
    bean = bio.LSystem(
        """#define rate(low,high) max(0,((low+high)/2-8)*0.05)
axiom: A?E(0,0)
p1: A > ?E(low,high) --> F(rate(low,high))A?E(0,0)
p2: ?E(low,high) --> *
"""
    )
    grown = bio.environments.derive(bean, 7, environment=Weather())
    lengths = [float(one) for one in re.findall(r"F\(([^)]*)\)", grown.string())]
    expected = [max(0.0, ((low + high) / 2 - 8) * 0.05) for low, high in Weather.days]
    # What the axiom heard was the first day.
    assert lengths == pytest.approx([*expected, expected[0]], abs=1e-6)
    assert min(lengths) == 0 < max(lengths)


class HalfShade(bio.environments.Environment):
    """Light for whatever stands on the right."""

    def exchange(self, step, messages):
        """Tell how light it is."""
        return (messages["positions"][:, :1] > 0) * 1.0


@pytest.mark.capability("PL-123", "PL-606")
def test_a_shaded_seedling_is_old_by_the_calendar_and_young_in_form():
    seedlings = bio.LSystem(
        """axiom: [-(90)f(1)+(90)A(0,0)?E(0)][+(90)f(1)-(90)A(0,0)?E(0)]
p1: A(days,age) > ?E(light) : light > 0 && age >= 3 --> F[+L]A(days+1,age+1)?E(0)
p2: A(days,age) > ?E(light) : light > 0 --> F[+J]A(days+1,age+1)?E(0)
p3: A(days,age) > ?E(light) --> A(days+1,age)?E(0)
p4: ?E(light) --> *
"""
    )
    string = bio.environments.derive(seedlings, 8, environment=HalfShade()).string()
    sunny, shaded = re.findall(r"A\((\d+),(\d+)\)", string)
    assert sunny == ("8", "8")
    assert shaded == ("8", "0")
    assert (string.count("J"), string.count("L")) == (3, 5)


@pytest.mark.capability("PL-324")
def test_younger_buds_fork_more_when_they_wake():
    forks = []
    for younger in (5, -2, -10):
        system = gallery.read("pruned_tree", cc=younger)
        texts = [system.derive(36, seed).string() for seed in range(1, 9)]
        # Of what the tips have made: lateral shoots beside buds that wait.
        shares = [one.count("[") / (one.count("[") + one.count("B(")) for one in texts]
        forks.append(np.mean(shares))
    assert forks == sorted(forks)
    assert forks[-1] > 1.1 * forks[0]


@pytest.mark.capability("PL-214")
def test_signals_and_buds_are_marked():
    drawn = bio.Turtle().interpret(gallery.read("pruned_square").derive(9))
    balls = drawn.balls.color.tolist()
    marks = sorted(balls.count(color) for color in set(balls))
    # Five dormant buds and one signal, and the signal is the larger.
    assert marks == [1, 5]
    signal = balls.index(min(set(balls), key=balls.count))
    assert drawn.balls.radius[signal] > np.delete(drawn.balls.radius, signal).max()
    stem = bio.Turtle().interpret(gallery.read("mesotonic").derive(24)).segments
    narrow, wide = np.unique(stem.radii[:, 1], return_counts=True)[1]
    # As the table of the mesotonic structure says.
    assert (narrow, wide) == (8, 16)


@pytest.mark.capability("PL-601")
def test_what_can_be_foretold_is_foretold():
    foretold = {name: gallery.model(name).count for name in gallery.names()}
    assert {name for name, count in foretold.items() if count} == {
        "koch_snowflake",
        "compound_leaf",
        "basitonic",
    }
    assert not foretold["clonal_plant"] + foretold["light_tree"]
    for name in ("koch_snowflake", "compound_leaf", "basitonic"):
        formula, of = foretold[name].split(" internodes ")
        assert of == "F after n steps"
        for n in range(7):
            grown = gallery.read(name).derive(n)
            symbols = np.array(grown.symbols)[grown.kinds]
            assert (symbols == "F").sum() == eval(formula.replace("^", "**"), {"n": n})
