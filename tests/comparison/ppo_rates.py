# SPDX-License-Identifier: Apache-2.0
"""Env steps per second of PPO, Shoal's beside Stable-Baselines3's with SubprocVecEnv.

usage: ppo_rates.py SHOAL [hopper] [reach] [reach-pixels]

SHOAL is the program; shoal-bench lies beside it. The same rollouts, minibatches, epochs and networks on both sides, those of the
presets hopper-ppo, fetch-reach-ppo and fetch-reach-pixels-ppo; from pixels theirs is NatureCNN, the
customary one, on one 84x84 picture of the original environment by OSMesa, ours the preset's small
encoder on two. Each side counts from the end of its first update on; no evaluations. FetchReach from
state stands beside its physics alone too, on all cores at once, before and after. Prints JSON.
Wants stable-baselines3, gymnasium[mujoco], gymnasium-robotics and, for the latter's models, mujoco
3.3.7 from PyPI; nothing of Shoal needs Python.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("MUJOCO_GL", "osmesa")

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import SubprocVecEnv, VecNormalize


class Pixels(gymnasium.ObservationWrapper):
    """The picture alone, as (3, 84, 84)."""

    def __init__(self, env):
        super().__init__(env)
        self.observation_space = gymnasium.spaces.Box(0, 255, (3, 84, 84), np.uint8)

    def observation(self, _):
        return np.ascontiguousarray(self.render().transpose(2, 0, 1))


def make(kind):
    if kind == "hopper":
        return gymnasium.make("Hopper-v4")
    import gymnasium_robotics

    gymnasium.register_envs(gymnasium_robotics)
    if kind == "reach":
        return gymnasium.make("FetchReachDense-v4")
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


class Clock(BaseCallback):
    start = None

    def _on_rollout_start(self):
        if self.start is None and self.num_timesteps > 0:
            self.start = (time.monotonic(), self.num_timesteps)

    def _on_step(self):
        return True


def rate_of_shoal(program, preset, env_steps):
    with tempfile.TemporaryDirectory() as folder:
        keys = {"run_dir": folder, "env_steps": env_steps, "eval.interval": 10**8,
                "eval.final_episodes": 0, "stop.success": 2}
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


def rate_of_sb3(kind):
    _, _, policy, envs, settings, env_steps = KINDS[kind]
    venv = SubprocVecEnv([lambda: make(kind)] * envs)
    if kind == "hopper":
        venv = VecNormalize(venv)
    model = PPO(policy, venv, device="cpu", **settings)
    clock = Clock()
    model.learn(env_steps, callback=clock)
    rate = (model.num_timesteps - clock.start[1]) / (time.monotonic() - clock.start[0])
    venv.close()
    return rate


def main():
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(KINDS):
        sys.exit(__doc__)
    program = sys.argv[1]
    rows = []
    for kind in sys.argv[2:] or KINDS:
        preset, env_steps = KINDS[kind][:2]
        physics = [rate_of_physics(program)] if kind == "reach" else []
        ours = rate_of_shoal(program, preset, env_steps)
        if physics:
            physics.append(rate_of_physics(program))
        theirs = rate_of_sb3(kind)
        row = {"task": kind, "preset": preset, "env_steps_per_second": round(ours, 1),
               "stable_baselines3": round(theirs, 1), "ratio": round(ours / theirs, 2)}
        if physics:
            row["physics_alone_on_all_cores"] = [round(rate, 1) for rate in physics]
            row["ratio_to_physics_alone"] = round(ours * len(physics) / sum(physics), 2)
        rows.append(row)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    print(json.dumps({"shoal": version.stdout.strip(), "cores": os.cpu_count(), "rows": rows},
                     indent=2))


if __name__ == "__main__":
    main()
