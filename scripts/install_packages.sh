#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages of the given sections of packages.txt that are missing. Silent when there is nothing to do.
# Usage: scripts/install_packages.sh SECTION…          (SACCADE_SKIP_PACKAGES=1 turns it off)
set -euo pipefail
list="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/packages.txt"

fail() {
  echo "install_packages: $*" >&2
  exit 1
}

packages_of() {  # the names in section $1
  awk -v wanted="[$1]" '{ sub(/#.*/, "") } NF == 0 { next } /^\[/ { inside = ($1 == wanted); seen += inside; next }
                        inside { print $1 } END { exit !seen }' "$list" || fail "no section [$1] in $list"
}

[[ ${SACCADE_SKIP_PACKAGES:-0} == 1 ]] && exit 0
(($# > 0)) || fail "usage: scripts/install_packages.sh SECTION… (sections of packages.txt)"
command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
  fail "this is not a Debian system; install the equivalents of packages.txt yourself, then set SACCADE_SKIP_PACKAGES=1"

wanted=()
for section in "$@"; do
  names="$(packages_of "$section")"
  while read -r name; do wanted+=("$name"); done <<<"$names"
done
installed="$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^installed //p' || true)"
missing=()
for name in "${wanted[@]}"; do
  grep -qxF -- "$name" <<<"$installed" || missing+=("$name")
done
((${#missing[@]} > 0)) || exit 0

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || fail "neither root nor sudo here; have an administrator run: apt-get install ${missing[*]}"
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages and what they need: ${missing[*]}"
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
run_apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q "$@" >"$log" 2>&1 || {
    tail -n 15 "$log" >&2
    fail "apt-get $1 failed (its last lines are above)"
  }
}
run_apt update
run_apt install --no-install-recommends "${missing[@]}"
