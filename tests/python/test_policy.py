# SPDX-License-Identifier: Apache-2.0
"""Policies of the package shoal-rl, and what importing it does to a process. Needs NumPy and pytest
alone: ctest runs it on the package in the build folder (tests/python/policy_tests.sh).

SHOAL_CHECKPOINTS     checkpoints that random-checkpoints has written
SHOAL_POLICY_LIBRARY  libshoal-policy.so, whose actions are compared
"""

import ctypes
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest
import shoal_rl
from support import CHECKPOINTS, answers_of_first_calls, checkpoint, refusal


def random_observations(policy, count, seed=1):
    random = np.random.default_rng(seed)
    observations = {
        name: random.normal(size=(count, size)).astype(np.float32)
        for name, size in policy.blocks.items()
    }
    if policy.pixels is not None:
        observations["pixels"] = random.integers(0, 256, (count, *policy.pixels), np.uint8)
    return observations


# --- the C library, by ctypes (common/policy/shoal_policy.h)


class Block(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("values", ctypes.c_void_p), ("count", ctypes.c_size_t)]


class Observations(ctypes.Structure):
    _fields_ = [
        ("count", ctypes.c_size_t),
        ("pixels", ctypes.c_void_p),
        ("pixel_count", ctypes.c_size_t),
        ("blocks", ctypes.POINTER(Block)),
        ("block_count", ctypes.c_size_t),
    ]


def act_by_c_library(folder, observations, count, action_size):
    library = ctypes.CDLL(os.environ["SHOAL_POLICY_LIBRARY"])
    policy = ctypes.c_void_p()
    assert library.shoal_policy_load(os.fsencode(folder), ctypes.byref(policy)) == 0
    pixels = observations.get("pixels")
    names = [name for name in observations if name != "pixels"]
    blocks = (Block * len(names))(
        *[Block(n.encode(), observations[n].ctypes.data, observations[n].size) for n in names]
    )
    given = Observations(
        count,
        None if pixels is None else pixels.ctypes.data,
        0 if pixels is None else pixels.size,
        blocks,
        len(names),
    )
    actions = np.empty((count, action_size), np.float32)
    act = library.shoal_policy_act
    act.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t]
    assert act(policy, ctypes.byref(given), actions.ctypes.data, actions.size) == 0
    library.shoal_policy_free(policy)
    return actions


# --- Policy


@pytest.mark.parametrize("folder", CHECKPOINTS, ids=lambda folder: folder.parent.parent.name)
def test_actions_are_those_of_the_c_library(folder):
    policy = shoal_rl.Policy(folder)
    observations = random_observations(policy, 5)
    actions = policy.act(observations)
    assert actions.dtype == np.float32 and actions.shape == (5, policy.action_size)
    assert np.array_equal(actions, act_by_c_library(folder, observations, 5, policy.action_size))
    assert np.unique(actions, axis=0).shape[0] == 5
    for n in range(5):
        one = policy.act({name: array[n] for name, array in observations.items()})
        assert one.shape == (policy.action_size,)
        np.testing.assert_allclose(one, actions[n], atol=1e-5)


def test_arrays_may_be_views_and_blocks_of_any_float():
    policy = shoal_rl.Policy(checkpoint("sac-compact"))
    observations = random_observations(policy, 4)
    strided = {}
    for name, array in observations.items():
        wide = np.repeat(array, 2, axis=-1)
        wide[..., 1::2] = 0
        strided[name] = wide[..., ::2]
        assert not strided[name].flags.c_contiguous
        if name != "pixels":
            strided[name] = strided[name].astype(np.float64)
    assert np.array_equal(policy.act(strided), policy.act(observations))


def test_policy_says_what_it_observes():
    policy = shoal_rl.Policy(str(checkpoint("sac-compact")))
    description = json.loads((checkpoint("sac-compact") / "policy.json").read_text())
    spec = description["spec"]
    assert policy.task == spec["task"] and policy.algorithm == "sac"
    assert policy.action_size == spec["action_size"] and policy.cameras == spec["cameras"]
    assert policy.stack == spec["stack"]
    assert policy.pixels == (spec["stack"] * spec["channels"], spec["height"], spec["width"])
    observed = {block["name"]: block["size"] for block in spec["blocks"] if block["observed"]}
    assert policy.blocks == observed
    assert shoal_rl.Policy(checkpoint("sac-state")).pixels is None


def test_observations_that_do_not_fit_are_refused_by_name():
    policy = shoal_rl.Policy(checkpoint("sac-compact"))
    good = random_observations(policy, 2)
    name, size = next(iter(policy.blocks.items()))
    assert "pixels are missing" in refusal(policy.act, {name: good[name]})
    assert f"block '{name}' is missing" in refusal(policy.act, {"pixels": good["pixels"]})
    assert "uint8" in refusal(policy.act, good | {"pixels": good["pixels"] / 255})
    assert "expected" in refusal(policy.act, good | {"pixels": good["pixels"][:, :, ::2]})
    three = refusal(policy.act, good | {name: np.zeros((3, size))})
    assert f"does not go with block '{name}', which is of N = 3" in three
    assert "without N" in refusal(policy.act, good | {name: np.zeros(size)})
    long = refusal(policy.act, good | {name: np.zeros(2 * size)})
    assert f"shape ({2 * size},), expected ({size},) or (N, {size})" in long
    assert "array of numbers" in refusal(policy.act, good | {name: ["a"] * size})
    assert "not finite" in refusal(policy.act, good | {name: np.full((2, size), np.nan)})
    assert "'other' is not observed" in refusal(policy.act, good | {"other": np.zeros((2, 1))})
    assert "names" in refusal(policy.act, good | {1: np.zeros((2, 1))})
    assert "at least 1" in refusal(policy.act, {key: array[:0] for key, array in good.items()})


