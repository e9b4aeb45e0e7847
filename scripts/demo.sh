#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The main job on a made-up table: a depth sequence, its map, and the views that would show most of what is still unseen.
# Everything lands in out/demo.   Usage: scripts/demo.sh (make demo builds the program first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
out=out/demo
compile release example_table_scene >build/example_table_scene.log || { cat build/example_table_scene.log >&2; exit 1; }
rm -rf "$out"
mkdir -p "$out"

echo "1. A depth camera goes round the near side of a table."
build/release/examples/example_table_scene "$out/frames"
echo
echo "2. Its frames are tracked and fused into a map of occupied, empty and unknown."
build/release/saccade fuse "$out/frames" --tracking icp --out "$out/run"
echo
echo "3. Which views of the things on the table would show most of what is unknown?"
build/release/saccade nbv "$out/run/map.sacmap" --poi 0.05,0.03,0.08 --radius 0.25 --out "$out/views"
echo
echo "Everything is in $out: run/mesh.ply (MeshLab, CloudCompare), the pictures in run and views, run/run.json."
