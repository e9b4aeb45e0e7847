#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs every fuzz target of build/asan-ubsan for a bounded time on a copy of its seeds: scripts/fuzz.sh [SECONDS [TARGET…]]
# A crash, leak, hang or undefined behaviour fails, and the input that shows it stays under out/fuzz/TARGET.
# SACCADE_FUZZ_FAILED names a file for a line per target that failed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
seconds="${1:-10}"
shift || true

configure asan-ubsan
compile asan-ubsan tests/fuzz/all
targets=("$@")
if ((${#targets[@]} == 0)); then
  for source in tests/fuzz/fuzz_*.cpp; do targets+=("$(basename "$source" .cpp)"); done
fi

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
export ASAN_OPTIONS="allocator_may_return_null=0:detect_leaks=1:${ASAN_OPTIONS:-}"
export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1"

fuzz_one() {  # TARGET: leaves its exit status in $work/TARGET.rc
  local target="$1" seeds="$work/$1" artifacts="out/fuzz/$1/"
  mkdir -p "$seeds" "$artifacts"
  if [[ -d tests/fuzz/corpus/${target#fuzz_} ]]; then cp -r "tests/fuzz/corpus/${target#fuzz_}/." "$seeds"; fi
  local status=0
  "build/asan-ubsan/tests/fuzz/$target" "$seeds" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 \
    -artifact_prefix="$artifacts" -print_final_stats=1 >"$work/$target.log" 2>&1 || status=$?
  echo "$status" >"$work/$target.rc"
}

failed=0
passed=0
report() {
  local target="$1" executions coverage
  executions="$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$target.log")"
  coverage="$(sed -n 's/.*cov: \([0-9]*\).*/\1/p' "$work/$target.log" | tail -n 1)"
  if [[ $(cat "$work/$target.rc") == 0 && ${executions:-0} -gt 10 ]]; then
    echo "  $target: $executions inputs in $seconds s, coverage ${coverage:-?}"
    passed=$((passed + 1))
    rm -rf "out/fuzz/$target"
  else
    mkdir -p "out/fuzz/$target"
    cp "$work/$target.log" "out/fuzz/$target/log.txt"
    tail -n 40 "$work/$target.log"
    echo "  $target FAILED after ${executions:-0} inputs; to see it again: build/asan-ubsan/tests/fuzz/$target $(sed -n 's/.*Test unit written to //p' "$work/$target.log" | tail -n 1)"
    if [[ -n ${SACCADE_FUZZ_FAILED:-} ]]; then
      echo "$target, $(grep -m 1 -E '^SUMMARY|ERROR: ' "$work/$target.log" || echo "status $(cat "$work/$target.rc")")" >>"$SACCADE_FUZZ_FAILED"
    fi
    failed=$((failed + 1))
  fi
}

width="$(jobs_here)"
for ((i = 0; i < ${#targets[@]}; i += width)); do
  batch=("${targets[@]:i:width}")
  for target in "${batch[@]}"; do fuzz_one "$target" & done
  wait
  for target in "${batch[@]}"; do report "$target"; done
done
echo "fuzzing: $passed passed, $failed failed"
((failed == 0 && passed > 0))
