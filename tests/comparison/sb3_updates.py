# SPDX-License-Identifier: Apache-2.0
"""Records what a few updates of Stable-Baselines3 compute, for a test of ours to be held to.

usage: sb3_updates.py FOLDER

Writes td3.safetensors and ddpg.safetensors to FOLDER: from state, without noise on the target's
action; and sac.safetensors: from pixels, CnnPolicy. Inputs (weights, observations, actions, rewards,
noise) are not stored: both sides compute them from shared_numbers.py, so that the files hold results
alone. Wants stable-baselines3 and safetensors
from PyPI; nothing of Shoal needs Python.

In a file, u = 0..3 counts updates; NAME is a tensor's name in Stable-Baselines3 after its model's
("actor.mu.0.weight", "critic.qf0.0.bias", "critic_target.qf0.0.bias"):

  u.critic_loss, u.actor_loss   as logged; actor_loss in updates that move the actor
  u.ent_coef                    the entropy coefficient that the update's losses are made with
  u.target                      y of the critic's loss (B)
  u.gradient.NAME               as the optimiser's step finds it
  u.after.NAME                  parameters when the update is over, targets too

Of an array of more than 1024 numbers every n-th is kept, n the least that leaves at most 256.
"""

import os
import sys

import gymnasium
import numpy as np
import stable_baselines3
import torch
from safetensors.numpy import save_file
from stable_baselines3 import DDPG, SAC, TD3
from stable_baselines3.common.buffers import ReplayBufferSamples
from stable_baselines3.common.logger import Logger
from stable_baselines3.sac import sac
from stable_baselines3.td3 import td3

from shared_numbers import Random, bytes_of, symmetric

BATCH, ACTIONS, VECTOR, UPDATES = 8, 3, 11, 4
HIDDEN = [20, 16]
IMAGE, FEATURES, SEED = (3, 36, 36), 24, 7


class Spaces(gymnasium.Env):
    """Nothing but the two spaces that a model asks for."""

    observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (VECTOR,), np.float32)
    action_space = gymnasium.spaces.Box(-1, 1, (ACTIONS,), np.float32)


def set_weights(module, prefix, small=()):
    """Weights U(+-sqrt(6 / fan_in)), so that no layer fades; biases U(+-1 / sqrt(fan_in)). Those of
    the layers `small` a tenth of it."""
    parameters = dict(module.named_parameters())
    with torch.no_grad():
        for name, parameter in parameters.items():
            fan_in = parameters[name.rsplit(".", 1)[0] + ".weight"][0].numel()
            numerator = 6 if name.endswith("weight") else 1
            scale = (numerator / fan_in) ** 0.5
            if name.split(".")[0] in small:
                scale *= 0.1
            parameter.copy_(symmetric(f"{prefix}.{name}", parameter.shape, scale))


def batch(update):
    at = f"update{update}."
    dones = torch.zeros(BATCH, 1)
    dones[update % BATCH] = 1
    dones[(update + 3) % BATCH] = 1
    return ReplayBufferSamples(
        observations=symmetric(at + "obs", (BATCH, VECTOR), 1.5),
        actions=symmetric(at + "action", (BATCH, ACTIONS), 1.0),
        next_observations=symmetric(at + "next_obs", (BATCH, VECTOR), 1.5),
        dones=dones,
        rewards=symmetric(at + "reward", (BATCH, 1), 2.0),
    )


