# SPDX-License-Identifier: Apache-2.0
"""Rates of PyTorch's SAC+DrQ updates on a GPU, beside which shoal-gpu-trial's rates are read.

usage: python tests/comparison/gpu_updates.py NETWORK:BATCH... [--seconds S] [--eager]
                                              [--wait-for FILE] [--json FILE]

NETWORK is compact, drq (MLPs of 1024) or nature. The update has the networks and passes of
docs/algorithm.md, in bf16 (autocast), with channels last; the actor learns in every second update.
Forward passes and losses are compiled (torch.compile), and an update is a CUDA graph; Adam is fused.
Both batches of frames come from pinned memory on a stream of their own while the update before
computes: two sets of inputs take turns, with a graph for each. --eager measures neither compiled nor
recorded updates instead, as most programs run them. --wait-for: compiles, then waits for the file, so
that both sides can be measured in the same minute.

Needs PyTorch with CUDA; nothing of Shoal. JSON (schema shoal-gpu-peer-1).
"""
import argparse
import json
import os
import sys
import time

import torch
import torch.nn.functional as F
from torch import nn

ACTIONS, FEATURES, RATE, TAU, AVERAGE_RATE = 4, 50, 5e-4, 0.01, 0.005
DEVICE = "cuda"


def convolutions(*layers):
    return [m for layer in layers for m in (nn.Conv2d(*layer), nn.ReLU())]


NETWORKS = {  # pooling before the convolutions, convolutions, width of the MLPs
    "compact": (2, ((6, 32, 3, 2), (32, 32, 3, 1), (32, 32, 3, 2)), 256),
    "drq": (1, ((6, 32, 3, 2), (32, 32, 3, 1), (32, 32, 3, 1), (32, 32, 3, 1)), 1024),
    "nature": (1, ((6, 32, 8, 4), (32, 64, 4, 2), (64, 64, 3, 1)), 256),
}


class Update:
    """The networks, their optimisers, and one update of a batch in the GPU's memory."""

    def __init__(self, network, batch, compiled):
        self.pool, layers, width = NETWORKS[network]
        side = 84 // self.pool
        encoder = nn.Sequential(*convolutions(*layers), nn.Flatten())
        flat = encoder(torch.zeros(1, 6, side, side)).shape[1]

        features = 512 if network == "nature" else FEATURES

        def trunk():
            if network == "nature":
                return nn.Sequential(nn.Linear(flat, features), nn.ReLU())
            return nn.Sequential(nn.Linear(flat, features), nn.LayerNorm(features), nn.Tanh())

        def mlp(inputs, outputs):
            hidden = []
            for _ in range(2):
                hidden += [nn.Linear(inputs, width), nn.LayerNorm(width), nn.ReLU()]
                inputs = width
            return nn.Sequential(*hidden, nn.Linear(inputs, outputs))

        def critic():
            return nn.ModuleDict({"trunk": trunk(), "q0": mlp(features + ACTIONS, 1),
                                  "q1": mlp(features + ACTIONS, 1)}).to(DEVICE)

        self.encoder = encoder.to(DEVICE).to(memory_format=torch.channels_last)
        self.critic, self.target = critic(), critic()
        self.target.load_state_dict(self.critic.state_dict())
        self.actor = nn.ModuleDict({"trunk": trunk(), "mlp": mlp(features, 2 * ACTIONS)}).to(DEVICE)
        self.log_alpha = torch.tensor(-2.3, device=DEVICE, requires_grad=True)
        self.learned = [*self.encoder.parameters(), *self.critic.parameters()]
        self.policy = list(self.actor.parameters())
        self.averaged = [*self.encoder.parameters(), *self.policy]
        self.average = [p.detach().clone() for p in self.averaged]
        options = {"lr": RATE, "fused": True, "capturable": compiled}
        self.steps = [torch.optim.Adam(p, **options)
                      for p in (self.learned, self.policy, [self.log_alpha])]
        self.action = torch.rand(batch, ACTIONS, device=DEVICE) * 2 - 1
        self.reward = -torch.rand(batch, 1, device=DEVICE)
        self.targets, self.critic_loss, self.actor_loss = self._targets, self._critic, self._actor
        if compiled:
            self.targets, self.critic_loss, self.actor_loss = map(
                torch.compile, (self.targets, self.critic_loss, self.actor_loss))

    def encode(self, frames):
        x = frames.to(memory_format=torch.channels_last).float()
        return self.encoder((F.avg_pool2d(x, self.pool) if self.pool > 1 else x) / 255 - 0.5)

    @staticmethod
    def values(critic, h, action):
        x = torch.cat([critic["trunk"](h), action], 1)
        return critic["q0"](x).float(), critic["q1"](x).float()

    def act(self, h):
        mean, log_std = self.actor["mlp"](self.actor["trunk"](h)).float().chunk(2, 1)
        log_std = -10 + 6 * (torch.tanh(log_std) + 1)
        noise = torch.randn_like(mean)
        u = mean + log_std.exp() * noise
        log_prob = (-0.5 * noise**2 - log_std - 0.9189385).sum(1, keepdim=True)
        return torch.tanh(u), log_prob - (2 * (0.6931472 - u - F.softplus(-2 * u))).sum(1, keepdim=True)

    def _targets(self, next_frames, alpha):
        with torch.autocast(DEVICE, torch.bfloat16):
            h = self.encode(next_frames)
            action, log_prob = self.act(h)
            q0, q1 = self.values(self.target, h, action)
        return self.reward + 0.9 * (torch.minimum(q0, q1) - alpha * log_prob)

    def _critic(self, frames, y):
        with torch.autocast(DEVICE, torch.bfloat16):
            h = self.encode(frames)
            q0, q1 = self.values(self.critic, h, self.action)
        return F.mse_loss(q0, y) + F.mse_loss(q1, y), h.detach()

    def _actor(self, h, alpha):
        with torch.autocast(DEVICE, torch.bfloat16):
            action, log_prob = self.act(h)
            q0, q1 = self.values(self.critic, h, action)
        return (alpha * log_prob - torch.minimum(q0, q1)).mean(), log_prob

    def step(self, optimiser, parameters, loss):
        for parameter, gradient in zip(parameters, torch.autograd.grad(loss, parameters)):
            parameter.grad = gradient
        optimiser.step()

    def __call__(self, frames, next_frames, with_actor):
        alpha = self.log_alpha.detach().exp()
        with torch.no_grad():
            y = self.targets(next_frames, alpha)
        loss, h = self.critic_loss(frames, y)
        self.step(self.steps[0], self.learned, loss)
        if with_actor:
            loss, log_prob = self.actor_loss(h, alpha)
            self.step(self.steps[1], self.policy, loss)
            loss = -self.log_alpha.exp() * (log_prob.detach() - ACTIONS).mean()
            self.step(self.steps[2], [self.log_alpha], loss)
        with torch.no_grad():
            torch._foreach_lerp_(list(self.target.parameters()), list(self.critic.parameters()), TAU)
            torch._foreach_lerp_(self.average, self.averaged, AVERAGE_RATE)


