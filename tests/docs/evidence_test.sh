#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/comparison/evidence.py in a repository of its own: add, restore, pack, verify, refusals.
set -euo pipefail
script="$(cd "$(dirname "$0")/../comparison" && pwd)/evidence.py"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "evidence_test: $*" >&2; exit 1; }
expect() { [ "$1" = "$2" ] || fail "expected '$2', got '$1'"; }
refuses() { # TEXT COMMAND...
  local text="$1" out
  shift
  if out="$("$@" 2>&1)"; then fail "'$*' succeeded"; fi
  [[ "$out" == *"$text"* ]] || fail "'$*' said '$out', expected '$text'"
}

mkdir -p docs/results
printf 'film' > docs/results/a.mp4
printf '{"aggregate": {"episodes": 1}, "episodes": [{"success": true}]}' > docs/results/eval.json
git init -q .
git add .
git -c user.name=a -c user.email=a@example.org commit -q -m a
printf 'new film' > docs/results/b.mp4

python3 "$script" add docs/results/a.mp4 docs/results/eval.json docs/results/b.mp4
[ ! -e docs/results/a.mp4 ] || fail "a.mp4 is still in the tree"
expect "$(tr -d ' \n' < docs/results/eval.json)" '{"aggregate":{"episodes":1}}'
expect "$(grep -c sha256 docs/results/evidence.json)" 3

rm -r build
python3 "$script" restore docs/results/a.mp4 docs/results/eval.json > /dev/null
expect "$(cat build/evidence/docs/results/a.mp4)" film
grep -q success build/evidence/docs/results/eval.json || fail "the episodes are not restored"
refuses "is in no commit" python3 "$script" restore docs/results/b.mp4
refuses "has no 'c.mp4'" python3 "$script" restore c.mp4

mkdir -p build/evidence/docs/results
printf 'new film' > build/evidence/docs/results/b.mp4
python3 "$script" pack all.tar.gz
python3 "$script" verify all.tar.gz > /dev/null
rm -r build
python3 "$script" restore --from all.tar.gz docs/results/b.mp4 > /dev/null
expect "$(cat build/evidence/docs/results/b.mp4)" "new film"

sed -i 's/"sha256": "./"sha256": "x/' docs/results/evidence.json
refuses "another SHA-256" python3 "$script" verify all.tar.gz
refuses "another SHA-256" python3 "$script" restore docs/results/a.mp4
