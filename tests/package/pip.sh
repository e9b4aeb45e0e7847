#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# pip install . in a new virtual environment, with nothing to download from; the module and the program run from there, the
# archive of the sources is whole, and what is missing is said.     Usage: pip.sh SOURCE BUILD WORK (BUILD relative to SOURCE)
set -euo pipefail
source_dir="$(cd "$1" && pwd)" build="$2" work="$3"
rm -rf "$work"
mkdir -p "$work"
work="$(cd "$work" && pwd)"
/usr/bin/python3 -m venv --system-site-packages "$work/env"
export PIP_CONFIG_FILE=/dev/null PIP_DISABLE_PIP_VERSION_CHECK=1
PIP_NO_INDEX=1 "$work/env/bin/pip" install -q "$source_dir" --config-settings "build-dir=$build"
cd "$work"
env/bin/python -c 'import saccade, sys; assert saccade.__file__.startswith(sys.prefix); print(saccade.TsdfMap(voxel_size_m=0.01))'
env/bin/python -m saccade explore tabletop-1 --out run --max-views 1 --quiet --no-pictures
env/bin/saccade --version
env/bin/pip show -q saccade
env/bin/pip uninstall -q -y saccade
if env/bin/python -c 'import saccade' 2>/dev/null; then
  echo "the module is still there" >&2
  exit 1
fi

back_end() { (cd "$source_dir" && PYTHONPATH=packaging/python /usr/bin/python3 -B -c "import saccade_build; $1"); }
SOURCE_DATE_EPOCH=1000000000 back_end "saccade_build.build_sdist('$work/a'); saccade_build.build_sdist('$work/b')"
cmp a/saccade-*.tar.gz b/saccade-*.tar.gz
tar -tzf a/saccade-*.tar.gz >listed.txt
for name in PKG-INFO pyproject.toml CMakeLists.txt lib/saccade/map/tsdf_map.hpp web/dist/index.html packaging/python/saccade_build.py; do
  grep -q "^saccade-[0-9.]*/$name$" listed.txt || { echo "$name is not in the archive" >&2; exit 1; }
done

# refused TEXT PATH…: building fails where nothing but PATH is there, and says so.
refused() {
  local text="$1" tools="$work/tools"
  shift
  rm -rf "$tools"
  mkdir "$tools"
  for tool in "$@"; do ln -s "$(command -v "$tool")" "$tools/"; done
  if PATH="$tools" back_end "saccade_build.build_wheel('$work/wheel')" 2>refused.txt; then
    echo "a wheel was built without what it needs" >&2
    exit 1
  fi
  grep -q "$text" refused.txt || { cat refused.txt >&2; exit 1; }
}
refused "CMake 3.25 or later is not in PATH.*apt-get install"
refused "no C++20 compiler.*apt-get install g++" cmake
echo "installed by pip, used, removed"
