# SPDX-License-Identifier: Apache-2.0
"""Environments that cost next to nothing, so that what Shoal adds to a step can be measured
(tests/benchmark/hosted_actors.h). Run as a program it prints the CPU seconds of their own steps as JSON."""

import json
import time

import gymnasium
import numpy as np
from gymnasium import spaces

STEPS = 1000  # of an episode


class State(gymnasium.Env):
    """Observes three numbers."""

    def __init__(self, render_mode=None):
        self.action_space = spaces.Box(-1, 1, (1,), np.float32)
        self.observation_space = spaces.Box(-10, 10, (3,), np.float32)
        self._observation = np.zeros(3, np.float32)
        self._info = {}

    def reset(self, *, seed=None, options=None):
        self._steps = 0
        return self._observation, self._info

    def step(self, action):
        self._steps += 1
        return self._observation, 0.0, False, self._steps == STEPS, self._info


class Picture(State):
    """Observes one picture of 84x84."""

    def __init__(self, render_mode=None):
        super().__init__()
        self.observation_space = spaces.Box(0, 255, (84, 84, 3), np.uint8)
        self._observation = np.zeros((84, 84, 3), np.uint8)


def seconds_of_step(environment):
    action = np.zeros(1, np.float32)
    environment.reset()
    count = 200_000
    begin = time.process_time()
    for _ in range(count):
        environment.step(action)
    return (time.process_time() - begin) / count


if __name__ == "__main__":
    print(json.dumps({kind.__name__: seconds_of_step(kind()) for kind in (State, Picture)}))
