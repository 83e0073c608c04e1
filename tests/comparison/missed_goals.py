# SPDX-License-Identifier: Apache-2.0
"""Where the missed goals of FetchReach lie, of files that `shoal eval --json` wrote.

Goals are drawn evenly from a cube of 30 cm, their marker is a sphere of 2 cm radius. In the table: the
marker's centre is 5 mm or more below the table's top. At the rim: within 15 mm of a face of the cube.
Inside: the others.

usage: python3 missed_goals.py EVAL.json...
"""

import collections
import json
import sys

TABLE_TOP = 0.400  # m
FACES = ((1.192, 1.492), (0.599, 0.899), (0.385, 0.685))  # m, along x, y, z


def place(goal):
    if goal[2] < TABLE_TOP - 0.005:
        return "in the table"
    rim = any(min(p - low, high - p) < 0.015 for p, (low, high) in zip(goal, FACES))
    return "at the rim" if rim else "inside"


def main():
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            episodes = json.load(file)["episodes"]
        goals = collections.Counter(place(e["desired_goal"]) for e in episodes)
        missed = [e for e in episodes if not e["success"]]
        places = collections.Counter(place(e["desired_goal"]) for e in missed)
        left = sum(e["failure"] == "reached_then_left" for e in missed)
        counts = ", ".join(f"{places[p]} of {goals[p]} {p}" for p in ("inside", "at the rim", "in the table"))
        print(f"{path}: missed {counts}; {left} of {len(missed)} reached, then left")


if __name__ == "__main__":
    main()
