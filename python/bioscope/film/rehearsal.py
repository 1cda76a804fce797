"""Rehearsal: when to give a cue so that something happens at a planned time.

Animals that decide for themselves follow no time table. To bring two events into one shot, X. Tu
("Artificial animals for computer animation", 1996, section 9.2) let one group wait, ran the other
alone, took down when its event came, and let the first group begin at the right moment. Done by
hand there, it is done by trial runs here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from bioscope.errors import InvalidValueError, LimitError

if TYPE_CHECKING:
    from bioscope.world import World
    from bioscope.world.events import Event


def rehearse(
    make: Callable[[], World],
    cue: Callable[[World], object],
    event: Callable[[Event], bool],
    at: float,
    *,
    tolerance: float = 1.0,
    patience: float = 60.0,
    trials: int = 8,
) -> float:
    """Return when to give a cue, in seconds from the beginning, by trial runs.

    Parameters
    ----------
    make
        Makes the world anew, the same each time.
    cue
        What is done to the world at the cue: a drive raised, a group let go.
    event
        Whether an event is the one that is planned.
    at
        When it is to happen, seconds from the beginning.
    tolerance
        How far from that it may happen, seconds.
    patience
        Seconds after the cue within which it must happen.
    trials
        Most trial runs.

    Raises
    ------
    InvalidValueError
        If there is less time than it takes, or a number is not positive.
    LimitError
        If no trial brought it near enough, or it did not happen.
    """
    for name, value in {"at": at, "tolerance": tolerance, "patience": patience}.items():
        if not (math.isfinite(value) and value > 0):
            raise InvalidValueError(f"{name} = {value}: expected a positive number of seconds")
    cue_at, missed = 0.0, math.inf
    for _ in range(trials):
        happened = _happened(make(), cue, event, cue_at, patience)
        if abs(happened - at) <= tolerance:
            return cue_at
        missed = min(missed, abs(happened - at))
        if cue_at == 0.0 and happened > at:
            raise InvalidValueError(f"at = {at}: expected at least the {happened:.1f} s it takes")
        cue_at = max(0.0, cue_at + at - happened)
    raise LimitError(f"no trial of {trials} came nearer to {at} s than {missed:.1f} s")


def _happened(
    world: World,
    cue: Callable[[World], object],
    event: Callable[[Event], bool],
    cue_at: float,
    patience: float,
) -> float:
    """Return when the event happened after a cue at this time."""
    world.run(cue_at)
    world.drain_events()
    cue(world)
    while world.time < cue_at + patience:
        world.step(3)
        for one in world.drain_events():
            if event(one):
                return one.time
    raise LimitError(f"it did not happen within {patience} s of the cue at {cue_at:.1f} s")
