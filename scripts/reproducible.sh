#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds the packages of the last commit in two checkouts and compares their bytes. Takes two whole builds, less what the
# compiler's cache has; SACCADE_UNCACHED=1 compiles everything anew.       Usage: scripts/reproducible.sh FOLDER
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work="${1:?usage: scripts/reproducible.sh FOLDER}"
if [[ -e $work ]]; then
  echo "reproducible.sh: $work is there already; name a new folder" >&2
  exit 2
fi
mkdir -p "$work"
work="$(cd "$work" && pwd)"
SOURCE_DATE_EPOCH="$(git log -1 --format=%ct)"
export SOURCE_DATE_EPOCH
[[ ${SACCADE_UNCACHED:-0} == 1 ]] && export CCACHE_RECACHE=1
for name in one another-name; do
  git clone -q . "$work/$name"
  "$work/$name/scripts/package.sh"
done
differ=0 compared=0
for package in "$work"/one/build/release/packages/*.deb; do
  compared=$((compared + 1))
  if ! cmp "$package" "$work/another-name/build/release/packages/${package##*/}"; then differ=1; fi
done
((compared > 0)) || { echo "no package was built" >&2; exit 1; }
((differ == 0)) && echo "$compared packages, the same bytes twice"
exit $differ
