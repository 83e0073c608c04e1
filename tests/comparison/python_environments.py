# SPDX-License-Identifier: Apache-2.0
"""Trains on ten environments of others, unmodified, and collects each run's account. Prints JSON
(docs/results/python-environments.json; docs/results/python-environments.md shows it).

usage: python_environments.py SHOAL RUN_DIR [--only NAME] [--env-steps N]

SHOAL is the program, RUN_DIR a folder for the runs. This script is run by the interpreter that runs the
environments. It wants the wheel of shoal-rl there (or its folder on PYTHONPATH), and from PyPI
gymnasium[box2d,mujoco], gymnasium-robotics, mujoco==3.3.2 (the newest that loads the Fetch models) and
gym-pusht.
"""

import argparse
import importlib.metadata
import json
import pathlib
import platform
import subprocess
import sys

# Name of the run: environment, further words.
ENVIRONMENTS = {
    "pendulum": ["Pendulum-v1"],
    "mountain-car": ["MountainCarContinuous-v0"],
    "car-racing": ["CarRacing-v3", "--set", 'env.kwargs={"continuous": true}'],
    "bipedal-walker": ["BipedalWalker-v3"],
    "half-cheetah": ["HalfCheetah-v5"],
    "hopper": ["gymnasium:Hopper-v5"],
    "reacher": ["Reacher-v5"],
    "fetch-reach": ["gymnasium_robotics:FetchReach-v4", "--preset", "fetch-reach-her"],
    "fetch-push": ["gymnasium_robotics:FetchPush-v4", "--preset", "fetch-push-her"],
    "push-t": ["gym_pusht:gym_pusht/PushT-v0"],
}
# Places of the account: each record that was made is in one of them.
WHERE = ("stored", "lost_with_process", "lost_with_replay", "rejected", "after_gap", "discarded")
PACKAGES = ("gymnasium", "gymnasium-robotics", "mujoco", "Box2D", "gym-pusht", "numpy")


def space_text(space):
    low, high = ([bound] if not isinstance(bound, list) else bound for bound in (space["low"], space["high"]))
    low = "-inf" if None in low else f"{min(low):g}"
    high = "inf" if None in high else f"{max(high):g}"
    return f"{space['dtype']} {'x'.join(map(str, space['shape']))} in [{low}, {high}]"


def train(shoal, folder, name, env_steps):
    """The row of one environment. The run evaluates its last checkpoint on four episodes."""
    words = ["train", "--env", *ENVIRONMENTS[name], "--set", f"env_steps={env_steps}",
             "--set", "eval.interval=1000000", "--set", "eval.final_episodes=4"]
    own = ["--set", f"env.python={sys.executable}", "--set", f"run_dir={folder}", "--set", f"run_name={name}"]
    done = subprocess.run([shoal, *words, *own], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{name}: shoal train ended with {done.returncode}: {done.stdout[-2000:]}")
    run = pathlib.Path(folder) / name
    meta = json.loads((run / "meta.json").read_text())
    config = json.loads((run / "config.json").read_text())
    environment = config["spec"]["environment"]
    account = meta["accounting"]
    if account["made"] != sum(account[where] for where in WHERE) or not account["balances"]:
        raise SystemExit(f"{name}: the account does not balance: {account}")
    return {
        "environment": environment["id"],
        "command": "shoal " + " ".join(f"'{word}'" if " " in word else word for word in words),
        "preset": config["preset"],
        "observation": {space["name"]: space_text(space) for space in environment["observation"]},
        "action": space_text(environment["action"]),
        "goal": environment.get("goal"),
        "env_steps": meta["env_steps"],
        "updates": meta["updates"],
        "seconds": round(meta["wall_seconds"], 1),
        "restarts": meta["restarts"],
        "accounting": {figure: account[figure] for figure in ("made", *WHERE)},
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("shoal")
    parser.add_argument("run_dir")
    parser.add_argument("--only", choices=ENVIRONMENTS)
    parser.add_argument("--env-steps", type=int, default=5000)
    options = parser.parse_args()
    names = [options.only] if options.only else list(ENVIRONMENTS)
    rows = []
    for name in names:
        print(name, file=sys.stderr, flush=True)
        rows.append(train(options.shoal, options.run_dir, name, options.env_steps))
    versions = {name: importlib.metadata.version(name) for name in PACKAGES}
    print(json.dumps({"schema": "shoal-python-environments-1", "python": platform.python_version(),
                      "packages": versions, "rows": rows}, indent=1))


if __name__ == "__main__":
    main()
