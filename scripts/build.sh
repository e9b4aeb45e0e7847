#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Release program, build/release/saccade. An existing build folder keeps its options, so that switching between
# make demo and make test compiles nothing twice.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/install_packages.sh program
source scripts/common.sh
if [[ ! -f build/release/build.ninja ]]; then
  configure release -DSACCADE_BUILD_TESTS=OFF
fi
compile release apps/cli/all apps/reproduce/all
