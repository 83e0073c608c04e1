# SPDX-License-Identifier: Apache-2.0
"""Environments that do what they should not, some steps after they began: as actors of a run alone,
not while they are tried before it starts."""

import ctypes
import os
import sys
import time

import numpy as np
from gymnasium import spaces
from point import Point


_LATE = {"after": 60 if "--id" in sys.orig_argv else 10**9, "limit": 40}


def _raise(_):
    raise ValueError("the gripper\nis stuck")


def _not_finite(observation):
    return observation | {"place": np.array([np.nan], np.float32)}


def _shape(observation):
    return observation | {"place": np.zeros(2, np.float32)}


def _type(observation):
    return observation | {"place": np.zeros(1, np.int64)}


def _missing(observation):
    return {"place": observation["place"]}


def _hang(_):
    time.sleep(3600)


def _leave(_):
    os._exit(7)


def _leave_well(_):
    os._exit(0)


def _segfault(_):
    ctypes.string_at(0)


def _talk(observation):
    print("moved", flush=True)
    return observation


class Raises(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_raise, **_LATE, **kwargs)


class NotFinite(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_not_finite, **_LATE, **kwargs)


class Shape(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_shape, **_LATE, **kwargs)


class Type(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_type, **_LATE, **kwargs)


class Missing(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_missing, **_LATE, **kwargs)


class Hangs(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_hang, **_LATE, **kwargs)


class Leaves(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_leave, **_LATE, **kwargs)


class LeavesWell(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_leave_well, **_LATE, **kwargs)


class Segfaults(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_segfault, **_LATE, **kwargs)


class Talks(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_talk, after=0, limit=40, **kwargs)


class DiscreteActions(Point):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.action_space = spaces.Discrete(3)


class Unbounded(Point):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.action_space = spaces.Box(-np.inf, np.inf, (1,), np.float32)


class DiscreteObservation(Point):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.observation_space = spaces.Dict({"room": spaces.Discrete(4)})


class Changes(Point):
    """Its bounds differ from process to process."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.action_space = spaces.Box(-2, 2 + os.getpid(), (1,), np.float32)


class Drifts(Point):
    """Its episodes depend on the ones before."""

    def reset(self, *, seed=None, options=None):
        observation, info = super().reset(seed=seed)
        self._place = self._place + self._steps
        return self._observation(), info


class RaisesAtOnce(Point):
    def __init__(self, **kwargs):
        super().__init__(fault=_raise, after=0, **kwargs)
