#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy (checks: .clang-tidy, every warning is an error) over lib/ and apps/ as build/release compiles them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
[[ -f build/release/compile_commands.json ]] || configure release -DSACCADE_BUILD_TESTS=OFF
mkdir -p build/tidy
# g++ reads some flags that clang does not know; nothing else about the compilation differs.
log=build/tidy/log.txt
if ! run-clang-tidy -quiet -p build/release -j "$(jobs_here)" '/(lib/saccade|apps)/.*\.cpp$' >"$log" 2>build/tidy/errors.txt; then
  grep -E -A 3 '(warning|error):' "$log" || cat build/tidy/errors.txt
  exit 1
fi
files="$(grep -c '^clang-tidy' "$log" || true)"
((files > 0)) || { echo "clang-tidy found no file to check" >&2; exit 1; }
echo "clang-tidy: $files files clean"
