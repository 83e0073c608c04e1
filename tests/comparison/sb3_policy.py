# SPDX-License-Identifier: Apache-2.0
"""Holds Stable-Baselines3 to the actions of Shoal's own networks, on files of `shoal export --sb3`.

usage: sb3_policy.py SHOAL CHECKPOINT...

Exports each checkpoint (a folder), makes the model that the command prints around an environment of
the same observations and actions, loads the file with set_parameters(exact_match=False), and
predicts the actions of a file of samples. Every parameter of the file must be one of the model's.
Prints the largest difference of an action for each and exits with 1 where one is above 1e-4. Wants
stable-baselines3 and safetensors from PyPI; nothing of Shoal needs Python. Checkpoints:

  build/release/bin/random-checkpoints /tmp/checkpoints sb3
  sb3_policy.py build/release/bin/shoal /tmp/checkpoints/*-sb3*/checkpoints/step_*
"""

import json
import os
import subprocess
import sys
import tempfile

import gymnasium
import numpy as np
import stable_baselines3
import torch
from safetensors.numpy import load_file
from stable_baselines3 import DDPG, PPO, SAC, TD3  # what the printed line calls
from stable_baselines3.common.save_util import load_from_zip_file
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

MOST = 1e-4


class Surroundings(gymnasium.Env):
    """An environment of these spaces, in which nothing is ever played."""

    def __init__(self, observations, actions):
        if observations.dtype == np.uint8:
            self.observation_space = gymnasium.spaces.Box(0, 255, observations.shape[1:], np.uint8)
        else:
            self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, observations.shape[1:])
        self.action_space = gymnasium.spaces.Box(-1, 1, actions.shape[1:])


def observations_of(checkpoint, samples):
    if "pixels" in samples:
        return samples["pixels"]
    with open(os.path.join(checkpoint, "policy.json")) as file:
        blocks = json.load(file)["spec"]["blocks"]
    return np.concatenate([samples[b["name"]] for b in blocks if b["name"] in samples], axis=1)


def largest_difference(line, zip_file, observations, actions):
    env = DummyVecEnv([lambda: Surroundings(observations, actions)])
    _, parameters, variables = load_from_zip_file(zip_file, load_data=False)
    if variables:
        env = VecNormalize(env, training=False, norm_reward=False)
        env.obs_rms.mean = variables["observation.mean"].numpy()
        env.obs_rms.var = variables["observation.variance"].numpy()
        observations = env.normalize_obs(observations)
    model = eval(line, {"SAC": SAC, "TD3": TD3, "DDPG": DDPG, "PPO": PPO, "torch": torch, "env": env})
    own = model.policy.state_dict()
    unknown = [name for name in parameters["policy"] if name not in own]
    assert not unknown, unknown
    before, _ = model.predict(observations, deterministic=True)
    model.set_parameters(zip_file, exact_match=False)
    after, _ = model.predict(observations, deterministic=True)
    assert np.abs(before - actions).max() > MOST, "nothing was to be seen of the parameters"
    return np.abs(after - actions).max()


def main(shoal, checkpoints):
    worst = 0.0
    for checkpoint in checkpoints:
        with tempfile.TemporaryDirectory() as folder:
            exported, samples = os.path.join(folder, "p.zip"), os.path.join(folder, "p.safetensors")
            said = subprocess.run(
                [shoal, "export", checkpoint, "--sb3", exported, "--samples", samples],
                check=True,
                capture_output=True,
                text=True,
            ).stdout
            line = next(s.split(" = ", 1)[1] for s in said.splitlines() if s.startswith("  model = "))
            tensors = load_file(samples)
            difference = largest_difference(
                line, exported, observations_of(checkpoint, tensors), tensors["action"]
            )
        print(f"{difference:.1e}  {checkpoint}  {line}", flush=True)
        worst = max(worst, difference)
    version = stable_baselines3.__version__
    print(f"largest of {len(checkpoints)}: {worst:.1e} (Stable-Baselines3 {version})")
    return 0 if worst <= MOST else 1


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2:]))
