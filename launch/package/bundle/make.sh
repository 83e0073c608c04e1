#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make.sh BUILD FOLDER [--slim]: makes FOLDER/shoal-VERSION-linux-x86_64.tar.xz of what BUILD has
# built: programs, shared data, manual, and every library that they use, the loader and the C library
# included (docs/install.md). libcodec2, a speech codec of 17 MB that FFmpeg names, is left out.
# --slim leaves out FFmpeg, Cairo and Mesa: no films, no pictures by OpenGL. Needs Debian, whose packages say under which licence a library is.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
source=$(readlink -f "$here/../../..")
build=$(readlink -f "$1") folder=$(readlink -f "$2") slim=false
[[ ${3:-} == --slim ]] && slim=true
programs=(shoal shoal-actor shoal-learner shoal-replay)
version=$(sed -n 's/^CPACK_PACKAGE_VERSION "\(.*\)"\|^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1\2/p' \
  "$build/CPackConfig.cmake" | head -1)
name=shoal-$version$($slim && echo -slim || true)-linux-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/$name

DESTDIR='' cmake --install "$build" --component shoal --strip --prefix "$root" >/dev/null
mkdir -p "$root"/{libexec,lib,share/licences} "$work/left_out"
for program in "${programs[@]}"; do
  mv "$root/bin/$program" "$root/libexec/"
  install -m 755 "$here/launcher.sh" "$root/bin/$program"
done

# The libraries that a file needs, and theirs: "soname path" a line.
libraries_of() {
  LD_LIBRARY_PATH=$work/left_out ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// {print $1, $3}' | sort -u
}

# The path of a library of the system. It reads the whole list: ldconfig ends with an error if its
# output is not read to the end.
system_library() {
  ldconfig -p | awk -v name="$1" '$1 == name && /x86-64/ && path == "" {path = $NF} END {print path}'
}

# left_out LINE FUNCTIONS USERS SONAME...: libraries whose functions (of the pattern FUNCTIONS, as far
# as USERS, the paths of an array, use them) end the program with LINE (left_out.c).
left_out() {
  local line=$1 functions=$2 soname
  local -n users=$3
  shift 3
  nm -D --undefined-only "${users[@]}" | awk 'NF == 2 {print $2}' |
    grep -E "$functions" | sort -u >"$work/names"
  sed 's/@.*//; s/.*/SHOAL_LEFT_OUT(&)/' "$work/names" >"$work/names.h"
  # FUNCTION@VERSION: the loader looks for the versions.
  awk -F@ 'NF > 1 {of[$NF] = of[$NF] " " $1 ";"}
    END {for (version in of) print version " {" of[version] " };"}' "$work/names" >"$work/versions"
  local versions=()
  [[ ! -s $work/versions ]] || versions=(-Wl,--version-script="$work/versions")
  for soname in "$@"; do
    gcc -shared -fPIC -O1 -w -fno-builtin -DLINE="\"$line\"" \
      -DNAMES="\"$work/names.h\"" -Wl,-soname,"$soname" "${versions[@]}" \
      -o "$work/left_out/$soname" "$here/left_out.c"
  done
}
executables=("${programs[@]/#/$root/libexec/}")
needed() { libraries_of "${executables[@]}" | awk '{print $1}' | grep -E "$1"; }
if $slim; then
  mapfile -t film < <(needed '^lib(avcodec|avformat|avutil|swscale|cairo)\.so')
  left_out 'this is a slim bundle, which leaves out what films need: use the full bundle (docs/install.md)' \
    '^(av|sws|swr|cairo)' executables "${film[@]}"
else
  mapfile -t codec < <(libraries_of "${executables[@]}" | awk '$1 ~ /^libcodec2/ {print $1}')
  mapfile -t ffmpeg < <(libraries_of "${executables[@]}" | awk '$1 ~ /^libavcodec/ {print $2}')
  left_out 'this bundle leaves out the speech codec libcodec2' '^codec2_' ffmpeg "${codec[@]}"
fi

opened=()
if ! $slim; then
  osmesa=$(system_library libOSMesa.so.8)
  [[ -n $osmesa ]] || { echo "bundle: libOSMesa.so.8 is not installed (libosmesa6)" >&2; exit 1; }
  opened+=("$osmesa")
