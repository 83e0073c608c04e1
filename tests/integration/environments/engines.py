# SPDX-License-Identifier: Apache-2.0
"""An environment that brings an engine of its own, and therefore refuses Shoal's."""

import pathlib

from point import Point


class Alone(Point):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        maps = pathlib.Path("/proc/self/maps").read_text()
        found = {line.split("/")[-1] for line in maps.splitlines() if "mujoco" in line.lower() or "osmesa" in line.lower()}
        if found:
            raise RuntimeError(f"this process has loaded {sorted(found)}")
