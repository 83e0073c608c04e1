# SPDX-License-Identifier: Apache-2.0
"""Another environment of these folders that notes what it observes and which actions it gets, if the
variable SHOAL_TEST_RECORD names a folder."""

import copy
import importlib
import os
import pathlib
import pickle

import gymnasium


class Recorded(gymnasium.Env):
    def __init__(self, of, render_mode=None, **kwargs):
        module, name = of.split(":")
        self._env = getattr(importlib.import_module(module), name)(**kwargs)
        self.observation_space, self.action_space = self._env.observation_space, self._env.action_space
        for name in ("compute_reward", "_max_episode_steps"):
            if hasattr(self._env, name):
                setattr(self, name, getattr(self._env, name))
        self._moments = []  # (None, observation) of a reset, (action, observation) of a step

    def reset(self, *, seed=None, options=None):
        observation, info = self._env.reset(seed=seed)
        self._moments.append((None, copy.deepcopy(observation)))
        return observation, info

    def step(self, action):
        result = self._env.step(action)
        self._moments.append((action.copy(), copy.deepcopy(result[0])))
        if (result[2] or result[3]) and "SHOAL_TEST_RECORD" in os.environ:
            file = pathlib.Path(os.environ["SHOAL_TEST_RECORD"]) / "moments"
            file.write_bytes(pickle.dumps(self._moments))
        return result
