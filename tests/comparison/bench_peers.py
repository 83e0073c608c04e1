# SPDX-License-Identifier: Apache-2.0
"""Rates of Shoal beside those of its peers, measured in turn: PyTorch, Stable-Baselines3,
Gymnasium-Robotics. JSON (schema shoal-bench-1) on stdout.

usage: bench_peers.py PROGRAMS PYTHON [--repetitions N] [--seconds S] [--only TEXT]

PROGRAMS is the folder of shoal-bench and shoal-bench-actors, PYTHON an interpreter that has torch,
stable-baselines3, gymnasium-robotics and mujoco 3.3.7 (./run bench --against peers makes one), or -
for none: then only our own rows are printed. Exit code 1 when a peer could not be measured.

Each peer is a process of its own (this file again, `bench_peers.py worker KIND ...`) that measures
for so many seconds on request, and sleeps meanwhile. PyTorch computes an update with the
networks and passes of docs/algorithm.md; every variant of eager or compiled, f32 or bf16 (autocast),
channels last or not is tried once for an encoder and a number of threads, with the smaller batch, and
the best of them is the peer. Two threads are compared for `compact` alone. The other encoders are held
to 2.5 times the peer or 0.8 of the rate of their convolutions alone, whichever is lower; both are rows.

What fails ends the measurement; the rows so far are printed, and the exit code is 1.
"""

import argparse
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

ENCODERS = ("compact", "drq", "mrq", "nature")
BATCHES = (128, 256)
VARIANTS = ["+".join(v) for v in itertools.product(("eager", "compiled"), ("f32", "bf16"),
                                                   ("plain", "channels-last"))]
UPDATE_TARGET, CONVOLUTIONS_TARGET = 2.5, 0.8
CONVOLUTIONS = "its convolutions alone"
SB3_TARGET, SB3_SHARED_TARGET, SB3_F32_TARGET = 4, 10, 1.5
FAST_TARGET, NATIVE_TARGET, REFERENCE_TARGET = 10, 20, 1.5


# --- The peers -------------------------------------------------------------------------------------


