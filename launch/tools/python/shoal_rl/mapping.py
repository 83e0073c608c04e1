# SPDX-License-Identifier: Apache-2.0
"""Converts an environment's observations and actions for a policy, as the actors of its run did."""

from collections.abc import Mapping as _Dictionary

from shoal_rl import _native
from shoal_rl.names import array_name


def _arrays(observation, keys=()):
    if not isinstance(observation, _Dictionary):
        return {array_name(keys): observation}
    return {name: array for key, inner in observation.items() for name, array in _arrays(inner, (*keys, key)).items()}


class Mapping(_native.Mapping):
    """Mapping(path) connects an environment with Gymnasium's interface and the policy of a checkpoint.

    path: the checkpoint's folder. Each environment needs its own Mapping, which keeps the stack of
    frames.

        inputs = mapping.reset(env.reset()[0])
        observation, *_ = env.step(mapping.action(policy.act(inputs)))
        inputs = mapping.observe(observation)

    `inputs` is a dict of arrays for Policy.act or an exported policy.
    """

    def reset(self, observation):
        """The policy's inputs at the beginning of an episode."""
        return self._observe(_arrays(observation), True)

    def observe(self, observation):
        """The policy's inputs after a step."""
        return self._observe(_arrays(observation), False)
