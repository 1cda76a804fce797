"""The course's models give the strings and figures that its texts state."""

import math
import re
from collections import Counter

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

MODULE = re.compile(r"(~[A-Za-z]|@[A-Za-z]|\?[A-Z]|[^()])(?:\(([^()]*)\))?")


def modules(name, steps=None, seed=1):
    """The modules of a model's string as (symbol, numbers)."""
    text = gallery.read(name).derive(steps, seed).string()
    return [
        (symbol, tuple(float(one) for one in numbers.split(",")) if numbers else ())
        for symbol, numbers in MODULE.findall(text)
    ]


def counts(name, steps=None, seed=1):
    return Counter(symbol for symbol, _ in modules(name, steps, seed))


def with_depth(parts):
    """Each module with the number of brackets that are open round it."""
    depth = 0
    for symbol, numbers in parts:
        if symbol == "]":
            depth -= 1
        yield depth, symbol, numbers
        if symbol == "[":
            depth += 1


@pytest.mark.capability("PL-101", "PL-106", "PL-301")
def test_the_parametric_example_gives_its_trace():
    system = gallery.read("parametric_example")
    trace = [system.derive(step).string() for step in range(5)]
    assert trace == [
        "B(2)A(4,4)",
        "B(1)B(4)A(1,0)",
        "B(0)B(3)A(2,1)",
        "CB(2)A(4,3)",
        "CB(1)A(8,7)",
    ]
    last = modules("parametric_example", 5)
    assert last[:3] == [("C", ()), ("B", (0.0,)), ("B", (8.0,))]
    assert last[3] == ("A", (pytest.approx(8 / 7), 0.0))


@pytest.mark.capability("PL-109")
def test_the_context_example():
    assert gallery.read("context_example").derive().string() == "A(4)E(4.5)F(5.5)C(6)"


@pytest.mark.capability("PL-110", "PL-302")
def test_the_stochastic_example_has_its_probabilities():
    system = gallery.read("stochastic_example")
    runs = [system.derive(seed=seed).string() for seed in range(1, 601)]
    seen = Counter(runs)
    assert all(
        re.fullmatch(r"(A\(2\)|B\(0\))B\(6\)A\(3\)(A\(6\)|B\(4\)|C\(5\))", one) for one in seen
    )
    first, last = {"A(2)": 0.4, "B(0)": 0.6}, {"A(6)": 0.2, "B(4)": 0.3, "C(5)": 0.5}
    square = 0.0
    for start, one in first.items():
        for end, other in last.items():
            expected = one * other * len(runs)
            square += (seen[f"{start}B(6)A(3){end}"] - expected) ** 2 / expected
    # 0.999 quantile of chi-squared with five degrees of freedom.
    assert square < 20.5


def test_the_stochastic_branch():
    system = gallery.read("stochastic_branch")
    runs = {system.derive(seed=seed).string() for seed in range(1, 60)}
    assert "A(2)B(6)[A(3)]B(4)" in runs
    assert runs == {f"{a}B(6)[A(3)]{b}" for a in ("A(2)", "B(0)") for b in ("A(6)", "B(4)")}


@pytest.mark.capability("PL-116")
def test_the_cut_example():
    assert gallery.read("cut_example").derive().string() == "a[b]g[h[]j]k"


@pytest.mark.capability("PL-004", "PL-303")
def test_the_snowflake_is_closed_and_has_its_edges():
    for steps in range(4):
        parts = modules("koch_snowflake", steps)
        edges = [numbers[0] for symbol, numbers in parts if symbol == "F"]
        assert len(edges) == 3 * 4**steps
        assert edges == pytest.approx([3.0**-steps] * len(edges), rel=1e-6)
        heading, place, corners = 0.0, 0j, []
        for symbol, numbers in parts:
            if symbol == "F":
                place += 3.0**-steps * complex(math.cos(heading), math.sin(heading))
                corners.append(place)
            else:
                heading += math.radians(numbers[0]) * (1 if symbol == "+" else -1)
        assert abs(place) < 1e-9
        if steps == 3:
            pairs = zip(corners, corners[1:] + corners[:1], strict=True)
            area = abs(sum((a.conjugate() * b).imag for a, b in pairs)) / 2
            assert area == pytest.approx(0.67001, abs=1e-5)
    assert counts("koch_snowflake", 6)["F"] == 12288


