"""Direction: a trial run tells what will happen, and cameras are chosen that show it.

A world runs the same way each time from its seed. So the director watches it once without filming,
as Tu did by hand to bring events into one shot (X. Tu, "Artificial animals for computer animation",
1996, section 8.1), and then says where the camera swims when it does happen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bioscope import _engine
from bioscope.film.ground import Ground
from bioscope.senses.eye import look_many

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from bioscope._engine import Scene
    from bioscope.world import Event, World

_Point = NDArray[np.float64]

_WATCHED = 0.25
"""World time between two moments that are kept of a trial run, seconds."""
_MOMENTS = 9
"""Moments of a shot at which a point of view is tried."""
_SKETCH = (80, 45)
"""Pixels of the pictures by which points of view are compared."""
_SHORTEST, _LONGEST = 1.5, 12.0
"""Length of a shot that is worth a cut, and of one that is not yet too long, seconds."""
_EDGE, _CUT = 3, 1.5
"""Pixels of such a picture that are its edge; by how much it counts that a subject reaches it."""
_BEARINGS = 12
_HEIGHTS = (-0.15, 0.05, 0.3)
"""Of the lens over its subjects, as a share of its distance."""
_DISTANCES = (0.7, 1.0, 1.4)
"""In those at which all subjects just fill the picture."""
_BEST, _UNSEEN = 0.07, 2e-4
"""Share of the picture that one subject best fills; share that is as good as not at all."""
_DEPTH, _HEIGHT = 0.3, 0.25
"""Least depth of the lens, and least height over the ground, metres."""
_OUT = 50.0
"""By how much it counts to be elsewhere."""
_NEAR, _BLOCKED = 0.6, 8.0
"""Share of the way to the subjects within which other things are in the way; by how much it counts
how much of the picture they fill."""
_LEAST = 0.15
"""Least reach of subjects, metres: who is smaller is not shown larger."""
_ROOM = 0.6
"""Body lengths round the middle of a subject that are to be in the picture."""
_SNOUT = 0.55
"""From the middle of a subject to just before its snout, body lengths."""
_WIDE = np.array([0.6, 1.0, 0.6])
"""Pictures are wider than high: how far subjects reach on the level counts less."""


@dataclass(frozen=True)
class Shot:
    """Some seconds of a film from one point of view."""

    seconds: float
    camera: str = ""
    """A camera of the world; or else one that goes with subjects:"""
    subjects: tuple[int, ...] = ()
    """Identities of those whose middle it goes with."""
    arm: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """From their middle to the lens, in the distance at which they just fill the picture."""
    field_of_view: float = math.radians(46)
    """Vertical, radians."""
    plate: str = ""
    """Name of the still that is worth taking of it; none if empty."""
    moment: float = 0.0
    """When the still is taken, seconds from the shot's beginning."""
    eyes: bool = False
    """Whether it shows what the one subject has before its eyes."""


@dataclass(frozen=True)
class Part:
    """What a shot is to be about."""

    end: float
    """World time at which the next one begins, seconds."""
    subjects: Sequence[int]
    """Identities of those that it is about."""
    beyond: Sequence[int] = ()
    """Identities of those that are to be seen behind them."""
    field_of_view: float = 46.0
    """Vertical, degrees."""
    plate: str = ""
    still: float | None = None
    """World time at which the still is taken, seconds."""
    eyes: bool = False
    """Whether it is seen through the eyes of the one subject."""


