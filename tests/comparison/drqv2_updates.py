# SPDX-License-Identifier: Apache-2.0
"""Records updates of DrQ-v2 (Yarats et al. 2021, arXiv:2107.09645) and shifted pictures, computed
with PyTorch, for tests that compare Shoal with them.

usage: drqv2_updates.py FOLDER

Writes updates.safetensors and shifts.safetensors to FOLDER. Needs torch and safetensors from PyPI;
no part of Shoal needs Python. Inputs (weights, batches, noise) are not stored, because
shared_numbers.py and the tests compute the same numbers.

updates.safetensors: u = 0..3 counts updates; NAME is a parameter ("encoder.0.weight",
"actor.policy.4.bias", "critic.q1.0.weight", "target.trunk.1.bias"):

  u.critic_loss, u.actor_loss
  u.target                      y of the critic's loss (B)
  u.gradient.NAME               as the optimiser's step gets it
  u.after.NAME                  parameters at the end of the update, with targets

Of an array of more than 1024 numbers every n-th is kept, n the least that leaves at most 256.

shifts.safetensors: "shifted" (9, 2, 12, 12) f32. Picture k is shifted by k columns and 8 - k rows
of its picture that is padded by 4 pixels, by the grid of the paper's program.
"""

import copy
import os
import sys

import numpy as np
import torch
import torch.nn.functional as F
from safetensors.numpy import save_file
from torch import nn

from shared_numbers import Random, bytes_of, symmetric

BATCH, ACTIONS, UPDATES, SEED = 8, 3, 4, 7
CHANNELS, SIDE, FEATURES, HIDDEN = 9, 17, 24, [20, 16]
RATE, DISCOUNT, TAU = 1e-3, 0.99, 0.01
NOISE, NOISE_CLIP, STEPS_OF_UPDATE = (1.0, 0.1, 1000), 0.3, 400


def mlp(inputs, outputs):
    return nn.Sequential(nn.Linear(inputs, HIDDEN[0]), nn.ReLU(), nn.Linear(HIDDEN[0], HIDDEN[1]),
                         nn.ReLU(), nn.Linear(HIDDEN[1], outputs))


def trunk(inputs):
    return nn.Sequential(nn.Linear(inputs, FEATURES), nn.LayerNorm(FEATURES), nn.Tanh())


class Encoder(nn.Sequential):
    def __init__(self):
        layers = []
        for i in range(4):
            layers += [nn.Conv2d(CHANNELS if i == 0 else 32, 32, 3, stride=2 if i == 0 else 1),
                       nn.ReLU()]
        super().__init__(*layers)

    def forward(self, pixels):
        return super().forward(pixels / 255 - 0.5).flatten(1)


class Actor(nn.Module):
    def __init__(self, inputs):
        super().__init__()
        self.trunk, self.policy = trunk(inputs), mlp(FEATURES, ACTIONS)

    def forward(self, h):
        return torch.tanh(self.policy(self.trunk(h)))


class Critic(nn.Module):
    def __init__(self, inputs):
        super().__init__()
        self.trunk = trunk(inputs)
        self.q1, self.q2 = mlp(FEATURES + ACTIONS, 1), mlp(FEATURES + ACTIONS, 1)

    def forward(self, h, action):
        joined = torch.cat([self.trunk(h), action], dim=1)
        return self.q1(joined), self.q2(joined)


def set_weights(module, prefix):
    """Weights U(+-sqrt(6 / fan_in)), biases U(+-1 / sqrt(fan_in)), as in sb3_updates.py."""
    parameters = dict(module.named_parameters())
    with torch.no_grad():
        for name, parameter in parameters.items():
            fan_in = parameters[name.rsplit(".", 1)[0] + ".weight"][0].numel()
            scale = ((6 if name.endswith("weight") else 1) / fan_in) ** 0.5
            parameter.copy_(symmetric(f"{prefix}.{name}", parameter.shape, scale))


def deviation(step):
    first, last, duration = NOISE
    share = min(max(step / duration, 0), 1)
    return (1 - share) * first + share * last


def noisy(action, sigma, normals):
    """The gradient passes the last clip as if it were not there."""
    sample = action + torch.clamp(sigma * normals, -NOISE_CLIP, NOISE_CLIP)
    clipped = torch.clamp(sample, -1 + 1e-6, 1 - 1e-6)
    return sample + (clipped - sample).detach()