@pytest.mark.capability("PL-304")
def test_the_compound_leaf_doubles():
    for steps in range(1, 6):
        parts = modules("compound_leaf", steps)
        kinds = Counter(numbers[1] for symbol, numbers in parts if symbol == "F")
        assert kinds == {1.0: 3**steps, 2.0: 3**steps - 1}
        axis = [n[0] for depth, symbol, n in with_depth(parts) if symbol == "F" and depth == 0]
        assert sum(axis) == 2 ** (steps + 1) - 1


@pytest.mark.capability("PL-305")
def test_the_borchert_slade_tree_has_its_mean_number_of_apices():
    system = gallery.read("borchert_slade")
    runs = [system.derive(seed=seed).string() for seed in range(1, 251)]
    assert np.mean([text.count("A(") for text in runs]) == pytest.approx(160.4, rel=0.05)
    start = bio.Turtle().interpret(system.derive(1)).segments
    ways = (start.end - start.start)[-2:]
    cosine = ways[0] @ ways[1] / np.prod(np.linalg.norm(ways, axis=1))
    assert math.degrees(math.acos(cosine)) == pytest.approx(52, abs=0.01)


@pytest.mark.capability("PL-206", "PL-306")
def test_the_stylized_flower_has_five_equal_sectors():
    parts = modules("stylized_flower")
    lines = Counter(numbers[0] for symbol, numbers in parts if symbol == "F")
    assert lines == {5.0: 1, 1.0: 15}
    drawn = bio.Turtle().interpret(gallery.read("stylized_flower").derive())
    assert Counter(name for name, *_ in drawn.surfaces) == {"s": 5, "p": 5}
    anthers = drawn.segments.end[-15:].astype(float)
    apart = np.linalg.norm(anthers[:, None] - anthers[None], axis=2)
    turned = np.roll(np.roll(apart, 3, axis=0), 3, axis=1)
    assert np.abs(apart - turned).max() < 1e-6


@pytest.mark.capability("PL-115", "PL-307")
def test_bluebell_petals_come_and_fall_from_below_upward():
    petals = []
    for step in range(46):
        seen = counts("bluebell", step)
        petals.append(seen["P"])
        ages = [numbers[0] for symbol, numbers in modules("bluebell", step) if symbol == "K"]
        assert ages == sorted(ages, reverse=True)
    assert max(petals) == 12
    assert petals[40] == 0
    assert petals[0] == 0
    assert counts("bluebell", 45)["K"] == 9


@pytest.mark.capability("PL-308")
def test_shedding_keeps_the_crown_constant():
    for step in range(1, 14):
        parts = list(with_depth(modules("branch_shedding", step)))
        lengths = Counter((min(depth, 1), n[0]) for depth, symbol, n in parts if symbol == "F")
        assert lengths[0, 1.0] == step
        scars = sum(count for (depth, length), count in lengths.items() if depth and length < 0.5)
        assert scars == 2 * max(0, step - 5)
        if step >= 5:
            assert lengths[1, 1.0] == 20


@pytest.mark.capability("PL-209", "PL-309")
def test_the_date_palm_keeps_its_fronds():
    for step in (50, 60, 80):
        seen = counts("date_palm", step)
        assert seen["X"] == 41
        assert seen["~l"] == 730
        parts = with_depth(modules("date_palm", step))
        assert sum(symbol == "F" and depth == 0 for depth, symbol, _ in parts) == step


@pytest.mark.capability("PL-117", "PL-215", "PL-310")
def test_the_rhizome_falls_apart_into_plants():
    separate = []
    system = gallery.read("alpinia")
    for seed in range(1, 21):
        ages = [n[1] for symbol, n in modules("alpinia", 13, seed) if symbol == "F"]
        assert max(ages) < 7
        drawn = bio.Turtle().interpret(system.derive(13, seed)).segments
        separate.append(islands(drawn.start, drawn.end))
    assert sum(number >= 2 for number in separate) >= 10
    widths = {n[1]: w for w, n in widths_and_ages(modules("alpinia", 13))}
    assert [widths[age] for age in sorted(widths)] == sorted(widths.values())


