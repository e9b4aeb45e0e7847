#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Times the kernels on a machine with an NVIDIA GPU, and holds them to the CPU's bits: scripts/gpu_check.sh [PROGRAM]
# Figures go to out/gpu_check.json, each as soon as it is known. Without PROGRAM, bench_gpu_check is built here; a
# PROGRAM that was built on another machine needs only the libraries beside it (libtbb, libhwy) and a driver. All of it
# ends within SACCADE_GPU_CHECK_S seconds (540), the build included.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
budget_s="${SACCADE_GPU_CHECK_S:-540}"
# Runs a command for as long as there is time; 124, or 137, where it was cut off.
in_time() {
  local left=$((budget_s - SECONDS))
  timeout -k 5 "$((left > 1 ? left : 1))" "$@"
}
program="${1:-}"
if [[ -z $program ]]; then
  source scripts/common.sh
  configure release -DSACCADE_BUILD_BENCH=ON
  in_time ninja -C build/release bench_gpu_check
  program=build/release/bench/bench_gpu_check
fi
mkdir -p out
folder="$(cd "$(dirname "$program")" && pwd)"
CUDA_CACHE_PATH="$(mktemp -d)"  # the driver compiles the kernels of this build, and leaves nothing behind
export CUDA_CACHE_PATH
trap 'rm -rf "$CUDA_CACHE_PATH"' EXIT
status=0
LD_LIBRARY_PATH="$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" in_time "$program" "${@:2}" >out/gpu_check.json || status=$?
# A run that was cut off: its last whole line, and how it ended.
if [[ -s out/gpu_check.json && $(tail -c 2 out/gpu_check.json) != "}" ]]; then
  sed -i -e '${/,$/!d}' out/gpu_check.json
  printf ' "status": %d}\n' "$status" >>out/gpu_check.json
fi
cat out/gpu_check.json
exit $status
