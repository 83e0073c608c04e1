# SPDX-License-Identifier: Apache-2.0
"""Goal environments: a point in a plane is to reach a place."""

import gymnasium
import numpy as np
from gymnasium import spaces


class Reach(gymnasium.Env):
    def __init__(self, render_mode=None):
        numbers = spaces.Box(-np.inf, np.inf, (2,), np.float64)
        self.observation_space = spaces.Dict(
            {"observation": numbers, "achieved_goal": numbers, "desired_goal": numbers}
        )
        self.action_space = spaces.Box(-1, 1, (2,), np.float32)
        self._max_episode_steps = 20  # as Gymnasium's TimeLimit notes it

    def compute_reward(self, achieved_goal, desired_goal, info):
        return -float(np.linalg.norm(achieved_goal - desired_goal) > 0.05)

    def reset(self, *, seed=None, options=None):
        random = np.random.default_rng(seed)
        self._place, self._goal = random.uniform(-0.2, 0.2, (2, 2))
        self._steps = 0
        return self._observation(), {}

    def step(self, action):
        self._place = self._place + 0.05 * action
        self._steps += 1
        reward = self.compute_reward(self._place, self._goal, {})
        return self._observation(), reward, False, self._steps == 20, {"is_success": reward == 0}

    def _observation(self):
        return {"observation": self._place, "achieved_goal": self._place, "desired_goal": self._goal}


class Dense(Reach):
    def compute_reward(self, achieved_goal, desired_goal, info):
        return -float(np.linalg.norm(achieved_goal - desired_goal))


class Box(Reach):
    """Reached within a square, which is no threshold on the distance."""

    def compute_reward(self, achieved_goal, desired_goal, info):
        return -float(np.abs(achieved_goal - desired_goal).max() > 0.05)
