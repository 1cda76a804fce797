"""A hungry shark hunts fusiliers over sand, and lets the angelfishes be.

Watch for: the shark that picks the prey it meets alone; the school that bursts apart when it comes
near and gathers again; the angelfishes that feed on undisturbed, for the shark does not eat them.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 8.2, "Preying".
"""

from __future__ import annotations

import bioscope as bio
from bioscope.film.direction import Part, Shot, Story
from bioscope.worlds.seascape import seascape

FILM_SEED = 1
TRIAL = 40.0
"""How long the story is watched before it is filmed, seconds."""
PLATES = ("peaceful_world", "predator_chase", "fleeing_school")
_SHARK, _PREY = "blacktip_shark", "fusilier"


def world(seed: int) -> bio.World:
    """Make the hunting ground."""
    ground = seascape(seed, "preying")
    _settle_animals(ground)
    _place_cameras(ground)
    return ground


def _settle_animals(ground: bio.World) -> None:
    prey = bio.minds.Intentions(
        "prey", enemies=[_SHARK], food=["plankton"], habits=["school"], home_range=3.0
    )
    ground.add(bio.FishSchool(_PREY, 5, center=(1.5, -3.8, -0.5), half=(0.5, 0.3, 0.5), mind=prey))
    ground.add(bio.FishSchool(_PREY, 5, center=(-1.5, -3.8, 1.0), half=(2.0, 0.6, 2.0), mind=prey))
    peaceful = bio.minds.Intentions("pacifist", food=["plankton"], libido_growth=0.0)
    ground.add(
        bio.FishSchool(
            "emperor_angelfish", 3, center=(0.5, -4.3, 0.9), half=(1.0, 0.3, 0.6), mind=peaceful
        )
    )
    hunter = bio.minds.Intentions(
        "predator", food=[_PREY], stagger=0.0, appetite=2.0, home_range=4.0
    )
    ground.add(
        bio.RoamingFish(
            _SHARK, 1, center=(0.0, -3.2, 7.0), radius=0.3, home=(0.0, -3.8, 0.0), mind=hunter
        )
    )
    ground.add(bio.Plankton(700, low=(-4.0, -5.4, -4.0), high=(4.0, -1.0, 4.0)))


def _place_cameras(ground: bio.World) -> None:
    cameras = ground.cameras
    cameras.fixed("bay", position=(1.4, -4.5, 3.6), target=(0.4, -4.0, -0.4), field_of_view=56)
    cameras.follow("shark", species=_SHARK, offset=(1.0, 0.25, 0.9), field_of_view=48)
    cameras.follow("behind", species=_SHARK, offset=(0.35, 0.3, -1.1), field_of_view=56)
    cameras.follow("prey", species=_PREY, index=2, offset=(2.4, 0.4, 2.4), field_of_view=48)
    cameras.follow("angelfish", species="emperor_angelfish", offset=(2.2, 0.3, 2.0))
    ground.shots = [
        ("prey", 3.0),
        ("behind", 6.5),
        ("shark", 4.0),
        ("prey", 4.0),
        ("angelfish", 3.5),
        ("bay", 6.0),
    ]


def direct(story: Story) -> list[Shot]:
    """Film the peace before, the hunt up to the kills, and the peace after."""
    (shark,), prey = story.ids(_SHARK), story.ids(_PREY)
    grazer, neighbor, _ = story.ids("emperor_angelfish")
    kills = story.all("caught", _PREY)[:2]
    hunt, last = kills[0].time - 3.0, kills[-1].time
    fled = story.nearest(shark, prey, last + 3.0)[0]
    parts = [
        Part(3.5, story.nearest(prey[2], prey, 2.0)[:2], plate="fleeing_school", still=2.5),
        Part(hunt - 4.0, [grazer, neighbor], plate="peaceful_world", still=hunt - 4.5),
        Part(hunt, [shark], field_of_view=42.0),
    ]
    for kill, plate in zip(kills, ("predator_chase", ""), strict=False):
        both, still = [shark, kill.subject], kill.time - 0.4
        # The chase from afar, its end from near by.
        parts += [
            Part(kill.time - 1.6, both),
            Part(kill.time + 1.2, both, plate=plate, still=still),
        ]
    parts += [
        Part(last + 5.5, [fled, *story.nearest(fled, prey, last + 3.0, within=0.8)]),
        Part(last + 9.0, [grazer]),
        Part(last + 14.0, [shark], field_of_view=42.0),
    ]
    return story.sequence(parts)
