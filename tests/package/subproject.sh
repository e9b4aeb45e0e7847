#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs a project that takes Saccade in with FetchContent.   Usage: subproject.sh SOURCE BUILD WORK
set -euo pipefail
source_dir="$1" work="$3"
rm -rf "$work"
cmake -S "$source_dir/tests/package/subproject" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS="-g0 -DHWY_COMPILE_ONLY_STATIC" -DCMAKE_UNITY_BUILD=ON \
  -DSACCADE_SOURCE="$source_dir" -DCONSUMER_SOURCE="$source_dir/examples/embedding.cpp"
cmake --build "$work" -j 2 --target subproject
"$work/subproject" | grep -x '1.005 m: occupied'
