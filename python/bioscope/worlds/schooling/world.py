"""Yellow tangs follow a blue tang on a zigzag; a pillar splits the school, which closes again.

Watch for: the two parts that pass the pillar on either side; the smaller one that hurries to catch
up; the leader, who goes his way and never looks back.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 8.2, "Schooling".
"""

from __future__ import annotations

from functools import partial

import bioscope as bio
from bioscope.worlds.seascape import Guide, pillar, seascape

FILM_SEED = 6
_MEMBER, _LEADER = "yellow_tang", "blue_tang"
_HOME = (0.0, -4.2, 0.0)
_WAY = [
    (2.6, -4.1, 0.6),
    (1.4, -4.3, -0.5),
    (0.5, -4.2, 0.75),
    (-1.6, -4.0, -0.6),
    (-3.8, -4.2, 0.5),
]
"""Corners of the leader's zigzag, metres."""


def world(seed: int) -> bio.World:
    """Make the bay with its pillar and the school."""
    bay = seascape(seed, "schooling")
    pillar(bay, (0.0, 0.0), 0.24, -2.7)
    # No hunger is strong enough to leave the school.
    member = bio.minds.Intentions(
        "prey",
        leaders=[_LEADER],
        habits=["school"],
        drive_threshold=1.0,
        spacing=1.1,
        school_radius=8.0,
        timidity=0.7,
        home_range=30.0,
    )
    start = (3.3, -4.2, 0.4)
    bay.add(bio.RoamingFish(_MEMBER, 20, center=start, radius=0.45, home=_HOME, mind=member))
    start = (2.8, -4.2, 0.5)
    # No faster than his school can follow without haste.
    guide = partial(Guide, _WAY, _HOME, 0.8)
    bay.add(
        bio.RoamingFish(
            _LEADER, 1, center=start, radius=0.05, home=_HOME, mind=guide, body="muscle_swimmer"
        )
    )
    bay.add(bio.Plankton(500, low=(-5.0, -5.5, -3.0), high=(5.0, -1.0, 4.0)))
    _place_cameras(bay)
    return bay


def _place_cameras(bay: bio.World) -> None:
    cameras = bay.cameras
    cameras.fixed("bay", position=(1.2, -4.6, 3.6), target=(1.0, -4.2, 0.0), field_of_view=52)
    cameras.fixed("pillar", position=(-0.8, -4.5, 2.1), target=(0.25, -4.05, 0.0), field_of_view=48)
    cameras.fixed("beyond", position=(-3.4, -4.5, 1.6), target=(0.0, -4.1, -0.2), field_of_view=44)
    cameras.follow("leader", species=_LEADER, offset=(2.4, 0.5, 3.2), field_of_view=46)
    cameras.follow("member", species=_MEMBER, index=9, offset=(6.0, 1.0, 3.0), field_of_view=46)
    bay.shots = [("bay", 8.0), ("leader", 7.0), ("pillar", 10.0), ("beyond", 7.0), ("member", 4.0)]
