"""Productions on figures: Koch constructions beside the growth of the turtle."""

import cmath
import math

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import InvalidValueError
from bioscope.lsystem import Figure, Generator

FLAKE = "F-F++F-F"
BRANCH = "F[+F]F[-F]F"


def walked(word: str, angle: float) -> np.ndarray:
    """Return start and end (n, 2) of what a turtle draws, in double precision."""
    here, heading, stack, edges = 0j, 1j, [], []
    for symbol in word:
        if symbol in "+-":
            heading *= cmath.rect(1, math.radians(angle if symbol == "+" else -angle))
        elif symbol == "[":
            stack.append((here, heading))
        elif symbol == "]":
            here, heading = stack.pop()
        else:
            edges.append((here, here + heading))
            here += heading
    return np.array(edges)


def derived(axiom: str, rule: str, steps: int) -> str:
    text = f"lsystem: x\naxiom: {axiom}\n{rule}\nendlsystem\n"
    return bio.LSystem(text).derive(steps).string()


def hausdorff(one: np.ndarray, other: np.ndarray) -> float:
    distances = np.abs(one.ravel()[:, None] - other.ravel()[None])
    return float(max(distances.min(axis=0).max(), distances.min(axis=1).max()))


def edges(figure: Figure) -> np.ndarray:
    return np.column_stack([figure.start, figure.end])


@pytest.mark.capability("PL-105", "PL-607", "PL-611", "PL-605")
def test_the_snowflake_grows_the_same_as_string_and_as_figure():
    # The same production as a string and as a generator.
    figure, steps = Figure.edge(), 4
    generator = Generator.of_word(FLAKE, 60)
    for _ in range(steps):
        figure = figure.koch({"F": generator})
    drawn = walked(derived("F", f"F --> {FLAKE}", steps), 60)
    assert len(figure) == len(drawn) == 4**steps
    assert hausdorff(edges(figure), drawn / 3**steps) < 1e-9
    assert np.allclose(np.abs(figure.end - figure.start), 3.0**-steps)
    closed = Figure.polygon([0, 1, cmath.rect(1, -math.pi / 3)]).koch({"F": generator})
    assert np.abs(closed.end - np.roll(closed.start, -1)).max() < 1e-12
    # A rule that does not keep its end points gives other figures.
    turning = Generator.of_word("F+F", 60)
    koch, grown = Figure.edge(), Figure.edge()
    for _ in range(2):
        koch, grown = koch.koch({"F": turning}), grown.grown({"F": turning})
    assert abs(koch.end[-1] - 1j) < 1e-9
    string = walked(derived("F", "F --> F+F", 2), 60)
    assert hausdorff(edges(grown), string) < 1e-9
    assert hausdorff(edges(koch) / abs(koch.end[0]), string / abs(string[0, 1])) > 0.1


@pytest.mark.capability("PL-105", "PL-608")
def test_branches_stay_in_koch_constructions_and_move_in_growth():
    generator = Generator.of_word(BRANCH, 25)
    koch = grown = Figure.edge()
    for steps in range(1, 4):
        before = koch
        koch, grown = koch.koch({"F": generator}), grown.grown({"F": generator})
        drawn = walked(derived("F", f"F --> {BRANCH}", steps), 25)
        assert np.abs(edges(grown) - drawn).max() < 1e-9, "tips are those of the turtle"
        # End points of every edge of the last figure are still there.
        ends = np.concatenate([koch.start, koch.end])
        for point in np.concatenate([before.start, before.end]):
            assert np.abs(ends - point).min() < 1e-9
    assert abs(grown.end - koch.end).max() > 1
    with pytest.raises(InvalidValueError, match="elsewhere"):
        Generator.of_word("F++F", 90)


@pytest.mark.capability("PL-607")
def test_generators_have_sides_of_any_length_and_branches():
    uneven = Generator.of_pieces(
        [("F", 0, 0.6), ("F", 0.6, 0.6 + 0.2j), ("G", 0.6, 0.7 - 0.1j), ("F", 0.6 + 0.2j, 1)]
    )
    assert uneven.parent.tolist() == [-1, 0, 0, 1]
    figure = Figure.edge(end=2)
    for _ in range(2):
        figure = figure.koch({"F": uneven})
    # G has no production, and stays.
    assert (figure.labels == "G").sum() == 4
    assert len(figure) == 3 * 4 + 1
    assert abs(figure.end[-1] - 2) < 1e-12
    lengths = np.abs(figure.end - figure.start)
    assert lengths[0] == pytest.approx(2 * 0.6**2)


@pytest.mark.capability("PL-103")
def test_what_stands_above_an_internode_moves_as_it_is():
    # A stem of internodes with an apex A; the third internode I bears the branch.
    start = np.array([0, 1j, 2j, 3j, 3j])
    end = np.array([1j, 2j, 3j, 3.2 + 3.4j, -0.5 + 3.6j])
    labels, parent = np.array(["S", "I", "S", "A", "L"]), np.array([-1, 0, 1, 2, 2])
    plant = Figure(start, end, labels, parent)
    # (a) The apex is replaced by a flower: nothing else moves.
    flower = plant.grown({"A": Generator.of_word("S[+P][P][-P]", 40)})
    assert np.array_equal(flower.start[:3], start[:3])
    assert (flower.labels == "P").sum() == 3
    # (b) An internode develops a branch and bends: what stands above moves, its shape does not.
    grown = plant.grown({"I": Generator.of_word("S[-S]+S", 20)})
    above = np.isin(grown.parent, np.flatnonzero(grown.labels == "S")) & (np.arange(len(grown)) > 3)
    before = np.concatenate([start[2:], end[2:]])
    after = np.concatenate([grown.start[above], grown.end[above]])
    far = lambda points: np.abs(points[:, None] - points[None])  # noqa: E731
    assert np.abs(far(before) - far(after)).max() < 1e-9
    assert np.abs(before - after).min() > 0.5
    assert grown.labels.tolist() == ["S", "S", "S", "S", "S", "A", "L"]
