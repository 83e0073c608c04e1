"""A cart on a rail is to stop under a light. Its velocity obeys the action with a delay."""

import gymnasium
import numpy as np
from gymnasium import spaces


class CatchLight(gymnasium.Env):
    def __init__(self, rail=1.0, render_mode=None):
        self.rail = rail
        self.render_mode = render_mode
        self.observation_space = spaces.Box(-10, 10, (3,), np.float32)  # place, velocity, light
        self.action_space = spaces.Box(-2, 2, (1,), np.float32)  # force

    def reset(self, *, seed=None, options=None):
        random = np.random.default_rng(seed)
        self.place, self.light = random.uniform(-self.rail, self.rail, 2)
        self.velocity, self.steps = 0.0, 0
        return self.observe(), {}

    def step(self, action):
        self.velocity += 0.1 * float(action[0]) - 0.1 * self.velocity
        self.place = float(np.clip(self.place + 0.1 * self.velocity, -10, 10))
        self.steps += 1
        distance = abs(self.place - self.light)
        info = {"is_success": distance < 0.1}
        return self.observe(), -distance, False, self.steps == 100, info

    def observe(self):
        return np.array([self.place, self.velocity, self.light], np.float32)

    def render(self):
        picture = np.full((64, 192, 3), 40, np.uint8)
        for place, colour in ((self.light, (255, 220, 0)), (self.place, (80, 160, 255))):
            column = int(np.clip(96 + 40 * place, 4, 187))
            picture[20:44, column - 4 : column + 4] = colour
        return picture
