#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ./run bench --compare COMMIT [--repetitions N] [--only TEXT] [--seconds S] [--threads N]
#
# Builds another commit in a worktree outside of this tree and runs shoal-bench of both in turn, N
# times (5), so that a machine whose speed drifts does not favour either. Prints for each row of both
# ours / theirs and its spread. Exit 2: the commit is unknown, or the tree has uncommitted
# changes, so that no commit would name what was compared.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

readonly build=build/release
readonly cache=${XDG_CACHE_HOME:-$HOME/.cache}/shoal

usage_error() {
  echo "bench: $*" >&2
  exit 2
}

commit="" repetitions=5 others=()
while (($# > 0)); do
  case $1 in
    --compare | --repetitions | --only | --seconds | --threads)
      (($# > 1)) || usage_error "$1 wants a value"
      case $1 in
        --compare) commit=$2 ;;
        --repetitions) repetitions=$2 ;;
        *) others+=("$1" "$2") ;;
      esac
      shift 2
      ;;
    *) usage_error "'$1' does not go with --compare (--repetitions, --only, --seconds, --threads do)" ;;
  esac
done
[[ $repetitions =~ ^[1-9][0-9]{0,2}$ ]] || usage_error "--repetitions '$repetitions' is not 1 to 999"
theirs=$(git rev-parse --verify --quiet --end-of-options "$commit^{commit}") ||
  usage_error "there is no commit '$commit'"
[[ -z $(git status --porcelain) ]] ||
  usage_error "the tree holds changes that no commit does: commit or stash them, then compare"

mkdir -p "$cache"
work=$(mktemp -d "$cache/compare-XXXXXX")
readonly tree=$work/tree
clean_up() {
  [[ ! -d $tree ]] || git worktree remove --force "$tree"
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 130' INT TERM

./run build shoal-bench shoal-bench-report >&2
git worktree add --quiet --detach "$tree" "$theirs" >&2
launchers=()
if command -v ccache >/dev/null; then
  launchers=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
# The folder has another name each time: the cache is to know its sources all the same.
export CCACHE_BASEDIR=$tree CCACHE_NOHASHDIR=1
echo "building ${theirs:0:12} in $tree" >&2
if ! (cd "$tree" && cmake --preset release "${launchers[@]}" && ninja -C build/release shoal-bench) \
  >"$work/build.log" 2>&1; then
  tail -n 30 "$work/build.log" >&2
  echo "bench: ${theirs:0:12} does not build here" >&2
  exit 1
fi

# side NAME PROGRAM REPETITION
side() {
  echo "== $1, repetition $3 of $repetitions" >&2
  "$2" --repetitions 1 "${others[@]}" >"$work/$1-$3.json" || [[ -s $work/$1-$3.json ]]  # 1: a row was not measured
}
ours_files=() theirs_files=()
for ((i = 1; i <= repetitions; ++i)); do
  # The first of two has the cooler machine: each side is it in turn.
  if ((i % 2)); then
    side ours "$build/bin/shoal-bench" "$i"
    side theirs "$tree/build/release/bin/shoal-bench" "$i"
  else
    side theirs "$tree/build/release/bin/shoal-bench" "$i"
    side ours "$build/bin/shoal-bench" "$i"
  fi
  ours_files+=("$work/ours-$i.json") theirs_files+=("$work/theirs-$i.json")
done
"$build/bin/shoal-bench-report" compare --ours "${ours_files[@]}" --theirs "${theirs_files[@]}"
