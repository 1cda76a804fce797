"""Minds: percepts in, an intention out; the engine's minds of fishes, and minds of one's own."""

from bioscope.minds.fish import BehaviorNetwork, FishMind, FreeFlow, Intentions, asked
from bioscope.minds.own import Mind, Reviving, from_function, kinds, maker

__all__ = [
    "BehaviorNetwork",
    "FishMind",
    "FreeFlow",
    "Intentions",
    "Mind",
    "Reviving",
    "asked",
    "from_function",
    "kinds",
    "maker",
]
