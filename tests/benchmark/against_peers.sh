#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ./run bench --against peers [--venv DIR] [--repetitions N] [--seconds S] [--only TEXT]
#             [--variants V,V]
#
# Our rates beside those of PyTorch, Stable-Baselines3 and Gymnasium-Robotics, measured in turn
# (tests/comparison/bench_peers.py). They are taken from PyPI into a virtual environment outside of
# the tree, DIR or one in the user's cache, unless they are there. Where they do not install it says
# so, prints our own rows and ends with 1.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

venv=${XDG_CACHE_HOME:-$HOME/.cache}/shoal/peers others=()
while (($# > 0)); do
  case $1 in
    --against | --venv | --repetitions | --seconds | --only | --variants)
      if (($# < 2)); then
        echo "bench: $1 wants a value" >&2
        exit 2
      fi
      case $1 in
        --against)
          if [[ $2 != peers ]]; then
            echo "bench: --against '$2': there are peers alone" >&2
            exit 2
          fi
          ;;
        --venv) venv=$2 ;;
        *) others+=("$1" "$2") ;;
      esac
      shift 2
      ;;
    *)
      echo "bench: '$1' does not go with --against" >&2
      exit 2
      ;;
  esac
done

# 3.3.7: the newest MuJoCo that loads Gymnasium-Robotics' Fetch models.
readonly peers=(torch stable-baselines3 gymnasium-robotics mujoco==3.3.7)

has_peers() {
  "$venv/bin/python" -c 'import torch, stable_baselines3, gymnasium_robotics, mujoco' 2>/dev/null
}

./run build shoal-bench shoal-bench-actors >&2
python=$venv/bin/python
if ! has_peers; then
  log=$(mktemp)
  echo "installing ${peers[*]} into $venv" >&2
  if ! { python3 -m venv "$venv" && "$python" -m pip install --quiet "${peers[@]}"; } >"$log" 2>&1 ||
    ! has_peers; then
    echo "bench: the peers do not install: $(grep -v '^ *$' "$log" | tail -n 1)" >&2
    python=-
  fi
  rm -f "$log"
fi
exec python3 tests/comparison/bench_peers.py build/release/bin "$python" "${others[@]}"
