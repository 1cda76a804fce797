"""Models of the gallery in their environments: climbers, clones, roots, and trees side by side."""

import math
import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

GOOD, FAIR = (-16.0, -16.0, 13.0), (18.0, 18.0, 10.0)
"""Patches I and II of light on the ground: middle and radius."""


@pytest.mark.capability("PL-323", "PL-405")
@pytest.mark.parametrize(("x", "z"), [(1.0, 0.0), (0.8, 0.3), (-0.6, 0.8)])
def test_a_climber_finds_its_pole_and_winds_round_it(x, z):
    pole = bio.environments.Pole(x=x, z=z, radius=0.3)
    string = bio.environments.derive(gallery.read("climber"), environment=pole)
    drawn = bio.Turtle().interpret(string).segments
    stem = drawn.end[drawn.color == 1] - (x, 0, z)
    distance = np.hypot(stem[:, 0], stem[:, 2])
    contact = int(np.argmax(distance < 0.35 + 0.2))
    assert distance[0] > 0.7
    angle = np.unwrap(np.arctan2(stem[contact:, 2], stem[contact:, 0]))
    turns = np.abs(angle - angle[0]) / (2 * math.pi)
    assert turns[-1] >= 2
    after = distance[contact:][turns > 1]
    assert after.std() < 0.05 * after.mean()
    assert after.min() > 0.3, "it stays outside the pole"
    assert np.diff(stem[contact + 2 :, 1]).min() > 0, "upward"
    # The signal has run down and frozen all joints.
    assert re.findall(r"R\((\d)", string.string()).count("1") == 0


class Meadow(bio.environments.Environment):
    """Patches of light, with a diary of the ramets of a clone."""

    def __init__(self) -> None:
        self.light = bio.environments.PatchLight()
        self.ramets: set[tuple[float, float]] = set()
        self.diary: list[tuple[int, int]] = []
        """Ramets in patch I and in patch II after every step."""

    def exchange(self, step, messages):
        """Tell how light it is."""
        kinds = messages["parameters"][:, 0] if len(messages["positions"]) else np.zeros(0)
        for kind, (x, y, _) in zip(kinds, messages["positions"], strict=True):
            place = (round(float(x), 2), round(float(y), 2))
            if kind == 1:
                self.ramets.add(place)
            elif kind == 2:
                self.ramets.discard(place)
        self.diary.append((self.within(GOOD), self.within(FAIR)))
        if not len(kinds):
            return None
        return np.array(self.light.ask(messages["parameters"], messages["positions"]))

    def within(self, patch: tuple[float, float, float]) -> int:
        """Count the ramets in a patch."""
        x, y, radius = patch
        return sum(math.hypot(a - x, b - y) < radius for a, b in self.ramets)


def clone(seed: int) -> tuple[bio.ModuleString, np.ndarray]:
    """Grow a clone from patch II toward patch I."""
    start = "axiom: -(90)f(18)+(90)f(18)+(135)A(1)"
    text = gallery.text("clonal_plant").replace("axiom: A(1)", start)
    meadow = Meadow()
    grown = bio.environments.derive(bio.LSystem(text), seed=seed, environment=meadow)
    return grown, np.array(meadow.diary)


@pytest.mark.capability("PL-117", "PL-420", "PL-423")
def test_a_clone_forages_for_light():
    reached, occupied, invaded = [], [], 0
    for seed in range(1, 13):
        grown, diary = clone(seed)
        good, fair = diary[:, 0], diary[:, 1]
        reached.append(good[:60].any())
        if grown.string().count("A("):
            occupied.append((good[60:] > 0).mean())
        left = fair.tolist()
        first = next((step for step, number in enumerate(left) if number), len(left))
        pattern = "".join("x" if number else "." for number in left[first:])
        invaded += bool(re.search(r"\.{10,}x", pattern))
    assert np.mean(reached) >= 0.5
    assert len(occupied) >= 4
    assert np.mean(np.array(occupied) >= 0.6) >= 0.5
    assert invaded >= 1


@pytest.mark.capability("PL-423")
def test_spacers_vary_in_length_and_angle():
    same = gallery.read("clonal_plant", DevLen=0, DevAngle=0)
    lengths = re.findall(r"F\(([\d.]+),", bio.environments.derive(same, 30).string())
    assert {float(one) for one in lengths} == {2.0}
    varied = bio.environments.derive(gallery.read("clonal_plant"), 60).string()
    lengths = np.array([float(one) for one in re.findall(r"F\(([\d.]+),", varied)])
    assert len(lengths) > 100
    assert lengths.mean() == pytest.approx(2, abs=0.1)
    assert lengths.std() == pytest.approx(0.2, rel=0.3)


def main_axis(string: bio.ModuleString) -> np.ndarray:
    """Return the joints of the root outside all brackets."""
    symbols = np.array(string.symbols)[string.kinds]
    depth = np.cumsum((symbols == "[").astype(int) - (symbols == "]"))
    drawn = bio.Turtle().interpret(string).segments
    strokes = symbols == "F"
    return drawn.end[depth[strokes] == 0]


