# SPDX-License-Identifier: Apache-2.0
"""Learning curves of SAC over wall clock, Shoal's beside Stable-Baselines3's. Prints JSON.

usage: sac_learning.py SHOAL OUT [pendulum] [halfcheetah] [--only SIDE:SEED] [--loaded] [--seeds N]
                       [--share F]

SHOAL is the program, OUT a folder. A piece is one side ("shoal", "sb3") with one seed; its result is
OUT/TASK-SIDE-SEED.json. Pieces whose file exists are not run again, so that an interrupted call can be
repeated. The two sides take turns, seed by seed. --only runs one piece. What is printed says which
pieces are missing.

Both sides train on the same environment of Gymnasium, one copy of it, with the same networks (two hidden
layers of 256, ReLU, PyTorch's initial weights), batch, learning rate, discount, target rate, initial
temperature and warm-up of random actions, and with one update of actor, critics and temperature for each
env step after that. Shoal runs the environment, the replay and the learner in processes of their own,
Stable-Baselines3 in one. Each side has the number of threads that is faster, measured once for each task
(OUT/TASK-SIDE-threads.json): PyTorch one or its default, Shoal's learner one or two.

The clock of Shoal starts with its command, so that it includes the start of all processes; that of
Stable-Baselines3 starts with learn(), after all imports. Neither contains an evaluation: each side keeps
policies at fixed env steps, and when training is over the same code plays 20 episodes with each, without
noise, from seeds that no training uses.

Nothing else may run on the machine. With --loaded other programs may run: the piece then has one thread
and gives returns but no times. F multiplies env steps, intervals and warm-up: 0.05 for a trial. Run it
with an interpreter that has stable-baselines3, gymnasium[mujoco] and the wheel of shoal-rl.
"""

import argparse
import importlib.metadata
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from over_seeds import mean, student, welch

SIDES = ("shoal", "sb3")
BATCH, HIDDEN, DISCOUNT, TAU, TEMPERATURE = 256, [256, 256], 0.99, 0.005, 1.0
EPISODES, FIRST_SEED = 20, 1_000_000
# learning_rate: that of rl-baselines3-zoo. interval: env steps between policies that are kept.
TASKS = {
    "pendulum": dict(env="Pendulum-v1", env_steps=20_000, interval=1_000, warm_up=1_000,
                     learning_rate=1e-3, target=-200),
    "halfcheetah": dict(env="HalfCheetah-v5", env_steps=100_000, interval=10_000, warm_up=1_000,
                        learning_rate=3e-4, target=None),
}
PACKAGES = ("stable_baselines3", "torch", "gymnasium", "mujoco", "numpy")


def task_of(name, share):
    task = dict(TASKS[name])
    for key in ("env_steps", "interval", "warm_up"):
        task[key] = int(task[key] * share)
    return task


def returns_of(env_name, act, begin):
    """Returns of the evaluation's episodes. `begin(observation)` starts an episode, `act(observation)`
    gives an action."""
    import gymnasium

    env = gymnasium.make(env_name)
    returns = []
    for seed in range(FIRST_SEED, FIRST_SEED + EPISODES):
        observation, _ = env.reset(seed=seed)
        begin(observation)
        total, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, _ = env.step(act(observation))
            total += float(reward)
            over = terminated or truncated
        returns.append(total)
    env.close()
    return returns


def point(env_steps, seconds, returns):
    return {"env_steps": env_steps, "seconds": round(seconds, 2), "return": round(mean(returns), 2),
            "returns": [round(value, 1) for value in returns]}


# --- The peer: a process of its own ---------------------------------------------------------------


def sb3_model(task, seed, threads):
    import gymnasium
    import torch
    from stable_baselines3 import SAC

    if threads:
        torch.set_num_threads(threads)
    return SAC("MlpPolicy", gymnasium.make(task["env"]), device="cpu", seed=seed, batch_size=BATCH,
               learning_rate=task["learning_rate"], learning_starts=task["warm_up"], train_freq=1,
               gradient_steps=1, gamma=DISCOUNT, tau=TAU, ent_coef=f"auto_{TEMPERATURE}",
               buffer_size=task["env_steps"], policy_kwargs=dict(net_arch=HIDDEN))


