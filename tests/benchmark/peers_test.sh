#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `./run bench --against peers` where PyPI cannot be reached, in a folder of the test's own whose
# `run` builds nothing: it says so in one line, prints our own rows and ends with 1.
#
# usage: peers_test.sh FOLDER_OF_THE_PROGRAMS
set -euo pipefail
readonly here=$(dirname "$(readlink -f "$0")") programs=$(readlink -f "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p tests/benchmark tests/comparison build/release
cp "$here/against_peers.sh" tests/benchmark/
cp "$here/../comparison/bench_peers.py" tests/comparison/
ln -s "$programs" build/release/bin
printf '#!/bin/sh\n' >run
chmod +x run

# Nothing listens on the port of discard.
export PIP_INDEX_URL=http://127.0.0.1:9/simple PIP_RETRIES=0 PIP_CONFIG_FILE=/dev/null
status=0
tests/benchmark/against_peers.sh --against peers --venv "$folder/venv" --only "compact, batch 128" \
  --repetitions 1 --seconds 0.01 >rows.json 2>said || status=$?
if ((status != 1)) || (($(grep -c 'the peers do not install: .' said) != 1)); then
  echo "it ended with $status and said: $(cat said)" >&2
  exit 1
fi
python3 - <<'PYTHON'
import json

rows = json.load(open("rows.json"))["rows"]
assert any("compact, batch 128" in row["stage"] and row["figure"] > 0 for row in rows), rows
PYTHON