class Pipeline:
    """Calls of an update whose frames arrive while the update before computes."""

    def __init__(self, network, batch, compiled):
        def frames():
            return torch.randint(0, 256, (batch, 6, 84, 84), dtype=torch.uint8)

        self.update = Update(network, batch, compiled)
        self.host = [frames().pin_memory() for _ in range(2)]
        self.inputs = [[f.to(DEVICE) for f in self.host] for _ in range(2)]
        self.copies, self.main = torch.cuda.Stream(), torch.cuda.Stream()
        self.arrived, self.used = ([torch.cuda.Event() for _ in range(2)] for _ in range(2))
        self.calls = 0
        with torch.cuda.stream(self.main):
            for i in range(8):
                self.update(*self.inputs[i % 2], i // 2 % 2 == 0)
        torch.cuda.synchronize()
        self.graphs = {(s, a): self.record(s, a) for s in range(2)
                       for a in (True, False)} if compiled else None

    def record(self, inputs, with_actor):
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph, stream=self.main):
            self.update(*self.inputs[inputs], with_actor)
        return graph

    def __call__(self):
        turn, with_actor = self.calls % 2, self.calls // 2 % 2 == 0
        with torch.cuda.stream(self.copies):
            self.copies.wait_event(self.used[turn])
            for to, source in zip(self.inputs[turn], self.host):
                to.copy_(source, non_blocking=True)
            self.arrived[turn].record()
        with torch.cuda.stream(self.main):
            self.main.wait_event(self.arrived[turn])
            if self.graphs:
                self.graphs[turn, with_actor].replay()
            else:
                self.update(*self.inputs[turn], with_actor)
            self.used[turn].record()
        self.calls += 1

    def rate(self, seconds):
        for _ in range(20):
            self()
        torch.cuda.synchronize()
        start, calls = time.monotonic(), 0
        while time.monotonic() - start < seconds:
            for _ in range(20):  # a bounded number of updates in flight
                self()
            torch.cuda.synchronize()
            calls += 20
        return calls / (time.monotonic() - start)


def main():
    parser = argparse.ArgumentParser(description="PyTorch's updates on a GPU.")
    parser.add_argument("cases", nargs="+", metavar="NETWORK:BATCH")
    parser.add_argument("--seconds", type=float, default=3)
    parser.add_argument("--eager", action="store_true")
    parser.add_argument("--wait-for", metavar="FILE")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    torch.manual_seed(0)
    torch.backends.cudnn.benchmark = True
    torch.backends.cuda.matmul.allow_tf32 = torch.backends.cudnn.allow_tf32 = True
    pipelines = {}
    for case in options.cases:
        network, _, batch = case.partition(":")
        if network not in NETWORKS or not batch.isdigit():
            parser.error(f"'{case}': expected NETWORK:BATCH, NETWORK among {', '.join(NETWORKS)}")
        pipelines[network, int(batch)] = Pipeline(network, int(batch), not options.eager)
    while options.wait_for and not os.path.exists(options.wait_for):
        time.sleep(0.1)
    how = "eager" if options.eager else "compiled, CUDA graph"
    rows = [{"network": network, "batch": batch, "how": f"{how}, bf16",
             "updates_per_second": pipeline.rate(options.seconds)}
            for (network, batch), pipeline in pipelines.items()]
    for row in rows:
        print(f"PyTorch, {row['how']}: {row['network']}, batch {row['batch']}: "
              f"{row['updates_per_second']:.0f} updates/s", file=sys.stderr)
    text = json.dumps({"schema": "shoal-gpu-peer-1", "gpu": torch.cuda.get_device_name(),
                       "torch": torch.__version__, "cuda": torch.version.cuda, "rows": rows}, indent=2)
    if options.json:
        with open(options.json, "w") as file:
            file.write(text + "\n")
    else:
        print(text)


if __name__ == "__main__":
    main()
