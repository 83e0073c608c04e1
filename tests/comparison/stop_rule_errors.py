# SPDX-License-Identifier: Apache-2.0
"""How often the stop rule errs: the table of docs/algorithm.md, "When a run stops".

    python3 tests/comparison/stop_rule_errors.py

Exact: successes of an evaluation are binomial, evaluations independent. Needs no packages.
"""

from math import comb

# (name, episodes of an evaluation, least successes in each of two, least successes in both)
RULES = (
    ("each of two of 50", 50, 49, 98),
    ("two of 50, pooled", 50, 0, 98),
    ("two of 100, pooled", 100, 0, 196),
)
RATES = (0.94, 0.95, 0.96, 0.97, 0.98, 0.99)
# True success rates at successive evaluations of a run that learns.
LEARNING = (0.90, 0.93, 0.95, 0.96, 0.97, 0.975, 0.98, 0.98, 0.985, 0.985) + 8 * (0.99,)


def binomial(episodes, rate):
    return [
        comb(episodes, k) * rate**k * (1 - rate) ** (episodes - k) for k in range(episodes + 1)
    ]


def chance_to_stop(rates, episodes, least_each, least_both):
    """At each evaluation, of a run whose policies have these true success rates."""
    at = [0.0]
    going_on = binomial(episodes, rates[0])  # by the newest evaluation's successes
    for rate in rates[1:]:
        newest = binomial(episodes, rate)
        stopped, after = 0.0, [0.0] * (episodes + 1)
        for before, chance in enumerate(going_on):
            for successes, share in enumerate(newest):
                if min(before, successes) >= least_each and before + successes >= least_both:
                    stopped += chance * share
                else:
                    after[successes] += chance * share
        at.append(stopped)
        going_on = after
    return at


def main():
    print("| true success rate |", " | ".join(name for name, *_ in RULES), "|")
    print("| --- |", " | ".join("---" for _ in RULES), "|")
    for rate in RATES:
        chances = [chance_to_stop((rate, rate), *rule[1:])[-1] for rule in RULES]
        print(f"| {100 * rate:.0f} % |", " | ".join(f"{100 * c:.1f} %" for c in chances), "|")
    runs = [chance_to_stop(LEARNING, *rule[1:]) for rule in RULES]
    for bound in (0.97, 0.98):
        early = [sum(c for c, rate in zip(at, LEARNING) if rate < bound) for at in runs]
        print(
            f"| a run that learns stops below {100 * bound:.0f} % |",
            " | ".join(f"{100 * c:.1f} %" for c in early),
            "|",
        )
    ends = [sum(i * c for i, c in enumerate(at, 1)) / sum(at) for at in runs]
    print("| it stops at evaluation, mean |", " | ".join(f"{end:.1f}" for end in ends), "|")


if __name__ == "__main__":
    main()
