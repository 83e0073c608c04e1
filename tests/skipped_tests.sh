#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/skipped_tests.sh LOG...: lists the tests that were skipped in these logs of ctest
# (BUILD/Testing/Temporary/LastTest.log), by reason, and says of each reason whether these
# surroundings explain it: the CPU, the user's rights, the installed programs. Exit code 1 when they
# do not explain one: a test that can run here is to run. A new reason for GTEST_SKIP gets its line in
# explained().
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

# Reason, tab, test; one line per skip.
skips() {
  awk '/^\[ RUN      \] / { test = $0; sub(/^[^\]]*\] /, "", test) }
       /: Skipped$/ { getline; print $0 "\t" test }' "$@"
}

# Same as tests/support/isolation.h: as root here, else as root of a namespace of users.
can_unshare() {
  local user=()
  ((EUID == 0)) || user=(--user --map-root-user)
  unshare "${user[@]}" "$@" true 2>/dev/null
}

# Whether a group below this process's own can be made and limited.
can_limit_memory() {
  local line key group limit made=1
  while IFS= read -r line; do
    case $line in
      *:memory:*) key=/sys/fs/cgroup/memory limit=memory.limit_in_bytes ;;
      0::*) key=/sys/fs/cgroup limit=memory.max ;;
      *) continue ;;
    esac
    group=$key${line#*:*:}
    [[ -e $group/$limit ]] || continue
    mkdir "$group/shoal-skips-$$" 2>/dev/null || continue
    echo 1000000000 2>/dev/null >"$group/shoal-skips-$$/$limit" && made=0
    rmdir "$group/shoal-skips-$$"
  done </proc/self/cgroup
  return "$made"
}

has_capability() {
  local effective
  effective=$(awk '/^CapEff/ { print $2 }' /proc/self/status)
  (((16#$effective >> $1) & 1))
}

# Whether these surroundings are why a test is skipped for that reason.
explained() {
  case $1 in
    "only as a program that another test starts") true ;;
    "this CPU has no bf16 arithmetic") ! grep -qE '\<(avx512_bf16|amx_bf16)\>' /proc/cpuinfo ;;
    "no fingerprint of "*) ! grep -qF "\"${1#*recorded for: }\"" tests/golden/fingerprints.json ;;
    "needs root, iproute2 and network namespaces")
      ((EUID != 0)) || ! command -v ip >/dev/null || ! can_unshare --net
      ;;
    "unshare: no process numbers"*) ! can_unshare --pid --fork --mount-proc ;;
    unshare:* | mount* | loopback:*) ! can_unshare --mount --net ;;
    "no writable memory control group"*) ! can_limit_memory ;;
    "needs CAP_NET_RAW") ! has_capability 13 ;;
    "needs two cores") (($(nproc) < 2)) ;;
    "needs root: slurmd"* | "needs root: to be another user") ((EUID != 0)) ;;
    "needs "*" (Debian's "*")")
      local program=${1#needs }
      ! command -v "${program%% *}" >/dev/null
      ;;
    "needs the Python module "*)
      ! "${SHOAL_PYTHON:-/usr/bin/python3}" -c "import ${1##* }" 2>/dev/null
      ;;
    *) false ;;
  esac
}

unexplained=0
while IFS= read -r reason; do
  verdict="explained by these surroundings"
  if ! explained "$reason"; then
    verdict="NOT EXPLAINED by these surroundings"
    unexplained=1
  fi
  echo "skipped ($verdict): $reason"
  skips "$@" | awk -F '\t' -v reason="$reason" '$1 == reason { print "  " $2 }' | sort -u
done < <(skips "$@" | cut -f 1 | sort -u)
exit "$unexplained"