def islands(starts, ends):
    """Number of pieces that share no end points."""
    links: dict[tuple, tuple] = {}

    def root(point):
        while links.setdefault(point, point) != point:
            point = links[point]
        return point

    for start, end in zip(starts.round(3), ends.round(3), strict=True):
        links[root(tuple(start + 0.0))] = root(tuple(end + 0.0))
    return len({root(point) for point in list(links)})


def widths_and_ages(parts):
    width = 0.0
    for symbol, numbers in parts:
        if symbol == "!":
            width = numbers[0]
        elif symbol == "F":
            yield width, numbers


@pytest.mark.capability("PL-311")
def test_the_basitonic_structure():
    for steps in (3, 6, 12):
        parts = modules("basitonic", steps)
        assert sum(symbol == "F" for symbol, _ in parts) == steps**2
        lengths, last = [], 0
        for depth, symbol, _ in with_depth(parts):
            if symbol == "[" and depth == 0:
                lengths.append(0)
            elif symbol == "F" and depth:
                lengths[-1] += 1
            last = max(last, depth)
        assert lengths == [steps - j for j in range(1, steps + 1) for _ in range(2)]
        assert last == 1


MESOTONIC = {
    12: (5, "1 2* 1* 1*", 6),
    24: (9, "1 2 2 3 3* 2* 1* 1*", 16),
    36: (13, "1 2 2 3 3 4 4* 4* 3* 2* 1* 1*", 30),
    48: (17, "1 2 2 3 3 4 4 5 5 5* 4* 4* 3* 2* 1* 1*", 47),
    60: (21, "1 2 2 3 3 4 4 5 5 6 6 7* 6* 5* 4* 4* 3* 2* 1* 1*", 68),
}


@pytest.mark.capability("PL-113", "PL-312")
@pytest.mark.parametrize("step", MESOTONIC)
def test_the_mesotonic_structure(step):
    axis, branches = 0, []
    parts = modules("mesotonic", step)
    for depth, symbol, _ in with_depth(parts):
        if symbol == "[":
            branches.append([0, ""])
        elif symbol == "F":
            axis += depth == 0
            if depth:
                branches[-1][0] += 1
        elif symbol == "B":
            branches[-1][1] = "*"
    lengths = " ".join(f"{length}{alive}" for length, alive in branches)
    wide = sum(symbol == "#" for symbol, _ in parts)
    assert (axis, lengths, wide) == MESOTONIC[step]


@pytest.mark.capability("PL-317")
def test_the_insect_eats_every_bud_once():
    eaten, before = 0, None
    for step in range(20, 101):
        parts = modules("insect", step)
        states = [numbers[1] for symbol, numbers in parts if symbol == "I"]
        assert sum(state in (1, 5) for state in states) <= 1
        buds = sum(symbol == "A" for symbol, _ in parts)
        if before is not None and buds < before:
            assert before - buds == 1
            eaten += 1
        before = max(buds, before or 0) if step < 26 else buds
    assert eaten == 16
    assert before == 0
    root = next(numbers for symbol, numbers in modules("insect", 99) if symbol == "I")
    assert root[1] == 4
    wilted = [numbers[1] for symbol, numbers in modules("insect", 140) if symbol == "F"]
    assert wilted == [1.0] * 31


@pytest.mark.capability("PL-119", "PL-319")
def test_the_query_example():
    system = gallery.read("query_example")
    assert [system.derive(step).string() for step in (1, 2, 3)] == [
        "F(1)?P(0,1)-A",
        "F(2)?P(0,2)-F(1)?P(1,2)-A",
        "F(3)?P(0,3)-F(2)?P(2,3)-F(1)?P(2,2)-A",
    ]


