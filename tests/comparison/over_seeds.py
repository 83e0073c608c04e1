# SPDX-License-Identifier: Apache-2.0
"""Intervals over seeds and sample efficiency, from files that Shoal wrote.

usage: over_seeds.py EVAL.json... [--against EVAL.json...]
       over_seeds.py SUMMARY.json
       over_seeds.py --target RATE CURVE.json...

EVAL.json is what `shoal eval --json` or a run's final evaluation wrote: one trained policy each. One
file has Wilson's 95 % interval of its episodes. Several are the seeds of one recipe: Student's interval
of the mean of their rates, cut off at 0 and 100 %, and never narrower than Wilson's interval of all
episodes. `--against`: the difference to the mean of other seeds with Welch's interval. Of an
experiment's summary.json (schema shoal-experiment-1): each arm, and its difference to the first.

`--target`: the first of two evaluations of a curve whose episodes together reach the rate, by the rule
of launch/record/first_reached.h.

Python's standard library alone, so that it checks launch/tools/experiment/statistics.cpp from outside.
"""

import argparse
import json
import math


def t95(freedom):
    """Two-sided quantile of Student's t, by integrating its density; `freedom` may be fractional."""
    scale = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2)) / math.sqrt(
        freedom * math.pi)

    def inside(t, steps=4000):  # P(|T| <= t); t = sqrt(f) tan(u) makes the integrand bounded
        end = math.atan(t / math.sqrt(freedom))
        width = end / steps
        values = [math.cos(i * width) ** (freedom - 1) for i in range(steps + 1)]
        simpson = values[0] + values[-1] + 4 * sum(values[1:-1:2]) + 2 * sum(values[2:-1:2])
        return 2 * scale * math.sqrt(freedom) * simpson * width / 3

    low, high = 0.0, 1000.0
    while high - low > 1e-9 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if inside(middle) < 0.95 else (low, middle)
    return (low + high) / 2


def mean(values):
    return sum(values) / len(values)


def variance(values):
    return sum((v - mean(values)) ** 2 for v in values) / (len(values) - 1)


def wilson(successes, episodes):
    z, rate = 1.959963984540054, successes / episodes
    centre = (rate + z * z / (2 * episodes)) / (1 + z * z / episodes)
    half = z / (1 + z * z / episodes) * math.sqrt(
        rate * (1 - rate) / episodes + z * z / (4 * episodes * episodes))
    return max(0.0, centre - half), min(1.0, centre + half)


def student(values):
    half = t95(len(values) - 1) * math.sqrt(variance(values) / len(values))
    return mean(values) - half, mean(values) + half


def success_text(policies):
    """policies: (rate, episodes) of each."""
    successes = sum(round(rate * n) for rate, n in policies)
    episodes = sum(n for _, n in policies)
    low, high = wilson(successes, episodes)
    rates = [rate for rate, _ in policies]
    if len(policies) > 1:
        by_seed = student(rates)
        low, high = max(0.0, min(low, by_seed[0])), min(1.0, max(high, by_seed[1]))
    return (f"{100 * mean(rates):.1f} % [{100 * low:.1f}, {100 * high:.1f}] "
            f"({successes} of {episodes}, {len(policies)} seed(s))")


def mean_text(values, unit=""):
    if len(values) == 1:
        return f"{values[0]:.2f}{unit}"
    low, high = student(values)
    return f"{mean(values):.2f}{unit} [{low:.2f}, {high:.2f}]"


def welch(values, others):
    """Difference of two means, half of Welch's interval, and t. Both sides have two values or more, of
    which not all are equal."""
    a, b = variance(values) / len(values), variance(others) / len(others)
    freedom = (a + b) ** 2 / (a * a / (len(values) - 1) + b * b / (len(others) - 1))
    difference = mean(values) - mean(others)
    return difference, t95(freedom) * math.sqrt(a + b), abs(difference) / math.sqrt(a + b)


def difference_text(rates, others):
    """Welch's interval of the difference of two means, in points."""
    if len(rates) < 2 or len(others) < 2:
        return "one seed: no interval of the difference"
    if variance(rates) + variance(others) == 0:
        difference = 100 * (mean(rates) - mean(others))
        return f"difference {difference:+.1f} points; the seeds of each side are equal"
    difference, half, t = welch(rates, others)
    return f"difference {100 * difference:+.1f} +- {100 * half:.1f} points (Welch, t = {t:.1f})"


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def rates_of(paths):
    policies, returns, distances = [], [], []
    for path in paths:
        aggregate = load(path)["aggregate"]
        if aggregate["success_rate"] is not None:
            policies.append((aggregate["success_rate"], aggregate["episodes"]))
            print(f"{path}: {success_text(policies[-1:])}")
        returns.append(aggregate["return_mean"])
        if aggregate["final_distance_mean"] is not None:
            distances.append(100 * aggregate["final_distance_mean"])
    if policies:
        print(f"success {success_text(policies)}")
    print(f"return {mean_text(returns)}" +
          (f"; final distance {mean_text(distances, ' cm')}" if distances else ""))
    return [rate for rate, _ in policies]


def summary(path):
    first = None
    for arm in load(path)["arms"]:
        rows = [row for row in arm["runs"] if row["status"] == "finished"]
        failed = sum(row["status"] == "failed" for row in arm["runs"])
        policies = [(row["success"], row["episodes"]) for row in rows if row["success"] is not None]
        returns = [row["return_mean"] for row in rows if row["return_mean"] is not None]
        text = [success_text(policies)] if policies else []
        text += [f"return {mean_text(returns)}"] if returns else ["no finished run"]
        text += [f"{failed} failed"] if failed else []
        rates = [rate for rate, _ in policies]
        text += [difference_text(rates, first)] if first and rates else []
        first = first or rates
        print(f"{arm['name']}: {'; '.join(text)}")


def first_reached(path, target):
    points = load(path)["evaluations"]
    for a, b in zip(points, points[1:]):
        successes = sum(p["success_rate"] * p["episodes"] for p in (a, b))
        if successes >= target * (a["episodes"] + b["episodes"]) - 1e-6:
            return (f"{a['env_steps']} env steps, {a.get('wall_seconds', math.nan):.0f} s "
                    f"({100 * a['success_rate']:.0f} and {100 * b['success_rate']:.0f} %)")
    return "not reached"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--against", nargs="+")
    parser.add_argument("--target", type=float)
    arguments = parser.parse_args()
    if arguments.target is not None:
        for path in arguments.files:
            print(f"{path}: {first_reached(path, arguments.target)}")
        return
    if "arms" in load(arguments.files[0]):
        for path in arguments.files:
            summary(path)
        return
    rates = rates_of(arguments.files)
    if arguments.against:
        print(difference_text(rates, rates_of(arguments.against)))


if __name__ == "__main__":
    main()
