#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The main job in a simulated cell: a camera looks at a table from one side, and then goes to where it expects
# to see most new surface, until nothing worth a move is left. Everything lands in out/demo, with a report to look at.
# Usage: scripts/demo.sh (make demo builds the program first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=out/demo
rm -rf "$out"
mkdir -p "$out"

echo "A depth camera explores eight objects on a table."
build/release/saccade explore tabletop-2 --out "$out"
echo
echo "The report of the run: file://$PWD/$out/report.html"
if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]] && command -v xdg-open >/dev/null; then
  xdg-open "$out/report.html" >/dev/null 2>&1 || true
fi
