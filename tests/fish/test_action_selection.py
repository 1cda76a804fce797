"""How well three minds choose what to do: the criteria of Tu 1996, section 6.1, as trials.

Every trial gives a share of successes, 0 to 1, over seeds. Run as a script,
`python tests/fish/test_action_selection.py`, it prints the table of docs/concepts/fish-mind.md.
"""

import math
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from arena import DT, Arena, Fish, Pillar, distance

import bioscope as bio

KINDS = {
    "intentions": bio.minds.Intentions,
    "behavior_network": bio.minds.BehaviorNetwork,
    "free_flow": bio.minds.FreeFlow,
}
SEEDS = 12
LENGTH = 0.1


def fish(kind, role="generic", *, fed=0, **more):
    """Return a fish of this mind in the middle of the tank."""
    names = {"species": "fish", "enemies": ["shark"], "food": ["plankton"]}
    mind = KINDS[kind](role, **{"stagger": 0.0, "home_range": 5.0} | names | more)
    if fed:
        mind.decide({"fed": fed})
    return Fish(1, "fish", mind, (0.0, 0.0, 0.0))


def shark(place, yaw):
    mind = bio.minds.Intentions(
        "predator", species="shark", food=["fish"], stagger=0.0, full_speed=0.9
    )
    return Fish(2, "shark", mind, place, yaw=yaw, size=0.3)


def priority(kind):
    """A shark comes while a hungry fish has food before its mouth: it lives and keeps off."""
    lived = 0
    for seed in range(SEEDS):
        angle = 2 * math.pi * seed / SEEDS
        place = (0.6 * math.sin(angle), 0.0, 0.6 * math.cos(angle))
        food = {50: (0.05, 0.0, 0.15), 51: (-0.05, 0.0, 0.2)}
        arena = Arena([fish(kind), shark(place, angle + math.pi)], food=food, seed=seed)
        arena.run(4)
        both = len(arena.fishes) == 2
        lived += both and distance(arena.fishes[0].place, arena.fishes[1].place) > 0.25
    return lived / SEEDS


def persistence(kind):
    """Two morsels at nearly equal distance: how straight the way to the first of them is."""
    straight = 0.0
    for seed in range(SEEDS):
        tilt = 0.02 * (seed - SEEDS / 2)
        food = {
            50: (0.6 * math.sin(0.6 + tilt), 0.0, 0.6 * math.cos(0.6 + tilt)),
            51: (-0.6 * math.sin(0.6), 0.0, 0.6 * math.cos(0.6)),
        }
        one = fish(kind, "pacifist")
        arena = Arena([one], food=food, seed=seed)
        way, before = 0.0, one.place
        for _ in range(round(12 / DT)):
            arena.step()
            way += distance(before, one.place)
            before = one.place
            if one.eaten:
                straight += min(1.0, 0.55 / way)
                break
    return straight / SEEDS


def compromise(kind):
    """Obstacles ahead on the right and on the left, food to the right: it passes there."""
    right = 0
    for seed in range(SEEDS):
        one = fish(kind, "pacifist")
        pillars = [Pillar(-0.01, 0.45, 0.1), Pillar(0.19, 0.3, 0.06)]
        arena = Arena([one], food={50: (-0.4, 0.0, 0.5)}, pillars=pillars, seed=seed)
        arena.run(8, until=lambda one=one: one.place[2] > 0.35 or one.eaten > 0)
        free = all(pillar.gap(one.place) > 0 for pillar in pillars)
        right += free and one.place[0] < -0.05
    return right / SEEDS


