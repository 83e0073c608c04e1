# SPDX-License-Identifier: Apache-2.0
"""What a policy of an environment of Python observes of it, as the actors of its run did."""

from collections.abc import Mapping as _Dictionary

from shoal_rl import _native
from shoal_rl.names import array_name


def _arrays(observation, keys=()):
    if not isinstance(observation, _Dictionary):
        return {array_name(keys): observation}
    return {name: array for key, inner in observation.items() for name, array in _arrays(inner, (*keys, key)).items()}


class Mapping(_native.Mapping):
    """Mapping(path): between an environment with Gymnasium's interface and the policy of a checkpoint.

    path: the checkpoint's folder. One object for each environment: it keeps the stack of frames.

        inputs = mapping.reset(env.reset()[0])
        observation, *_ = env.step(mapping.action(policy.act(inputs)))
        inputs = mapping.observe(observation)

    `inputs` are what Policy.act takes, and an exported policy: arrays by name.
    """

    def reset(self, observation):
        """The policy's inputs at the beginning of an episode."""
        return self._observe(_arrays(observation), True)

    def observe(self, observation):
        """The policy's inputs after a step."""
        return self._observe(_arrays(observation), False)
