#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Starts the program of this bundle that this file is named after, with the bundle's own loader, C
# library and libraries. The system's are not used.
set -eu
name=${0##*/}
here=$(readlink -f "$0")
root=${here%/bin/*}
loader=$root/lib/ld-linux-x86-64.so.2
machine=$(uname -m)
if [ "$machine" != x86_64 ]; then
  echo "$name: error: this bundle holds programs for x86_64 and cannot run on $machine: build Shoal there, or use a bundle made there" >&2
  exit 2
fi
# A library that is cut short would end the program by a bus error. Sizes are quick to compare.
sizes=$(cd "$root" && LC_ALL=C && stat -c '%s %n' lib/*.so* libexec/* 2>/dev/null) || sizes=
if [ "$sizes" != "$(cat "$root/lib/sizes" 2>/dev/null)" ]; then
  echo "$name: error: files in '$root' are missing or cut short: the bundle is damaged; unpack the archive again (sha256sum -c SHA256SUMS there names the files)" >&2
  exit 1
fi
# Films write text: the fonts that the bundle carries, unless the user has chosen others.
fonts=$root/share/fontconfig/fonts.conf
if [ -f "$fonts" ]; then export FONTCONFIG_FILE="${FONTCONFIG_FILE:-$fonts}"; fi
# LD_LIBRARY_PATH may name the folders of CUDA's libraries, which the bundle does not have.
libraries=$root/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
exec "$loader" --inhibit-cache --library-path "$libraries" --argv0 "$root/bin/$name" \
  "$root/libexec/$name" "$@"