def train_sb3(task, seed, threads):
    """The curve of Stable-Baselines3 in this process."""
    from stable_baselines3.common.callbacks import BaseCallback

    class Keep(BaseCallback):
        def __init__(self):
            super().__init__()
            self.kept = []

        def _on_training_start(self):
            self.start = time.monotonic()

        def _on_step(self):
            # Called before the update of this env step: as many updates behind for every policy.
            if self.num_timesteps % task["interval"] == 0:
                before = time.monotonic()
                policy = self.model.policy.state_dict()
                self.kept.append((self.num_timesteps, before - self.start,
                                  {name: tensor.clone() for name, tensor in policy.items()}))
                self.start += time.monotonic() - before
            return True

    model, keep = sb3_model(task, seed, threads), Keep()
    model.learn(task["env_steps"], callback=keep)
    seconds = time.monotonic() - keep.start
    points = []
    for env_steps, after, weights in keep.kept:
        model.policy.load_state_dict(weights)
        returns = returns_of(task["env"], lambda o: model.predict(o, deterministic=True)[0], lambda _: None)
        points.append(point(env_steps, after, returns))
    return {"seconds": round(seconds, 2), "threads": threads, "points": points}


def sb3_rate(task, threads):
    """Env steps per second of a short training after its warm-up."""
    from stable_baselines3.common.callbacks import BaseCallback

    env_steps = 3 * task["warm_up"]

    class Clock(BaseCallback):
        start = None

        def _on_step(self):
            if self.num_timesteps == task["warm_up"]:
                self.start = time.monotonic()
            return True

    clock = Clock()
    sb3_model(task, 0, threads).learn(env_steps, callback=clock)
    return (env_steps - task["warm_up"]) / (time.monotonic() - clock.start)


def in_a_process(*words):
    said = subprocess.run([sys.executable, os.path.abspath(__file__), "--peer", *map(str, words)],
                          check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(said.stdout.splitlines()[-1])


def peer(name, share, what, *words):
    task = task_of(name, float(share))
    if what == "rate":
        print(json.dumps(sb3_rate(task, int(words[0]))))
    else:
        print(json.dumps(train_sb3(task, int(words[0]), int(words[1]))))


# --- Ours -----------------------------------------------------------------------------------------


def keys_of(task, seed, threads, folder):
    return {
        "env.python": sys.executable, "run_dir": folder, "run_name": "run", "seed": seed,
        "env_steps": task["env_steps"], "actors": 1, "envs_per_actor": 1,
        "exploration.random_steps": task["warm_up"],
        "replay.min_size": task["warm_up"], "replay.capacity": task["env_steps"] + 1_000,
        "replay.samples_per_insert": BATCH, "learner.batch": BATCH, "learner.threads": threads,
        "learner.learning_rate": task["learning_rate"], "learner.discount": DISCOUNT, "learner.tau": TAU,
        "learner.actor_period": 1, "learner.target_period": 1, "learner.average_rate": 1,
        "learner.normalise_vectors": "false", "learner.checkpoint_period": task["interval"],
        "sac.initial_temperature": TEMPERATURE, "network.hidden": json.dumps(HIDDEN),
        "network.layer_norm": "false", "network.log_std": "clamped", "network.initialisation": "pytorch",
        "eval.interval": 10**9, "eval.final_episodes": 0, "stop.success": 2,
    }


def keep_checkpoints(process, run, kept):
    """Copies each checkpoint while `process` runs: the learner removes all but its newest. The copies
    have the times of their files."""
    while True:
        over = process.poll() is not None
        for folder in sorted(run.glob("checkpoints/step_*")):
            # config.json is the last of its files.
            if (kept / folder.name).exists() or not (folder / "config.json").exists():
                continue
            copy = kept / "under-way"
            shutil.rmtree(copy, ignore_errors=True)
            try:
                shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("learner.safetensors"))
            except (shutil.Error, FileNotFoundError):
                raise SystemExit(f"{folder.name} was removed before it was copied") from None
            copy.rename(kept / folder.name)
        if over:
            return
        time.sleep(0.02)


