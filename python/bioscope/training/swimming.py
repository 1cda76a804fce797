"""One body that learns to swim with its muscles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces

from bioscope.errors import InvalidValueError
from bioscope.fish import Tank

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HELD = 1 / 30
_MUSCLES, _NODES = 12, 23
_BOUND = 100.0


class FishSwimming(gymnasium.Env[Any, Any]):
    """The muscle-driven body alone in still water: find out how to swim ahead.

    Actions are the contractions (12,) of its muscles, 0 at rest to 1, as `Tank.step` takes them,
    held for a thirtieth of a second. Observations (150,) are what a body feels, in its own frame
    (x left, y up, z ahead): the places of its 23 nodes from its center in body lengths, their
    velocities in body lengths per second, and the present contractions. The reward is the way made
    along +Z, in body lengths, less `effort` times the work of the muscles in units of the energy
    of the body at its cruising speed. An episode is truncated after `seconds`.

    Learning to swim without being told how is that of R. Grzeszczuk and D. Terzopoulos, "Automated
    learning of muscle-actuated locomotion through control abstraction", SIGGRAPH 1995.

    Parameters
    ----------
    species
        The fish.
    seconds
        World time of an episode.
    effort
        What work costs.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self, species: str = "anthias", seconds: float = 10.0, effort: float = 0.02
    ) -> None:
        if not 0.0 < seconds < np.inf:
            raise InvalidValueError(f"seconds = {seconds}: expected a number above 0")
        self.tank = Tank(species)
        self._species, self._seconds, self._effort = species, seconds, effort
        self._steps = max(1, round(_HELD / self.tank.dt))
        self._time = 0.0
        self.action_space = spaces.Box(0.0, 1.0, (_MUSCLES,), np.float32)
        size = 6 * _NODES + _MUSCLES
        self.observation_space = spaces.Box(-_BOUND, _BOUND, (size,), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin at rest, but for a push of up to a tenth of the cruising speed."""
        super().reset(seed=seed)
        del options
        self.tank = Tank(self._species)
        push = self.np_random.uniform(-0.1, 0.1, 3) * self.tank.cruise
        self.tank.kick(push.tolist())
        self._time = 0.0
        return self._observe(), {}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Contract the muscles for a thirtieth of a second."""
        tank = self.tank
        before, work = tank.center[2], tank.work
        tank.step(np.clip(action, 0.0, 1.0), steps=self._steps)
        self._time += self._steps * tank.dt
        way = float(tank.center[2] - before) / tank.length
        energy = 0.5 * tank.mass * tank.cruise**2
        spent = max(0.0, tank.work - work) / energy
        info = {"way": way, "work": spent}
        over = self._time >= self._seconds
        return self._observe(), way - self._effort * spent, False, over, info

    def _observe(self) -> NDArray[np.float32]:
        """Return places and velocities in the body's own frame, and contractions."""
        tank = self.tank
        nodes = tank.nodes
        ahead = _unit(nodes[1:5].mean(axis=0) - nodes[9:13].mean(axis=0))
        left = _unit(np.cross((0.0, 1.0, 0.0), ahead))
        frame = np.stack([left, np.cross(ahead, left), ahead], axis=1)
        places = (nodes - tank.center) @ frame / tank.length
        speeds = tank.node_velocities @ frame / tank.length
        felt = np.concatenate([places.ravel(), speeds.ravel(), tank.contraction])
        return felt.clip(-_BOUND, _BOUND).astype(np.float32)


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the vector with length 1."""
    unit: NDArray[np.float64] = vector / max(float(np.linalg.norm(vector)), 1e-12)
    return unit