fi
carried=()  # files of the system that the bundle has
while read -r soname path; do
  install -m 644 "$(readlink -f "$path")" "$root/lib/$soname"
  [[ $path == "$work"/* ]] || carried+=("$path")
done < <(libraries_of "${executables[@]}" "${opened[@]}")
# Those that programs open at run time.
for path in "${opened[@]}"; do
  install -m 644 "$(readlink -f "$path")" "$root/lib/$(basename "$path")"
  carried+=("$path")
done
# An NVIDIA driver of the system needs them, and those of another C library would not fit.
for soname in libdl.so.2 libpthread.so.0 librt.so.1; do
  path=$(system_library "$soname")
  install -m 644 "$(readlink -f "$path")" "$root/lib/$soname"
  carried+=("$path")
done
loader=/lib64/ld-linux-x86-64.so.2
install -m 755 "$(readlink -f "$loader")" "$root/lib/ld-linux-x86-64.so.2"
carried+=("$loader")

# Files that programs find when they are asked for them: the page's curves, the fonts of films.
javascript=/usr/share/javascript/dygraphs
mkdir -p "$root/share/javascript/dygraphs"
install -m 644 "$javascript"/dygraph.min.{js,css} "$root/share/javascript/dygraphs/"
carried+=("$javascript/dygraph.min.js")
if ! $slim; then
  mkdir -p "$root"/share/{fonts,fontconfig}
  install -m 644 /usr/share/fonts/truetype/dejavu/DejaVuSans{,-Bold}.ttf "$root/share/fonts/"
  install -m 644 "$here/fonts.conf" "$root/share/fontconfig/"
  carried+=(/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf)
fi

# A file of licences for each package that something comes from.
mapfile -t carried < <(printf '%s\n' "${carried[@]}" | xargs readlink -f | sort -u)
# dpkg knows some files below /lib, which is /usr/lib: both names are asked for.
owners=$(dpkg -S "${carried[@]}" "${carried[@]#/usr}" 2>/dev/null || true)
owned=$(sed 's/^.*: //; s#^/usr##' <<<"$owners")
for file in "${carried[@]}"; do
  grep -qxF -e "${file#/usr}" <<<"$owned" ||
    { echo "bundle: no package owns '$file': its licence is not known" >&2; exit 1; }
done
mapfile -t packages < <(cut -d: -f1 <<<"$owners" | tr ',' '\n' | tr -d ' ' | sort -u)
for package in "${packages[@]}"; do
  install -m 644 "/usr/share/doc/$package/copyright" "$root/share/licences/$package"
done

# The sizes that launcher.sh compares before it starts a program.
(cd "$root" && LC_ALL=C && stat -c '%s %n' lib/*.so* libexec/* >"$work/sizes")
install -m 644 "$work/sizes" "$root/lib/sizes"

install -m 644 "$source"/{LICENSE,NOTICE} "$root/"
{
  echo "Libraries in lib/, fonts and scripts in share/ come from these packages of Debian, unchanged."
  echo "Their licences lie beside this file. Their sources: https://snapshot.debian.org, by name and"
  echo "version of the source package, or apt-get source."
  $slim || echo "FFmpeg is under the GPL as Debian builds it: so is this bundle as a whole, version 3."
  echo
  dpkg-query -W -f='${Package} ${Version} (source ${source:Package} ${source:Version})\n' \
    "${packages[@]}" | sort -u
} >"$root/share/licences/PACKAGES"
(cd "$root" && find . -type f ! -name SHA256SUMS -print0 | sort -z | xargs -0 sha256sum >SHA256SUMS)

mkdir -p "$folder"
time=$(git -C "$source" log -1 --format=%ct 2>/dev/null || echo 0)
# XZ_LEVEL: 0 to 9; the tests take less time for more bytes.
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$time" -cf - "$name" |
  xz -T0 --x86 --lzma2=preset="${XZ_LEVEL:-9}" >"$folder/$name.tar.xz.part"
mv "$folder/$name.tar.xz.part" "$folder/$name.tar.xz"
echo "$folder/$name.tar.xz"