def train_shoal(program, task, seed, threads, judge):
    """`judge`: the return of a checkpoint."""
    with tempfile.TemporaryDirectory() as folder:
        keys = keys_of(task, seed, threads, folder)
        command = [program, "train", "--env", f"gymnasium:{task['env']}", "--preset", "state"]
        for key, value in keys.items():
            command += ["--set", f"{key}={value}"]
        kept = pathlib.Path(folder) / "kept"
        kept.mkdir()
        start = time.time()
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
            keep_checkpoints(process, pathlib.Path(folder) / "run", kept)
        if process.returncode != 0:
            raise SystemExit(f"shoal train ended with {process.returncode}")
        points = []
        for checkpoint in sorted(kept.glob("step_*")):
            state = json.loads((checkpoint / "state.json").read_text())
            seconds = (checkpoint / "state.json").stat().st_mtime - start
            points.append(point(state["env_steps"], seconds, judge(task, checkpoint)))
        meta = json.loads((pathlib.Path(folder) / "run" / "meta.json").read_text())
        # The last checkpoint is written when the budget is spent and its updates are made.
        return {"seconds": points[-1]["seconds"], "updates": meta["updates"], "threads": threads,
                "points": points}


def shoal_rate(program, task, threads):
    """Env steps per second between the first and the last of some checkpoints."""
    short = dict(task, env_steps=5_000, interval=1_000)
    first, *_, last = train_shoal(program, short, 0, threads, lambda *_: [0.0])["points"]
    return (last["env_steps"] - first["env_steps"]) / (last["seconds"] - first["seconds"])


def returns_of_checkpoint(task, checkpoint):
    import shoal_rl

    policy, mapping = shoal_rl.Policy(str(checkpoint)), shoal_rl.Mapping(str(checkpoint))
    fresh = []

    def begin(observation):
        fresh.append(mapping.reset(observation))

    def act(observation):
        inputs = fresh.pop() if fresh else mapping.observe(observation)
        return mapping.action(policy.act(inputs))

    return returns_of(task["env"], act, begin)


# --- Both -----------------------------------------------------------------------------------------


def threads_of(out, name, side, rate, choices):
    """The number of threads of `choices` with the highest `rate` on this machine."""
    file = out / f"{name}-{side}-threads.json"
    if not file.exists():
        rates = {threads: round(rate(threads), 1) for threads in choices}
        file.write_text(json.dumps({"threads": max(rates, key=rates.get),
                                    "env_steps_per_second": rates}, indent=2) + "\n")
    return json.loads(file.read_text())["threads"]


def run_piece(program, out, name, share, side, seed, loaded):
    task = task_of(name, share)
    file = out / f"{name}-{side}-{seed}.json"
    if file.exists():
        if json.loads(file.read_text())["task"] != task:
            raise SystemExit(f"{file} was made with another --share or by another version; remove it")
        return
    print(f"{name}: {side}, seed {seed}", file=sys.stderr)
    if loaded:
        threads = 1
    elif side == "shoal":
        threads = threads_of(out, name, side, lambda n: shoal_rate(program, task, n), (1, 2))
    else:
        threads = threads_of(out, name, side, lambda n: in_a_process(name, share, "rate", n), (1, 0))
    if side == "shoal":
        result = train_shoal(program, task, seed, threads, returns_of_checkpoint)
    else:
        result = in_a_process(name, share, "train", seed, threads)
    if loaded:
        for timed in (result, *result["points"]):
            timed["seconds"] = None
    piece = {"side": side, "seed": seed, "task": task, **result}
    file.with_suffix(".part").write_text(json.dumps(piece, indent=2) + "\n")
    file.with_suffix(".part").rename(file)


