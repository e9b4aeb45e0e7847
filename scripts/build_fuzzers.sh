#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds the libFuzzer programs into build/fuzz.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
configure fuzz
compile fuzz tests/fuzz/all
