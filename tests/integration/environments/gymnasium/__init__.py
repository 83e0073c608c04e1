# SPDX-License-Identifier: Apache-2.0
"""As much of Gymnasium's interface as the tests' environments need: CI has no network to install it.

`./run python` runs tests with the real package.
"""

import importlib
import types

from gymnasium import spaces

_REGISTERED = {
    "Point-v0": ("point:Point", 40),
    "Picture-v0": ("point:Picture", 30),
}


def spec(name):
    if name not in _REGISTERED:
        raise LookupError(f"Environment `{name}` doesn't exist.")
    where, steps = _REGISTERED[name]
    return types.SimpleNamespace(id=name, entry_point=where, max_episode_steps=steps)


class TimeLimit:
    def __init__(self, env, steps):
        self.env = env
        self._max_episode_steps = steps
        self.observation_space, self.action_space = env.observation_space, env.action_space
        self._elapsed = 0

    def reset(self, *, seed=None, options=None):
        self._elapsed = 0
        return self.env.reset(seed=seed, options=options)

    def step(self, action):
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._elapsed += 1
        return observation, reward, terminated, truncated or self._elapsed >= self._max_episode_steps, info

    def render(self):
        return self.env.render()


def make(spec, disable_env_checker=False, **kwargs):
    module, name = spec.entry_point.split(":")
    return TimeLimit(getattr(importlib.import_module(module), name)(**kwargs), spec.max_episode_steps)


class Env:
    pass


__all__ = ["Env", "make", "spaces", "spec"]
