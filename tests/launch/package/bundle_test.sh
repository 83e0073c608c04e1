#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# bundle_test.sh BUILD [--slim] [--debian SUITE]: makes a bundle of BUILD, unpacks it elsewhere, and
# uses it there with nothing of this system's libraries: `shoal check`, a training, an evaluation, a
# training from pixels (slim: in quality native), the web page, a plot, manual, completions and (not
# slim) a film. --debian: in a bare root of that Debian, made by debootstrap, which needs root and a
# mirror; else in this system, as it is. With XZ_LEVEL=1 (make.sh), as CI sets it, the archive may be
# 1.2 times as large: a full one has 102 MB instead of 85.
set -euo pipefail
build=$(readlink -f "$1")
shift
slim='' suite=''
while (($# > 0)); do
  case $1 in
    --slim) slim=--slim ;;
    --debian) suite=$2 && shift ;;
    *) echo "bundle_test: $1?" >&2; exit 2 ;;
  esac
  shift
done
here=$(dirname "$(readlink -f "$0")")
# `shoal check` fails without room for a full replay (4.3 GB), so a small /tmp is not used.
for folder in "${TMPDIR:-/tmp}" /var/tmp /dev/shm; do
  (($(df --output=avail --block-size=1M "$folder" | tail -1) > 6000)) && break
done
work=$(mktemp -d -p "$folder")
trap 'rm -rf "$work"' EXIT
fail() { echo "bundle_test: $*" >&2; exit 1; }

archive=$("$here/../../../launch/package/bundle/make.sh" "$build" "$work/out" $slim)
most=90000000
[[ -z $slim ]] || most=40000000
[[ ${XZ_LEVEL:-9} == 9 ]] || most=$((most * 12 / 10))
size=$(stat -c %s "$archive")
echo "$archive: $size bytes"

# A folder with a space in its name, in a root that has nothing of ours.
root=$work/root
if [[ -n $suite ]]; then
  debootstrap --variant=minbase "$suite" "$root" >"$work/debootstrap.log" 2>&1 ||
    { tail -5 "$work/debootstrap.log" >&2; fail "no root of $suite"; }
  inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/tmp TERM=dumb sh -c "$1"; }
  mount --bind /proc "$root/proc"
  mount -t tmpfs none "$root/dev/shm" 2>/dev/null || mkdir -p "$root/dev/shm"
  trap 'umount "$root/proc" "$root/dev/shm" 2>/dev/null; rm -rf "$work"' EXIT
  place="/opt/a place"
else
  mkdir -p "$root"
  inside() { env -i PATH=/usr/bin:/bin HOME="$work" TERM=dumb sh -c "$1"; }
  place="$root/a place"
fi
target="$root/a place"
[[ -z $suite ]] || target="$root/opt/a place"
mkdir -p "$target"
tar -C "$target" -xf "$archive"
name=$(basename "$archive" .tar.xz)
bundle="$place/$name"
run() { inside "cd '$place' && $1"; }

(cd "$target/$name" && sha256sum --quiet -c SHA256SUMS) || fail "a file is not as it was packed"
run "'$bundle/bin/shoal' --version"

# No library of the system: each that a running program has mapped is a file of the bundle.
run "'$bundle/bin/shoal' check" >"$work/check" 2>&1 || { cat "$work/check"; fail "shoal check"; }
osmesa=missing
! inside "ls /usr/lib/x86_64-linux-gnu/libOSMesa.so.8" >/dev/null 2>&1 || osmesa=installed
if [[ -z $slim || $osmesa == installed ]]; then
  grep -q "OK    opengl" "$work/check" || { cat "$work/check"; fail "OpenGL draws nothing"; }
else
  grep -q "WARN  opengl" "$work/check" || { cat "$work/check"; fail "check does not miss OSMesa"; }
fi
# A GPU: LD_LIBRARY_PATH names the folders of CUDA's libraries, behind the bundle's own. The libraries
# that a driver of the system needs are the bundle's.
for soname in libdl.so.2 libpthread.so.0 librt.so.1; do
  [[ -s $target/$name/lib/$soname ]] || fail "no $soname"
done
mkdir "$target/cuda"
cp "$build/bin/fake_gpu/libshoal-cuda.so" "$target/cuda/"
for library in "$target/$name"/lib/libfmt.so.*; do echo broken >"$target/cuda/${library##*/}"; done
run "LD_LIBRARY_PATH='$place/cuda' FAKE_GPU=works '$bundle/bin/shoal' check" >"$work/gpu" 2>&1 ||
  { cat "$work/gpu"; fail "shoal check with LD_LIBRARY_PATH"; }
