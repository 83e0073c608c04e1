# SPDX-License-Identifier: Apache-2.0
"""Shoal's worlds and renderer as a Gymnasium environment."""

import json
import os
import warnings

import gymnasium
import numpy as np

from shoal_rl import _native

_SECTIONS = {
    "observation": (
        "pixels",
        "cameras",
        "grey",
        "height",
        "width",
        "stack",
        "goal_mode",
        "proprioception",
        "quality",
        "custom_cameras",
    ),
    "randomization": ("body_mass",),
    None: (
        "task_library",
        "model",
        "physics",
        "action_repeat",
        "end_on_success",
        "distance_threshold",
    ),
}


def _configuration(keys):
    """Keys of make() as the JSON of a configuration, whose reader checks the values."""
    section_of = {key: section for section, names in _SECTIONS.items() for key in names}
    configuration = {}
    for key, value in keys.items():
        if key not in section_of:
            raise _native.Error(f"make has no key '{key}'; expected {', '.join(section_of)}")
        section = section_of[key]
        place = configuration if section is None else configuration.setdefault(section, {})
        place[key] = os.fspath(value) if isinstance(value, os.PathLike) else value
    try:
        return json.dumps(configuration)
    except TypeError as error:
        raise _native.Error(f"make: a key's value has no JSON: {error}") from None


class Environment(gymnasium.Env):
    """A task as a Gymnasium environment; shoal_rl.make returns it.

    Observation: a dict of `pixels` (K*C, H, W) uint8 and of the vectors that the keys select, float32.
    With goal_mode="image", `pixels` is ((K+1)*C, H, W) and the last C channels show the goal reached.
    Action: Box(-1, 1). info: `distance` (m) and `is_success`, if the task has a goal.
    If a number of the simulation is not finite, the step truncates the episode: it returns the previous
    observation and reward 0, and info's `fault` and a RuntimeWarning give the reason.
    reset(seed=s) starts the first episode of the seed s; reset() starts the next one.
    """

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(self, task, *, render_mode=None, **keys):
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise _native.Error(f"render_mode is '{render_mode}'; expected None or 'rgb_array'")
        self._native = _native.Environment(task, _configuration(keys))
        self.task = task
        self.cameras = self._native.cameras
        self.render_mode = render_mode
        spaces = {}
        if self._native.pixels is not None:
            spaces["pixels"] = gymnasium.spaces.Box(0, 255, self._native.pixels, np.uint8)
        elif render_mode is not None:
            raise _native.Error("render_mode 'rgb_array' shows the pixels; expected pixels=True")
        for name, size in self._native.blocks.items():
            spaces[name] = gymnasium.spaces.Box(-np.inf, np.inf, (size,), np.float32)
        self.observation_space = gymnasium.spaces.Dict(spaces)
        self.action_space = gymnasium.spaces.Box(-1, 1, (self._native.action_size,), np.float32)
        if render_mode is not None:
            self.metadata = {**self.metadata, "render_fps": self._frames_per_second()}
        self._seed = None
        self._episode = 0
        self._pixels = None

    def _frames_per_second(self):
        """By the simulation's clock, over one step of an episode that is not shown."""
        self._native.reset(0, 0)
        start = self._native.simulated_seconds
        *_, fault = self._native.step(np.zeros(self._native.action_size, np.float32))
        if fault is not None:
            raise _native.Error(fault)
        return round(1 / (self._native.simulated_seconds - start), 3)

    def _info(self, success, distance):
        if not self._native.has_success:
            return {}
        return {"is_success": success, "distance": distance}

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if seed is not None:
            self._seed, self._episode = seed % 2**64, 0
        elif self._seed is None:
            self._seed = int(self.np_random.integers(2**63))
        else:
            self._episode += 1
        observation, distance = self._native.reset(self._seed, self._episode)
        self._pixels = observation.get("pixels")
        # Nothing has been done yet, wherever the goal is.
        return observation, self._info(False, distance)

    def step(self, action):
        observation, reward, *ends, success, distance, fault = self._native.step(action)
        terminated, truncated = ends
        self._pixels = observation.get("pixels")
        info = self._info(success, distance)
        if fault is not None:
            info["fault"] = fault
            warnings.warn(fault, RuntimeWarning, stacklevel=2)
        return observation, reward, terminated, truncated, info

    def render(self):
        """The latest frame (H, cameras * W, 3); grey ones in three equal channels."""
        if self.render_mode is None or self._pixels is None:
            return None
        channels, height, width = self._pixels.shape
        stack = self._native.stack
        shown = channels // (stack + self._native.goal_picture)
        frame = self._pixels[(stack - 1) * shown : stack * shown].reshape(len(self.cameras), -1, height, width)
        colours = np.broadcast_to(frame, (len(self.cameras), 3, height, width))
        return colours.transpose(2, 0, 3, 1).reshape(height, -1, 3)
