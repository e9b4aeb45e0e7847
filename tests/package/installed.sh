#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build into an empty prefix; a consumer finds the components it wants there, without what it did not ask for.
# Usage: installed.sh SOURCE BUILD WORK
set -euo pipefail
source_dir="$1" build="$2" work="$3"
rm -rf "$work"
mkdir -p "$work"
cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"

version="$(sed -n 's/^#define SACCADE_VERSION "\([0-9]*\.[0-9]*\).*/\1/p' "$work/prefix/include/saccade/core/version.hpp")"

consume() {  # NAME COMPONENTS…
  local name="$1"
  shift
  cmake -S "$source_dir/tests/package/consumer" -B "$work/$name" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCONSUMER_SOURCE="$source_dir/examples/embedding.cpp" -DCONSUMER_VERSION="$version" "$@"
}
hide=(-DCMAKE_DISABLE_FIND_PACKAGE_ImageCodecs=ON -DCMAKE_DISABLE_FIND_PACKAGE_zstd=ON
      -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON)
consume map "-DCONSUMER_COMPONENTS=core;map" "${hide[@]}"
cmake --build "$work/map"
"$work/map/consumer" | tee "$work/output.txt"
grep -qx '1.005 m: occupied' "$work/output.txt"

if [[ -d $work/prefix/include/saccade/explore ]]; then  # the README's example
  consume explore -DCONSUMER_COMPONENTS=explore "-DCONSUMER_SOURCE=$source_dir/examples/next_view.cpp" "${hide[@]}"
  cmake --build "$work/explore"
  "$work/explore/consumer" | grep 'candidates, from'
fi

if consume nowhere "-DCONSUMER_COMPONENTS=core;nowhere" >"$work/nowhere.log" 2>&1; then
  echo "an unknown component was found" >&2
  exit 1
fi
tr -s ' \n' ' ' <"$work/nowhere.log" >"$work/nowhere.txt"  # CMake breaks lines
grep -q 'there is no component nowhere. The components here are: core ' "$work/nowhere.txt"
consume optional "-DCONSUMER_COMPONENTS=core;map" -DCONSUMER_OPTIONAL=nowhere "${hide[@]}"

if [[ -d $work/prefix/include/saccade/io/clouds ]]; then
  consume all "-DCONSUMER_COMPONENTS=map;io_clouds"
  cmake --build "$work/all"
  "$work/all/consumer"
fi
if [[ -x $build/saccade ]]; then "$work/prefix/bin/saccade" info; fi
