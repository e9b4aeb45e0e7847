#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy (checks: .clang-tidy, every warning is an error) over lib/ and apps/, several sources of a room at a
# time as the preset tidy puts them together: most of its time goes into the headers that they share.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
configure tidy
# g++ reads some flags that clang does not know; nothing else about the compilation differs.
log=build/tidy/log.txt
if ! run-clang-tidy -quiet -p build/tidy -j "$(jobs_here)" '/(lib/saccade|apps)/.*\.c(pp|xx)$' >"$log" 2>build/tidy/errors.txt; then
  grep -E -A 3 '(warning|error):' "$log" || cat build/tidy/errors.txt
  exit 1
fi
checked="$(grep -c '^clang-tidy' "$log" || true)"
((checked > 0)) || { echo "clang-tidy found no file to check" >&2; exit 1; }
echo "clang-tidy: $(find lib/saccade apps -name '*.cpp' | wc -l) files clean, in $checked compilations"
