# SPDX-License-Identifier: Apache-2.0
"""A point on a line that is to come to rest at a place. Cheap, and learned within a minute."""

import time

import gymnasium
import numpy as np
from gymnasium import spaces


class Point(gymnasium.Env):
    """observation: place, target; action: the velocity, -2 to 2; reward: minus the distance."""

    def __init__(self, fault=None, after=60, limit=None, render_mode=None):
        self.observation_space = spaces.Dict(
            {
                "place": spaces.Box(-10, 10, (1,), np.float32),
                "aims": spaces.Dict({"target": spaces.Box(-1, 1, (1,), np.float64)}),
            }
        )
        self.action_space = spaces.Box(-2, 2, (1,), np.float32)
        self._fault, self._after, self._steps = fault, after, 0
        self._limit, self._elapsed = limit, 0

    def _observation(self):
        return {"place": self._place.astype(np.float32), "aims": {"target": self._target}}

    def reset(self, *, seed=None, options=None):
        self._elapsed = 0
        self._random = np.random.default_rng(seed)
        self._place, self._target = self._random.uniform(-1, 1, (2, 1))
        return self._observation(), {}

    def step(self, action):
        assert action.shape == (1,) and action.dtype == np.float32
        self._steps += 1
        self._elapsed += 1
        self._place = np.clip(self._place + 0.1 * action, -10, 10)
        distance = float(abs(self._place - self._target)[0])
        observation = self._observation()
        if self._fault is not None and self._steps > self._after:
            observation = self._fault(observation)
        return observation, -distance, False, self._elapsed == self._limit, {"is_success": distance < 0.1}

    def render(self):
        picture = np.zeros((48, 64, 3), np.uint8)
        picture[:, int(np.clip(16 * self._place[0] + 32, 0, 63))] = 255
        return picture


class Short(Point):
    """Its episodes have 40 steps."""

    def __init__(self, render_mode=None):
        super().__init__(limit=40)


class Picture(Point):
    """The same, seen: the place is a white column, the target a red one; 24 x 32 pixels."""

    def __init__(self, channels_first=False, render_mode=None):
        super().__init__(limit=30)
        self._first = channels_first
        shape = (3, 24, 32) if channels_first else (24, 32, 3)
        self.observation_space = spaces.Box(0, 255, shape, np.uint8)

    def _observation(self):
        picture = np.zeros((24, 32, 3), np.uint8)
        picture[:, int(np.clip(8 * self._target[0] + 16, 0, 31)), 0] = 255
        picture[:, int(np.clip(8 * self._place[0] + 16, 0, 31))] = 255
        return np.ascontiguousarray(picture.transpose(2, 0, 1)) if self._first else picture


class Slow(Point):
    """Its step takes at least 2 ms, and so does reading its observation."""

    def __init__(self, render_mode=None):
        super().__init__(limit=40)

    def _observation(self):
        return SlowToRead(super()._observation())

    def step(self, action):
        _spin(0.002)
        return super().step(action)


class SlowToRead(dict):
    def __getitem__(self, key):
        if key == "place":
            _spin(0.002)
        return super().__getitem__(key)


def _spin(seconds):
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        pass