class Recorder:
    def __init__(self):
        self.update, self.file = 0, {}

    def keep(self, name, tensor):
        numbers = np.array(tensor.detach().numpy(), np.float32).reshape(-1)
        if numbers.size > 1024:
            numbers = numbers[:: -(-numbers.size // 256)].copy()
        self.file[f"{self.update}.{name}"] = numbers

    def keep_parameters(self, kind, modules, of):
        for prefix, module in modules.items():
            for name, parameter in module.named_parameters():
                self.keep(f"{kind}.{prefix}.{name}", of(parameter))


def record_updates():
    encoder = Encoder()
    inputs = encoder(torch.zeros(1, CHANNELS, SIDE, SIDE)).shape[1]
    actor, critic = Actor(inputs), Critic(inputs)
    target = copy.deepcopy(critic)
    trained = {"encoder": encoder, "actor": actor, "critic": critic}
    for prefix, module in {**trained, "target": target}.items():
        set_weights(module, prefix)  # the target differs much from the critic
    optimisers = {prefix: torch.optim.Adam(module.parameters(), lr=RATE)
                  for prefix, module in trained.items()}
    recorder = Recorder()
    for update in range(UPDATES):
        recorder.update = update
        at = f"update{update}."
        pixels, next_pixels = (bytes_of(at + name, (BATCH, CHANNELS, SIDE, SIDE)).float()
                               for name in ("pixels", "next_pixels"))
        action = symmetric(at + "action", (BATCH, ACTIONS), 1.0)
        reward = symmetric(at + "reward", (BATCH, 1), 2.0)
        bootstrap = torch.ones(BATCH, 1)
        bootstrap[update % BATCH] = bootstrap[(update + 3) % BATCH] = 0
        random = Random(SEED, Random.LEARNER_UPDATE, update, 0)
        sigma = deviation(STEPS_OF_UPDATE * update)

        with torch.no_grad():
            next_h = encoder(next_pixels)
            next_action = noisy(actor(next_h), sigma, random.normal((BATCH, ACTIONS)))
            y = reward + DISCOUNT * bootstrap * torch.minimum(*target(next_h, next_action))
        h = encoder(pixels)
        q1, q2 = critic(h, action)
        critic_loss = F.mse_loss(q1, y) + F.mse_loss(q2, y)
        for prefix in ("encoder", "critic"):
            optimisers[prefix].zero_grad()
        critic_loss.backward()
        recorder.keep_parameters("gradient", {"encoder": encoder, "critic": critic},
                                 lambda parameter: parameter.grad)
        for prefix in ("encoder", "critic"):
            optimisers[prefix].step()

        h = h.detach()  # of the encoder before its step
        sample = noisy(actor(h), sigma, random.normal((BATCH, ACTIONS)))
        actor_loss = -torch.minimum(*critic(h, sample)).mean()
        optimisers["actor"].zero_grad()
        actor_loss.backward()
        recorder.keep_parameters("gradient", {"actor": actor}, lambda parameter: parameter.grad)
        optimisers["actor"].step()

        with torch.no_grad():
            for online, average in zip(critic.parameters(), target.parameters()):
                average.copy_(TAU * online + (1 - TAU) * average)
        for name, tensor in (("critic_loss", critic_loss), ("actor_loss", actor_loss),
                             ("target", y)):
            recorder.keep(name, tensor)
        recorder.keep_parameters("after", {**trained, "target": target},
                                 lambda parameter: parameter)
    return recorder.file


def record_shifts(pad=4, side=12, channels=2):
    pictures = bytes_of("shift.pixels", (2 * pad + 1, channels, side, side)).float()
    padded = F.pad(pictures, (pad, pad, pad, pad), "replicate")
    whole = side + 2 * pad
    centres = torch.linspace(-1 + 1 / whole, 1 - 1 / whole, whole)[:side]
    grid = torch.stack([centres.repeat(side, 1), centres.repeat(side, 1).T], dim=2)
    columns = torch.arange(2 * pad + 1.0)
    shift = torch.stack([columns, 2 * pad - columns], dim=1).reshape(-1, 1, 1, 2) * (2 / whole)
    shifted = F.grid_sample(padded, grid + shift, padding_mode="zeros", align_corners=False)
    return {"shifted": shifted.numpy()}


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    torch.set_num_threads(1)
    for name, arrays in (("updates", record_updates()), ("shifts", record_shifts())):
        path = os.path.join(sys.argv[1], name + ".safetensors")
        save_file(arrays, path, metadata={"torch": torch.__version__})
        print(path, os.path.getsize(path), "bytes", len(arrays), "arrays")


main()
