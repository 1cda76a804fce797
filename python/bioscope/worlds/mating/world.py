"""Two male idols court one female; the larger wins her, and the other finds somebody else.

Watch for: the male that loops before the female's head while she hovers and bobs; the pair that
circles, each after the other's tail; the ascent; three touches from below, and spawning.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 8.2, "Mating".
"""

from __future__ import annotations

import bioscope as bio
from bioscope.film.direction import Part, Shot, Story
from bioscope.worlds.seascape import seascape

FILM_SEED = 5
TRIAL = 80.0
"""How long the story is watched before it is filmed, seconds."""
PLATES = ("courting_pair",)
_IDOL, _ANGELFISH, _BUTTERFLYFISH = "moorish_idol", "emperor_angelfish", "butterflyfish"
_CAST = [
    # Species, share of females, how many, where.
    (_IDOL, 0.0, 2, (0.0, -4.2, 0.6)),
    (_IDOL, 1.0, 1, (0.3, -4.3, 0.9)),
    (_BUTTERFLYFISH, 1.0, 1, (-1.2, -4.3, 0.2)),
    (_ANGELFISH, 0.5, 2, (1.6, -4.1, -0.6)),
]


def world(seed: int) -> bio.World:
    """Make the bay and those who court in it."""
    bay = seascape(seed, "mating")
    # A morsel stills their hunger; then they think of mating alone.
    mind = bio.minds.Intentions(
        "pacifist",
        food=["plankton"],
        appetite=0.5,
        digestion=0.0,
        food_weight=0.2,
        libido_growth=0.01,
        mate_weight=0.0,
        cruise_speed=1.7,
        home_range=1.5,
        spawning_depth=2.8,
    )
    for species, females, count, center in _CAST:
        pair = bio.RoamingFish(
            species, count, center=center, radius=0.5, mind=mind, females=females
        )
        bay.add(pair)
    bay.add(bio.Plankton(900, low=(-4.0, -5.5, -3.0), high=(4.0, -2.0, 4.0)))
    _place_cameras(bay)
    return bay


def _place_cameras(bay: bio.World) -> None:
    cameras = bay.cameras
    cameras.follow("suitor", species=_IDOL, index=1, offset=(3.4, 0.5, 1.6), field_of_view=44)
    cameras.follow("bride", species=_IDOL, index=2, offset=(3.4, 0.3, 1.2), field_of_view=42)
    cameras.follow("pair", species=_ANGELFISH, index=0, offset=(2.6, 0.3, 0.8), field_of_view=42)
    cameras.follow("ascent", species=_IDOL, index=1, offset=(3.2, -0.4, 0.8), field_of_view=44)
    cameras.follow("spawning", species=_IDOL, index=2, offset=(2.8, -0.3, 0.8), field_of_view=42)
    cameras.follow("other", species=_BUTTERFLYFISH, offset=(3.6, 0.4, 1.4), field_of_view=42)
    bay.shots = [
        ("suitor", 6.0),
        ("pair", 6.0),
        ("bride", 8.0),
        ("pair", 7.0),
        ("bride", 6.0),
        ("other", 5.0),
        ("ascent", 8.0),
        ("spawning", 10.0),
    ]


def direct(story: Story) -> list[Shot]:
    """Film the rivals, the dances of both pairs, the loser, and the spawning."""
    circling = story.all("circled", _IDOL)[0]
    # Events of courtship have the partner for their object; none would be nobody, 0.
    groom, bride = circling.subject, circling.object or 0
    loser = next(one for one in story.ids(_IDOL) if one not in (groom, bride))
    pair, other = story.ids(_ANGELFISH), story.ids(_BUTTERFLYFISH)
    nuzzling = story.all("mated", _IDOL)[0].time
    spawning = story.all("spawned", _IDOL)[0].time
    second = story.all("spawned", _ANGELFISH)[0].time
    return story.sequence(
        [
            Part(5.0, [groom, loser, bride]),
            Part(10.0, pair),
            Part(circling.time - 5.0, [groom, bride]),
            Part(
                circling.time + 5.0,
                [groom, bride],
                plate="courting_pair",
                still=circling.time + 2.0,
            ),
            Part(circling.time + 10.0, pair),
            Part(circling.time + 15.0, [loser, *other]),
            Part(nuzzling, [groom, bride]),
            Part((nuzzling + spawning) / 2, [groom, bride]),
            Part(spawning + 2.0, [groom, bride]),
            Part(max(spawning, second) + 2.0, pair),
        ]
    )
