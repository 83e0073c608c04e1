# SPDX-License-Identifier: Apache-2.0
"""Records what an update of PPO computes in Stable-Baselines3, for a test of ours to be held to.

usage: sb3_ppo.py FOLDER

Writes ppo.safetensors and ppo_clipped.safetensors to FOLDER: from state, two epochs of a rollout of
STEPS steps of ENVS environments; ppo_clipped with clipped values, an entropy bonus and a small
clip. Inputs are not stored but computed on both sides, as shared_numbers.py says.

In a file; rows are steps of environment 0 in order, then of environment 1:

  value, log_prob        of the rollout, by the policy before the update; advantage, target (R)
  permutation.E          rows in the order of epoch E
  M.gradient.NAME        of minibatch M, as the optimiser finds it: cut to the largest norm
  M.after.NAME           parameters after it
  policy_loss, value_loss, entropy_loss, approx_kl, clip_fraction   as logged after the update
"""

import os
import sys

import gymnasium
import numpy as np
import stable_baselines3
import torch
from safetensors.numpy import save_file
from stable_baselines3 import PPO
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.vec_env import DummyVecEnv

from shared_numbers import symmetric, uniform

STEPS, ENVS, BATCH, ACTIONS, VECTOR = 8, 2, 4, 3, 5


class Spaces(gymnasium.Env):
    """Nothing but the two spaces that a model asks for."""

    observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (VECTOR,), np.float32)
    action_space = gymnasium.spaces.Box(-1, 1, (ACTIONS,), np.float32)


def set_weights(policy):
    parameters = dict(policy.named_parameters())
    with torch.no_grad():
        for name, parameter in parameters.items():
            scale = 0.3
            if name != "log_std":
                fan_in = parameters[name.rsplit(".", 1)[0] + ".weight"].shape[1]
                scale = ((6 if name.endswith("weight") else 1) / fan_in) ** 0.5
            parameter.copy_(symmetric(name, parameter.shape, scale))


def rows(array):
    """(STEPS, ENVS, ...) to rows by environment."""
    return np.ascontiguousarray(np.swapaxes(np.asarray(array), 0, 1)).reshape(
        (STEPS * ENVS,) + np.asarray(array).shape[2:]).astype(np.float32)


def fill(model):
    """As collect_rollouts: environment 0 terminates after step 2, environment 1 is cut by a time
    limit after step 4, whose last observation is `final`."""
    buffer, policy = model.rollout_buffer, model.policy
    obs = symmetric("obs", (STEPS + 1, ENVS, VECTOR), 1.5)
    drawn = symmetric("drawn", (STEPS, ENVS, ACTIONS), 1.5)
    reward = symmetric("reward", (STEPS, ENVS), 2.0).numpy()
    final = symmetric("final", (1, VECTOR), 1.5)
    starts = np.zeros((STEPS + 1, ENVS), np.float32)
    starts[0] = 1
    starts[3, 0] = 1
    starts[5, 1] = 1
    buffer.reset()
    with torch.no_grad():
        reward[4, 1] += model.gamma * float(policy.predict_values(final))
        for t in range(STEPS):
            values, log_prob, _ = policy.evaluate_actions(obs[t], drawn[t])
            # The policy that acted was another one: ratios are not 1, and some are clipped.
            log_prob = log_prob + symmetric(f"moved{t}", (ENVS,), 0.3)
            buffer.add(obs[t].numpy(), drawn[t].numpy(), reward[t], starts[t], values, log_prob)
        last = policy.predict_values(obs[STEPS])
    buffer.compute_returns_and_advantage(last_values=last, dones=starts[STEPS])
    return {"value": rows(buffer.values), "log_prob": rows(buffer.log_probs),
            "advantage": rows(buffer.advantages), "target": rows(buffer.returns)}


class Scalars(Logger):
    def __init__(self, file):
        super().__init__(folder=None, output_formats=[])
        self.file = file

    def record(self, key, value, exclude=None):
        names = {"policy_gradient_loss": "policy_loss"}
        name = key.removeprefix("train/")
        name = names.get(name, name)
        if name in ("policy_loss", "value_loss", "entropy_loss", "approx_kl", "clip_fraction"):
            self.file[name] = np.array([value], np.float32)


def run(folder, name, **options):
    model = PPO("MlpPolicy", DummyVecEnv([Spaces] * ENVS), n_steps=STEPS, batch_size=BATCH,
                n_epochs=2, learning_rate=1e-3, gamma=0.9, gae_lambda=0.8, device="cpu",
                policy_kwargs={"net_arch": [7, 6]}, **options)
    set_weights(model.policy)
    file = fill(model)
    model._logger = Scalars(file)
    count = [0]
    step = model.policy.optimizer.step

    def recorded(*args, **kwargs):
        for key, parameter in model.policy.named_parameters():
            file[f"{count[0]}.gradient.{key}"] = parameter.grad.detach().numpy().copy()
        result = step(*args, **kwargs)
        for key, parameter in model.policy.named_parameters():
            file[f"{count[0]}.after.{key}"] = parameter.detach().numpy().copy()
        count[0] += 1
        return result

    model.policy.optimizer.step = recorded
    permutation, epoch = np.random.permutation, [0]

    def ours(n):
        order = np.argsort(uniform(f"order{epoch[0]}", n), kind="stable")
        file[f"permutation.{epoch[0]}"] = order.astype(np.float32)
        epoch[0] += 1
        return order

    np.random.permutation = ours
    try:
        model.train()
    finally:
        np.random.permutation = permutation
    path = os.path.join(folder, name + ".safetensors")
    versions = {"stable_baselines3": stable_baselines3.__version__, "torch": torch.__version__}
    save_file({k: np.array(v, np.float32) for k, v in file.items()}, path, metadata=versions)
    print(path, os.path.getsize(path), "bytes", len(file), "arrays")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    torch.set_num_threads(1)
    run(sys.argv[1], "ppo")
    run(sys.argv[1], "ppo_clipped", clip_range=0.1, clip_range_vf=0.05, ent_coef=0.01)


main()
