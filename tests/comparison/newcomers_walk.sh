#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/comparison/newcomers_walk.sh ROOT PACKAGE|CLONE [TRAIN-ARGUMENTS...]: what a newcomer does in a
# bare Debian: install the package, or take a clone and build its programs; check, train, film,
# report; then purge the package. Each step is shown with its time and the seconds of CPU that it
# took, and the first that fails ends it. ROOT is made by debootstrap where it is not there yet, of
# the release SUITE (bookworm), and kept. A package is installed by root, all else with it is done by
# a user without rights; a clone has root, which installs what is missing, and git. /dev/shm has
# 64 MB. Needs root and debootstrap; a time is worth something on a quiet machine.
#
#   ./run package
#   sudo tests/comparison/newcomers_walk.sh /srv/bare build/package/packages/shoal_0.1.0-0shoal1_amd64.deb
#   sudo tests/comparison/newcomers_walk.sh /srv/bare-clone .
#   sudo SUITE=trixie tests/comparison/newcomers_walk.sh /srv/bare-13 .
set -euo pipefail
if (($# < 2)); then
  echo "usage: newcomers_walk.sh ROOT PACKAGE|CLONE [TRAIN-ARGUMENTS...]" >&2
  exit 2
fi
root=$(realpath -m "$1")
readonly root source=$2
shift 2
readonly suite=${SUITE:-bookworm} mirror=http://deb.debian.org/debian
if [[ ! -e $root/etc/debian_version ]]; then
  debootstrap --variant=minbase "$suite" "$root" "$mirror" >/dev/null
  printf 'deb %s %s main\ndeb %s-security %s-security main\n' "$mirror" "$suite" "$mirror" "$suite" \
    >"$root/etc/apt/sources.list"
  chroot "$root" useradd --create-home newcomer
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"

cat >"$root/srv/walk.sh" <<'WALK'
set -euo pipefail
TIMEFORMAT='== %0R s, CPU %0U + %0S s'
step() {
  printf '\n$ %s\n' "$*"
  time "$@"
}
if [[ -e /srv/shoal.deb ]]; then
  rm -rf ~/walk && mkdir ~/walk && cd ~/walk
else
  rm -rf ~/shoal && cd ~
  step git clone -q /srv/shoal.git shoal
  cd shoal
  step ./run check
  PATH=$PWD/build/release/bin:$PATH
fi
step shoal check
step shoal train --preset fetch-reach-state --set run_name=reach "$@"
step shoal film reach
step shoal report reach
ls -l runs/reach/videos/best.mp4 report.html
WALK

# Processes and mounts of its own, all of which end with it.
readonly enter='
mount -t proc proc "$0/proc"
mount -t tmpfs -o mode=755 dev "$0/dev"
for device in null zero full random urandom; do
  touch "$0/dev/$device"
  mount --bind "/dev/$device" "$0/dev/$device"
done
ln -s /proc/self/fd "$0/dev/fd"
mkdir "$0/dev/shm"
mount -t tmpfs -o size=64m,mode=1777 shm "$0/dev/shm"
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$0" "$@"'
within() { unshare --mount --pid --fork --kill-child bash -euc "$enter" "$root" "$@"; }

# quietly LOG COMMAND...: within, and what it said only when it fails.
quietly() {
  local log=$root/srv/$1
  shift
  within "$@" >"$log" 2>&1 || { tail "$log" >&2; exit 1; }
}

if [[ -d $source ]]; then
  rm -rf "$root/srv/shoal.deb" "$root/srv/shoal.git"
  git clone -q --bare "$source" "$root/srv/shoal.git"
  quietly git.log sh -c 'apt-get -q update && apt-get -q -y --no-install-recommends install git'
  start=$SECONDS
  within env HOME=/root bash /srv/walk.sh "$@"
  echo "from the clone to the report: $((SECONDS - start)) s"
else
  cp "$source" "$root/srv/shoal.deb"
  start=$SECONDS
  quietly install.log sh -c 'apt-get -q update && apt-get -q -y install /srv/shoal.deb'
  echo "installed: $((SECONDS - start)) s"
  within runuser -u newcomer -- env HOME=/home/newcomer bash /srv/walk.sh "$@"
  echo "from the package to the report: $((SECONDS - start)) s"
  quietly purge.log apt-get -q -y purge shoal
  left=$(within find / -xdev -path /srv -prune -o -path /home -prune -o -iname '*shoal*' -print)
  echo "left after the purge: ${left:-nothing}"
fi
