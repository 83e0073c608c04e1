# SPDX-License-Identifier: Apache-2.0
"""Updates by two builds, measured in turn: two compilers, two versions of a library. JSON (schema
shoal-bench-1) on stdout, with the figures of each repetition.

usage: bench_two_builds.py --ours NAME COMMAND --theirs NAME COMMAND [--networks LIST]
                           [--batches LIST] [--threads LIST] [--repetitions N] [--seconds S]

COMMAND starts shoal-bench-scaling, for example in the root of another Debian with /proc:

  sudo tests/comparison/bench_two_builds.py
    --ours "oneDNN 3" "chroot /srv/bare-13 /root/shoal/build/release/bin/shoal-bench-scaling"
    --theirs "oneDNN 2" build/release/bin/shoal-bench-scaling

(./run bench --compare COMMIT compares two commits.)
"""

import argparse
import json
import os
import platform
import shlex
import statistics
import subprocess
import sys


def machine():
    """As shoal-bench describes it."""
    with open("/proc/cpuinfo", encoding="ascii") as file:
        info = dict(line.rstrip("\n").replace("\t", "").split(":", 1)
                    for line in file.read().split("\n\n")[0].splitlines())
    cpu, flags = {name: value.strip() for name, value in info.items()}, info["flags"].split()
    isa = next(name for flag, name in (("amx_bf16", "avx512_core_amx"),
                                       ("avx512_bf16", "avx512_core_bf16"),
                                       ("avx512_vnni", "avx512_core_vnni"),
                                       ("avx512bw", "avx512_core"), ("avx2", "avx2"), ("sse4_1", "sse41"))
               if flag in flags)
    return {"cpu": f"{cpu['model name']} (family {cpu['cpu family']}, model {cpu['model']})",
            "cores": len(os.sched_getaffinity(0)), "isa": isa, "kernel": platform.release()}


def commit(command):
    """Of `COMMAND --version`: "shoal-bench-scaling 0.1.0 (COMMIT), ..."."""
    version = subprocess.run([*shlex.split(command), "--version"], capture_output=True, check=True,
                             text=True).stdout
    return version.split("(")[1].split(")")[0]


def measure(command, options):
    """One repetition: {stage: updates per second}."""
    words = [*shlex.split(command), "--networks", options.networks, "--batches", options.batches,
             "--threads", options.threads, "--seconds", str(options.seconds)]
    print("==", *words, file=sys.stderr)
    done = subprocess.run(words, stdout=subprocess.PIPE, check=False, text=True)
    if done.returncode != 0:
        sys.exit(f"bench: {words}: exit code {done.returncode}")
    rates = {}
    for line in done.stdout.splitlines():
        row = json.loads(line)
        stage = f"SAC update, {row['network']}, batch {row['batch']}, on {row['threads']} thread(s)"
        rates[stage] = row["updates_per_second"]
    return rates


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ours", nargs=2, required=True)
    parser.add_argument("--theirs", nargs=2, required=True)
    parser.add_argument("--networks", default="compact,drq,nature")
    parser.add_argument("--batches", default="128,256")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1)
    options = parser.parse_args()
    sides = {"ours": options.ours, "theirs": options.theirs}
    commits = {commit(command) for _, command in sides.values()}
    if len(commits) != 1:
        sys.exit(f"bench: builds of several commits: {' '.join(commits)}")
    repetitions = {"ours": [], "theirs": []}
    for i in range(options.repetitions):
        # Each side is the first in turn, because the first has the cooler machine.
        for side in sorted(sides, reverse=bool(i % 2)):
            repetitions[side].append(measure(sides[side][1], options))
    rows = []
    for stage in repetitions["ours"][0]:
        ours, theirs = ([rates[stage] for rates in repetitions[side]] for side in sides)
        ratios = [of_ours / of_theirs for of_ours, of_theirs in zip(ours, theirs)]
        ratio = statistics.median(ratios)
        rows.append({"stage": f"{stage}, {options.ours[0]}", "figure": statistics.median(ours),
                     "unit": "updates/s", "against": options.theirs[0],
                     "against_figure": statistics.median(theirs), "ratio": ratio,
                     "repetitions": options.repetitions,
                     "spread": (max(ratios) - min(ratios)) / ratio,
                     "figures": ours, "against_figures": theirs})
    print(json.dumps({"schema": "shoal-bench-1", "commit": commits.pop(),
                      "machine": machine(), "rows": rows}, indent=1))


main()
