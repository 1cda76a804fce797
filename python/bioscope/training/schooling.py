"""Many fishes that learn to live with a predator."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

import bioscope as bio
from bioscope.errors import InvalidValueError
from bioscope.training.observation import Observation, actions
from bioscope.training.pupil import Pupil

if TYPE_CHECKING:
    from gymnasium import spaces
    from numpy.typing import NDArray

TICKS = 3
_PREY, _PREDATOR = "anchovy", "barracuda"
_CENTER = (0.0, -3.0, 0.0)
_AT_HOME = 3.0


class _Hunter(Pupil):
    """Swims at the nearest prey that it sees, mouth open when near."""

    kind = "bioscope.training.Hunter"

    def decide(self, percepts: dict[str, Any]) -> dict[str, Any]:
        """Return the chase."""
        prey = [one for one in percepts["seen"] if one["species"] == _PREY]
        if not prey:
            home = np.asarray(percepts["home"])
            ahead = tuple(map(float, home)) if np.linalg.norm(home) > 1.0 else (0.3, 0.0, 1.0)
            return {"behavior": "search", "heading": ahead, "speed": 0.6}
        nearest = prey[0]
        near = float(np.linalg.norm(nearest["position"])) < percepts["body_length"]
        return {
            "behavior": "chase",
            "heading": nearest["position"],
            "speed": 1.4,
            "mouth": 1.0 if near else 0.0,
            "target": nearest["id"],
        }


class SchoolEnv(ParallelEnv):  # type: ignore[misc]  # the library has no types
    """Anchovies that stay together, apart and alive while a barracuda hunts them.

    Agents are named `anchovy_0`, `anchovy_1`, …; a name is never used twice. Each is rewarded in
    every step with 0.1 for staying alive, with up to 0.1 for keeping one to three body lengths
    from its nearest fellow and within 3 m of home, and -5 when it is caught, upon which it
    terminates. Every `newcomer_interval` seconds another fish joins, until `most` have lived.

    Parameters
    ----------
    count
        Fishes at the beginning.
    most
        Fishes that may live in one episode, newcomers included.
    newcomer_interval
        Seconds from one newcomer to the next; infinite for none.
    predators
        Barracudas.
    seconds
        World time after which all are truncated.
    """

    metadata: ClassVar[dict[str, Any]] = {"name": "school_v0", "render_modes": []}

    def __init__(
        self,
        count: int = 8,
        most: int = 12,
        newcomer_interval: float = 5.0,
        predators: int = 1,
        seconds: float = 30.0,
    ) -> None:
        if not 1 <= count <= most:
            raise InvalidValueError(f"count: {count}: expected 1 to most ({most})")
        for name, value in (("newcomer_interval", newcomer_interval), ("seconds", seconds)):
            if not value > 0.0:
                raise InvalidValueError(f"{name} = {value}: expected a number above 0")
        self._count, self._most = count, most
        self._interval, self._predators, self._seconds = newcomer_interval, predators, seconds
        self.observation = Observation(_PREY, _PREDATOR)
        self.possible_agents = [f"{_PREY}_{number}" for number in range(most)]
        self.agents: list[str] = []
        self.render_mode = None
        self.world: bio.World | None = None
        self._pupils: dict[str, Pupil] = {}
        self._random: np.random.Generator | None = None

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's observations."""
        del agent
        return self.observation.space

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's actions."""
        if not hasattr(self, "_actions"):
            self._actions = {name: actions() for name in self.possible_agents}
        return self._actions[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, dict[str, Any]]]:
        """Begin an episode in a new world; the same seed gives the same one."""
        del options
        if seed is not None or self._random is None:
            self._random, _ = seeding.np_random(seed)
        self.world = world = bio.World(int(self._random.integers(2**32)), dt=1 / 30)
        world.environment.water(surface=0.0, current=bio.Current(speed=0.03))
        self.agents, self._pupils = [], {}
        for _ in range(self._count):
            self._join()
        if self._predators:
            far = (3.0, -3.0, 3.0)
            world.add(
                bio.RoamingFish(
                    _PREDATOR, self._predators, center=far, radius=0.5, home=_CENTER, mind=_Hunter
                )
            )
        world.step(2)
        return self._observations(), {agent: {} for agent in self.agents}

    def step(
        self, actions: dict[str, NDArray[np.float32]]
    ) -> tuple[
        dict[str, NDArray[np.float32]],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Let all act for a tenth of a second."""
        if self.world is None or not self.agents:
            return {}, {}, {}, {}, {}
        for agent, action in actions.items():
            if agent not in self._pupils:
                expected = ", ".join(self.agents)
                raise InvalidValueError(f"actions of '{agent}': expected those of {expected}")
            self._pupils[agent].obey(action)
        if self._due():
            self._join()
        self.world.step(TICKS)
        caught = {event.subject for event in self.world.drain_events() if event.kind == "caught"}
        gone = {agent for agent in self.agents if self._identity(agent) in caught}
        over = self.world.time >= self._seconds
        rewards = {agent: -5.0 if agent in gone else self._reward(agent) for agent in self.agents}
        observations = self._observations()
        terminations = {agent: agent in gone for agent in self.agents}
        truncations = dict.fromkeys(self.agents, over)
        infos: dict[str, dict[str, Any]] = {agent: {} for agent in self.agents}
        self.agents = [] if over else [agent for agent in self.agents if agent not in gone]
        return observations, rewards, terminations, truncations, infos

    def _due(self) -> bool:
        """Say whether a newcomer's time comes in this step."""
        if self.world is None:
            return False
        now = self.world.time
        then = now + TICKS * self.world.dt
        return now // self._interval < then // self._interval

    def _join(self) -> None:
        """Let another fish join, if any may."""
        if self.world is None or len(self._pupils) >= self._most:
            return
        agent = self.possible_agents[len(self._pupils)]
        self._pupils[agent] = pupil = Pupil()
        self.world.add(
            bio.RoamingFish(_PREY, center=_CENTER, radius=0.8, home=_CENTER, mind=lambda: pupil)
        )
        self.agents.append(agent)

    def _identity(self, agent: str) -> int | None:
        identity: int | None = self._pupils[agent].percepts.get("id")
        return identity

    def _observations(self) -> dict[str, NDArray[np.float32]]:
        return {agent: self.observation.of(self._pupils[agent].percepts) for agent in self.agents}

    def _reward(self, agent: str) -> float:
        percepts = self._pupils[agent].percepts
        if not percepts:
            return 0.1
        length = percepts["body_length"]
        fellows = [
            float(np.linalg.norm(one["position"])) / length
            for one in percepts["seen"]
            if one["species"] == _PREY
        ]
        apart = min(fellows, default=np.inf)
        together = 1.0 if 1.0 <= apart <= 3.0 else np.exp(-abs(apart - 2.0) / 4.0)
        away = float(np.linalg.norm(percepts["home"]))
        return 0.1 + 0.1 * float(together) * (1.0 if away < _AT_HOME else 0.3)


def school_parallel_env(**settings: Any) -> SchoolEnv:
    """Return a `SchoolEnv` for PettingZoo's parallel interface; `settings` are its parameters."""
    return SchoolEnv(**settings)
