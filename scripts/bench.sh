#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the benchmarks: scripts/bench.sh [options of Google Benchmark]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
scripts/install_packages.sh program tests bench
configure release -DSACCADE_BUILD_BENCH=ON
compile release bench/all
for program in build/release/bench/bench_*; do
  echo "=== ${program##*/}"
  "$program" "$@"
done
