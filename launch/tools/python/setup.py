# SPDX-License-Identifier: Apache-2.0
"""Says of the package, all else of which is in pyproject.toml, that it has compiled code."""

from setuptools import Distribution, setup


class CompiledDistribution(Distribution):
    """CMake has built the module: setuptools has nothing to compile, only a wheel to name."""

    def has_ext_modules(self):
        return True


setup(distclass=CompiledDistribution)
