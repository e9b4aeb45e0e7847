#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs a project that takes Saccade in with FetchContent while every package but Eigen, oneTBB and Highway is
# hidden: the core rooms are there without them. Then looks through the headers that the core rooms were built from in
# BUILD for any that belongs to another library. Built as quickly as can be.   Usage: subproject.sh SOURCE BUILD WORK
set -euo pipefail
source_dir="$1" build="$2" work="$3"
core_rooms=(core sensor cloud map tracking surfel segment attention views robot explore annotate)
rm -rf "$work"
cmake -S "$source_dir/tests/package/subproject" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_FLAGS="-O0 -DNDEBUG -DHWY_COMPILE_ONLY_STATIC" -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=32 \
  -DCMAKE_PROJECT_TOP_LEVEL_INCLUDES="$source_dir/tests/package/only_core_dependencies.cmake" \
  -DSACCADE_SOURCE="$source_dir" -DCONSUMER_SOURCE="$source_dir/examples/embedding.cpp" -DCORE_ROOMS="$(IFS=';' && echo "${core_rooms[*]}")"
cmake --build "$work" -j 2
if [[ -n $(find "$work" -name 'libsaccade_annotate.a') ]]; then
  echo "a room that the program does not link was built with it" >&2
  exit 1
fi
"$work/subproject" | grep -x '1.005 m: occupied'

# The headers of every object of a core room, as ninja keeps them.
headers_of() {  # BUILD ROOM
  ninja -C "$1" -t deps | awk -v room="lib/saccade/$2/" '/^[^ ]/ { of_room = index($0, room) } /^ / && of_room { print $1 }' | sort -u
}
for room in "${core_rooms[@]}"; do
  headers_of "$build" "$room" >"$work/headers_of_$room.txt"
  (($(wc -l <"$work/headers_of_$room.txt") > 100)) || { echo "$room: too few headers seen: the check is void" >&2; exit 1; }
done
sort -u "$work"/headers_of_*.txt >"$work/headers.txt"
# Headers of the C and C++ libraries and of what is allowed; whatever else lies in a system folder is foreign.
libc="$(dpkg-query -L libc6-dev linux-libc-dev 2>/dev/null || true)"
foreign="$(grep '^/usr/\(local/\)\?include/' "$work/headers.txt" |
  grep -vE '^/usr/include/(c\+\+|eigen3|tbb|oneapi|hwy|([^/]*-linux-gnu/)?(c\+\+|bits|sys|asm|gnu|asm-generic|linux))/' |
  grep -vxF -f <(printf '%s\n' "${libc:-/none}") || true)"
if [[ -n $foreign ]]; then
  printf 'foreign headers in core rooms:\n%s\n' "$foreign" >&2
  exit 1
fi
echo "${#core_rooms[@]} core rooms built from $(wc -l <"$work/headers.txt") headers, none of them foreign"
