# SPDX-License-Identifier: Apache-2.0
"""Records losses and gradients of MR.Q (Fujimoto et al. 2025, arXiv:2501.16142), computed by the
published code, for a test that compares Shoal with them.

usage: mrq_updates.py CODE FOLDER

CODE is the folder MRQ of a clone of https://github.com/facebookresearch/MRQ. Writes
updates.safetensors to FOLDER. Needs torch and safetensors from PyPI; no part of Shoal needs Python.
Inputs (weights, batches) are not stored, because shared_numbers.py and the test compute the same
numbers.

The published code has two encoders; Shoal has three, because an update trains the model and the
values together. The encoder and its target are therefore Shoal's "model" and "held" networks in the
update of the model, and "held" and "target" in that of the values. Every update starts from the same
weights. Targets have no noise, because the two programs draw different random numbers.

updates.safetensors: u = 0..3 counts updates; NAME is a parameter ("model.zs_mlp.l1.weight",
"critic.q1.q1.l2.bias", "actor.policy.l3.bias"):

  u.model_loss, u.critic_loss, u.actor_loss
  u.target                      y of the critic's loss (B)
  u.gradient.NAME
"""

import os
import sys

import numpy as np
import torch
from safetensors.numpy import save_file

from shared_numbers import symmetric

BATCH, ACTIONS, VECTOR, UPDATES = 8, 3, 11, 4
STATE, HIDDEN, HORIZON = 24, 20, 3
DISCOUNT, N_STEP, PENALTY = 0.99, 3, 1e-2


def set_weights(module, prefix):
    """Weights U(+-sqrt(6 / fan_in)), biases U(+-1 / sqrt(fan_in)), as in sb3_updates.py."""
    parameters = dict(module.named_parameters())
    with torch.no_grad():
        for name, parameter in parameters.items():
            fan_in = parameters[name.rsplit(".", 1)[0] + ".weight"][0].numel()
            scale = ((6 if name.endswith("weight") else 1) / fan_in) ** 0.5
            parameter.copy_(symmetric(f"{prefix}.{name}", parameter.shape, scale))


class Losses:
    """Keeps the values of losses when their gradients are computed."""

    def __init__(self):
        self.values, backward = [], torch.Tensor.backward

        def recording(tensor, *arguments, **named):
            self.values.append(tensor.detach().clone())
            return backward(tensor, *arguments, **named)

        torch.Tensor.backward = recording


def make_agent(mrq, models, encoder, target):
    """An agent without a replay. `encoder`, `target`: prefixes of the weights."""
    agent = mrq.Agent.__new__(mrq.Agent)
    for name, value in mrq.Hyperparameters(target_policy_noise=0.0,
                                           pre_activ_weight=PENALTY).__dict__.items():
        setattr(agent, name, value)
    agent.enc_horizon, agent.discount, agent.zs_dim = HORIZON, DISCOUNT**N_STEP, STATE
    agent.discrete, agent.state_shape = False, [VECTOR]
    agent.two_hot = mrq.TwoHot("cpu", agent.lower, agent.upper, agent.num_bins)
    networks = {
        encoder: models.Encoder(VECTOR, ACTIONS, False, agent.num_bins, STATE, STATE // 2, HIDDEN,
                                HIDDEN),
        target: models.Encoder(VECTOR, ACTIONS, False, agent.num_bins, STATE, STATE // 2, HIDDEN,
                               HIDDEN),
        "critic": models.Value(HIDDEN, HIDDEN), "target_critic": models.Value(HIDDEN, HIDDEN),
        "actor": models.Policy(ACTIONS, False, zs_dim=STATE, hdim=HIDDEN),
        "target_actor": models.Policy(ACTIONS, False, zs_dim=STATE, hdim=HIDDEN)}
    for prefix, network in networks.items():
        set_weights(network, prefix)
    agent.encoder, agent.encoder_target = networks[encoder], networks[target]
    agent.value, agent.value_target = networks["critic"], networks["target_critic"]
    agent.policy, agent.policy_target = networks["actor"], networks["target_actor"]
    # A step of size 0 keeps the weights.
    for name in ("encoder", "value", "policy"):
        optimiser = torch.optim.SGD(getattr(agent, name).parameters(), lr=0)
        setattr(agent, name + "_optimizer", optimiser)
    return agent


def ends_of(update):
    """Step of each row that ends the task, else HORIZON."""
    ends = torch.full((BATCH,), HORIZON)
    ends[update], ends[(update + 3) % BATCH] = 0, 1
    return ends


def record(mrq, models):
    losses, file = Losses(), {}

    def keep(update, name, tensor):
        numbers = np.array(tensor.detach().numpy(), np.float32).reshape(-1)
        if numbers.size > 1024:
            numbers = numbers[:: -(-numbers.size // 256)].copy()
        file[f"{update}.{name}"] = numbers

    for update in range(UPDATES):
        at = f"update{update}."
        steps = [f"{at}step{h}." for h in range(1, HORIZON + 1)]
        obs = symmetric(at + "obs", (BATCH, VECTOR), 1.5)
        next_obs = symmetric(at + "next_obs", (BATCH, VECTOR), 1.5)
        action = symmetric(at + "action", (BATCH, ACTIONS), 1.0)
        reward = symmetric(at + "reward", (BATCH, 1), 2.0)
        rewards = torch.stack([symmetric(step + "reward", (BATCH, 1), 2.0) for step in steps], 1)
        ends = ends_of(update)
        not_done = torch.stack([(ends != h).float().reshape(-1, 1) for h in range(HORIZON)], 1)

        agent = make_agent(mrq, models, "model", "held")
        agent.train_encoder(
            obs.reshape(BATCH, 1, VECTOR),
            torch.stack([symmetric(step + "action", (BATCH, ACTIONS), 1.0) for step in steps], 1),
            torch.stack([symmetric(step + "next_obs", (BATCH, VECTOR), 1.5) for step in steps], 1),
            rewards, not_done, env_terminates=True)
        keep(update, "model_loss", losses.values.pop())
        for name, parameter in agent.encoder.named_parameters():
            keep(update, "gradient.model." + name, parameter.grad)

        agent = make_agent(mrq, models, "held", "target")
        scale = rewards[:, 0].abs().mean().item()
        _, target = agent.train_rl(obs, action, next_obs, reward, not_done.prod(1), scale, 1.0)
        keep(update, "actor_loss", losses.values.pop())
        keep(update, "critic_loss", losses.values.pop())
        keep(update, "target", target)
        for name, parameter in agent.policy.named_parameters():
            keep(update, "gradient.actor." + name, parameter.grad)
        # The policy's loss adds to these gradients, so the critic's loss is computed once more.
        agent = make_agent(mrq, models, "held", "target")
        critic_gradients(agent, obs, action, target)
        for name, parameter in agent.value.named_parameters():
            keep(update, "gradient.critic." + name, parameter.grad)
    return file


def critic_gradients(agent, obs, action, target):
    q = agent.value(agent.encoder(agent.encoder.zs(obs), action).detach())
    torch.nn.functional.smooth_l1_loss(q, target.expand(-1, 2)).backward()


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.path.insert(0, sys.argv[1])
    import models
    import MRQ as mrq
    torch.set_num_threads(1)
    arrays = record(mrq, models)
    path = os.path.join(sys.argv[2], "updates.safetensors")
    save_file(arrays, path, metadata={"torch": torch.__version__})
    print(path, os.path.getsize(path), "bytes", len(arrays), "arrays")


main()
