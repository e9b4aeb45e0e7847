#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of README and guides anew, in docs/images: exploration.png, exploration-surfels.png and segments.png by the program, viewer.png and
# annotate*.png by the browser tests that look at the pages. Look at each before you commit it. Needs make build.
# Usage: scripts/pictures.sh [run | pages]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
what="${1:-all}"
[[ $what == all || $what == run || $what == pages ]] || { sed -n '3,5s/^# //p' "$0" >&2; exit 2; }
saccade="$PWD/build/release/saccade"
[[ -x $saccade ]] || { echo "build/release/saccade is not there: run make build" >&2; exit 1; }

if [[ $what != pages ]]; then
  folder="$(mktemp -d)"
  trap 'rm -rf "$folder"' EXIT
  "$saccade" --quiet explore tabletop-2 --robot free --strategy sphere --max-views 3 --out "$folder/run" >/dev/null
  cp "$folder/run/view-02-choice.png" docs/images/exploration.png
  "$saccade" --quiet explore tabletop-1 --robot free --map surfels --max-views 2 --out "$folder/surfels" >/dev/null
  cp "$folder/surfels/view-02-choice.png" docs/images/exploration-surfels.png
  # The table alone: a floor and walls would make it small in the picture of its segments.
  grep -vE '^ +- \{name: (floor|wall)' scenes/tabletop-2.yaml >"$folder/table.yaml"
  "$saccade" --quiet explore "$folder/table.yaml" --robot free --strategy sphere --max-views 4 --no-pictures --out "$folder/table" >/dev/null
  "$saccade" --quiet segment "$folder/table/map.sacmap" --picture docs/images/segments.png >/dev/null
fi
if [[ $what != run ]]; then
  SACCADE_UPDATE_IMAGES=1 scripts/web.sh test looking.spec show.spec
fi