class Recorder:
    def __init__(self):
        self.update, self.file = 0, {}

    def keep(self, name, tensor):
        numbers = np.array(tensor.detach().numpy(), np.float32)  # a copy
        if numbers.size > 1024:
            numbers = numbers.reshape(-1)[:: -(-numbers.size // 256)].copy()
        self.file[f"{self.update}.{name}"] = numbers

    def watch_optimiser(self, prefix, module):
        step = module.optimizer.step

        def recorded(*args, **kwargs):
            for name, parameter in module.named_parameters():
                self.keep(f"gradient.{prefix}.{name}", parameter.grad)
            return step(*args, **kwargs)

        module.optimizer.step = recorded


class Scalars(Logger):
    def __init__(self, recorder):
        super().__init__(folder=None, output_formats=[])
        self.recorder = recorder

    def record(self, key, value, exclude=None):
        if key in ("train/actor_loss", "train/critic_loss", "train/ent_coef"):
            self.recorder.keep(key[len("train/") :], torch.tensor([float(value)]))


def run(kind, folder, **options):
    model = kind("MlpPolicy", Spaces(), batch_size=BATCH, buffer_size=64, device="cpu",
                 policy_kwargs={"net_arch": HIDDEN}, **options)
    modules = {"actor": model.actor, "critic": model.critic, "actor_target": model.actor_target,
               "critic_target": model.critic_target}
    recorder = Recorder()
    model._logger = Scalars(recorder)
    for prefix, module in modules.items():
        set_weights(module, prefix)  # targets are far from what they follow
    for prefix in ("actor", "critic"):
        recorder.watch_optimiser(prefix, modules[prefix])

    mse = td3.F.mse_loss

    def recorded_mse(q, y):
        recorder.keep("target", y.reshape(-1))
        return mse(q, y)

    td3.F.mse_loss = recorded_mse
    try:
        for update in range(UPDATES):
            recorder.update = update
            model.replay_buffer.sample = lambda *_, **__: batch(recorder.update)
            model.train(gradient_steps=1, batch_size=BATCH)
            for prefix, module in modules.items():
                for name, parameter in module.named_parameters():
                    recorder.keep(f"after.{prefix}.{name}", parameter)
    finally:
        td3.F.mse_loss = mse
    save(recorder, folder, kind)


def pixel_batch(update):
    return batch(update)._replace(
        observations=bytes_of(f"update{update}.pixels", (BATCH, *IMAGE)),
        next_observations=bytes_of(f"update{update}.next_pixels", (BATCH, *IMAGE)),
    )


def run_sac(folder):
    Spaces.observation_space = gymnasium.spaces.Box(0, 255, IMAGE, np.uint8)
    model = SAC("CnnPolicy", Spaces(), batch_size=BATCH, buffer_size=64, gamma=0.95, device="cpu",
                policy_kwargs={"net_arch": HIDDEN, "normalize_images": True,
                               "features_extractor_kwargs": {"features_dim": FEATURES}})
    # They add 1e-6 in the logarithm of 1 - tanh(u)^2, against log 0; Shoal's form needs nothing.
    model.actor.action_dist.epsilon = 0.0
    modules = {"actor": model.actor, "critic": model.critic, "critic_target": model.critic_target}
    recorder = Recorder()
    model._logger = Scalars(recorder)
    for prefix, module in modules.items():
        # Far from saturation, where 1 - tanh(u)^2 loses its digits.
        set_weights(module, prefix, small=("mu", "log_std"))
    for prefix in ("actor", "critic"):
        recorder.watch_optimiser(prefix, modules[prefix])
    mse = sac.F.mse_loss

    def recorded_mse(q, y):
        recorder.keep("target", y.reshape(-1))
        return mse(q, y)

    sac.F.mse_loss = recorded_mse
    model.replay_buffer.sample = lambda *_, **__: pixel_batch(recorder.update)
    for update in range(UPDATES):
        recorder.update = update
        # Shoal draws for the next observations first.
        random = Random(SEED, Random.LEARNER_UPDATE, update, 0)
        noise = [random.normal((BATCH, ACTIONS)) for _ in range(2)]
        torch.distributions.normal._standard_normal = lambda shape, **_: noise.pop()
        model.train(gradient_steps=1, batch_size=BATCH)
        assert not noise
        for prefix, module in modules.items():
            for name, parameter in module.named_parameters():
                recorder.keep(f"after.{prefix}.{name}", parameter)
        recorder.keep("after.log_ent_coef", model.log_ent_coef)
    sac.F.mse_loss = mse
    save(recorder, folder, SAC)


def save(recorder, folder, kind):
    path = os.path.join(folder, kind.__name__.lower() + ".safetensors")
    versions = {"stable_baselines3": stable_baselines3.__version__, "torch": torch.__version__}
    save_file(recorder.file, path, metadata=versions)
    print(path, os.path.getsize(path), "bytes", len(recorder.file), "arrays")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    torch.set_num_threads(1)
    run(TD3, sys.argv[1], target_policy_noise=0.0)
    run(DDPG, sys.argv[1])
    run_sac(sys.argv[1])


main()
