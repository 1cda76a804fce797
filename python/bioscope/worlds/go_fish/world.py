"""Hungry fishes forage among pillars; a hook is lowered, one of them bites and is hauled out.

Watch for: the fishes that zigzag from morsel to morsel; the worm that comes down on its line; the
one that takes it, throws itself from side to side and is gone, while the others feed on.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 8.1, the film "Go Fish!".
"""

from __future__ import annotations

import bioscope as bio
from bioscope.film.direction import Part, Shot, Story
from bioscope.worlds.seascape import pillar, seascape

FILM_SEED = 4
TRIAL = 40.0
"""How long the story is watched before it is filmed, seconds."""
PLATES = ("fishing_line", "hooked_fish")
_HOME = (0.0, -4.3, 0.2)
_BITE = "bait"


def world(seed: int) -> bio.World:
    """Make the bay, those who feed in it and the line."""
    bay = seascape(seed, "go_fish")
    pillar(bay, (-1.7, -1.2), 0.28, -2.9)
    pillar(bay, (1.9, -0.6), 0.22, -3.6)
    for species, count, food in [
        ("emperor_angelfish", 3, [_BITE]),
        ("parrotfish", 2, ["plankton"]),
        ("butterflyfish", 5, ["plankton"]),
        ("yellow_tang", 5, ["plankton"]),
    ]:
        hungry = bio.minds.Intentions(
            "pacifist", food=food, appetite=25.0, home_range=2.0, libido_growth=0.0
        )
        bay.add(bio.RoamingFish(species, count, center=_HOME, radius=1.4, mind=hungry))
    bay.add(bio.Plankton(900, low=(-3.0, -5.4, -2.4), high=(3.0, -2.4, 2.4)))
    bay.add(
        bio.FishingLine(
            (0.2, 0.4), bait=_BITE, start=9.0, depth=4.1, sinking=1.2, hauling=0.6, thickness=0.005
        )
    )
    _place_cameras(bay)
    return bay


def _place_cameras(bay: bio.World) -> None:
    cameras = bay.cameras
    cameras.fixed("bay", position=(0.7, -4.5, 2.3), target=(0.1, -4.25, 0.0), field_of_view=48)
    cameras.follow("angelfish", species="emperor_angelfish", offset=(2.2, 0.4, 2.2))
    cameras.follow("tang", species="yellow_tang", offset=(2.6, 0.5, 2.6))
    cameras.fixed("hook", position=(0.65, -4.25, 1.25), target=(0.2, -3.95, 0.4), field_of_view=42)
    cameras.fixed("haul", position=(0.75, -4.2, 1.4), target=(0.2, -2.9, 0.4), field_of_view=58)
    bay.shots = [("bay", 5.0), ("angelfish", 4.0), ("hook", 8.6), ("haul", 6.8), ("tang", 4.0)]


def direct(story: Story) -> list[Shot]:
    """Film the feeding, the worm that comes down, the bite, the haul, and the feeding after it."""
    (bite,) = story.all("hooked")
    (landing,) = story.all("caught", after=bite.time)
    caught = bite.subject
    (worm,) = (one.subject for one in story.all("eaten") if one.object == caught)
    tangs, angelfishes = story.ids("yellow_tang"), story.ids("emperor_angelfish")

    def feeding(until: float) -> Part:
        return Part(until, [tangs[0], *story.nearest(tangs[0], tangs, until - 2.0, within=0.6)])

    def through(eyes: int, until: float) -> Part:
        return Part(until, [eyes], field_of_view=62.0, eyes=True)

    waiting = [feeding(3.5), Part(6.5, [caught]), through(tangs[1], 9.5), Part(13.5, [worm])]
    return story.sequence(
        [one for one in waiting if one.end < bite.time - 5.0]
        + [
            Part(bite.time - 3.2, [worm, *story.nearest(worm, angelfishes, bite.time - 4.0)]),
            through(caught, bite.time - 1.2),
            Part(bite.time + 1.2, [worm, caught], plate="fishing_line", still=bite.time - 0.6),
            Part(landing.time + 0.3, [caught], plate="hooked_fish", still=bite.time + 2.0),
            feeding(landing.time + 4.5),
        ]
    )
