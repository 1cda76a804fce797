"""Worlds as training environments: Gymnasium for one fish, PettingZoo for many.

Importing this module registers the Gymnasium ids `bioscope/FishForaging-v0`. It needs the extra
`rl`: `pip install "bioscope[rl]"`.

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

if "bioscope/FishForaging-v0" not in _gymnasium.registry:
    _gymnasium.register(
        id="bioscope/FishForaging-v0", entry_point="bioscope.training.foraging:FishForaging"
    )

__all__ = ["FishForaging", "Observation", "Pupil", "SchoolEnv", "school_parallel_env"]
