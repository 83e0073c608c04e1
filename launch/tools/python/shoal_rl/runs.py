# SPDX-License-Identifier: Apache-2.0
"""What a run has written, as pandas data frames."""

import json
import pathlib

from shoal_rl import _native


def _pandas():
    try:
        import pandas
    except ImportError:
        raise _native.Error("data frames need pandas, which is not installed") from None
    return pandas


def _run_folder(run):
    folder = pathlib.Path(run)
    if not (folder / "config.json").is_file():
        raise _native.Error(f"'{folder}' is not a run: it has no config.json")
    return folder


def _object(text, source):
    try:
        found = json.loads(text)
    except ValueError as error:
        raise _native.Error(f"{source}: not JSON: {error}") from None
    if not isinstance(found, dict):
        raise _native.Error(f"{source}: expected a JSON object")
    return found


def metrics(run):
    """Reads metrics.jsonl: one row for each report of a process, in the order of time.

    run: the run's folder. Column `t` is a UTC time; figures that a process does not report are NaN.
    docs/monitoring.md describes the columns.
    """
    pandas = _pandas()
    file = _run_folder(run) / "metrics.jsonl"
    if not file.is_file():
        raise _native.Error(f"'{file}': no such file; the run has reported nothing yet")
    rows = []
    with open(file, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            # The last one of a run that is running may be half written.
            if line.endswith("\n"):
                rows.append(_object(line, f"{file}:{number}"))
    frame = pandas.DataFrame(rows)
    if rows:
        frame["t"] = pandas.to_datetime(frame["t"], unit="s", utc=True)
    return frame


_FIGURES = {
    "success": "success_rate",
    "return_mean": "return_mean",
    "return_std": "return_std",
    "length_mean": "length_mean",
    "final_distance_mean": "final_distance_mean",
    "episodes": "episodes",
}


def _evaluation(file):
    found = _object(file.read_text(encoding="utf-8"), str(file))
    if found.get("schema") != "shoal-eval-1":
        raise _native.Error(f"{file}: schema is '{found.get('schema')}', expected shoal-eval-1")
    try:
        figures = found["aggregate"]
        row = {
            "final": file.name == "final.json",
            "env_steps": found["env_steps"],
            "updates": found["weights_version"]["update"],
            "wall_seconds": found.get("wall_seconds"),
            "checkpoint": found["checkpoint"],
        }
        return row | {column: figures.get(name) for column, name in _FIGURES.items()}
    except (KeyError, TypeError, AttributeError) as error:
        raise _native.Error(f"{file}: not an evaluation: {error!r}") from None


def evaluations(run):
    """Reads eval/*.json: one row for each evaluation in the order of env steps, the `final` one last.

    run: the run's folder. success (rate, 0..1) and final_distance_mean (m) are NaN if the task has no
    goals. Lengths are in env steps. wall_seconds is the time since the run's start, NaN for the final
    evaluation.
    """
    pandas = _pandas()
    folder = _run_folder(run) / "eval"
    files = sorted(folder.glob("steps_*.json")) + sorted(folder.glob("final.json"))
    columns = ["final", "env_steps", "updates", "wall_seconds", "checkpoint", *_FIGURES]
    frame = pandas.DataFrame([_evaluation(file) for file in files], columns=columns)
    return frame.astype({name: float for name in ("wall_seconds", "success", "final_distance_mean")})
