# SPDX-License-Identifier: Apache-2.0
"""Environments and runs of the package shoal-rl as it is installed; policies are in test_policy.py.
`./run python` says where these lie:

SHOAL_CHECKPOINTS     checkpoints that random-checkpoints has written
SHOAL_TASK_LIBRARY    point_reach.so, whose tasks are played: docs/examples/point_reach
"""

import json
import os

import gymnasium
import numpy as np
import pytest
import shoal_rl
from gymnasium.utils.env_checker import check_env
from support import answers_of_first_calls, in_fresh_python, refusal


# --- make

FORMS = {
    "pixels": {},
    "state": {"pixels": False},
    "stacked": {"stack": 3, "grey": True, "proprioception": True, "height": 40, "width": 50,
                "render_mode": "rgb_array"},
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("task", shoal_rl.tasks())
def test_gymnasium_accepts_every_task(task, form):
    env = shoal_rl.make(task, **FORMS[form])
    check_env(env)
    env.close()


def play(env, seed, steps):
    env.action_space.seed(seed)
    observation, info = env.reset(seed=seed)
    rows = [(observation, info)]
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        rows.append((observation, reward, terminated, truncated, info))
        if terminated or truncated:
            rows.append(env.reset())
    return rows


def same(left, right):
    if isinstance(left, dict):
        return left.keys() == right.keys() and all(same(left[k], right[k]) for k in left)
    return np.array_equal(left, right)


def test_a_seed_names_its_episodes():
    keys = {"goal_mode": "both", "height": 32, "width": 32}
    rows = [play(shoal_rl.make("FetchReach", **keys), seed, 60) for seed in (3, 3, 4)]
    assert all(same(a, b) for first, again in zip(rows[0], rows[1]) for a, b in zip(first, again))
    assert not same(rows[0][0][0], rows[2][0][0])
    # The second episode is another.
    starts = [row[0] for row in rows[0] if len(row) == 2]
    assert len(starts) == 2 and not same(starts[0]["desired_goal"], starts[1]["desired_goal"])


def test_numbers_of_a_step_agree():
    env = shoal_rl.make("FetchReachDense", goal_mode="both")
    assert set(env.observation_space.spaces) == {"pixels", "achieved_goal", "desired_goal"}
    env.reset(seed=1)
    ends = []
    for step in range(50):
        observation, reward, terminated, truncated, info = env.step(np.full(4, 0.5))
        distance = np.linalg.norm(observation["achieved_goal"] - observation["desired_goal"])
        assert info["distance"] == pytest.approx(distance, abs=1e-6)
        assert reward == pytest.approx(-distance, abs=1e-6)
        assert info["is_success"] == (distance < 0.05)
        ends.append(terminated or truncated)
    assert ends == [False] * 49 + [True]
    assert "reset()" in refusal(env.step, np.zeros(4))


def test_tasks_without_goals_say_nothing_of_success():
    env = shoal_rl.make("cartpole_swingup", pixels=False)
    assert env.reset(seed=1)[1] == {}
    assert env.step(np.zeros(1))[4] == {}


def test_a_stack_starts_with_its_first_frame_and_shifts():
    env = shoal_rl.make("FetchReachDense", stack=3, render_mode="rgb_array")
    first = env.reset(seed=1)[0]["pixels"].reshape(3, 3, 84, 84)
    assert np.array_equal(first[0], first[1]) and np.array_equal(first[1], first[2])
    earlier = first
    for _ in range(3):
        later = env.step(np.ones(4))[0]["pixels"].reshape(3, 3, 84, 84)
        assert np.array_equal(later[:2], earlier[1:]) and not np.array_equal(later[2], earlier[2])
        earlier = later
    assert np.array_equal(env.render(), later[2].transpose(1, 2, 0))
    assert first.std() > 10


def test_render_shows_cameras_side_by_side():
    env = shoal_rl.make("FetchReachDense", cameras=["front", "side"], render_mode="rgb_array")
    frame = env.reset(seed=1)[0]["pixels"]
    picture = env.render()
    assert picture.shape == (84, 168, 3)
    assert np.array_equal(picture[:, 84:], frame[3:].transpose(1, 2, 0))
    assert "render_mode" in refusal(shoal_rl.make, "FetchReachDense", render_mode="human")
    assert "pixels" in refusal(
        shoal_rl.make, "FetchReachDense", render_mode="rgb_array", pixels=False
    )


def test_what_make_does_not_know_is_refused():
    line = refusal(shoal_rl.make, "FetchRech")
    assert "'FetchRech'" in line and all(task in line for task in shoal_rl.tasks())
    assert line.endswith("nearest is 'FetchReach'")
    assert "'camras'" in refusal(shoal_rl.make, "FetchReach", camras=["front"])
    assert "front, side" in refusal(shoal_rl.make, "FetchReach", cameras=["top"])
    assert "width" in refusal(shoal_rl.make, "FetchReach", width=-1)
    assert "JSON" in refusal(shoal_rl.make, "FetchReach", width=np.zeros(2))
    env = shoal_rl.make("FetchReach", pixels=False)
    assert "reset()" in refusal(env.step, np.zeros(4))
    env.reset(seed=0)
    assert "4 numbers" in refusal(env.step, np.zeros(3))
    assert "number 1" in refusal(env.step, [0, 2, 0, 0])
    assert "nan" in refusal(env.step, np.full(4, np.nan))
    env.step(np.zeros(4))


def test_environments_side_by_side_are_those_alone():
    envs = shoal_rl.make_vec("FetchReachDense", 2, height=32, width=32)
    try:
        assert isinstance(envs, gymnasium.vector.VectorEnv)
        observations, _ = envs.reset(seed=[5, 6])
        actions = np.full((2, 4), 0.25, np.float32)
        stepped, rewards, *_ = envs.step(actions)
    finally:
        envs.close()
    for n, seed in enumerate((5, 6)):
        alone = shoal_rl.make("FetchReachDense", height=32, width=32)
        assert np.array_equal(alone.reset(seed=seed)[0]["pixels"], observations["pixels"][n])
        observation, reward, *_ = alone.step(actions[n])
        assert np.array_equal(observation["pixels"], stepped["pixels"][n])
        assert reward == rewards[n]


# --- tasks of one's own

# A fresh process for each: a library stays loaded.
PLAY_POINT = """
import sys, pathlib, numpy, shoal_rl
from gymnasium.utils.env_checker import check_env
path = pathlib.Path(sys.argv[1])
assert "PointReachDense" not in shoal_rl.tasks()
env = shoal_rl.make("PointReachDense", task_library=path, goal_mode="both")
assert shoal_rl.tasks()[-1] == "PointReachDense" and env.cameras == ["top"]
check_env(env)
observation, info = env.reset(seed=1)
push = observation["desired_goal"] - observation["achieved_goal"]
stepped, reward, *_ = env.step(numpy.sign(push).astype(numpy.float32))
distance = numpy.linalg.norm(stepped["desired_goal"] - stepped["achieved_goal"])
assert distance < info["distance"] and abs(reward + distance) < 1e-6
assert stepped["pixels"].std() > 1
shoal_rl.make("PointReachDense", task_library=str(path), pixels=False).reset(seed=1)
envs = shoal_rl.make_vec("PointReachDense", 2, task_library=path, pixels=False)
envs.reset(seed=1)
envs.close()
try:
    shoal_rl.make("PointRech", task_library=path)
except shoal_rl.Error as error:
    print(error)
"""


def test_a_task_library_brings_its_tasks():
    line = in_fresh_python(PLAY_POINT, os.environ["SHOAL_TASK_LIBRARY"])
    assert line.startswith("unknown task 'PointRech'") and "PointReachDense" in line


def test_task_libraries_that_do_not_load_are_refused(tmp_path):
    line = refusal(shoal_rl.make, "PointReachDense", task_library=tmp_path / "none.so")
    assert "task_library: cannot load" in line and "none_python.so" in line
    (tmp_path / "text_python.so").write_text("no library")
    line = refusal(shoal_rl.make, "PointReachDense", task_library=tmp_path / "text.so")
    assert "text_python.so" in line
    assert "task_library" in refusal(shoal_rl.make, "FetchReach", task_library=3)


# --- threads


@pytest.mark.parametrize("attempt", range(5))
def test_first_resets_from_several_threads_answer(attempt):
    assert answers_of_first_calls("reset") == f"{[True] * 4}\n"


# --- runs


def write_run(folder):
    (folder / "eval").mkdir()
    (folder / "config.json").write_text("{}")
    (folder / "metrics.jsonl").write_text(
        '{"t":100.5,"role":"actor","id":0,"env_steps":7}\n'
        '{"t":101.5,"role":"learner","id":0,"updates":3,"loss":null}\n'
        '{"t":102.5,"role":"ac'
    )

    def evaluation(name, env_steps, success, **more):
        figures = {"episodes": 2, "return_mean": -1.0, "return_std": 0.5, "length_mean": 50.0}
        if success is not None:
            figures |= {"success_rate": success, "final_distance_mean": 0.01}
        (folder / "eval" / name).write_text(
            json.dumps(
                {
                    "schema": "shoal-eval-1",
                    "checkpoint": "best",
                    "weights_version": {"session": 1, "update": env_steps // 10},
                    "env_steps": env_steps,
                    "aggregate": figures,
                    **more,
                }
            )
        )

    evaluation("steps_0000000200_updates_0000000020.json", 200, None, wall_seconds=2.0)
    evaluation("steps_0000000100_updates_0000000010.json", 100, 0.5, wall_seconds=1.0)
    evaluation("final.json", 200, 1.0)


def test_metrics_are_a_row_for_each_report(tmp_path):
    write_run(tmp_path)
    frame = shoal_rl.metrics(tmp_path)
    assert list(frame["role"]) == ["actor", "learner"]  # not the line that is being written
    assert frame["t"][0].timestamp() == 100.5 and str(frame["t"].dt.tz) == "UTC"
    assert frame["env_steps"][0] == 7 and np.isnan(frame["env_steps"][1])
    with open(tmp_path / "metrics.jsonl", "a") as file:
        file.write("\n")
    assert "metrics.jsonl:3" in refusal(shoal_rl.metrics, tmp_path)


def test_evaluations_are_rows_by_env_steps(tmp_path):
    write_run(tmp_path)
    frame = shoal_rl.evaluations(str(tmp_path))
    assert list(frame["env_steps"]) == [100, 200, 200]
    assert list(frame["final"]) == [False, False, True]
    assert frame["success"][0] == 0.5 and np.isnan(frame["success"][1])
    assert list(frame["updates"]) == [10, 20, 20] and frame["episodes"].sum() == 6
    assert frame["wall_seconds"][1] == 2 and np.isnan(frame["wall_seconds"][2])
    broken = tmp_path / "eval" / "steps_0000000300_updates_0000000030.json"
    broken.write_text('{"schema": "shoal-eval-1"}')
    assert broken.name in refusal(shoal_rl.evaluations, tmp_path)
    broken.write_text('{"schema": "other"}')
    assert "shoal-eval-1" in refusal(shoal_rl.evaluations, tmp_path)


def test_a_folder_that_is_no_run_is_refused(tmp_path):
    assert "config.json" in refusal(shoal_rl.metrics, tmp_path)
    assert "config.json" in refusal(shoal_rl.evaluations, tmp_path / "nothing")