def test_checkpoints_that_cannot_be_read_are_refused(tmp_path):
    assert "no-such" in refusal(shoal_rl.Policy, tmp_path / "no-such")
    copy = tmp_path / "copy"
    shutil.copytree(checkpoint("sac-state"), copy)
    shoal_rl.Policy(copy)
    damaged = copy / "policy.safetensors"
    damaged.write_bytes(damaged.read_bytes()[:-1])
    assert "policy.safetensors" in refusal(shoal_rl.Policy, copy)


def test_a_card_acts_as_its_checkpoint(tmp_path):
    # The files of a checkpoint that `shoal card` copies (CardTest) are enough, and each is needed.
    files = ["policy.json", "policy.safetensors", "state.json"]
    card = tmp_path / "card"
    card.mkdir()
    (card / "README.md").write_text("# run on FetchReachDense")
    for file in files:
        shutil.copy(checkpoint("sac-compact") / file, card)
    policy = shoal_rl.Policy(card)
    observations = random_observations(policy, 3)
    expected = shoal_rl.Policy(checkpoint("sac-compact")).act(observations)
    assert np.array_equal(policy.act(observations), expected)
    for file in files:
        (card / file).rename(tmp_path / file)
        assert file in refusal(shoal_rl.Policy, card)
        (tmp_path / file).rename(card / file)


def test_a_package_of_another_python_says_so(tmp_path):
    package = tmp_path / "shoal_rl"
    shutil.copytree(pathlib.Path(shoal_rl.__file__).parent, package)
    (native,) = package.glob("_native.*.so")
    native.rename(package / "_native.cpython-27-x86_64-linux-gnu.so")
    done = subprocess.run(
        [sys.executable, "-c", "import shoal_rl"],
        env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True,
    )
    line = done.stderr.splitlines()[-1]
    assert line.startswith("ImportError: ") and "cpython-27" in line
    assert f"this is Python {sys.version_info.major}.{sys.version_info.minor}" in line


# --- threads


@pytest.mark.parametrize("attempt", range(5))
def test_first_acts_from_several_threads_answer(attempt):
    assert answers_of_first_calls("act") == f"{[True] * 4}\n"


# --- cores


def cores_in_fresh_python(program, **environment):
    done = subprocess.run(
        [sys.executable, "-c", "import os\nbefore = os.sched_getaffinity(0)\n" + program],
        env=os.environ | environment, capture_output=True, text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip(), done.stderr


def test_a_mapping_gives_the_numbers_of_the_observation_and_the_actions_bounds():
    folder = str(checkpoint("sac-environment"))
    policy, mapping = shoal_rl.Policy(folder), shoal_rl.Mapping(folder)
    state = np.array([0.5, -1.25, 3.0])
    arm = np.array([[1.0, -2.0], [3.5, 4.25]], np.float32)
    observation = {"state": state, "robot": {"arm": arm}}
    for inputs in (mapping.reset(observation), mapping.observe(observation)):
        assert inputs["state"].tolist() == state.tolist()
        assert inputs["robot.arm"].tolist() == arm.ravel().tolist()
        assert all(array.dtype == np.float32 for array in inputs.values())
    assert mapping.action(np.array([-1.0, 0.5], np.float32)).tolist() == [-2.0, 7.5]
    plain = {"state": state.astype(np.float32), "robot.arm": arm.ravel()}
    assert policy.act(inputs).tolist() == policy.act(plain).tolist()
    changed = mapping.observe({"state": -state, "robot": {"arm": -arm}})
    assert policy.act(changed).tolist() != policy.act(plain).tolist()


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="needs two cores")
@pytest.mark.parametrize(
    "binding", [{"OMP_PROC_BIND": "true"}, {"OMP_PLACES": "cores"}, {"GOMP_CPU_AFFINITY": "0"}]
)
def test_openmp_variables_bind_neither_the_importing_thread_nor_those_that_call(binding):
    program = """
import threading
import shoal_rl
masks = [os.sched_getaffinity(0)]

def call(folder):
    policy = shoal_rl.Policy(folder)
    import numpy
    policy.act({name: numpy.zeros(size) for name, size in policy.blocks.items()})
    masks.append(os.sched_getaffinity(0))

thread = threading.Thread(target=call, args=(%r,))
thread.start()
thread.join()
print(len(masks) == 2 and all(mask == before for mask in masks))
"""
    out, err = cores_in_fresh_python(program % str(checkpoint("sac-state")), **binding)
    assert out == "True" and not err


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="needs two cores")
def test_a_thread_that_was_bound_before_the_import_stays_so_with_a_warning():
    bind = "one = {min(before)}\nos.sched_setaffinity(0, one)\n"
    program = bind + "import shoal_rl\nprint(os.sched_getaffinity(0) == one)"
    out, err = cores_in_fresh_python(program, OMP_PROC_BIND="true")
    assert out == "True" and err.count("RuntimeWarning") == 1
    assert "may use only 1 of" in err and "OMP_PROC_BIND=true" in err
    # One's own choice, without such a variable, is no reason for a warning.
    quiet = {name: value for name, value in os.environ.items() if name != "OMP_PROC_BIND"}
    done = subprocess.run(
        [sys.executable, "-c", "import os\nbefore = os.sched_getaffinity(0)\n" + program],
        env=quiet, capture_output=True, text=True,
    )
    assert done.stdout.strip() == "True" and not done.stderr
