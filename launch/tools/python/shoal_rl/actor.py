# SPDX-License-Identifier: Apache-2.0
"""python -m shoal_rl.actor: an actor of a run whose environment is written in Python.

The coordinator starts it in place of the program shoal-actor, whose arguments it takes. The loop is
the same C++; of Python it calls reset, step and render of the environment alone.
"""

import faulthandler
import os
import pathlib
import signal
import sys

import shoal_rl


def _preload():
    """Starts the interpreter again with a library that must be loaded before libc: the DDS library
    then waits on a clock that is never set (docs/decisions/0004). Returns in the second one."""
    library = str(pathlib.Path(__file__).with_name("libshoal_steady_waits.so").resolve())
    preloaded = [name for name in os.environ.get("LD_PRELOAD", "").split(":") if name]
    if library not in preloaded:
        os.environ["LD_PRELOAD"] = ":".join([library, *preloaded])
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
    preloaded.remove(library)  # processes that the environment starts do not need it
    if preloaded:
        os.environ["LD_PRELOAD"] = ":".join(preloaded)
    else:
        del os.environ["LD_PRELOAD"]


def main():
    _preload()
    # A fault of a C extension, and a call that does not return (SIGUSR2), leave the Python stack in the log.
    faulthandler.enable()
    faulthandler.register(signal.SIGUSR2, all_threads=True, chain=False)
    try:
        from shoal_rl import _actor
    except ModuleNotFoundError:
        # pip refuses the wheel under another Python, PYTHONPATH and copied folders do not.
        print(f"shoal-actor: error: {shoal_rl._why_not_native()}", file=sys.stderr)
        return 2
    from shoal_rl.hosting import Refused, open_environment

    return _actor.run(["shoal-actor", *sys.argv[1:]], open_environment, Refused)


if __name__ == "__main__":
    sys.exit(main())
