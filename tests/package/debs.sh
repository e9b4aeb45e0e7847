#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Looks at the Debian packages of build/release/packages, builds against the library, and runs the program and the module from where
# they were unpacked. With SACCADE_CLEAN_ROOT=1, which takes two minutes more, it installs them in an empty Debian instead (mmdebstrap,
# as root), and removes them again: no file is left.
# Usage: debs.sh SOURCE PACKAGES WORK
set -euo pipefail
source_dir="$(cd "$1" && pwd)" packages="$(cd "$2" && pwd)" work="$3"
rm -rf "$work"
mkdir -p "$work"
work="$(cd "$work" && pwd)"

echo "== lintian"
lintian --allow-root --fail-on error,warning "$packages"/*.deb

consume() {  # PREFIX: a program that finds the library there prints what it should
  cmake -S "$source_dir/tests/package/consumer" -B "$work/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$1" \
    -DCONSUMER_SOURCE="$source_dir/examples/embedding.cpp" "-DCONSUMER_COMPONENTS=core;map" >"$work/consumer.log"
  cmake --build "$work/consumer"
  grep -q "^saccade_DIR:PATH=$1/" "$work/consumer/CMakeCache.txt"
  "$work/consumer/consumer" | grep -x '1.005 m: occupied'
}

told() {  # COMMAND…: what `saccade info` says; fails where the program was built without kernels for GPUs
  "$@" info | tee "$work/info.txt"
  if grep 'this build has no kernels' "$work/info.txt" >"$work/no_kernels.txt"; then
    echo "the packages were built without clang: their program can use no GPU" >&2
    exit 1
  fi
}

echo "== find_package(saccade)"
for package in "$packages"/*.deb; do dpkg -x "$package" "$work/unpacked"; done
consume "$work/unpacked/usr"
desktop-file-validate "$work/unpacked/usr/share/applications/saccade.desktop"
update-mime-database "$work/unpacked/usr/share/mime" 2>"$work/mime.log"
grep -q x-saccade-map "$work/unpacked/usr/share/mime/globs2"

if [[ -z ${SACCADE_CLEAN_ROOT:-} ]]; then
  echo "== used from where they were unpacked"
  told "$work/unpacked/usr/bin/saccade"
  "$work/unpacked/usr/bin/saccade" explore tabletop-1 --out "$work/run" --max-views 1 --quiet --no-pictures
  export PYTHONPATH="$work/unpacked/usr/lib/python3/dist-packages"
  /usr/bin/python3 -B -c 'import saccade; print(saccade.__file__, saccade.TsdfMap(voxel_size_m=0.01))'
  exit 0
fi

echo "== installed, used, removed"
# Dependencies are installed first, so that what they bring themselves can be told, and nothing is downloaded later.
needed="$(for package in "$packages"/saccade_*.deb "$packages"/python3-saccade_*.deb; do dpkg-deb -f "$package" Depends; done |
  tr ',' '\n' | sed 's/(.*//; s/ //g' | sort -u | paste -s -d ,)"
suite="$(. /etc/os-release && echo "$VERSION_CODENAME")"
mmdebstrap --quiet --variant=apt "--include=$needed" "$suite" "$work/root" 2>"$work/mmdebstrap.log" || {
  echo "no empty Debian can be made here: $(tail -n 1 "$work/mmdebstrap.log")" >&2
  exit 1
}
root="$work/root"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./var -o -path ./etc/ld.so.cache \) \
  -prune -o -print | sort); }
mkdir -p "$root/tmp/packages"
cp "$packages"/saccade_*.deb "$packages"/python3-saccade_*.deb "$root/tmp/packages"
files >"$work/before.txt"
began=$SECONDS
inside sh -c 'dpkg -i /tmp/packages/*.deb' >"$work/dpkg.log" 2>&1
echo "installed in $((SECONDS - began)) s"
told inside saccade
inside saccade explore tabletop-1 --out /tmp/run --max-views 1 --quiet --no-pictures
inside python3 -c 'import saccade; print(saccade.TsdfMap(voxel_size_m=0.01))'
inside python3 -m saccade --version
files >"$work/installed.txt"
(($(comm -13 "$work/before.txt" "$work/installed.txt" | wc -l) > 50)) || { echo "too few files were installed" >&2; exit 1; }
inside dpkg -P python3-saccade saccade >>"$work/dpkg.log" 2>&1
files >"$work/after.txt"
left="$(comm -13 "$work/before.txt" "$work/after.txt")"
if [[ -n $left ]]; then
  printf 'removal left:\n%s\n' "$left" >&2
  exit 1
fi
echo "removal left nothing"
rm -rf "$root"
