#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The main job on a made-up table: a depth sequence, its map, and the views that would show most of what is still unseen.
# Everything lands in out/demo.   Usage: scripts/demo.sh (make demo builds the program first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
saccade=build/release/saccade
out=out/demo
rm -rf "$out"
mkdir -p "$out"

echo "1. A depth camera goes round the near side of a table."
"$saccade" sample --frames 40 --noise --out "$out/frames"
echo
echo "2. Its frames are tracked and fused into a map of occupied, empty and unknown."
"$saccade" fuse "$out/frames" --tracking icp --out "$out/run"
echo
echo "3. Which views of the things on the table would show most of what is unknown?"
"$saccade" nbv "$out/run/map.sacmap" --poi 0,0,0.1 --radius 0.3 --out "$out/views"
echo
echo "The results are in $out:"
find "$out/run" "$out/views" -type f | sort | sed 's/^/  /'
