"""Rehearsal: an event brought to a planned time by trial runs."""

import pytest

import bioscope as bio
from bioscope.film import rehearse


def pond():
    """Return a pond with a pair that does not think of mating yet."""
    world = bio.World(seed=5, dt=1 / 30)
    world.environment.water(surface=0.0)
    calm = bio.minds.Intentions(
        "pacifist",
        food=["plankton"],
        appetite=0.5,
        digestion=0.0,
        libido_growth=0.0,
        mate_weight=0.0,
        food_weight=0.2,
        home_range=1.0,
        stagger=0.0,
    )
    world.add(
        bio.RoamingFish("clownfish", 2, center=(0, -2, 0), radius=0.3, mind=calm, females=0.5)
    )
    world.add(bio.Plankton(120, low=(-1.0, -3.0, -1.0), high=(1.0, -1.0, 1.0)))
    return world


def libido(world):
    """Cue: they think of nothing else."""
    world.set("clownfish", "intentions_libido_growth", 1.0)


def happened(cue_at, kind):
    world = pond()
    world.run(cue_at)
    libido(world)
    while True:
        world.step()
        for event in world.drain_events():
            if event.kind == kind:
                return event.time
        assert world.time < 90


@pytest.mark.capability("TF-210", "TF-213")
def test_a_pair_circles_when_it_is_planned():
    cue_at = rehearse(pond, libido, lambda event: event.kind == "circled", at=30.0)
    assert cue_at > 0
    assert happened(cue_at, "circled") == pytest.approx(30.0, abs=1.0)
