# SPDX-License-Identifier: Apache-2.0
"""Policies, environments and runs of Shoal.

Policy(path).act(observation)   actions of a checkpoint's policy
Mapping(path)                   converts between an environment of yours and a policy
make(task, **keys)              a Gymnasium environment; make_vec(task, n, **keys): n side by side
tasks()                         names of all tasks
metrics(run), evaluations(run)  files of a run as data frames

Errors are raised as Error, with a message of one line. The package needs numpy, make also gymnasium,
metrics and evaluations also pandas.
"""


def _why_not_native():
    import pathlib
    import sys

    folder = pathlib.Path(__file__).parent
    built = ", ".join(file.name for file in folder.glob("_native.*")) or "nothing compiled"
    python = f"Python {sys.version_info.major}.{sys.version_info.minor}"
    return f"{folder} has {built}, but this is {python}: use the Python version that the wheel was built for"


def _warn_of_one_core(mask):
    """Says so once if an OpenMP library seems to have bound this thread before this import."""
    import os
    import warnings

    names = ("OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY", "KMP_AFFINITY")
    found = " ".join(f"{name}={os.environ[name]}" for name in names if name in os.environ)
    if found and len(mask) == 1 and (os.cpu_count() or 1) > 1:
        warnings.warn(
            f"this thread may use only 1 of {os.cpu_count()} cores, and threads and processes that it starts (such "
            f"as those of make_vec) inherit this limit: an OpenMP library may have set it because of {found}",
            RuntimeWarning,
            stacklevel=4,
        )


class _KeepCores:
    """Loading _native loads libgomp, which binds the importing thread to one core if OMP_PROC_BIND,
    OMP_PLACES or GOMP_CPU_AFFINITY say so. Threads and processes started later would inherit that core.
    Gives the thread back the cores that it had."""

    def __enter__(self):
        import os

        self._mask = os.sched_getaffinity(0)

    def __exit__(self, *_):
        import os

        if os.sched_getaffinity(0) != self._mask:
            os.sched_setaffinity(0, self._mask)
        _warn_of_one_core(self._mask)


def _load():
    """The names that need the compiled half, which brings MuJoCo into the process."""
    try:
        with _KeepCores():
            from shoal_rl._native import Error, Policy, __version__, tasks
    except ModuleNotFoundError as error:
        # pip refuses the wheel under another Python, PYTHONPATH and copied folders do not.
        raise ImportError(_why_not_native()) from error
    from shoal_rl.mapping import Mapping
    from shoal_rl.runs import evaluations, metrics

    return {
        "Error": Error,
        "Mapping": Mapping,
        "Policy": Policy,
        "__version__": __version__,
        "tasks": tasks,
        "evaluations": evaluations,
        "metrics": metrics,
    }


def _is_actor():
    """python -m shoal_rl.actor: it has a compiled half of its own, and the user's environment may
    have another MuJoCo."""
    import sys

    return sys.orig_argv[1:3] == ["-m", "shoal_rl.actor"]


def __getattr__(name):
    if name in __all__:
        globals().update(_load())
        return globals()[name]
    raise AttributeError(f"module 'shoal_rl' has no attribute '{name}'")


if not _is_actor():
    globals().update(_load())

__all__ = ["Error", "Mapping", "Policy", "__version__", "evaluations", "make", "make_vec", "metrics", "tasks"]


def make(task, *, render_mode=None, **keys):
    """A gymnasium.Env of the task.

    keys: configuration keys of an environment, without their section: pixels, cameras, grey, height,
    width, stack, goal_mode, proprioception, quality, custom_cameras; task_library, model, physics,
    action_repeat, end_on_success, distance_threshold, body_mass. The default of cameras is the task's
    first camera. With pixels=False the environment observes state and goals; proprioception and
    goal_mode select among them. task_library: NAME.so that defines further tasks (docs/own_task.md);
    tasks() then lists them too. render_mode: None, or "rgb_array" for the latest frame with the cameras
    side by side.
    """
    from shoal_rl.environment import Environment

    return Environment(task, render_mode=render_mode, **keys)


def make_vec(task, n, **keys):
    """n environments, each in a process of its own: a gymnasium.vector.AsyncVectorEnv."""
    from functools import partial

    from gymnasium.vector import AsyncVectorEnv

    return AsyncVectorEnv([partial(make, task, **keys)] * n)
