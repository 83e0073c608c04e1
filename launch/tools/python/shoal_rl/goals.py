# SPDX-License-Identifier: Apache-2.0
"""Finds out whether Shoal's replay can compute the rewards of a goal environment.

It can if compute_reward is one of
  sparse   -1 while the Euclidean distance of achieved and desired goal exceeds a threshold, else 0
  dense    minus that distance
Kind and threshold are found from pairs of goals and then verified on pairs that were not used.
"""

import math

import numpy

_VERIFIED = 1000  # pairs
_NEAR = 1e-3  # half of them lie so near the threshold, relative to it


class NoGoal(Exception):
    """Why Shoal cannot compute the rewards of this environment."""


def _compute_reward(environment):
    for wrapped in (environment, getattr(environment, "unwrapped", None)):
        found = getattr(wrapped, "compute_reward", None)
        if callable(found):
            return lambda achieved, desired: float(numpy.asarray(found(achieved, desired, {})).reshape(-1)[0])
    raise NoGoal("the environment has no compute_reward")


def _direction(random, size):
    while True:
        direction = random.normal(size=size)
        length = numpy.linalg.norm(direction)
        if length > 1e-3:
            return direction / length


def _is_dense(reward, goals, random):
    for goal in goals[:20]:
        for distance in (0.0, 0.01, 0.1, 1.0, 3.0):
            other = goal + distance * _direction(random, goal.size)
            if abs(reward(goal, other) + numpy.linalg.norm(other - goal)) > 1e-5 * (1 + distance):
                return False
    return True


def _threshold_at(reward, goal, direction):
    """The distance at which the reward falls from 0 to -1, by bisection."""
    low, high = 0.0, 1e-4
    while reward(goal, goal + high * direction) == 0:
        low, high = high, 2 * high
        if high > 1e4:
            raise NoGoal("the reward is 0 at every distance of the goals")
    while high - low > 1e-12 * high:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (middle, high) if reward(goal, goal + middle * direction) == 0 else (low, middle)
    return high


def _rounded(threshold):
    """0.05 of 0.05000000000012: thresholds are written by people."""
    digits = 6 - math.floor(math.log10(threshold))
    return round(threshold, digits)


def _sparse_threshold(reward, goals, random):
    values = {reward(goal, goal) for goal in goals[:20]}
    far = {reward(goal, goal + 1e3 * _direction(random, goal.size)) for goal in goals[:20]}
    if values != {0.0} or far != {-1.0}:
        raise NoGoal(
            f"its reward is {sorted(values)} at a reached goal and {sorted(far)} far from it; expected 0 and -1 "
            "(sparse), or minus the distance (dense)"
        )
    found = [_threshold_at(reward, goal, _direction(random, goal.size)) for goal in goals[:20]]
    if max(found) - min(found) > 1e-5 * max(found):
        raise NoGoal(
            f"its reward is no threshold on the Euclidean distance: it changes at {min(found):.6g} in one direction and "
            f"at {max(found):.6g} in another"
        )
    return _rounded(found[0])


def _verify(reward, expected, threshold, goals, random):
    for pair in range(_VERIFIED):
        goal = goals[random.integers(len(goals))]
        near = pair % 2 == 0
        distance = threshold * (1 + _NEAR * random.uniform(-1, 1)) if near else random.exponential(4 * threshold)
        other = goal + distance * _direction(random, goal.size)
        exact = float(numpy.linalg.norm(other - goal))
        if abs(exact - threshold) <= 1e-6 * threshold:
            continue  # float32 decides
        was = reward(other, goal)
        if abs(was - expected(exact)) > 1e-5 * (1 + exact):
            raise NoGoal(
                f"its reward is {was:.6g} at a distance of {exact:.6g}, where {expected(exact):.6g} was expected from "
                "earlier samples"
            )


def find_goal(environment, goals, seed=0):
    """{"reward": "sparse" | "dense", "threshold": metres}; raises NoGoal with the reason.

    goals: desired and achieved goals that were seen, at least one.
    """
    reward = _compute_reward(environment)
    random = numpy.random.default_rng(seed)
    goals = [numpy.asarray(goal, dtype=numpy.float64).reshape(-1) for goal in goals]
    if _is_dense(reward, goals, random):
        threshold = float(getattr(getattr(environment, "unwrapped", environment), "distance_threshold", 0.05))
        _verify(reward, lambda distance: -distance, threshold, goals, random)
        return {"reward": "dense", "threshold": threshold}
    threshold = _sparse_threshold(reward, goals, random)
    _verify(reward, lambda distance: -1.0 if distance > threshold else 0.0, threshold, goals, random)
    return {"reward": "sparse", "threshold": threshold}
