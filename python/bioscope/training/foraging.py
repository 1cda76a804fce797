"""One fish that learns to feed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium

import bioscope as bio
from bioscope.training.observation import Observation, actions
from bioscope.training.pupil import Pupil

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

TICKS = 3
"""World ticks per action."""
_SIDE = 1.2


class FishForaging(gymnasium.Env[Any, Any]):
    """A damselfish in a box of water with drifting food: swim to it and close the mouth on it.

    Actions are a `Pupil`'s: turn, climb, speed, mouth, each -1 to 1; ten are taken per second.
    Observations are those of `Observation` with food as the only species of interest. The reward
    is 1 for each morsel eaten, less 0.001 times the square of the speed asked for, so that haste
    costs. An episode never terminates by itself; it is truncated after `seconds`.

    Parameters
    ----------
    seconds
        World time of an episode.
    food
        How many morsels drift in the box.
    species
        The fish.
    render_mode
        None, or `rgb_array` for pictures by `render`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012

    def __init__(
        self,
        seconds: float = 30.0,
        food: int = 40,
        species: str = "anthias",
        render_mode: str | None = None,
    ) -> None:
        self.observation = Observation("food")
        self.observation_space = self.observation.space
        self.action_space = actions()
        self.render_mode = render_mode
        self._seconds, self._food, self._species = seconds, food, species
        self.world: bio.World | None = None
        self._pupil = Pupil()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode in a new world; the same seed gives the same one."""
        super().reset(seed=seed)
        del options
        self.world = world = bio.World(int(self.np_random.integers(2**32)), dt=1 / 30)
        world.environment.water(surface=0.0, current=bio.Current(speed=0.02))
        self._pupil = Pupil(food=["food"])
        middle = (0.0, -2.0, 0.0)
        low, high = (-_SIDE, -2.0 - _SIDE, -_SIDE), (_SIDE, -2.0 + _SIDE, _SIDE)
        world.add(
            bio.RoamingFish(
                self._species, center=middle, radius=0.3, mind=lambda: self._pupil, food=["food"]
            )
        )
        world.add(
            bio.Plankton(self._food, low=low, high=high, radius=(0.004, 0.006), species="food")
        )
        world.step(2)
        return self._observe(), {}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Act for a tenth of a second."""
        if self.world is None:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        self._pupil.obey(action)
        self.world.step(TICKS)
        eaten = sum(1 for event in self.world.drain_events() if event.kind == "eaten")
        reward = eaten - 0.001 * self._pupil.speed**2
        truncated = self.world.time >= self._seconds
        return self._observe(), reward, False, truncated, {"eaten": eaten}

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture of the box, 320 x 240."""
        if self.render_mode != "rgb_array" or self.world is None:
            return None
        camera = bio.Camera.looking_at((0.0, -1.4, 3.2), (0.0, -2.0, 0.0), 0.9)
        return bio.look(self.world.scene, camera, (320, 240)).picture()

    def _observe(self) -> NDArray[np.float32]:
        return self.observation.of(self._pupil.percepts)