@pytest.mark.capability("PL-112", "PL-430")
def test_roots_have_the_reference_size_and_stop_in_dry_soil():
    roots = gallery.read("roots")
    rich = bio.environments.SoilWater((200, 200), amount=1e6)
    grown = bio.environments.derive(roots, environment=rich).string()
    assert [grown.count(one) for one in ("F(", "A(", "B(")] == [2472, 32, 315]
    # Rootlets, by their order: where it is dry they stop before their full length.
    lengths = []
    for amount in (0.05, 0.3, 1.0, 1e6):
        soil = bio.environments.SoilWater((200, 200), amount=amount)
        string = bio.environments.derive(roots, environment=soil)
        drawn = bio.Turtle().interpret(string).segments
        pieces = np.linalg.norm(drawn.end - drawn.start, axis=1)
        lengths.append([pieces[drawn.color == order].sum() for order in (2, 3)])
        if amount == 0.05:
            assert string.string().count("A(") == 0
    assert lengths == sorted(lengths)
    assert lengths[1][0] < 0.1 * lengths[3][0]


@pytest.mark.capability("PL-430")
def test_the_main_root_grows_toward_the_water():
    # Columns that keep their amount, the wetter the farther to the left.
    columns = [(x, -32, -1, x + 1, 32, 1, 0.05 * (33 - x)) for x in range(-32, 32)]
    cosines = []
    for seed in range(1, 11):
        soil = bio.environments.SoilWater((64, 64), sources=columns)
        string = bio.environments.derive(gallery.read("roots"), 60, environment=soil, seed=seed)
        way = np.diff(main_axis(string)[:, :2], axis=0)
        cosines.append(np.mean(-way[:, 0] / np.linalg.norm(way, axis=1)))
    assert min(cosines) > 0.1
    assert np.mean(cosines) > 0.3


@pytest.mark.capability("PL-445", "PL-216", "PL-405")
def test_two_trees_grow_away_from_each_other():
    text = gallery.text("light_tree")
    axiom = re.search(r"(?m)^axiom: (.*)$", text)[1]
    centers = {}
    for name, planted in {
        "alone": f"axiom: [{axiom}]",
        "pair": f"axiom: [-(90)f(-1.5)+(90){axiom}][-(90)f(1.5)+(90){axiom}]",
    }.items():
        system = bio.LSystem(text.replace(f"axiom: {axiom}", planted))
        string = bio.environments.derive(system, 11 * 31 - 1)
        symbols = np.array(string.symbols)[string.kinds]
        depth = np.cumsum((symbols == "[").astype(int) - (symbols == "]"))
        tree = (np.cumsum((symbols == "[") & (depth == 1)) - 1)[symbols == "F"]
        ends = bio.Turtle().interpret(string).segments.end
        # Moved apart, to where each would stand alone.
        centers[name] = [ends[tree == one, 0].mean() for one in range(tree.max() + 1)]
    left = centers["pair"][0] + 1.5 - centers["alone"][0]
    right = centers["pair"][1] - 1.5 - centers["alone"][0]
    assert left <= -0.5
    assert right >= 0.5


def main_roots_apart(spread: float, seeds: range) -> np.ndarray:
    """Return how far apart two main roots end, by seed."""
    text = gallery.text("roots_3d", SPREAD=spread)
    # No deeper than the roots come in so many steps.
    deep, needed = "size=48x56x48 low=-48x-110x-48", "size=40x24x40 low=-40x-46x-40"
    assert deep in text
    system = bio.LSystem(text.replace(deep, needed), "roots_3d.lsys")
    apart = []
    for seed in seeds:
        string = bio.environments.derive(system, 100, seed=seed)
        symbols = np.array(string.symbols)[string.kinds]
        depth = np.cumsum((symbols == "[").astype(int) - (symbols == "]"))
        plant = np.cumsum((symbols == "[") & (depth == 1)) - 1
        strokes = symbols == "F"
        ends = bio.Turtle().interpret(string).segments.end
        tips = [ends[(depth[strokes] == 1) & (plant[strokes] == one)][-1] for one in (0, 1)]
        assert max(tip[1] for tip in tips) < -15, "downward"
        apart.append(np.hypot(*(tips[0] - tips[1])[[0, 2]]))
    return np.array(apart)


@pytest.mark.capability("PL-432")
def test_main_roots_part_the_more_the_faster_their_rootlets_spread():
    start = 4.0
    slow, fast = (main_roots_apart(spread, range(1, 25)) for spread in (0.03, 0.3))

    def error(apart: np.ndarray) -> float:
        return float(apart.std(ddof=1) / np.sqrt(len(apart)))

    assert slow.mean() > start + 3 * error(slow)
    assert fast.mean() > slow.mean() + 3 * np.hypot(error(fast), error(slow))
