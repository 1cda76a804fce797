"""A pair courts, anthias pick at plankton, a school passes behind, and a shark stalks it.

Watch for: everybody minding his own business before one lens: clownfishes that circle each other,
fusiliers that close ranks, and the blacktip that takes its time.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 8.1, the film "The
Undersea World of Jack Cousto".
"""

from __future__ import annotations

from functools import partial

import bioscope as bio
from bioscope.film.direction import Part, Shot, Story
from bioscope.worlds.seascape import Guide, seascape

FILM_SEED = 2
TRIAL = 60.0
"""How long the story is watched before it is filmed, seconds."""
PLATES = ("stalked_school",)
_SHARK, _PREY, _LEADER = "blacktip_shark", "fusilier", "parrotfish"


def world(seed: int) -> bio.World:
    """Make the bay with its cast."""
    bay = seascape(seed, "jack_cousto")
    _settle_pair(bay)
    _settle_background(bay)
    bay.add(bio.Plankton(1200, low=(-3.5, -5.4, -3.0), high=(3.5, -2.0, 3.5)))
    cameras = bay.cameras
    cameras.fixed("bay", position=(0.5, -4.6, 2.9), target=(0.2, -4.25, 0.0), field_of_view=50)
    cameras.fixed("pair", position=(0.9, -4.56, 2.3), target=(0.72, -4.55, 1.7), field_of_view=38)
    cameras.follow("school", species=_PREY, index=4, offset=(3.0, 0.5, 3.0), field_of_view=46)
    cameras.follow("shark", species=_SHARK, offset=(1.0, 0.25, 0.9), field_of_view=48)
    cameras.follow("feeders", species="anthias", index=2, offset=(3.0, 0.4, 2.5))
    bay.shots = [
        ("bay", 6.0),
        ("pair", 7.0),
        ("school", 4.0),
        ("shark", 5.0),
        ("pair", 4.0),
        ("feeders", 4.0),
        ("bay", 8.0),
    ]
    return bay


def _settle_pair(bay: bio.World) -> None:
    """Settle two who court in the foreground."""
    fond = bio.minds.Intentions(
        "pacifist",
        food=["plankton"],
        appetite=0.5,
        digestion=0.0,
        food_weight=0.2,
        libido_growth=0.01,
        mate_weight=0.0,
        home_range=0.6,
        spawning_depth=3.9,
    )
    at = (0.55, -4.55, 1.75)
    bay.add(bio.RoamingFish("clownfish", 2, center=at, radius=0.25, mind=fond, females=0.5))


def _settle_background(bay: bio.World) -> None:
    """Settle feeders in the middle, and a school with the shark that stalks it at the back."""
    feeder = bio.minds.Intentions(
        "pacifist", food=["plankton"], appetite=25.0, libido_growth=0.0, home_range=1.2
    )
    at = (-0.6, -4.4, 0.2)
    bay.add(bio.RoamingFish("anthias", 7, center=at, radius=0.7, mind=feeder))
    member = bio.minds.Intentions(
        "prey",
        enemies=[_SHARK],
        leaders=[_LEADER],
        habits=["school"],
        drive_threshold=1.0,
        fear_distance=4.0,
        home_range=30.0,
    )
    at, home = (-1.6, -3.7, -2.7), (0.0, -3.7, -2.6)
    bay.add(bio.RoamingFish(_PREY, 14, center=at, radius=0.7, mind=member))
    way = [(2.6, -3.6, -2.4), (-2.2, -3.7, -3.0)]
    guide = partial(Guide, way, home, 0.9)
    at = (-0.8, -3.7, -2.7)
    bay.add(
        bio.RoamingFish(
            _LEADER, 1, center=at, radius=0.1, home=home, mind=guide, body="muscle_swimmer"
        )
    )
    stalker = bio.minds.Intentions(
        "predator",
        food=[_PREY],
        stagger=0.0,
        appetite=2.0,
        cruise_speed=0.25,
        full_speed=0.3,
        home_range=3.5,
    )
    at = (-4.6, -3.4, -3.6)
    bay.add(bio.RoamingFish(_SHARK, 1, center=at, radius=0.2, home=home, mind=stalker))


def direct(story: Story) -> list[Shot]:
    """Film the pair with all that goes on behind it, and each of that by itself."""
    (shark,), school = story.ids(_SHARK), story.ids(_PREY)
    pair, feeders = story.ids("clownfish"), story.ids("anthias")
    kills = story.all("caught", _PREY)
    first, second = kills[0], kills[2]
    circling = story.all("circled", "clownfish")[0].time
    spawning = story.all("spawned", "clownfish")[0].time

    def few(of: list[int], until: float) -> Part:
        one = next(one for one in of[4:] if story.places([one], until))
        return Part(until, [one, *story.nearest(one, of, until - 2.0, within=0.6)[:3]])

    return story.sequence(
        [
            Part(first.time - 2.0, pair, [shark, *school[:4]]),
            Part(first.time + 1.5, [shark, first.subject]),
            few(school, first.time + 6.0),
            few(feeders, circling - 2.5),
            Part(
                circling + 4.5, pair, [shark, *school[:4]], plate="stalked_school", still=circling
            ),
            few(feeders, second.time - 3.0),
            Part(second.time + 1.5, [shark, second.subject]),
            Part(second.time + 8.0, pair, [shark, *school[:4]]),
            few(school, spawning - 4.0),
            Part(spawning + 3.0, pair),
        ]
    )
