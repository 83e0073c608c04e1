# SPDX-License-Identifier: Apache-2.0
"""A user's environment, opened and described for Shoal's actor (shoal_rl.actor).

env.id names it in one of three ways:
  Pendulum-v1                an environment that gymnasium.make knows
  package.module:Name        a class or a function of a module, else a name that gymnasium.make knows
                             once the module is imported
  /folder/my_env.py:Name     a class or a function of a file, which returns an environment
"""

import importlib
import importlib.util
import json
import pathlib
import sys

from shoal_rl.goals import NoGoal, find_goal
from shoal_rl.names import array_name

_GOAL_EPISODES = 20  # that are begun to see goals


class Refused(Exception):
    """One line for the user: what is wrong with the environment and what was expected."""


def _one_line(error):
    return " ".join(str(error).split())


def _gymnasium():
    try:
        return importlib.import_module("gymnasium")
    except ModuleNotFoundError as error:
        if error.name != "gymnasium":
            raise
        raise Refused(
            f"{sys.executable} has no package gymnasium; install it there (pip install gymnasium), or name "
            "another interpreter by env.python"
        ) from None


def _import(name):
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        # A module that this one imports is another mistake, which its traceback shows.
        if error.name is None or not (name == error.name or name.startswith(error.name + ".")):
            raise
        raise Refused(
            f"module '{name}' was not found by {sys.executable}; expected it installed there or in the folder "
            "where shoal train was started"
        ) from None


def _load_file(path):
    if not path.is_file():
        raise Refused(f"file '{path}' does not exist")
    # Modules beside the file can be imported by it.
    sys.path.insert(0, str(path.parent))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def _make_registered(name, kwargs):
    gymnasium = _gymnasium()
    try:
        spec = gymnasium.spec(name)
    except Exception as error:
        raise Refused(f"gymnasium knows no environment '{name}': {_one_line(error)}") from None
    # The checker would test each step again, which Shoal does.
    return gymnasium.make(spec, **{"disable_env_checker": True, **kwargs})


def _make(identifier, kwargs):
    where, _, name = identifier.rpartition(":")
    if where.endswith(".py"):
        module = _load_file(pathlib.Path(where))
        if not callable(getattr(module, name, None)):
            raise Refused(f"'{where}' has no class or function '{name}' that makes an environment")
        return getattr(module, name)(**kwargs)
    if not where:
        return _make_registered(identifier, kwargs)
    module = _import(where)
    made_by = getattr(module, name, None)
    return made_by(**kwargs) if callable(made_by) else _make_registered(name, kwargs)


def _wrappers(environment):
    """The environment and what it wraps, from the outside in."""
    while environment is not None:
        yield environment
        environment = getattr(environment, "env", None)


def _check_interface(environment):
    if hasattr(environment, "num_envs") and hasattr(environment, "single_action_space"):
        raise Refused("it is a vector environment; expected a single one: Shoal's actors run several side by side")
    for name in ("reset", "step", "observation_space", "action_space"):
        if not hasattr(environment, name):
            raise Refused(f"{type(environment).__name__} has no {name}; expected Gymnasium's interface")
    for wrapper in _wrappers(environment):
        if type(wrapper).__name__ in ("Autoreset", "AutoReset", "AutoResetWrapper", "AutoresetV0"):
            raise Refused(
                f"the wrapper {type(wrapper).__name__} hides where episodes end; expected the environment without it"
            )


def _episode_steps(environment):
    for wrapper in _wrappers(environment):
        steps = getattr(wrapper, "_max_episode_steps", None)
        if isinstance(steps, int) and steps > 0:
            return steps
    spec = getattr(environment, "spec", None)
    return getattr(spec, "max_episode_steps", None) or 0


def _kind(space):
    """The name of the space's class, or of the first class above it that Shoal knows."""
    names = [kind.__name__ for kind in type(space).__mro__]
    return next((name for name in names if name in ("Box", "Dict")), names[0])


def _bound(bound):
    numbers = [float(number) for number in bound.reshape(-1)]
    listed = [None if number in (float("inf"), float("-inf")) else number for number in numbers]
    return listed[0] if len(set(listed)) == 1 else listed


def _box(space, name):
    import numpy

    # An array without dimensions is one number.
    shape = [int(side) for side in space.shape] or [1]
    low, high = (numpy.asarray(bound) for bound in (space.low, space.high))
    return {
        "name": name,
        "shape": shape,
        "dtype": str(numpy.dtype(space.dtype)),
        "low": _bound(low),
        "high": _bound(high),
    }


def _arrays(space, keys=()):
    kind = _kind(space)
    if kind == "Box":
        return [(keys, _box(space, array_name(keys)))]
    if kind == "Dict":
        return [array for key, inner in space.spaces.items() for array in _arrays(inner, (*keys, key))]
    where = f" '{array_name(keys)}'" if keys else ""
    raise Refused(
        f"the observation{where} is {kind}; expected Box, or Dict of them "
        "(gymnasium.wrappers.FlattenObservation makes a Box of it)"
    )


def _action(space):
    kind = _kind(space)
    if kind != "Box":
        raise Refused(f"the action space is {kind}; expected a Box with finite bounds: actions are continuous")
    described = _box(space, "action")
    if described["dtype"] not in ("float32", "float64"):
        raise Refused(f"the action space is a Box of {described['dtype']}; expected float32 or float64")
    return described


class Opened:
    """An environment with its description.

    description: JSON of what its spaces say (common/tasks/environment_description.h); paths: the keys
    that lead to each array of an observation; action_shape: as its action space has it.
    """

    def __init__(self, environment):
        _check_interface(environment)
        self.environment = environment
        arrays = _arrays(environment.observation_space)
        action = _action(environment.action_space)
        self.paths = [keys for keys, _ in arrays]
        self.action_shape = tuple(int(side) for side in environment.action_space.shape)
        self.description = json.dumps(
            {
                "episode_steps": _episode_steps(environment),
                "action": action,
                "observation": [described for _, described in arrays],
            }
        )

    def find_goal(self):
        """JSON: {"goal": ...} of a goal environment whose rewards Shoal can compute, {"no_goal": why}
        of another one, {} of an environment without goals."""
        names = ("achieved_goal", "desired_goal")
        if not all((name,) in self.paths for name in names):
            return "{}"
        goals = []
        for seed in range(_GOAL_EPISODES):
            observation, _ = self.environment.reset(seed=seed)
            goals += [observation[name] for name in names]
        try:
            return json.dumps({"goal": find_goal(self.environment, goals)})
        except NoGoal as reason:
            return json.dumps({"no_goal": str(reason)})


def open_environment(identifier, kwargs, folder, render):
    """kwargs: JSON of an object. folder: where modules are looked for besides the interpreter's own
    places. render: "rgb_array", or empty for an environment that is not looked at."""
    if folder and folder not in sys.path:
        sys.path.insert(0, folder)
    arguments = json.loads(kwargs)
    if render:
        arguments.setdefault("render_mode", render)
    return Opened(_make(identifier, arguments))
