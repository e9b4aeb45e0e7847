#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/images/rviz.jpg: RViz, on a screen that is none, while saccade explore --publish ros waits before its third
# view. Needs make build, and the packages of the sections ros and rviz of packages.txt.
# Usage: scripts/picture_rviz.sh [PICTURE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
picture="$(realpath -m "${1:-docs/images/rviz.jpg}")"
build="$PWD/build/release"
for tool in rosmaster rviz Xvfb import convert; do
  command -v "$tool" >/dev/null || { echo "$tool is not there: scripts/install_packages.sh ros rviz" >&2; exit 1; }
done

folder="$(mktemp -d)"
chmod 700 "$folder"
started=()
end() {
  for process in "${started[@]}"; do kill "$process" 2>/dev/null || true; done
  wait || true
  rm -rf "$folder"
}
trap end EXIT
port=$((20000 + $$ % 20000))
export ROS_MASTER_URI="http://127.0.0.1:$port" ROS_IP=127.0.0.1 ROS_HOME="$folder" ROS_LOG_DIR="$folder"
export DISPLAY=":$((100 + $$ % 900))" XDG_RUNTIME_DIR="$folder" LIBGL_ALWAYS_SOFTWARE=1 HOME="$folder"

in_background() {  # COMMAND…: its output goes to a log
  "$@" >"$folder/$(basename "$1").log" 2>&1 &
  started+=("$!")
}
in_background rosmaster --core -p "$port"
in_background Xvfb "$DISPLAY" -screen 0 1280x800x24
sleep 3
in_background rviz -d apps/ros1/package/rviz/saccade.rviz
mkfifo "$folder/answers"
exec 3<>"$folder/answers"
"$build/saccade" explore tabletop-1 --strategy standard --max-views 3 --no-pictures --quiet --step --publish ros \
  --out "$folder/run" <"$folder/answers" >"$folder/explore.log" 2>&1 &
started+=("$!")
echo $'y\ny\ny\ny' >&3  # the two poses of the scan, and two views
sleep 20                # rendered by software

import -window root "$folder/screen.png"
# The chosen view, the plan and the frontier, by their colours.
for color in "rgb(25,230,77)" "rgb(252,233,79)" "rgb(114,159,207)"; do
  pixels="$(convert "$folder/screen.png" -fuzz 12% -fill magenta -opaque "$color" -fuzz 0 -fill black +opaque magenta \
    -fill white -opaque magenta -colorspace gray -format '%[fx:round(mean*w*h)]' info:)"
  echo "pixels like $color: $pixels"
  ((pixels >= 40)) || { tail -n 5 "$folder"/*.log >&2; exit 1; }
done
convert "$folder/screen.png" -resize 1024x -quality 82 -strip "$picture"
ls -l "$picture"
