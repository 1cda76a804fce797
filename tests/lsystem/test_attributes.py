"""Attributes of modules in one pass, beside signals that need many steps."""

import pytest

import bioscope as bio
from bioscope import gallery
from bioscope.errors import UnknownNameError

SHARE, FIRST, GROWTH, CYCLE = 0.7, 17, 0.89, 61
"""Numbers of the Borchert-Honda tree: share of the straight branch, flux, its growth, steps."""


def converged(cycle: int) -> bio.lsystem.Attributes:
    """Return the internodes of the tree when counts and flux have come to rest in a cycle."""
    string = gallery.read("borchert_honda").derive(CYCLE * cycle - 1)
    return bio.lsystem.Attributes(string, "I")


def shared_out(tree: bio.lsystem.Attributes, root: float) -> tuple[list[int], list[float]]:
    """Return the tips above each internode, and the flux that it gets: a pass down, a pass up."""
    tips = tree.synthesized(lambda _, above: sum(above) if above else 1)

    def flux(node: int, before: float | None) -> float:
        if before is None:
            return root
        rank, own, below = tree.numbers[node][0], tips[node], tips[tree.parents[node]]
        if below <= own:
            return before
        other = below - own
        if rank == 2:
            return min(before, before * (1 - SHARE) * own / other)
        return max(0.0, before - before * (1 - SHARE) * other / own)

    return tips, tree.inherited(flux)


@pytest.mark.capability("PL-610")
@pytest.mark.parametrize("cycle", [1, 3, 6, 8])
def test_one_pass_gives_what_the_signals_come_to(cycle):
    tree = converged(cycle)
    tips, fluxes = shared_out(tree, FIRST * 2 ** ((cycle - 1) * GROWTH))
    assert len(tree) == {1: 1, 3: 7, 6: 51, 8: 147}[cycle]
    assert tips == [int(count) for _, count, _, _ in tree.numbers]
    assert fluxes == pytest.approx([flux for _, _, flux, _ in tree.numbers], rel=1e-5)


@pytest.mark.capability("PL-610")
def test_signals_need_steps_and_attributes_do_not():
    young = gallery.read("borchert_honda").derive(CYCLE * 6 + 3)
    tree = bio.lsystem.Attributes(young, "I")
    tips, _ = shared_out(tree, 1.0)
    heard = [int(count) for _, count, _, _ in tree.numbers]
    assert tips[0] > heard[0], "the root has not heard of the new tips yet"


def test_what_is_no_symbol_is_refused():
    string = bio.LSystem("axiom: F[F]F\nF --> F\n").derive(0)
    with pytest.raises(UnknownNameError, match="'Q'"):
        bio.lsystem.Attributes(string, "Q")
    tree = bio.lsystem.Attributes(string, "F")
    assert tree.parents == [-1, 0, 0]
    assert tree.numbers == [(), (), ()]
