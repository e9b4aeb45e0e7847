#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Configures the preset tidy and runs clang-tidy over lib/ and apps/ (scripts/tidy.py).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
configure tidy -DSACCADE_ROS1=OFF -DSACCADE_ROS2=OFF  # their packages are not part of [tests]
exec /usr/bin/python3 -B scripts/tidy.py "$(jobs_here)"
