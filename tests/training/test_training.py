"""Worlds as training environments."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from bioscope import training
from bioscope.errors import InvalidValueError


def seeker(env: training.FishForaging, observation: np.ndarray) -> np.ndarray:
    """Swim at the nearest morsel, mouth open."""
    seen, x, y, z = observation[11:15]
    if seen == 0.0:
        return np.array([0.4, 0.0, 0.0, -1.0], np.float32)
    turn = np.arctan2(x, z) / (np.pi / 2)
    climb = np.arcsin(np.clip(y, -1, 1)) / (np.pi / 4)
    return np.clip(np.array([turn, climb, -0.4, 1.0]), -1, 1).astype(np.float32)


def play(policy, seed: int) -> float:
    env = training.FishForaging(seconds=20.0)
    observation, _ = env.reset(seed=seed)
    total, over = 0.0, False
    while not over:
        observation, reward, _, over, _ = env.step(policy(env, observation))
        total += reward
    return total


def test_gymnasium_accepts_it():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("bioscope/FishForaging-v0", seconds=1.0, render_mode="rgb_array")
        check_env(env.unwrapped)
    env.reset(seed=2)
    picture = env.render()
    assert picture.shape == (240, 320, 3)
    assert picture.std() > 1.0


def test_gymnasium_accepts_the_body_alone():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("bioscope/FishSwimming-v0", seconds=1.0)
        check_env(env.unwrapped)
    env.reset(seed=1)
    with pytest.raises(InvalidValueError, match="activations"):
        env.step(np.full(12, np.nan, np.float32))
    with pytest.raises(InvalidValueError, match="seconds"):
        training.FishSwimming(seconds=float("nan"))


def test_muscles_that_beat_in_turn_swim_and_those_at_rest_do_not():
    def swum(beats: bool) -> float:
        env = training.FishSwimming(seconds=6.0)
        env.reset(seed=3)
        way, time, over = 0.0, 0.0, False
        while not over:
            fore = np.sin(2 * np.pi * 2.0 * time) if beats else 0.0
            sides = [max(fore, 0.0)] * 2 + [max(-fore, 0.0)] * 2
            action = np.array([0.0] * 4 + sides + sides[2:] + sides[:2], np.float32)
            _, reward, _, over, info = env.step(action)
            way, time = way + info["way"], time + 1 / 30
            assert reward <= info["way"]
        return way

    assert swum(True) > swum(False) + 2.0


def test_the_same_seed_gives_the_same_episode():
    def episode():
        env = training.FishForaging(seconds=2.0)
        observations = [env.reset(seed=5)[0]]
        actions = np.random.default_rng(1).uniform(-1, 1, (10, 4)).astype(np.float32)
        observations += [env.step(action)[0] for action in actions]
        return np.array(observations)

    np.testing.assert_array_equal(episode(), episode())


def test_who_seeks_food_eats_more_than_who_does_not():
    still = np.array([0.0, 0.0, -1.0, 1.0], np.float32)
    seekers = [play(seeker, seed) for seed in (1, 2, 3)]
    idlers = [play(lambda _env, _observation: still, seed) for seed in (1, 2, 3)]
    assert sum(seekers) > sum(idlers) + 4.0, (seekers, idlers)


def test_stepping_before_a_reset_is_refused():
    with pytest.raises(gymnasium.error.ResetNeeded):
        training.FishForaging().step(np.zeros(4, np.float32))


def test_pettingzoo_accepts_it():
    env = training.school_parallel_env(count=3, most=5, newcomer_interval=1.0, seconds=4.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(env, num_cycles=60)
    parallel_seed_test(lambda: training.school_parallel_env(count=2, seconds=1.5), num_cycles=12)


def test_who_joins_is_observed_at_once():
    env = training.school_parallel_env(count=2, most=3, newcomer_interval=0.5, seconds=2.0)
    env.reset(seed=2)
    still = np.array([0.0, 0.0, -1.0, -1.0], np.float32)
    for _ in range(5):
        found = env.step(dict.fromkeys(env.agents, still))
    assert len(env.agents) == 3
    assert all(set(part) == set(env.agents) for part in found)
    assert np.abs(found[0]["anchovy_2"]).max() > 0.0


@pytest.mark.parametrize("action", [np.full(4, np.nan), np.zeros(3), None, "left"])
def test_actions_that_are_none_are_refused(action):
    alone = training.FishForaging(seconds=1.0)
    alone.reset(seed=1)
    with pytest.raises(InvalidValueError, match="action"):
        alone.step(action)
    many = training.school_parallel_env(count=1, seconds=1.0)
    many.reset(seed=1)
    with pytest.raises(InvalidValueError, match="action"):
        many.step({"anchovy_0": action})
    with pytest.raises(InvalidValueError, match="herring_0"):
        many.step({"herring_0": np.zeros(4)})


def test_agents_come_and_go_and_names_are_never_used_twice():
    env = training.school_parallel_env(count=5, most=8, newcomer_interval=2.0, seconds=25.0)
    env.reset(seed=4)
    still = np.array([0.0, 0.0, -1.0, -1.0], np.float32)
    lived, gone, rewards = set(env.agents), set(), {}
    while env.agents:
        before = set(env.agents)
        _, rewards, terminations, _, _ = env.step(dict.fromkeys(env.agents, still))
        newly_gone = {agent for agent, over in terminations.items() if over}
        assert all(rewards[agent] == -5.0 for agent in newly_gone)
        gone |= newly_gone
        newcomers = set(env.agents) - before
        assert not newcomers & lived
        lived |= newcomers
    assert len(lived) == 8
    assert gone, "a barracuda among fishes that rest catches some"
