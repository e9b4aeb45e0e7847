# SPDX-License-Identifier: Apache-2.0
# Sourced by the other scripts, in the root of the repository.

# One checkout takes results of another from the cache: paths below the root count as relative ones. CMake's
# -ffile-prefix-map (SaccadeRoom.cmake) keeps the root out of the objects, so that they are the same ones, too.
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
export CCACHE_BASEDIR="${CCACHE_BASEDIR:-$PWD}" CCACHE_NOHASHDIR=1 CCACHE_MAXSIZE="${CCACHE_MAXSIZE:-10G}"

# One compiler needs up to about 1.5 GB: use every core that has as much memory.
jobs_here() {
  local cores compilers
  cores="$(nproc)"
  compilers="$(awk '/MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null || echo 2)"
  echo $((compilers < 1 ? 1 : compilers < cores ? compilers : cores))
}

# configure PRESET OPTIONS…: quiet unless it fails.
configure() {
  local preset="$1" log
  shift
  mkdir -p build
  log="build/configure-$preset.log"
  cmake --preset "$preset" "$@" >"$log" 2>&1 || {
    tail -n 25 "$log" >&2
    echo "configuring the preset $preset failed; the whole output is in $log" >&2
    return 1
  }
}

# compile PRESET TARGETS…
compile() {
  local preset="$1"
  shift
  cmake --build "build/$preset" -j "$(jobs_here)" --target "${@:-all}"
}