def opportunism(kind):
    """On its way to a mate it passes food: it eats, and goes on to the mate."""
    done = 0
    for seed in range(SEEDS):
        one = fish(kind, "pacifist", fed=6, libido_growth=0.01, fatigue_time=1000.0)
        her = Fish(10, "fish", None, (0.0, 0.0, 0.9 + 0.01 * seed))
        her.mind = Resting()
        arena = Arena([one, her], seed=seed)
        one.place = (0.0, 0.0, 0.45)
        # Libido first, then the morsel drifts into view.
        for _ in range(45):
            arena.step()
            one.place = (0.0, 0.0, 0.0)
            one.yaw = one.pitch = 0.0
        arena.food = {50: (0.03, 0.0, 0.2)}
        ate = arena.run(8, until=lambda one=one: one.eaten > 0)
        there = arena.run(10, until=lambda one=one, her=her: distance(one.place, her.place) < 0.3)
        done += ate and there
    return done / SEEDS


def quickness(kind):
    """A shark appears before a feeding fish: the share of ten ticks that is left when it turns."""
    left = 0.0
    for seed in range(SEEDS):
        one = fish(kind, "prey")
        arena = Arena([one], food={50: (0.0, 0.0, 1.0)}, seed=seed)
        arena.run(1.5)
        ahead = add_scaled(one.place, one.heading, 0.5)
        arena.fishes.append(shark(ahead, one.yaw + math.pi))
        for tick in range(10):
            arena.step()
            if abs(one.wanted["turn"]) > 0.8 and one.wanted["target"] != 50:
                left += 1 - tick / 10
                break
    return left / SEEDS


def grading(kind):
    """Of two morsels, one by a tenth nearer, it goes to the nearer, whatever the distance."""
    nearer = 0
    for seed in range(SEEDS):
        far = 0.2 + 0.1 * seed
        side = 1 if seed % 2 else -1
        food = {
            50: (side * far * 0.5, 0.0, far * 0.87),
            51: (-side * far * 0.55, 0.0, far * 0.957),
        }
        one = fish(kind, "pacifist")
        arena = Arena([one], food=food, seed=seed)
        arena.run(15, until=lambda one=one: one.eaten > 0)
        nearer += 50 not in arena.food and 51 in arena.food
    return nearer / SEEDS


class Resting:
    """A female that waits."""

    def decide(self, percepts, *, seed=0):
        return {
            "behavior": "rest",
            "turn": 0.0,
            "pitch": 0.0,
            "brake": 1.0,
            "speed": 0.0,
            "mouth": 0.0,
            "target": None,
            "display": {"sex": "female", "act": "courting"},
        }


def add_scaled(place, direction, far):
    return tuple(a + b * far for a, b in zip(place, direction, strict=True))


TRIALS = {
    "priority": priority,
    "persistence": persistence,
    "compromise": compromise,
    "opportunism": opportunism,
    "quick response": quickness,
    "real-valued sensing": grading,
}
LEAST = {
    "priority": 0.9,
    "persistence": 0.8,
    "compromise": 0.9,
    "opportunism": 0.7,
    "quick response": 0.8,
    "real-valued sensing": 0.9,
}
"""What the mind of the artificial fish must reach."""


@pytest.mark.capability("TF-145", "TF-114")
@pytest.mark.parametrize("criterion", TRIALS)
def test_the_mind_of_intentions_meets_every_criterion(criterion):
    assert TRIALS[criterion]("intentions") >= LEAST[criterion]


@pytest.mark.capability("TF-146", "TF-145")
@pytest.mark.parametrize("kind", ["behavior_network", "free_flow"])
def test_the_baselines_run_the_same_suite_and_live(kind):
    scores = {name: trial(kind) for name, trial in TRIALS.items()}
    assert all(0 <= score <= 1 for score in scores.values())
    assert scores["priority"] >= 0.5, scores
    assert scores["real-valued sensing"] >= 0.5, scores


def table():
    """Return the measured table as Markdown."""
    lines = ["| criterion | " + " | ".join(KINDS) + " |", "|---|" + "---|" * len(KINDS)]
    for name, trial in TRIALS.items():
        lines.append(f"| {name} | " + " | ".join(f"{trial(kind):.2f}" for kind in KINDS) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
