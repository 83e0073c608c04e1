# SPDX-License-Identifier: Apache-2.0
"""act_again.py CHECKPOINT MOMENTS: acts on what recorded.py has noted, and prints how many actions are
those that were played then, to the last bit."""

import pathlib
import pickle
import sys

import shoal_rl

policy, mapping = shoal_rl.Policy(sys.argv[1]), shoal_rl.Mapping(sys.argv[1])
equal = different = 0
for played, observation in pickle.loads(pathlib.Path(sys.argv[2]).read_bytes()):
    if played is None:
        inputs = mapping.reset(observation)
        continue
    action = mapping.action(policy.act(inputs))
    same = action.dtype == played.dtype and action.shape == played.shape and action.tobytes() == played.tobytes()
    equal, different = equal + same, different + (not same)
    inputs = mapping.observe(observation)
print(f"{equal} equal, {different} different")
