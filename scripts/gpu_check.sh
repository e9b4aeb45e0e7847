#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Holds the kernels to the CPU's bits on a machine with an NVIDIA GPU, and times them: scripts/gpu_check.sh [PROGRAM]
# Figures go to out/gpu_check.json. Without PROGRAM, bench_gpu_check is built here; a PROGRAM that was built on another
# machine needs only the libraries beside it (libtbb, libhwy) and a driver.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program="${1:-}"
if [[ -z $program ]]; then
  source scripts/common.sh
  configure release -DSACCADE_BUILD_BENCH=ON
  ninja -C build/release bench_gpu_check
  program=build/release/bench/bench_gpu_check
fi
mkdir -p out
folder="$(cd "$(dirname "$program")" && pwd)"
status=0
LD_LIBRARY_PATH="$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" timeout 450 "$program" "${@:2}" >out/gpu_check.json || status=$?
cat out/gpu_check.json
exit $status
