#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make test: everything that is held to, phase after phase. All phases run even if one fails; any failure fails the whole.
# SACCADE_TEST_PHASES="release asan" runs some of them; SACCADE_FUZZ_SECONDS (5) is the time per fuzz target.
# What each phase may take stands in tests/budget.json; scripts/test_summary.py says at the end what it took.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
results=out/test
rm -rf "$results"
mkdir -p "$results"

phases="${SACCADE_TEST_PHASES:-format release web asan tsan fuzz tidy slurm ros package}"

# run_ctest NAME PRESET OPTIONS…: two at a time. ctest leaves its results in out/test/NAME.xml, GoogleTest in out/test/NAME/.
run_ctest() {
  local name="$1" preset="$2" status=0
  shift 2
  rm -rf "build/$preset/gtest"
  mkdir -p "build/$preset/gtest"
  "${launcher[@]}" ctest --test-dir "build/$preset" -j 2 --output-on-failure --no-tests=error --output-junit "$PWD/$results/$name.xml" \
    --test-output-size-passed 8192 --test-output-size-failed 65536 "$@" || status=$?
  cp -r "build/$preset/gtest" "$results/$name"
  return $status
}

release_options=(-DSACCADE_BUILD_TESTS=ON -DSACCADE_BUILD_BENCH=ON -DSACCADE_WARNINGS_AS_ERRORS=ON)
launcher=()  # what ctest is started by

build_format() { :; }
phase_format() { scripts/format.sh; }

build_release() {
  configure release "${release_options[@]}" -DSACCADE_ROS1=OFF -DSACCADE_ROS2=OFF && compile release
}
phase_release() { run_ctest release release -LE "floors|ros|slurm"; }

# The page: its bundle, then a browser that uses it.
build_web() { scripts/web.sh check; }
phase_web() { scripts/web.sh test --project pages; }

build_asan() { configure asan-ubsan && compile asan-ubsan; }
phase_asan() { UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 run_ctest asan-ubsan asan-ubsan -L memory; }

build_tsan() { configure tsan -DSACCADE_BUILD_APPS=OFF -DSACCADE_BUILD_EXAMPLES=OFF && compile tsan; }
phase_tsan() {
  # ThreadSanitizer of g++ 12 does not start under the address randomisation of newer kernels.
  if setarch "$(uname -m)" -R true 2>/dev/null; then local launcher=(setarch "$(uname -m)" -R); fi
  TSAN_OPTIONS="halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp" run_ctest tsan tsan -L threads
}

build_fuzz() { :; }  # its targets are of the preset asan-ubsan
phase_fuzz() { SACCADE_FUZZ_FAILED="$results/fuzz-failed.txt" scripts/fuzz.sh "${SACCADE_FUZZ_SECONDS:-5}"; }

build_tidy() { :; }
phase_tidy() { scripts/tidy.sh; }

# A campaign on a cluster of two nodes on this machine.
build_slurm() { scripts/install_packages.sh slurm && configure release "${release_options[@]}" && compile release saccade; }
phase_slurm() { run_ctest slurm release -L slurm; }

# The adapters for ROS, with their packages; all before was built and tested without them.
build_ros() {
  scripts/install_packages.sh ros && configure release "${release_options[@]}" -DSACCADE_ROS1=ON -DSACCADE_ROS2=ON && compile release
}
phase_ros() { run_ctest ros release -L ros; }

# Debian packages of what the phases before built, in an empty Debian.
build_package() { scripts/install_packages.sh package && scripts/package.sh; }
phase_package() {
  local status=0
  tests/package/debs.sh . build/release/packages "$results/debs" || status=$?
  tests/package/pip.sh . build/release "$results/pip" || status=$?
  return $status
}

# Times and the compiler cache's work go to out/test/phases.tsv: name, seconds of building and of running, how it ended.
run_phase() {
  local name="$1" began=$SECONDS built outcome=passed
  echo
  echo "=== $name"
  export CCACHE_STATSLOG="$PWD/$results/ccache-$name.log"
  "build_$name" || outcome=FAILED
  built=$SECONDS
  if [[ $outcome == passed ]]; then "phase_$name" || outcome=FAILED; fi
  echo "=== $name: $outcome after $((SECONDS - began)) s"
  printf '%s\t%d\t%d\t%s\n' "$name" $((built - began)) $((SECONDS - built)) "$outcome" >>"$results/phases.tsv"
}

scripts/install_packages.sh program tests || exit 1
for name in $phases; do
  /usr/bin/python3 -B scripts/machine_speed.py >>"$results/machine_speed.txt"
  run_phase "$name"
done
/usr/bin/python3 -B scripts/machine_speed.py >>"$results/machine_speed.txt"
echo
/usr/bin/python3 -B scripts/test_summary.py "$results" tests/budget.json
