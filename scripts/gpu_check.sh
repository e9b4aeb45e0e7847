#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Times the kernels on a machine with an NVIDIA GPU, and holds them to the CPU's bits:
# scripts/gpu_check.sh [PROGRAM [OPTIONS…]]
# Figures go to out/gpu_check.json once they are whole; those of an earlier run are out/gpu_check.before.json from the
# start. Without PROGRAM, bench_gpu_check is configured and built here; a PROGRAM that was built on another machine needs
# only the libraries beside it (libtbb, libhwy) and a driver. All of it ends within SACCADE_GPU_CHECK_S seconds (470).
# Exit status, also "status" in the figures: 0; 1: a bit differs, or an error; 2: no GPU; 124 or 137: no time was left.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
budget_s="${SACCADE_GPU_CHECK_S:-470}"
# Runs a command for as long as there is time, less 5 s for one that does not heed SIGTERM; 124, or 137, where it was
# cut off.
in_time() {
  local left=$((budget_s - 5 - SECONDS))
  timeout -k 5 "$((left > 1 ? left : 1))" "$@"
}
mkdir -p out
figures=out/gpu_check.json
[[ ! -e $figures ]] || mv -f "$figures" out/gpu_check.before.json  # an old file must not look new
work="$(mktemp -d out/gpu_check.XXXXXX)"  # beside the figures, so that they are moved in one step
export CUDA_CACHE_PATH="$PWD/$work/cache"  # the driver compiles the kernels of this build, and leaves nothing behind
trap 'rm -rf "$work"' EXIT

is_whole() {
  if command -v python3 >/dev/null; then
    python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$1" 2>/dev/null
  else
    [[ $(tail -c 2 "$1") == "}" ]]
  fi
}
# Makes a text the figures, if it is whole JSON.
keep() {
  is_whole "$1" || return 1
  mv -f "$1" "$figures"
  cat "$figures"
}
# Ends with figures that tell nothing but how.
end_without() {
  printf '{"status": %d, "ended": "%s"}\n' "$1" "$2" >"$work/figures"
  keep "$work/figures"
  exit "$1"
}

program="${1:-}"
if [[ -z $program ]]; then
  status=0
  # A shell of its own: timeout runs programs, and configure is a function.
  in_time bash -euo pipefail -c 'source scripts/common.sh; configure release -DSACCADE_BUILD_BENCH=ON' || status=$?
  ((status != 0)) || in_time ninja -C build/release bench_gpu_check || status=$?
  ((status == 0)) || end_without "$status" "while it was built"
  program=build/release/bench/bench_gpu_check
fi
folder="$(cd "$(dirname "$program")" && pwd)"
status=0
LD_LIBRARY_PATH="$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" in_time "$program" "${@:2}" >"$work/figures" || status=$?
((status != 2)) || end_without 2 "for lack of a GPU"
# A run that was cut off: its last whole line, and how it ended.
if [[ -s $work/figures && $(tail -c 2 "$work/figures") != "}" ]]; then
  sed -i -e '${/,$/!d}' "$work/figures"
  printf ' "status": %d}\n' "$status" >>"$work/figures"
fi
keep "$work/figures" || end_without "$((status != 0 ? status : 1))" "without whole figures"
exit "$status"