def seconds_to_target(piece):
    """Training time at the first policy whose mean return reaches the target; None: there is none, or
    the piece has no times."""
    target = piece["task"]["target"]
    return next((p["seconds"] for p in piece["points"] if p["return"] >= target), None)


def over_seeds(values):
    """Mean and Student's 95 % interval; None where a seed has no value."""
    if None in values or not values:
        return None
    if len(values) == 1:
        return {"mean": round(values[0], 2), "each": values}
    return {"mean": round(mean(values), 2), "interval": [round(end, 2) for end in student(values)],
            "each": [round(value, 2) for value in values]}


def summary(out, name, share, seeds):
    pieces, missing = {}, []
    for side in SIDES:
        for seed in range(seeds):
            file = out / f"{name}-{side}-{seed}.json"
            if file.exists():
                pieces[side, seed] = json.loads(file.read_text())
            else:
                missing.append(f"{side}:{seed}")
    row = {"task": name, **task_of(name, share), "missing": missing}
    figures = {"seconds": lambda piece: piece["seconds"],
               "final_return": lambda piece: piece["points"][-1]["return"],
               "best_return": lambda piece: max(p["return"] for p in piece["points"])}
    if TASKS[name]["target"] is not None:
        figures["seconds_to_target"] = seconds_to_target
    timed = {key for key, piece in pieces.items() if piece["seconds"] is not None}
    row["without_times"] = [f"{side}:{seed}" for side, seed in sorted(pieces.keys() - timed)]
    for side in SIDES:
        row[side] = {}
        for figure, value in figures.items():
            own = [key for key in sorted(pieces) if key[0] == side]
            if figure.startswith("seconds"):
                own = [key for key in own if key in timed]
            row[side][figure] = over_seeds([value(pieces[key]) for key in own])
    both = [seed for seed in range(seeds) if all((side, seed) in timed for side in SIDES)]
    for figure in ("seconds", "seconds_to_target"):
        if figure not in figures:
            continue
        pairs = [[figures[figure](pieces[side, seed]) for side in SIDES] for seed in both]
        if pairs and all(None not in pair for pair in pairs):
            row[f"ratio_of_{figure}"] = over_seeds([theirs / ours for ours, theirs in pairs])
    returns = [row[side]["final_return"]["each"] if row[side]["final_return"] else [] for side in SIDES]
    if min(map(len, returns)) > 1:
        difference, half, _ = welch(*returns)
        row["difference_of_final_return"] = {
            "mean": round(difference, 2), "interval": [round(difference - half, 2), round(difference + half, 2)]}
    row["pieces"] = [pieces[key] for key in sorted(pieces)]
    return row


def main():
    if sys.argv[1:2] == ["--peer"]:
        return peer(*sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shoal")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("tasks", nargs="*", metavar="task", help=" | ".join(TASKS))
    parser.add_argument("--only", metavar="SIDE:SEED", help="one piece")
    parser.add_argument("--loaded", action="store_true", help="other programs run: no times")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--share", type=float, default=1)
    arguments = parser.parse_args()
    pieces = [f"{side}:{seed}" for seed in range(arguments.seeds) for side in SIDES]
    if not set(arguments.tasks) <= set(TASKS) or arguments.only not in (None, *pieces):
        parser.error(f"tasks are {', '.join(TASKS)}; pieces {', '.join(pieces)}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    tasks = arguments.tasks or list(TASKS)
    for name in tasks:
        for piece in [arguments.only] if arguments.only else pieces:
            side, seed = piece.split(":")
            run_piece(arguments.shoal, arguments.out, name, arguments.share, side, int(seed),
                      arguments.loaded)
    version = subprocess.run([arguments.shoal, "--version"], capture_output=True, text=True, check=True)
    print(json.dumps({
        "shoal": version.stdout.strip(), "cores": os.cpu_count(),
        "packages": {package: importlib.metadata.version(package) for package in PACKAGES},
        "share_of_the_env_steps": arguments.share,
        "rows": [summary(arguments.out, name, arguments.share, arguments.seeds) for name in tasks],
    }, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
