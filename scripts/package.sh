#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make package: Debian packages in build/release/packages, of what the build folder is configured for. SOURCE_DATE_EPOCH is the
# time that stands in them: that of the last commit, or of CHANGELOG.md where git does not say, unless it is set.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/install_packages.sh program package
source scripts/common.sh
umask 022
if [[ -z ${SOURCE_DATE_EPOCH:-} ]]; then
  SOURCE_DATE_EPOCH="$(git log -1 --format=%ct 2>/dev/null)" || SOURCE_DATE_EPOCH="$(stat -c %Y CHANGELOG.md)"
fi
export SOURCE_DATE_EPOCH

build=build/release
if [[ ! -f $build/build.ninja ]]; then
  configure release -DSACCADE_BUILD_TESTS=OFF
fi
targets=(lib/saccade/all devices/all)
for app in cli reproduce python ros1 ros2; do targets+=("apps/$app/all"); done
compile release "${targets[@]}"

rm -rf "$build/packages"
log="$build/package.log"
(cd "$build" && cpack --config CPackConfig.cmake) >"$log" 2>&1 || {
  tail -n 25 "$log" >&2
  echo "packing failed; the whole output is in $log" >&2
  exit 1
}
rm -rf "$build/packages/_CPack_Packages"
ls -l "$build"/packages/*.deb | awk '{ printf "%6.1f MB  %s\n", $5 / 1e6, $9 }'
