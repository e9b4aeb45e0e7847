#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs a project that takes Saccade in with FetchContent, and the core rooms with it, while every package but
# Eigen, oneTBB and Highway is hidden; then looks through the headers that were read for any that belongs to another
# library. Built as quickly as can be.   Usage: subproject.sh SOURCE BUILD WORK
set -euo pipefail
source_dir="$1" work="$3"
rm -rf "$work"
cmake -S "$source_dir/tests/package/subproject" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS="-g0 -DHWY_COMPILE_ONLY_STATIC" -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_PROJECT_TOP_LEVEL_INCLUDES="$source_dir/tests/package/only_core_dependencies.cmake" \
  -DSACCADE_SOURCE="$source_dir" -DCONSUMER_SOURCE="$source_dir/examples/embedding.cpp"
targets=()
for room in core sensor map surfel segment attention view annotate; do
  if [[ -f $source_dir/lib/saccade/$room/CMakeLists.txt ]]; then targets+=("saccade_$room"); fi
done
cmake --build "$work" -j 2 --target subproject "${targets[@]}"
"$work/subproject" | grep -x '1.005 m: occupied'

ninja -C "$work" -t deps | sed -n 's/^ *\(\/.*\)$/\1/p' | sort -u >"$work/headers.txt"
(($(wc -l <"$work/headers.txt") > 100)) || { echo "too few headers seen: the check is void" >&2; exit 1; }
# Headers of the C and C++ libraries and of what is allowed; whatever else lies in a system folder is foreign.
libc="$(dpkg-query -L libc6-dev linux-libc-dev 2>/dev/null || true)"
foreign="$(grep '^/usr/\(local/\)\?include/' "$work/headers.txt" |
  grep -vE '^/usr/include/(c\+\+|eigen3|tbb|oneapi|hwy|([^/]*-linux-gnu/)?(c\+\+|bits|sys|asm|gnu|asm-generic|linux))/' |
  grep -vxF -f <(printf '%s\n' "${libc:-/none}") || true)"
if [[ -n $foreign ]]; then
  printf 'foreign headers in core rooms:\n%s\n' "$foreign" >&2
  exit 1
fi
echo "${#targets[@]} core rooms built from $(wc -l <"$work/headers.txt") headers, none of them foreign"
