# SPDX-License-Identifier: Apache-2.0
"""Plays random actions in an original environment and writes what they earn.

usage: gymnasium_random.py ENVIRONMENT EPISODES SEED FILE

For comparison with `shoal env random`; nothing of Shoal needs Python. Wants gymnasium-robotics
(docs/results/random-actions.md names the versions).
"""

import json
import sys

import gymnasium
import gymnasium_robotics  # noqa: F401  registers the environments
import mujoco
import numpy


def play(env, seed):
    env.reset(seed=seed)
    total, length, ended = 0.0, 0, False
    while not ended:
        _, reward, terminated, truncated, info = env.step(env.action_space.sample())
        total += float(reward)
        length += 1
        ended = terminated or truncated
    return {"return": total, "length": length, "success": bool(info["is_success"])}


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    name, episodes, seed, file = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    env = gymnasium.make(name)
    env.action_space.seed(seed)
    played = [play(env, 1000 * seed + k) for k in range(episodes)]
    returns = [episode["return"] for episode in played]
    result = {
        "environment": name,
        "versions": {
            "gymnasium": gymnasium.__version__,
            "gymnasium-robotics": gymnasium_robotics.__version__,
            "mujoco": mujoco.__version__,
        },
        "seed": seed,
        "return_mean": numpy.mean(returns),
        "return_std": numpy.std(returns),
        "length_mean": numpy.mean([episode["length"] for episode in played]),
        "success_rate": numpy.mean([episode["success"] for episode in played]),
        "episodes": played,
    }
    with open(file, "w", encoding="utf-8") as out:
        json.dump(result, out, indent=1)
        out.write("\n")
    print(f"return {result['return_mean']:.2f} +- {result['return_std']:.2f}, "
          f"length {result['length_mean']:.0f}, success {100 * result['success_rate']:.1f} %")


if __name__ == "__main__":
    main()
