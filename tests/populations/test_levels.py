"""One stand at two levels: as circles, and as plants in all their detail."""

import re
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

PAGE = Path(__file__).parents[2] / "docs" / "concepts" / "rewriting.md"
SEEDLINGS = 900
SIDE = SEEDLINGS**0.5
PLACING = 17
"""Steps in which the circles are only placed."""
STEPS = (30, 60, 80, 99)


def circles(seed: int) -> bio.LSystem:
    """Return the stand of circles with as many plants per area as the published one."""
    text = gallery.text("self_thinning").replace("#define N0 62500", f"#define N0 {SEEDLINGS}")
    return bio.LSystem(text.replace("#define FIELD 250", f"#define FIELD {SIDE}"))


def herbs(first: bio.lsystem.Balls) -> tuple[bio.World, bio.Plants]:
    """Return a world with herbs where the circles begin, each as large as its circle."""
    text = re.search(r'HERB = """(.*?)"""', PAGE.read_text(encoding="utf-8"), re.S)[1]
    world = bio.World(seed=5, dt=0.1)
    world.environment.terrain(np.zeros((17, 17), np.float32), spacing=SIDE / 8)
    places = [(float(x) - SIDE / 2, float(y) - SIDE / 2) for x, y, _ in first.center]
    stand = bio.Plants(
        text,
        len(places),
        habitat=bio.Habitat(area=places),
        room=0.0,
        rate=10.0,
        numbers={"R0": first.radius.tolist()},
        environment=bio.environments.Crowns(),
        flexibility=0.0,
    )
    return world, world.add(stand, "herbs")


def living(stand: bio.Plants) -> int:
    """Count the herbs with a root."""
    return sum("R" in text for text in stand.values("string"))


@pytest.mark.capability("PL-604")
def test_circles_and_detailed_plants_thin_out_alike():
    counts = {step: [0, 0] for step in STEPS}
    pieces = 0
    for seed in (1, 2):
        system = circles(seed)

        def drawn(step, seed=seed, system=system):
            return bio.Turtle().interpret(system.derive(PLACING + step, seed)).balls

        world, stand = herbs(drawn(0))
        for step in STEPS:
            # Runners sprout in the first step of the herbs.
            world.step(step + 1 - int(stand.values("steps").max()))
            counts[step][0] += len(drawn(step).radius)
            counts[step][1] += living(stand)
        pieces += int(stand.values("segments").sum())
    for of_circles, of_herbs in counts.values():
        assert of_herbs == pytest.approx(of_circles, rel=0.05)
    assert counts[99][0] < 0.4 * 2 * SEEDLINGS, "and they have thinned out"
    assert pieces > 50 * counts[99][1], "each herb is a plant of many pieces"


@pytest.mark.capability("PL-604")
def test_a_crown_is_what_the_tips_enclose():
    crowns = bio.environments.Crowns()
    tips = [(2, 0, 0), (-2, 0, 0), (0, 0, 2), (0, 0, -2)]
    one = np.array([(0, 0, 0), *tips], float)
    other = np.array([(3.5, 0, 0), *(np.array(tips) * 0.6 + (3.5, 5, 0))], float)
    kinds = [[0, 0], *([[1, 0]] * 4)]
    for move, lost in (((0.0, 0.0, 2.0), 0), ((-0.4, 0.0, 0.0), 1)):
        answers = crowns.ask(kinds + kinds, np.concatenate([one, other + np.array(move)]))
        # The smaller one loses, however high its tips are.
        assert [row[1] for row in answers] == [0] * 5 + [lost] * 5
