# SPDX-License-Identifier: Apache-2.0
"""Env steps to the success target of an experiment, over seeds.

usage: steps_to_target.py SUMMARY.json [--after N]

Prints for each arm the env steps less N (for example those before the first update) of each seed, their
mean with Student's 95 % interval, and the ratio to the first arm: the geometric mean of the pairs of equal
seeds, with its interval.
"""

import argparse
import json
import math

from over_seeds import mean, student


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("summary")
    parser.add_argument("--after", type=int, default=0)
    arguments = parser.parse_args()
    with open(arguments.summary, encoding="utf-8") as file:
        arms = json.load(file)["arms"]
    first = None
    for arm in arms:
        steps = {run["seed"]: run["n_to_target"] for run in arm["runs"]}
        if len(steps) < 2 or None in steps.values():
            raise SystemExit(f"{arm['name']}: expected two seeds or more, all of which reached the target")
        steps = {seed: value - arguments.after for seed, value in steps.items()}
        first = first or steps
        values = list(steps.values())
        low, high = student(values)
        logs = [math.log(steps[seed] / first[seed]) for seed in steps]
        ratio, least, most = (math.exp(x) for x in (mean(logs), *student(logs)))
        print(f"{arm['name']}: {', '.join(f'{value:,}' for value in values)}; mean {mean(values):,.0f} "
              f"({low:,.0f} to {high:,.0f}); ratio {ratio:.2f} ({least:.2f} to {most:.2f})")


if __name__ == "__main__":
    main()
