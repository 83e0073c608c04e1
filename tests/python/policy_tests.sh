#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# policy_tests.sh BUILD PYTHON: runs the tests of the Python package that need NumPy and pytest alone
# on the package in the build folder. Without one of them it says so, as GoogleTest does, and skips.
set -euo pipefail
readonly build=$1 python=$2
here=$(dirname "$(readlink -f "$0")")
for module in numpy pytest; do
  if ! "$python" -c "import $module" 2>/dev/null; then
    printf '[ RUN      ] Python.Policies\n%s: Skipped\n%s\n' "$0" "needs the Python module $module"
    exit 77
  fi
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/bin/random-checkpoints" "$work" sac- >/dev/null
# Nothing is written beside the sources of the package, from which the wheel is made.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$build/package SHOAL_CHECKPOINTS=$work \
  SHOAL_POLICY_LIBRARY=$build/common/policy/libshoal-policy.so \
  "$python" -m pytest -q -p no:cacheprovider "$here/test_policy.py"