def sac_update(encoder_name, batch, variant):
    """One call is one update of SAC in PyTorch, as shoal-bench's agent does it."""
    import torch
    from torch import nn
    from torch.nn import functional as F

    how, precision, layout = variant.split("+")
    actions, gamma, tau, average_rate = 4, 0.9, 0.01, 0.005
    torch.manual_seed(1)

    def convolutions(*layers):
        return nn.Sequential(*(m for layer in layers for m in (nn.Conv2d(*layer), nn.ReLU())))

    encoder = {
        "compact": lambda: nn.Sequential(nn.AvgPool2d(2), convolutions(
            (6, 32, 3, 2), (32, 32, 3, 1), (32, 32, 3, 2))),
        "drq": lambda: convolutions((6, 32, 3, 2), *[(32, 32, 3, 1)] * 3),
        "mrq": lambda: convolutions((6, 32, 3, 2), (32, 32, 3, 2), (32, 32, 3, 2), (32, 32, 3, 1)),
        "nature": lambda: convolutions((6, 32, 8, 4), (32, 64, 4, 2), (64, 64, 3, 1)),
    }[encoder_name]()
    flat = encoder(torch.zeros(1, 6, 84, 84)).numel()

    def trunk():
        if encoder_name == "nature":
            return nn.Sequential(nn.Linear(flat, 512), nn.ReLU()), 512
        return nn.Sequential(nn.Linear(flat, 50), nn.LayerNorm(50), nn.Tanh()), 50

    def mlp(inputs, outputs):
        layers = []
        for width in (256, 256):
            layers += [nn.Linear(inputs, width), nn.LayerNorm(width), nn.ReLU()]
            inputs = width
        return nn.Sequential(*layers, nn.Linear(inputs, outputs))

    class Critic(nn.Module):
        def __init__(self):
            super().__init__()
            self.trunk, features = trunk()
            self.q0, self.q1 = mlp(features + actions, 1), mlp(features + actions, 1)

        def forward(self, h, action):
            x = torch.cat([self.trunk(h), action], 1)
            return self.q0(x), self.q1(x)

    class Actor(nn.Module):
        def __init__(self):
            super().__init__()
            self.trunk, features = trunk()
            self.mlp = mlp(features, 2 * actions)

        def forward(self, h, noise):
            mean, log_std = self.mlp(self.trunk(h)).float().chunk(2, 1)
            log_std = -10 + 6 * (torch.tanh(log_std) + 1)
            u = mean + log_std.exp() * noise
            log_prob = (-0.5 * noise**2 - log_std - 0.9189385).sum(1)
            log_prob = log_prob - (2 * (0.6931472 - u - F.softplus(-2 * u))).sum(1)
            return torch.tanh(u), log_prob

    critic, target, actor = Critic(), Critic(), Actor()
    target.load_state_dict(critic.state_dict())
    memory = torch.channels_last if layout == "channels-last" else torch.contiguous_format
    encoder.to(memory_format=memory)
    log_alpha = torch.tensor(-2.3, requires_grad=True)
    learned, policy = [*encoder.parameters(), *critic.parameters()], list(actor.parameters())
    adam = {"foreach": True, "lr": 5e-4}
    critic_step, actor_step = torch.optim.Adam(learned, **adam), torch.optim.Adam(policy, **adam)
    alpha_step = torch.optim.Adam([log_alpha], lr=5e-4)
    target_pairs = list(target.parameters()), list(critic.parameters())
    averaged = [*encoder.parameters(), *policy]
    average_pairs = [p.detach().clone() for p in averaged], averaged

    def pixels(frames):
        x = frames.to(memory_format=memory).float() / 255
        return x if encoder_name == "nature" else x - 0.5

    def autocast():
        return torch.autocast("cpu", torch.bfloat16, enabled=precision == "bf16")

    def targets(next_frames, reward, noise, alpha):
        with autocast():
            h = encoder(pixels(next_frames)).flatten(1)
            action, log_prob = actor(h, noise)
            q0, q1 = target(h, action)
        return reward + gamma * (torch.minimum(q0, q1).float().squeeze(1) - alpha * log_prob)

    def critic_loss(frames, action, y):
        with autocast():
            h = encoder(pixels(frames)).flatten(1)
            q0, q1 = critic(h, action)
        loss = ((q0.float().squeeze(1) - y)**2).mean() + ((q1.float().squeeze(1) - y)**2).mean()
        return loss, h.detach()

    def actor_loss(h, noise, alpha):
        with autocast():
            action, log_prob = actor(h, noise)
            q0, q1 = critic(h, action)
        return (alpha * log_prob - torch.minimum(q0, q1).float().squeeze(1)).mean(), log_prob

    if how == "compiled":
        import torch._dynamo  # noqa: F401

        targets, critic_loss, actor_loss = map(torch.compile, (targets, critic_loss, actor_loss))

    frames, next_frames = (torch.randint(0, 256, (batch, 6, 84, 84), dtype=torch.uint8)
                           for _ in range(2))
    action, reward = torch.rand(batch, actions) * 2 - 1, -torch.rand(batch)
    updates = 0

    def update():
        nonlocal updates
        alpha = log_alpha.detach().exp()
        with torch.no_grad():
            y = targets(next_frames, reward, torch.randn(batch, actions), alpha)
        loss, h = critic_loss(frames, action, y)
        critic_step.zero_grad(set_to_none=True)
        loss.backward()
        critic_step.step()
        if updates % 2 == 0:
            for p in critic.parameters():
                p.requires_grad_(False)
            loss, log_prob = actor_loss(h, torch.randn(batch, actions), alpha)
            actor_step.zero_grad(set_to_none=True)
            loss.backward()
            actor_step.step()
            for p in critic.parameters():
                p.requires_grad_(True)
            alpha_step.zero_grad(set_to_none=True)
            (-log_alpha.exp() * (log_prob.detach() - actions).mean()).backward()
            alpha_step.step()
        with torch.no_grad():
            torch._foreach_lerp_(*target_pairs, tau)
            torch._foreach_lerp_(*average_pairs, average_rate)
        updates += 1

    return update


def sb3_train():
    """One call is train() of one gradient step: NatureCNN, batch 256."""
    import gymnasium
    import numpy as np
    from stable_baselines3 import SAC
    from stable_baselines3.common.logger import Logger

    class Noise(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(0, 255, (3, 84, 84), np.uint8)
        action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)

    model = SAC("CnnPolicy", Noise(), batch_size=256, buffer_size=600, device="cpu",
                policy_kwargs={"features_extractor_kwargs": {"features_dim": 256}})
    model._logger = Logger(None, [])
    random = np.random.default_rng(1)
    for _ in range(600):
        pair = random.integers(0, 256, (2, 1, 3, 84, 84), np.uint8)
        model.replay_buffer.add(*pair, random.uniform(-1, 1, (1, 4)), -random.random(1),
                                np.zeros(1), [{}])
    return lambda: model.train(gradient_steps=1, batch_size=256)


def make_reach():
    """FetchReach whose observation is its picture."""
    import gymnasium
    import gymnasium_robotics
    import numpy as np

    class Picture(gymnasium.ObservationWrapper):
        def __init__(self, env):
            super().__init__(env)
            self.observation_space = gymnasium.spaces.Box(0, 255, (84, 84, 3), np.uint8)

        def observation(self, _):
            return np.ascontiguousarray(self.render())

    gymnasium.register_envs(gymnasium_robotics)
    return Picture(gymnasium.make("FetchReach-v4", render_mode="rgb_array", width=84, height=84))


