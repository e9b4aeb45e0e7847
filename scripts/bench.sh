#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the benchmarks beside their peers, writes docs/results/performance.md and its plots, and holds the ratios to
# bench/floors.json. Results stay in out/bench.
# Usage: scripts/bench.sh [options of Google Benchmark], for example --benchmark_filter=icp (then nothing is written)
# SACCADE_BENCH_RESUME=1: programs that were measured since they were built are not measured again.
# SACCADE_BENCH_REPETITIONS=2: fewer rounds than 7, for a quick look.
# SACCADE_BENCH_SIMD=AVX2: our kernels on that instruction set, in place of the widest that is there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
scripts/install_packages.sh program tests bench
configure release -DSACCADE_BUILD_BENCH=ON
compile release bench/all saccade
out=out/bench
mkdir -p "$out"

# measure PROGRAM RESULTS: a run that is interrupted leaves no results.
measure() {
  # Repetitions of all benchmarks in random order, so that a slow minute of the machine meets ours and peers alike.
  "$1" --benchmark_repetitions="${SACCADE_BENCH_REPETITIONS:-7}" --benchmark_enable_random_interleaving=true \
    --benchmark_display_aggregates_only=true --benchmark_out="$2.part" --benchmark_out_format=json
  mv "$2.part" "$2"
}

for program in build/release/bench/bench_*; do
  [[ -f $program && -x $program ]] || continue
  name="${program##*/bench_}"
  results="$out/$name.json"
  if (($# > 0)); then
    echo "=== $name"
    "$program" "$@"
  elif [[ -n ${SACCADE_BENCH_RESUME:-} && $results -nt $program ]]; then
    echo "=== $name: measured already"
  else
    echo "=== $name"
    began=$SECONDS
    measure "$program" "$results"
    echo "=== $name: $((SECONDS - began)) s"
  fi
done
if (($# == 0)); then
  /usr/bin/python3 -B scripts/performance_table.py "$out" docs/results/performance.md
  /usr/bin/python3 -B scripts/check_floors.py "$out"
fi
