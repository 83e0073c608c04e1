# SPDX-License-Identifier: Apache-2.0
"""A walk along a cliff, for prioritised sampling: one wrong action ends an episode without reward.

At each of LENGTH positions one half of the actions is right and leads to the next position; which
half depends on the position. The last position gives the only reward, 1. Random actions therefore
succeed in 2^-LENGTH of the episodes. After the blind cliff walk of Schaul et al. 2016,
arXiv:1511.05952, section 3.1, with actions in [-1, 1] in place of two actions.
"""

import gymnasium
import numpy as np
from gymnasium import spaces

LENGTH = 12
RIGHT = (1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, -1)  # sign of the right actions at each position


class CliffWalk(gymnasium.Env):
    def __init__(self, render_mode=None):
        self.render_mode = render_mode
        self.observation_space = spaces.Box(0, 1, (LENGTH,), np.float32)
        self.action_space = spaces.Box(-1, 1, (1,), np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.position = 0
        return self.observe(), {}

    def step(self, action):
        fell = float(action[0]) * RIGHT[self.position] <= 0
        arrived = not fell and self.position == LENGTH - 1
        if not fell and not arrived:
            self.position += 1
        return self.observe(), float(arrived), fell or arrived, False, {"is_success": arrived}

    def observe(self):
        observation = np.zeros(LENGTH, np.float32)
        observation[self.position] = 1
        return observation
