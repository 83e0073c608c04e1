#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Refusals of `./run bench --compare`, in a repository of the test's own: one line, exit 2, and
# nothing built.
set -euo pipefail
readonly script=$(dirname "$(readlink -f "$0")")/compare.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export XDG_CACHE_HOME=$folder/cache
mkdir -p "$folder/repository/tests/benchmark"
cd "$folder/repository"
cp "$script" tests/benchmark/
git init --quiet .
git -c user.name=test -c user.email=test@example.org add .
git -c user.name=test -c user.email=test@example.org commit --quiet -m one

# refused PATTERN ARGUMENTS...
refused() {
  local pattern=$1 said status=0
  shift
  said=$(tests/benchmark/compare.sh "$@" 2>&1) || status=$?
  if ((status != 2)) || (($(wc -l <<<"$said") != 1)) || [[ ! $said =~ $pattern ]]; then
    echo "'$*' ended with $status and said: $said" >&2
    exit 1
  fi
}
refused "there is no commit 'nowhere'" --compare nowhere
refused "there is no commit '--help'" --compare --help
refused "--compare wants a value" --compare
refused "--repetitions 'many'" --compare HEAD --repetitions many
refused "'--odd' does not go with --compare" --compare HEAD --odd
touch new
refused "the tree holds changes" --compare HEAD
[[ ! -e $folder/cache ]]