def vector_steps(cores):
    """One call is one step of as many environments as there are cores, each in its process."""
    import numpy as np
    import torch._dynamo  # noqa: F401  before OSMesa, whose libraries it does not load after
    from stable_baselines3.common.vec_env import SubprocVecEnv

    environments = SubprocVecEnv([make_reach] * cores)
    environments.reset()
    random = np.random.default_rng(1)
    return lambda: environments.step(random.uniform(-1, 1, (cores, 4)).astype(np.float32))


def work(kind, arguments):
    """Answers each line SECONDS on stdin with calls per second."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what libraries print is no answer
    if kind == "environments":
        call = vector_steps(int(arguments[0]))
    else:
        import torch

        torch.set_num_threads(int(arguments[0]))
        call = sb3_train() if kind == "sb3" else sac_update(arguments[1], int(arguments[2]),
                                                            arguments[3])
        for _ in range(3):  # both kinds of update are compiled
            call()
    print("ready", file=answers, flush=True)
    for line in sys.stdin:
        start, calls = time.monotonic(), 0
        while calls == 0 or time.monotonic() - start < float(line):
            call()
            calls += 1
        print(calls / (time.monotonic() - start), file=answers, flush=True)


# --- Side by side ----------------------------------------------------------------------------------


class PeerError(Exception):
    pass


class OwnError(Exception):
    pass


class Worker:
    def __init__(self, python, *arguments):
        environment = dict(os.environ, MUJOCO_GL="osmesa", PYOPENGL_PLATFORM="osmesa")
        self.errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(
            [python, os.path.abspath(__file__), "worker", *map(str, arguments)], text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, env=environment)

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.errors.seek(0)
            errors = [e for e in self.errors.read().splitlines() if e.strip()]
            raise PeerError(errors[-1] if errors else "it ended without a word")
        return line

    def rate(self, seconds):
        try:
            self.process.stdin.write(f"{seconds}\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # it has ended: answer() says why
        return float(self.answer())

    def __enter__(self):
        try:
            self.answer()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


def ours(options, program, stage, arguments=()):
    """The rows of that stage, as `program` writes them."""
    seconds = options.seconds if program == "shoal-bench" else max(1, options.seconds)
    command = [os.path.join(options.programs, program), "--repetitions", "1", "--seconds",
               str(seconds), *arguments]
    if program == "shoal-bench":
        command += ["--only", stage]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise OwnError(f"{program} failed: {said[-1]}")
    report = json.loads(done.stdout)
    options.commit, options.machine = report["commit"], report["machine"]
    return [row for row in report["rows"] if stage in row["stage"]]


def best_variant(options, threads, encoder, batch):
    rates, faults = {}, {}
    for variant in options.variants.split(","):
        try:
            with Worker(options.python, "update", threads, encoder, batch, variant) as worker:
                rates[variant] = worker.rate(options.seconds)
        except PeerError as error:
            faults[variant] = error
    if not rates:
        raise PeerError(next(iter(faults.values())))
    for variant, error in faults.items():
        print(f"bench: PyTorch, {variant}: {error}", file=sys.stderr)
    return max(rates, key=rates.get), rates


class Peers:
    def __init__(self, options):
        self.options, self.rows, self.whole = options, [], True

    def wanted(self, stage):
        return self.options.only in stage

    def add(self, stage, unit, against, pairs, target, **further):
        figures, others = [p[0] for p in pairs], [p[1] for p in pairs if p[1] is not None]
        row = {"stage": stage, "figure": statistics.median(figures), "unit": unit,
               "against": against, "against_figure": None, "ratio": None, "target": target,
               "repetitions": len(pairs), "spread": None, **further}
        if others:
            ratios = [a / b for a, b in pairs]
            row["against_figure"] = statistics.median(others)
            row["ratio"] = statistics.median(ratios)
            row["spread"] = (max(ratios) - min(ratios)) / row["ratio"]
        self.rows.append(row)
        beside = f", {row['ratio']:.2f} x {against}" if others else ", alone"
        print(f"{stage}: {row['figure']:.4g} {unit}{beside}", file=sys.stderr)

    def in_turn(self, what, start, measure):
        """Pairs of our figures, by name, and the peer's; the peer's are None where it does not run."""
        repetitions, seconds = self.options.repetitions, self.options.seconds
        if self.options.python != "-":
            try:
                with start() as worker:
                    return [(measure(), worker.rate(seconds)) for _ in range(repetitions)]
            except PeerError as error:
                print(f"bench: {what} was not measured: {error}", file=sys.stderr)
        self.whole = False
        return [(measure(), None) for _ in range(repetitions)]

    def updates(self, threads, encoder):
        """Of all batches; the peer is the variant that is the best with the first of them."""
        options, variant, rates = self.options, None, {}
        for batch in BATCHES:
            stage = f"SAC update, {encoder}, batch {batch} of (6, 84, 84), auto"
            if threads == 2:
                stage = f"SAC update by two threads, {encoder}, batch {batch}, idle cores"
            if not self.wanted(stage):
                continue

            def start():
                nonlocal variant, rates
                if variant is None:
                    variant, rates = best_variant(options, threads, encoder, batch)
                return Worker(options.python, "update", threads, encoder, batch, variant)

            def measure():
                return {row["against"]: row for row in ours(options, "shoal-bench", stage)}

            pairs = self.in_turn("PyTorch", start, measure)
            target = UPDATE_TARGET
            if encoder != "compact":
                alone = [rows[CONVOLUTIONS] for rows, _ in pairs]
                self.add(stage, "updates/s", CONVOLUTIONS,
                         [(row["figure"], row["against_figure"]) for row in alone], None)
                peers = [rate for _, rate in pairs if rate]
                if peers:
                    target = min(target, CONVOLUTIONS_TARGET * statistics.median(
                        row["against_figure"] for row in alone) / statistics.median(peers))
            against = "PyTorch"
            if variant:
                against += f", {variant.replace('+', ', ')}, on {threads} thread(s)"
            self.add(stage, "updates/s", against,
                     [(next(iter(rows.values()))["figure"], rate) for rows, rate in pairs], target,
                     variants=rates)

    def measure(self):
        for encoder in ENCODERS:
            self.updates(1, encoder)
        self.updates(2, "compact")
        self.stable_baselines()
        self.environments()

    def stable_baselines(self):
        options = self.options
        three = "Stable-Baselines3's networks with its three encoders, batch 256"
        one = "Stable-Baselines3's networks with one encoder, batch 256"
        if not (self.wanted(three) or self.wanted(one)):
            return

        def measure():
            row = ours(options, "shoal-bench", three)[0]
            return row["figure"], row["against_figure"], ours(options, "shoal-bench",
                                                              one)[0]["figure"]

        pairs = self.in_turn("Stable-Baselines3", lambda: Worker(options.python, "sb3", 1), measure)
        for index, stage, target in ((0, f"{three}, precision auto", SB3_TARGET),
                                     (1, f"{three}, precision f32", SB3_F32_TARGET),
                                     (2, f"{one}, precision auto", SB3_SHARED_TARGET)):
            self.add(stage, "updates/s", "train() of Stable-Baselines3 on 1 thread",
                     [(our[index], their) for our, their in pairs], target)

    def environments(self):
        options, cores = self.options, len(os.sched_getaffinity(0))
        stage = "of FetchReach with one 84x84 camera"
        if not self.wanted(f"actors {stage}"):
            return

        def measure():
            rows = ours(options, "shoal-bench-actors", stage, ["--real"])
            return {q: r["figure"] for q in ("fast", "native", "reference") for r in rows
                    if r["stage"].endswith(f"{q}, on {cores} cores")}

        pairs = self.in_turn("Gymnasium-Robotics",
                             lambda: Worker(options.python, "environments", cores), measure)
        for quality, target in (("fast", FAST_TARGET), ("native", NATIVE_TARGET),
                                ("reference", REFERENCE_TARGET)):
            self.add(f"{cores} actors {stage}, {quality}", "env steps/s",
                     f"Gymnasium-Robotics in SubprocVecEnv of {cores}, OSMesa",
                     [(our[quality], their and their * cores) for our, their in pairs], target)


def main():
    if sys.argv[1:2] == ["worker"]:
        return work(sys.argv[2], sys.argv[3:])
    parser = argparse.ArgumentParser(description="Shoal beside its peers.")
    parser.add_argument("programs")
    parser.add_argument("python")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--only", default="", help="rows whose stage contains this text")
    parser.add_argument("--variants", default=",".join(VARIANTS), help="of PyTorch")
    options = parser.parse_args()
    if not set(options.variants.split(",")) <= set(VARIANTS):
        parser.error(f"--variants are among {','.join(VARIANTS)}")
    if options.repetitions < 1:
        parser.error(f"--repetitions {options.repetitions}: expected at least 1")
    peers = Peers(options)
    try:
        peers.measure()
    except OwnError as error:
        print(f"bench: {error}", file=sys.stderr)
        peers.whole = False
        if not peers.rows:
            return 1
    if not peers.rows:
        parser.error(f"no row has '{options.only}'")
    print(json.dumps({"schema": "shoal-bench-1", "commit": options.commit,
                      "machine": options.machine, "rows": peers.rows}, indent=2))
    return 0 if peers.whole else 1


if __name__ == "__main__":
    sys.exit(main())