class Story:
    """What happens in a world, found by a trial run.

    Parameters
    ----------
    world
        The world; it runs on.
    seconds
        How long it is watched, world time.
    """

    def __init__(self, world: World, seconds: float) -> None:
        self.events: list[Event] = []
        self.species: dict[int, str] = {}
        self._start = world.time
        self._scenes: list[Scene] = []
        self._ground = Ground(world.scene)
        while world.time - self._start < seconds:
            self._keep(world.scene)
            world.run(_WATCHED)
            self.events += world.drain_events()
        self._keep(world.scene)

    def _keep(self, scene: Scene) -> None:
        self._scenes.append(scene)
        for batch in scene.batches:
            if batch.alive:
                self.species.update((int(one), batch.species) for one in batch.ids)

    def all(self, kind: str, subject: str | None = None, after: float = 0.0) -> list[Event]:
        """Return the events of a kind, of subjects of a species if given, in order of time."""
        return [
            one
            for one in self.events
            if one.kind == kind
            and one.time >= after
            and (subject is None or self.species.get(one.subject) == subject)
        ]

    def ids(self, species: str) -> list[int]:
        """Return all that ever lived here of a species."""
        return [one for one, named in self.species.items() if named == species]

    def places(self, subjects: Sequence[int], time: float) -> dict[int, tuple[_Point, float]]:
        """Return where subjects are (metres) and how long (metres); the missing are left out."""
        index = round((time - self._start) / _WATCHED)
        scene = self._scenes[min(max(index, 0), len(self._scenes) - 1)]
        return _places(scene, subjects)

    def nearest(
        self, to: int, among: Sequence[int], time: float, within: float = math.inf
    ) -> list[int]:
        """Return these animals from the nearest to another one at this time to the farthest.

        Those farther away than `within` metres are left out.
        """
        places = {one: place for one, (place, _) in self.places([to, *among], time).items()}
        here = places.pop(to)
        away = {one: float(np.linalg.norm(place - here)) for one, place in places.items()}
        return sorted((one for one in away if away[one] < within), key=away.__getitem__)

    def sequence(self, parts: Sequence[Part]) -> list[Shot]:
        """Return the shots of a film, one after the other, from the start of the story.

        Parts that end before the last one did are left out; long ones are filmed in several shots.
        """
        shots, begin = [], self._start
        for part in parts:
            if part.end - begin < _SHORTEST:
                continue
            ends = np.linspace(begin, part.end, math.ceil((part.end - begin) / _LONGEST) + 1)[1:]
            for end in ends.tolist():
                shots.append(self._shot(begin, end - begin, part))
                begin = end
        return shots

    def _shot(self, begin: float, seconds: float, part: Part) -> Shot:
        """Return the shot of a part from where all its subjects are best seen."""
        angle = math.radians(part.field_of_view)
        times = np.linspace(begin, begin + seconds, _MOMENTS)
        scenes = [self._scenes[self._index(time)] for time in times]
        framed = [(scene, frame(scene, part.subjects)) for scene in scenes]
        kept = [(scene, one) for scene, one in framed if one is not None]
        if not kept:
            raise ValueError(f"nobody of {list(part.subjects)} is there {begin} s after the start")
        shot = Shot(seconds, "", tuple(part.subjects), field_of_view=angle, eyes=part.eyes)
        if not part.eyes:
            arms = list(_arms())
            wanted = [*part.subjects, *part.beyond]
            scores = sum(self._scores(scene, one, wanted, arms, angle) for scene, one in kept)
            shot = replace(shot, arm=arms[int(np.argmax(scores))])
        if part.still is None or not begin <= part.still < begin + seconds:
            return shot
        return replace(shot, plate=part.plate, moment=part.still - begin)

    def _scores(
        self,
        scene: Scene,
        framed: tuple[_Point, float],
        subjects: Sequence[int],
        arms: Sequence[tuple[float, float, float]],
        angle: float,
    ) -> NDArray[np.float64]:
        """Return how well subjects are seen from the end of each arm: the higher the better."""
        middle, reach = framed
        places = np.array([lens(middle, reach, arm, angle) for arm in arms])
        cameras = [
            _engine.Camera.looking_at(one, middle.tolist(), angle) for one in places.tolist()
        ]
        views = look_many(scene, cameras, _SKETCH)
        known = list(_places(scene, subjects))
        filled = [[(one.identity == subject).mean() for subject in known] for one in views]
        seen = np.array(filled) + _UNSEEN
        scores = np.asarray(np.log(np.minimum(seen, _BEST**2 / seen)).mean(axis=1), float)
        ways = _NEAR * np.linalg.norm(places - middle, axis=1)
        for index, (view, way) in enumerate(zip(views, ways, strict=True)):
            in_the_way = (view.depth < way) & ~np.isin(view.identity, known)
            scores[index] -= _BLOCKED * in_the_way.mean()
            inner = view.identity[_EDGE:-_EDGE, _EDGE:-_EDGE]
            cut = np.isin(view.identity, known).sum() - np.isin(inner, known).sum()
            scores[index] -= _CUT * (cut > 0)
        surface = scene.medium["surface"]
        if surface is not None:
            scores[places[:, 1] > surface - _DEPTH] -= _OUT
        scores[places[:, 1] < self._ground.height(places) + _HEIGHT] -= _OUT
        return scores

    def _index(self, time: float) -> int:
        return min(max(round((time - self._start) / _WATCHED), 0), len(self._scenes) - 1)


def _places(scene: Scene, subjects: Sequence[int]) -> dict[int, tuple[_Point, float]]:
    found = {}
    for batch in scene.batches:
        for row in np.flatnonzero(np.isin(batch.ids, subjects)):
            length = float(np.ptp(batch.mesh.positions, axis=0).max())
            scale = float(batch.transforms[row][3])
            place = np.array(batch.positions[row], float)
            found[int(batch.ids[row])] = (place, length * scale)
    return found


def frame(scene: Scene, subjects: Sequence[int]) -> tuple[_Point, float] | None:
    """Return the middle of those subjects that are there, and how far they reach, metres."""
    found = list(_places(scene, subjects).values())
    if not found:
        return None
    middle = np.mean([place for place, _ in found], axis=0)
    reach = max(
        float(np.linalg.norm((place - middle) * _WIDE)) + _ROOM * length for place, length in found
    )
    return middle, max(reach, _LEAST)


def before_eyes(scene: Scene, subject: int) -> tuple[_Point, _Point] | None:
    """Return the place just before the snout of a subject, metres, and where it heads."""
    found = _places(scene, [subject]).get(subject)
    if found is None:
        return None
    place, length = found
    batch = next(one for one in scene.batches if subject in one.ids)
    x, y, z, w = (float(one) for one in batch.rotations[np.flatnonzero(batch.ids == subject)[0]])
    ahead = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    return place + ahead * (_SNOUT * length), ahead


def drift(scene: Scene, subjects: Sequence[int]) -> _Point:
    """Return the mean velocity of those subjects that are there, m/s."""
    moving = [batch for batch in scene.batches if len(batch.velocities)]
    found = [batch.velocities[np.isin(batch.ids, subjects)] for batch in moving]
    every = np.concatenate([np.zeros((0, 3)), *found])
    return np.asarray(every.mean(axis=0), float) if len(every) else np.zeros(3)


def lens(middle: _Point, reach: float, arm: tuple[float, float, float], angle: float) -> _Point:
    """Return where the lens of a shot is."""
    return middle + np.array(arm) * (reach / math.tan(angle / 2))


def _arms() -> Iterator[tuple[float, float, float]]:
    for number in range(_BEARINGS):
        bearing = math.tau * number / _BEARINGS
        for share in _DISTANCES:
            for height in _HEIGHTS:
                yield share * math.sin(bearing), share * height, share * math.cos(bearing)