PRUNED = {
    6: (7, 6, 1, 0),
    7: (6, 6, 0, 1),
    8: (7, 5, 1, 0),
    9: (6, 5, 0, 1),
    10: (6, 5, 0, 1),
    12: (8, 5, 1, 0),
    13: (7, 5, 0, 1),
    14: (8, 4, 1, 0),
    17: (9, 6, 0, 1),
    20: (9, 5, 0, 1),
    40: (17, 8, 0, 1),
    75: (29, 11, 0, 1),
    94: (39, 17, 0, 1),
}


@pytest.mark.capability("PL-320")
def test_pruning_in_a_square_follows_the_figure():
    found = {}
    for step in PRUNED:
        seen = counts("pruned_square", step)
        found[step] = (seen["F"], seen["@o"], seen["A"], seen["S"])
    assert found == PRUNED


@pytest.mark.capability("PL-321")
def test_the_pruned_tree_stays_in_its_cube():
    system = gallery.read("pruned_tree")
    numbers = []
    for step in (3, 6, 9, 13, 21, 27):
        ends = bio.Turtle().interpret(system.derive(step)).segments.end
        assert np.abs(ends[:, [0, 2]]).max() <= 7
        assert 0 <= ends[:, 1].max() <= 13
        numbers.append(counts("pruned_tree", step)["F"])
    assert numbers == sorted(numbers)
    assert 14 <= numbers[0] <= 15
    assert 380 <= numbers[4] <= 760


@pytest.mark.capability("PL-315")
def test_trees_that_shed_have_fewer_internodes():
    pairs = [
        (counts("shedding_balance", 25, seed)["F"], counts("borchert_slade", 25, seed)["F"])
        for seed in range(1, 9)
    ]
    assert np.mean([a for a, _ in pairs]) < np.mean([b for _, b in pairs])


@pytest.mark.capability("PL-316")
def test_the_flux_is_shared_out_without_loss():
    expected = {1: (3, 2), 2: (7, 4), 3: (15, 8), 4: (29, 15), 5: (51, 26), 6: (87, 44)}
    for cycle, (internodes, terminals) in expected.items():
        parts = modules("borchert_honda", 61 * cycle)
        seen = Counter(symbol for symbol, _ in parts)
        assert (seen["I"], seen["A"]) == (internodes, terminals)
        # What leaves the root in a cycle arrives at the tips.
        before = gallery.read("borchert_honda").derive(61 * cycle - 1).string()
        assert sum(fluxes(before)) == pytest.approx(17 * 2 ** ((cycle - 1) * 0.89), rel=1e-5)


def fluxes(text: str) -> list[float]:
    """Return the flux that reaches each tip."""
    return [float(one) for one in re.findall(r"I\([^,]+,[^,]+,([^,]+),\d\)FA", text)]


def lateral(text: str) -> tuple[int, int]:
    """Return where the first bracket opens, and where it closes."""
    start, depth = text.index("["), 0
    for place in range(start, len(text)):
        depth += {"[": 1, "]": -1}.get(text[place], 0)
        if depth == 0:
            return start, place
    raise AssertionError("a bracket is not closed")


@pytest.mark.capability("PL-316")
def test_a_pruned_tree_makes_up_for_its_loss():
    source = gallery.text("borchert_honda")
    grown = gallery.read("borchert_honda").derive(61 * 6).string()
    start, _ = lateral(grown)
    cut = grown[: start + 1] + "%" + grown[start + 1 :]
    runs = {}
    for name, axiom in (("whole", grown), ("cut", cut)):
        system = bio.LSystem(re.sub(r"(?m)^axiom: .*$", "axiom: " + axiom, source))
        runs[name] = [system.derive(steps).string() for steps in (60, 61 * 3)]
    # The branches that stay, in the whole tree and in the pruned one.
    kept = []
    for text in runs["whole"]:
        start, end = lateral(text)
        kept.append(text[: start + 1] + text[end:])
    whole, pruned = fluxes(kept[0]), fluxes(runs["cut"][0])
    assert sum(pruned) == pytest.approx(sum(fluxes(runs["whole"][0])), rel=1e-5)
    assert len(whole) == len(pruned)
    assert np.all(np.array(pruned) >= np.array(whole))
    assert sum(pruned) > 1.2 * sum(whole)
    assert runs["cut"][1].count("I(") > kept[1].count("I(")
