"""Worlds as training environments: Gymnasium for one fish, PettingZoo for many.

Importing this module registers the Gymnasium ids `bioscope/FishForaging-v0` (senses in, orders to
the motor controllers out) and `bioscope/FishSwimming-v0` (what the body feels in, contractions of
its muscles out). It needs the extra `rl`: `pip install "bioscope[rl]"`.

Examples
--------
>>> import gymnasium
>>> import bioscope.training
>>> env = gymnasium.make("bioscope/FishForaging-v0", seconds=1.0)
>>> observation, info = env.reset(seed=1)
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

from bioscope.errors import MissingExtraError

try:
    import gymnasium as _gymnasium
    import pettingzoo as _pettingzoo  # noqa: F401
except ImportError as error:
    raise MissingExtraError("training", "rl") from error

from bioscope.training.foraging import FishForaging
from bioscope.training.observation import Observation
from bioscope.training.pupil import Pupil
from bioscope.training.schooling import SchoolEnv, school_parallel_env
from bioscope.training.swimming import FishSwimming

for _name, _place in (("FishForaging", "foraging"), ("FishSwimming", "swimming")):
    if f"bioscope/{_name}-v0" not in _gymnasium.registry:
        _gymnasium.register(
            id=f"bioscope/{_name}-v0", entry_point=f"bioscope.training.{_place}:{_name}"
        )

__all__ = [
    "FishForaging",
    "FishSwimming",
    "Observation",
    "Pupil",
    "SchoolEnv",
    "school_parallel_env",
]
