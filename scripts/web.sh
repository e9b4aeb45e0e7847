#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The pages of annotate, show and reports: scripts/web.sh build   makes web/dist anew from web/src
#                                scripts/web.sh check   types, and whether web/dist is what web/src gives, byte by byte
#                                scripts/web.sh test    the browser tests, with build/release/saccade and Chromium; what they leave is in out/test
# Building the program needs none of this: web/dist is part of the repository (docs/decisions/0015-web-bundle.md).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root="$PWD"
what="${1:-}"
[[ $what == build || $what == check || $what == test ]] || {
  sed -n '3,6s/^# //p' "$0" >&2
  exit 2
}
command -v npm >/dev/null || scripts/install_packages.sh web

cd web
if ! cmp -s package-lock.json node_modules/.saccade-lock; then
  for attempt in 1 2 3; do
    npm ci --ignore-scripts --no-audit --no-fund >"$root/web/.npm.log" 2>&1 && break
    ((attempt < 3)) || {
      tail -n 15 .npm.log >&2
      echo "web: npm ci failed (its last lines are above)" >&2
      exit 1
    }
    sleep $((attempt * 5))
  done
  rm -f .npm.log
  cp package-lock.json node_modules/.saccade-lock
fi

case "$what" in
  build)
    npx tsc --noEmit
    npx vite build --logLevel warn
    npx vite build --logLevel warn -c vite.report.config.ts
    ;;
  check)
    npx tsc --noEmit
    npx tsc --noEmit -p tests
    fresh="$(mktemp -d)"
    trap 'rm -rf "$fresh"' EXIT
    npx vite build --logLevel warn --outDir "$fresh" --emptyOutDir
    npx vite build --logLevel warn -c vite.report.config.ts --outDir "$fresh"
    diff -rq dist "$fresh" || {
      echo "web: web/dist is not what web/src gives; run scripts/web.sh build and commit web/dist" >&2
      exit 1
    }
    echo "web/dist is what web/src gives ($(find dist -type f | wc -l) files, $(du -sk --apparent-size dist | cut -f1) kB)"
    ;;
  test)
    [[ -x $root/build/release/saccade ]] || {
      echo "web: build/release/saccade is not there; run make build" >&2
      exit 1
    }
    mkdir -p "$root/out/test"
    SACCADE_PROGRAM="$root/build/release/saccade" npx playwright test "${@:2}"
    ;;
esac
