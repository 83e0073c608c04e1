# SPDX-License-Identifier: Apache-2.0
"""Env steps per second of PPO, Shoal's beside Stable-Baselines3's. Prints JSON.

usage: ppo_rates.py SHOAL [hopper] [reach] [reach-pixels] [--repetitions N] [--share F]
                    [--quality Q]

SHOAL is the program; shoal-bench lies beside it. Both sides have the same rollouts, minibatches,
epochs and networks, those of the presets hopper-ppo, fetch-reach-ppo and fetch-reach-pixels-ppo. From
pixels theirs is NatureCNN, the customary one, on one 84x84 picture of the original environment by
OSMesa; ours is the preset's small encoder on two pictures, in quality Q if it is given. Each side
counts from the end of its first update on; no evaluations.

The two sides are measured in turn, N times (3). Theirs is measured in four variants, each in a process
of its own: SubprocVecEnv or DummyVecEnv, PyTorch with its default number of threads or with one. The
variant of the highest median is the peer; all are printed. `ratio` is that of the medians, `spread` the
smallest and largest ratio of a repetition. FetchReach from state stands beside its physics alone too, on
all cores at once, before and after each repetition. F multiplies the env steps: 0.2 for a short trial.

Nothing else may run on the machine. Wants stable-baselines3, gymnasium[mujoco], gymnasium-robotics and,
for the models of gymnasium-robotics, mujoco 3.3.7 from PyPI; nothing of Shoal needs Python.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("MUJOCO_GL", "osmesa")

VARIANTS = [f"{environments}, {threads}" for environments in ("SubprocVecEnv", "DummyVecEnv")
            for threads in ("default threads", "1 thread")]


# --- The peer: a process of its own ---------------------------------------------------------------


def make(kind):
    import gymnasium
    import numpy as np

    if kind == "hopper":
        return gymnasium.make("Hopper-v4")
    import gymnasium_robotics

    gymnasium.register_envs(gymnasium_robotics)
    if kind == "reach":
        return gymnasium.make("FetchReachDense-v4")

    class Pixels(gymnasium.ObservationWrapper):
        """The picture alone, as (3, 84, 84)."""

        def __init__(self, env):
            super().__init__(env)
            self.observation_space = gymnasium.spaces.Box(0, 255, (3, 84, 84), np.uint8)

        def observation(self, _):
            return np.ascontiguousarray(self.render().transpose(2, 0, 1))

    return Pixels(gymnasium.make("FetchReachDense-v4", render_mode="rgb_array", width=84, height=84))


# Preset and env steps of ours; policy, environments, settings and env steps of theirs.
KINDS = {
    "hopper": ("hopper-ppo", 150_000, "MlpPolicy", 8,
               dict(n_steps=256, batch_size=64, n_epochs=10, gamma=0.99), 40_000),
    "reach": ("fetch-reach-ppo", 150_000, "MultiInputPolicy", 8,
              dict(n_steps=1024, batch_size=256, n_epochs=10), 40_000),
    "reach-pixels": ("fetch-reach-pixels-ppo", 30_000, "CnnPolicy", 16,
                     dict(n_steps=256, batch_size=512, n_epochs=4, gamma=0.9), 8_000),
}


def peer(kind, variant, share):
    """Prints the rate of Stable-Baselines3 in this process."""
    import torch
    import torch._dynamo  # before OSMesa, whose LLVM makes a later import of Triton crash
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv, VecNormalize

    class Clock(BaseCallback):
        start = None

        def _on_rollout_start(self):
            if self.start is None and self.num_timesteps > 0:
                self.start = (time.monotonic(), self.num_timesteps)

        def _on_step(self):
            return True

    environments, threads = variant.split(", ")
    if threads == "1 thread":
        torch.set_num_threads(1)
    _, _, policy, envs, settings, env_steps = KINDS[kind]
    vectorised = {"SubprocVecEnv": SubprocVecEnv, "DummyVecEnv": DummyVecEnv}[environments]
    venv = vectorised([lambda: make(kind)] * envs)
    if kind == "hopper":
        venv = VecNormalize(venv)
    model = PPO(policy, venv, device="cpu", **settings)
    clock = Clock()
    # Two rollouts at least: the first is before the clock starts.
    model.learn(max(int(env_steps * share), 2 * envs * settings["n_steps"]), callback=clock)
    print((model.num_timesteps - clock.start[1]) / (time.monotonic() - clock.start[0]))
    venv.close()


def rate_of_sb3(kind, variant, share):
    said = subprocess.run([sys.executable, os.path.abspath(__file__), "--peer", kind, variant,
                           str(share)], check=True, stdout=subprocess.PIPE, text=True)
    return float(said.stdout.split()[-1])


# --- Ours -----------------------------------------------------------------------------------------


def rate_of_shoal(program, preset, env_steps, quality):
    with tempfile.TemporaryDirectory() as folder:
        keys = {"run_dir": folder, "env_steps": env_steps, "eval.interval": 10**8,
                "eval.final_episodes": 0, "stop.success": 2}
        if quality:
            keys["observation.quality"] = quality
        command = [program, "train", "--preset", preset, "--run-name", "run"]
        for key, value in keys.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "run", "metrics.jsonl")) as lines:
            reports = [json.loads(line) for line in lines]
    reports = [r for r in reports if r["role"] == "learner" and r["state"] == "running"
               and r["updates"] > 0]
    first, last = reports[0], reports[-1]
    return (last["env_steps"] - first["env_steps"]) / (last["t"] - first["t"])


def rate_of_physics(program):
    """FetchReach's physics alone: as many processes at once as there are cores, added up."""
    bench = [os.path.join(os.path.dirname(program), "shoal-bench"), "--only",
             "FetchReach with one 84x84 camera, fast", "--repetitions", "5", "--seconds", "1"]
    running = [subprocess.Popen(bench, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
               for _ in range(os.cpu_count())]
    rows = [row for process in running for row in json.loads(process.communicate()[0])["rows"]]
    alone = [row["against_figure"] for row in rows if row["against"] == "physics alone"]
    assert len(alone) == len(running), rows
    return sum(alone)


# --- Both in turn ---------------------------------------------------------------------------------


def measure(program, kind, repetitions, share, quality):
    preset, env_steps = KINDS[kind][:2]
    quality = quality if kind == "reach-pixels" else None
    ours, physics, theirs = [], [], {variant: [] for variant in VARIANTS}
    for repetition in range(repetitions):
        before = rate_of_physics(program) if kind == "reach" else None
        ours.append(rate_of_shoal(program, preset, int(env_steps * share), quality))
        if before is not None:
            physics.append((before + rate_of_physics(program)) / 2)
        for variant in VARIANTS:
            theirs[variant].append(rate_of_sb3(kind, variant, share))
        print(f"{kind}, repetition {repetition + 1} of {repetitions}: {ours[-1]:.0f}, " +
              ", ".join(f"{v}: {rates[-1]:.0f}" for v, rates in theirs.items()), file=sys.stderr)
    best = max(VARIANTS, key=lambda variant: statistics.median(theirs[variant]))
    ratios = [mine / its for mine, its in zip(ours, theirs[best])]
    row = {"task": kind, "preset": preset, "repetitions": repetitions,
           "env_steps_per_second": round(statistics.median(ours), 1),
           "each": [round(rate, 1) for rate in ours],
           "stable_baselines3": round(statistics.median(theirs[best]), 1),
           "variant": best,
           "variants": {variant: [round(rate, 1) for rate in rates]
                        for variant, rates in theirs.items()},
           "ratio": round(statistics.median(ours) / statistics.median(theirs[best]), 2),
           "spread": [round(min(ratios), 2), round(max(ratios), 2)]}
    if quality:
        row["quality"] = quality
    if physics:
        row["physics_alone_on_all_cores"] = [round(rate, 1) for rate in physics]
        row["ratio_to_physics_alone"] = round(
            statistics.median(mine / its for mine, its in zip(ours, physics)), 2)
    return row


def main():
    if sys.argv[1:2] == ["--peer"]:
        kind, variant, share = sys.argv[2:]
        return peer(kind, variant, float(share))
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shoal")
    parser.add_argument("tasks", nargs="*", metavar="task", help=" | ".join(KINDS))
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--share", type=float, default=1)
    parser.add_argument("--quality", choices=("fast", "native", "reference"),
                        help="of our pictures; default: the preset's")
    arguments = parser.parse_args()
    if not set(arguments.tasks) <= set(KINDS) or arguments.repetitions < 1:
        parser.error(f"tasks are {', '.join(KINDS)}; --repetitions is at least 1")
    program = arguments.shoal
    rows = [measure(program, kind, arguments.repetitions, arguments.share, arguments.quality)
            for kind in arguments.tasks or KINDS]
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    print(json.dumps({"shoal": version.stdout.strip(), "cores": os.cpu_count(),
                      "share_of_the_env_steps": arguments.share, "rows": rows}, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
