#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make test: everything that is held to, phase after phase. All phases run even if one fails; any failure fails the whole.
# SACCADE_TEST_PHASES="release asan" runs some of them; SACCADE_FUZZ_SECONDS (10) is the time per fuzz target.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
results=out/test
rm -rf "$results"
mkdir -p "$results"

phases="${SACCADE_TEST_PHASES:-format release web asan tsan fuzz tidy}"
failed_phases=()

# ctest results end up in out/test/NAME.xml; parallel tests share the cores two by two.
run_ctest() {  # PRESET OPTIONS…
  local preset="$1"
  shift
  ctest --test-dir "build/$preset" -j 2 --output-on-failure --no-tests=error --output-junit "$PWD/$results/$preset.xml" \
    --test-output-size-passed 8192 "$@"
}

# ThreadSanitizer of g++ 12 does not start under the address randomisation of newer kernels.
without_randomisation() {
  if setarch "$(uname -m)" -R true 2>/dev/null; then setarch "$(uname -m)" -R "$@"; else "$@"; fi
}

phase_format() { scripts/format.sh; }

phase_release() {
  configure release -DSACCADE_BUILD_TESTS=ON -DSACCADE_BUILD_BENCH=ON -DSACCADE_WARNINGS_AS_ERRORS=ON && compile release && run_ctest release
}

# The page: its bundle, then a browser that uses it.
phase_web() { scripts/web.sh check && scripts/web.sh test; }

phase_asan() {
  configure asan-ubsan && compile asan-ubsan || return 1
  UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 run_ctest asan-ubsan -L sanitize
}

phase_tsan() {
  configure tsan -DSACCADE_BUILD_APPS=OFF -DSACCADE_BUILD_EXAMPLES=OFF && compile tsan saccade_parallel_tests || return 1
  TSAN_OPTIONS="halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp" run_tsan
}
run_tsan() { without_randomisation ctest --version >/dev/null && without_randomisation env ctest --test-dir build/tsan -j 2 \
  --output-on-failure --no-tests=error --output-junit "$PWD/$results/tsan.xml" -L parallel; }

phase_fuzz() { scripts/fuzz.sh "${SACCADE_FUZZ_SECONDS:-10}"; }

phase_tidy() { scripts/tidy.sh; }

run_phase() {
  local name="$1" began=$SECONDS
  echo
  echo "=== $name"
  if "phase_$name"; then
    echo "=== $name: passed in $((SECONDS - began)) s"
  else
    echo "=== $name: FAILED after $((SECONDS - began)) s"
    failed_phases+=("$name")
  fi
}

scripts/install_packages.sh program tests || exit 1
for name in $phases; do run_phase "$name"; done
echo
/usr/bin/python3 scripts/test_summary.py "$results" --phases "$phases" --failed "${failed_phases[*]:-}"
