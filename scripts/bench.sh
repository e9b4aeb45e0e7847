#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the benchmarks beside their peers, and writes docs/performance.md.
# Usage: scripts/bench.sh [options of Google Benchmark], for example --benchmark_filter=icp (then nothing is written)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
scripts/install_packages.sh program tests bench
configure release -DSACCADE_BUILD_BENCH=ON
compile release bench/all saccade
out=out/bench
mkdir -p "$out"
for program in build/release/bench/bench_*; do
  name="${program##*/bench_}"
  echo "=== $name"
  if (($# > 0)); then
    "$program" "$@"
  else
    # Repetitions of all benchmarks in random order, so that a slow minute of the machine meets ours and peers alike.
    "$program" --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true \
      --benchmark_display_aggregates_only=true --benchmark_out="$out/$name.json" --benchmark_out_format=json
  fi
done
(($# > 0)) || /usr/bin/python3 scripts/performance_table.py "$out" docs/performance.md
