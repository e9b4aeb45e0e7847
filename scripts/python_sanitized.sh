#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Python module with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests; once a release.
# Usage: scripts/python_sanitized.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
configure asan-ubsan -DSACCADE_PYTHON=ON
compile asan-ubsan saccade saccade_python
runtime="$(clang++ -print-file-name=libclang_rt.asan-x86_64.so)"
[[ -f $runtime ]] || { echo "python_sanitized.sh: clang has no shared runtime of AddressSanitizer ($runtime)" >&2; exit 1; }
export PYTHONPATH="$PWD/build/asan-ubsan/python" PYTHONMALLOC=malloc
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=0 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
# The program has its own runtime, so what starts it from Python must not preload another one.
mkdir -p "$PYTHONPATH/saccade/bin"
printf '#!/bin/sh\nunset LD_PRELOAD\nexec "%s" "$@"\n' "$PWD/build/asan-ubsan/saccade" >"$PYTHONPATH/saccade/bin/saccade"
chmod +x "$PYTHONPATH/saccade/bin/saccade"
for name in module segments rooms explore guide; do
  echo "  $name"
  LD_PRELOAD="$runtime" /usr/bin/python3 -B "tests/python/${name}_test.py"
done