grep -q "OK    gpu.*Fake GPU" "$work/gpu" || { cat "$work/gpu"; fail "no GPU by LD_LIBRARY_PATH"; }
# A slim bundle differs in what it leaves out: the rest is tried in the full one.
if [[ -z $slim ]]; then
  keys="--set env_steps=2000 --set eval.interval=1000 --set eval.episodes=2 --set eval.final_episodes=4"
  run "'$bundle/bin/shoal' train --preset fetch-reach-state $keys --set run_name=state" >"$work/state" 2>&1 ||
    { cat "$work/state"; fail "training from state"; }
  run "'$bundle/bin/shoal' eval state --episodes 3" >/dev/null || fail "evaluation"
  # The web page at its address, a plot where gnuplot is installed, manual pages and completions.
  inside "cd '$place'; timeout 60 '$bundle/bin/shoal' web --port 0 >web 2>&1 & echo \$!" >"$work/web.pid"
  for _ in {1..100}; do ! grep -qs "http://" "$target/web" || break; sleep 0.1; done
  port=$(sed -n 's#.*http://127\.0\.0\.1:\([0-9]*\).*#\1#p' "$target/web")
  [[ -n $port ]] || { cat "$target/web"; fail "no address of the web page"; }
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nConnection: close\r\n\r\n' "$port" >&3
  page=$(cat <&3)
  exec 3>&-
  kill "$(<"$work/web.pid")"
  [[ $page == "HTTP/1.1 200"* && $page == *dygraph* ]] || { head -c 500 <<<"$page"; fail "the web page"; }
  if inside "command -v gnuplot" >/dev/null; then
    run "'$bundle/bin/shoal' plot state" >/dev/null || fail "a plot"
    [[ -s $target/curves.png ]] || fail "an empty plot"
  else
    if run "'$bundle/bin/shoal' plot state" >"$work/plot" 2>&1; then fail "a plot without gnuplot"; fi
    grep -q gnuplot "$work/plot" || { cat "$work/plot"; fail "no word of gnuplot"; }
  fi
  share=$target/$name/share
  for page in man1/shoal{,-actor,-learner,-replay}.1 man5/shoal-configuration.5; do
    zgrep -q '^\.TH' "$share/man/$page.gz" || fail "no manual page $page"
  done
  bash -c 'source "$1" && complete -p shoal' completion "$share/bash-completion/completions/shoal" \
    >/dev/null || fail "no completion of bash"
  for file in zsh/vendor-completions/_shoal fish/vendor_completions.d/shoal.fish; do
    grep -q eval "$share/$file" || fail "no completion $file"
  done
  # Another host: a second copy of the bundle, in a folder of its own, behind a shell.
  mkdir -p "$target/other host"
  cp -r "$target/$name" "$target/other host/"
  cat >"$target/hosts.json" <<END
{"schema": "shoal-hosts-1", "servers": {"address": "127.0.0.1", "actors": 1},
 "hosts": [{"name": "other", "actors": 1, "ssh": ["env", "-i", "PATH=/usr/bin:/bin", "sh", "-c"],
            "programs": "$place/other host/$name/bin", "folder": "$place/other host/runs"}]}
END
  run "'$bundle/bin/shoal' train --preset fetch-reach-state $keys --set run_name=hosts --hosts hosts.json" \
    >"$work/hosts" 2>&1 || { cat "$work/hosts"; fail "training on two hosts"; }
  grep -q "actor x2" "$work/hosts" || { cat "$work/hosts"; fail "no actor on the other host"; }
  pixels="--preset fetch-reach-fast --set run_name=pixels --set env_steps=3000 --set eval.interval=3000"
  pixels+=" --set eval.episodes=2 --set eval.final_episodes=4 --set observation.quality=fast"
  # Meanwhile: the libraries that the processes of the run have mapped.
  run "'$bundle/bin/shoal' train $pixels >'$place/pixels' 2>&1 & run=\$!
    while kill -0 \$run 2>/dev/null; do
      for maps in /proc/[0-9]*/maps; do
        if grep -qF '$bundle/libexec' \$maps 2>/dev/null; then
          echo seen
          grep '\.so' \$maps | grep -vF '$bundle/lib/' | grep -v '/dev/shm'
        fi
      done
      sleep 1
    done >'$place/maps' 2>/dev/null
    wait \$run" || { cat "$target/pixels"; fail "training from pixels"; }
  grep -q seen "$target/maps" || fail "no process of the run was seen"
  if grep -v seen "$target/maps" | head -3 | grep .; then fail "libraries of the system are used"; fi
  run "'$bundle/bin/shoal' film pixels" >/dev/null || fail "a film"
else
  pixels="--preset fetch-reach-fast --set env_steps=2000 --set eval.interval=1000 --set eval.episodes=2"
  pixels+=" --set eval.final_episodes=4"
  run "'$bundle/bin/shoal' train $pixels --set run_name=native --set observation.quality=native" \
    >"$work/native" 2>&1 || { cat "$work/native"; fail "training from pixels in quality native"; }
  if run "'$bundle/bin/shoal' film native" >"$work/film" 2>&1; then fail "a slim bundle made a film"; fi
  grep -q "this is a slim bundle" "$work/film" || { cat "$work/film"; fail "no word of what is left out"; }
fi

# One line and an exit code for what cannot work.
refused() {  # TEXT COMMAND
  local said
  if said=$(inside "$2" 2>&1); then fail "taken: $2"; fi
  [[ $(wc -l <<<"$said") == 1 && $said == *"$1"* ]] || fail "'$2' said: $said"
}
if [[ -n $slim && $osmesa == missing ]]; then
  refused "quality=native" "cd '$place' && '$bundle/bin/shoal' train $pixels --set run_name=fast --set observation.quality=fast"
fi
mkdir -p "$target/tools"
printf '#!/bin/sh\necho aarch64\n' >"$target/tools/uname" && chmod +x "$target/tools/uname"
refused "cannot run on aarch64" "PATH='$place/tools':\$PATH '$bundle/bin/shoal' --version"
mv "$target/$name/lib/libc.so.6" "$work/"
refused "the bundle is damaged" "'$bundle/bin/shoal' --version"
mv "$work/libc.so.6" "$target/$name/lib/"
truncate -s 1000 "$target/$name"/lib/libfmt.so.*
refused "the bundle is damaged" "'$bundle/bin/shoal' --version"

((size <= most)) || fail "$size bytes are more than $most"
echo "bundle_test: passed${suite:+ in a bare $suite}"
