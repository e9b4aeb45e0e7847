#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Checks the layout of the C++ code with clang-format, or repairs it: scripts/format.sh [--fix]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(--dry-run --Werror)
[[ ${1:-} == --fix ]] && mode=(-i)
folders=()
for folder in lib apps devices tests examples bench; do
  [[ -d $folder ]] && folders+=("$folder")
done
find "${folders[@]}" \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 clang-format "${mode[@]}"
