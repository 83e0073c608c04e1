"""Tunes two keys with Optuna: pip install optuna; python docs/examples/tune.py SHOAL FOLDER TRIALS

Each trial is an experiment of one arm in FOLDER/trial-N; its objective is the mean over seeds of
what `shoal experiment run` prints as the last word on each run.
"""
import json
import pathlib
import statistics
import subprocess
import sys

import optuna

SHOAL, FOLDER, TRIALS = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])


def definition(trial):
    return {
        "schema": "shoal-experiment-definition-1",
        "name": f"trial-{trial.number}",
        "base": "fetch-reach-state",
        "set": {
            "env_steps": 4000,
            "eval.interval": 2000,
            "stop.success": 2,
            "learner.learning_rate": trial.suggest_float("learning_rate", 1e-4, 3e-3, log=True),
            "learner.batch": trial.suggest_categorical("batch", [64, 128, 256]),
        },
        "arms": [{"name": "only"}],
        "seeds": [0, 1],
        "final_episodes": 50,
    }


def objective(trial):
    FOLDER.mkdir(parents=True, exist_ok=True)
    file = FOLDER / f"trial-{trial.number}.json"
    file.write_text(json.dumps(definition(trial), indent=2))
    command = [SHOAL, "experiment", "run", file, "--out", FOLDER / f"trial-{trial.number}"]
    process = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if process.returncode == 130:
        raise KeyboardInterrupt
    runs = [json.loads(line) for line in process.stdout.splitlines()]
    if process.returncode != 0 or not runs:
        raise optuna.TrialPruned(f"exit code {process.returncode}: {runs}")
    return statistics.mean(run["objective"] for run in runs)


study = optuna.create_study(direction="maximize", sampler=optuna.samplers.TPESampler(seed=0))
study.optimize(objective, n_trials=TRIALS)
print(f"best of {len(study.trials)}: {study.best_value:.3f} with {study.best_params}")
