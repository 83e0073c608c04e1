# SPDX-License-Identifier: Apache-2.0
"""What the tests of the package share."""

import os
import pathlib
import subprocess
import sys

import pytest
import shoal_rl

CHECKPOINTS = sorted(pathlib.Path(os.environ["SHOAL_CHECKPOINTS"]).glob("*/checkpoints/step_*"))
assert CHECKPOINTS


def checkpoint(name):
    (found,) = [c for c in CHECKPOINTS if c.parent.parent.name == name]
    return found


def refusal(call, *arguments, **keys):
    with pytest.raises(shoal_rl.Error) as raised:
        call(*arguments, **keys)
    line = str(raised.value)
    assert line and "\n" not in line
    return line


def in_fresh_python(program, *arguments):
    # The deadline is kept from outside: a thread that hangs may hold Python's lock for ever.
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", program, *arguments],
        capture_output=True, text=True, timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


# The first calls of a process, from two threads: they must not wait for each other. The barrier
# brings them together; `kind` says what they call.
FIRST_CALLS = """
import sys, threading
import shoal_rl
kind, checkpoint = sys.argv[1:]
barrier = threading.Barrier(4)
answers = []

def call(number):
    if kind == "act":
        policy = shoal_rl.Policy(checkpoint)
        observation = {name: [0.5] * size for name, size in policy.blocks.items()}
        barrier.wait()
        answers.append(policy.act(observation).shape == (policy.action_size,))
    else:
        env = shoal_rl.make("FetchReach", pixels=False)
        barrier.wait()
        observation, _ = env.reset(seed=number)
        answers.append(all(array.size > 0 for array in observation.values()))

threads = [threading.Thread(target=call, args=(number,), daemon=True) for number in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(answers)
"""


def answers_of_first_calls(kind):
    return in_fresh_python(FIRST_CALLS, kind, str(checkpoint("sac-state")))
