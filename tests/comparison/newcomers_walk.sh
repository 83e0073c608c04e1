#!/usr/bin/env bash
# tests/comparison/newcomers_walk.sh ROOT PACKAGE [TRAIN-ARGUMENTS...]: what a newcomer does with the
# Debian package in a bare Debian 12: install, check, train, film, report; then purge. Each step is
# shown with its time, and the first that fails ends it. ROOT is made by debootstrap where it is not
# there yet, and kept. The package is installed by root, all else is done by a user without rights;
# /dev/shm has 64 MB. Needs root and debootstrap; a figure is worth something on a quiet machine.
#
#   ./run package
#   sudo tests/comparison/newcomers_walk.sh /srv/bare build/package/packages/shoal_0.1.0-0shoal1_amd64.deb
set -euo pipefail
if (($# < 2)); then
  echo "usage: newcomers_walk.sh ROOT PACKAGE [TRAIN-ARGUMENTS...]" >&2
  exit 2
fi
root=$(realpath -m "$1")
readonly root package=$2
shift 2
readonly mirror=http://deb.debian.org/debian
if [[ ! -e $root/etc/debian_version ]]; then
  debootstrap --variant=minbase bookworm "$root" "$mirror" >/dev/null
  printf 'deb %s bookworm main\ndeb %s-security bookworm-security main\n' "$mirror" "$mirror" \
    >"$root/etc/apt/sources.list"
  chroot "$root" useradd --create-home newcomer
fi
cp "$package" "$root/srv/shoal.deb"
cp /etc/resolv.conf "$root/etc/resolv.conf"

cat >"$root/srv/walk.sh" <<'WALK'
set -euo pipefail
rm -rf ~/walk && mkdir ~/walk && cd ~/walk
step() {
  local start=$SECONDS
  printf '\n$ %s\n' "$*"
  "$@"
  echo "== $((SECONDS - start)) s"
}
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

start=$SECONDS
within sh -c 'apt-get -q update && apt-get -q -y install /srv/shoal.deb' >"$root/srv/install.log" 2>&1 ||
  { tail "$root/srv/install.log" >&2; exit 1; }
echo "installed: $((SECONDS - start)) s"
within runuser -u newcomer -- env HOME=/home/newcomer bash /srv/walk.sh "$@"
echo "from the package to the report: $((SECONDS - start)) s"
within apt-get -q -y purge shoal >"$root/srv/purge.log" 2>&1
left=$(within find / -xdev -path /srv -prune -o -path /home -prune -o -iname '*shoal*' -print)
echo "left after the purge: ${left:-nothing}"
