#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Completion and manual pages that the program makes: each shell parses and uses its file, checkers find no fault.
# Usage: completion.sh PROGRAM WORK
set -euo pipefail
program="$1" work="$2" here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
rm -rf "$work"
mkdir -p "$work/folder"
cd "$work"
for shell in bash zsh fish; do "$program" generate "$shell" >"saccade.$shell"; done
"$program" generate man man --date 2026-01-01
failed=0

# expect SHELL WORDS… -- WANTED…: what is completed has all words of WANTED.
expect() {
  local shell="$1" wanted got
  shift
  local words=()
  while [[ $1 != -- ]]; do words+=("$1"); shift; done
  shift
  got="$("complete_in_$shell" "${words[@]}")"
  for wanted in "$@"; do
    if ! grep -qxF -- "$wanted" <<<"$got"; then
      echo "$shell: '${words[*]}' does not complete to '$wanted', but to: ${got//$'\n'/ }" >&2
      failed=1
    fi
  done
}
complete_in_bash() {
  bash -c 'compopt() { :; }; source saccade.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _saccade; printf "%s\n" "${COMPREPLY[@]}"' bash "$@"
}
complete_in_zsh() { zsh -f "$here/complete.zsh" "$*"; }
complete_in_fish() { HOME="$work" fish --no-config -c 'source saccade.fish; complete -C "$argv"' "$*" | cut -f 1; }

check_completion() {
  local shell="$1"
  expect "$shell" saccade ex -- explore
  expect "$shell" saccade explore --sens -- --sensor
  expect "$shell" saccade explore --sensor kin -- kinect-v1 kinect-v2
  expect "$shell" saccade robot re -- reach
  expect "$shell" saccade --threads 2 robot reach --base -- --base --base-at
  expect "$shell" saccade segment fol -- "$2"
}
touch folder/cloud.pcd
bash -n saccade.bash
check_completion bash folder
if command -v zsh >/dev/null; then
  zsh -n saccade.zsh
  # _arguments reads each list of options when completion runs; a stand-in shows that the functions reach it.
  zsh -f -c 'compdef() { :; }; _arguments() { print -rl -- "$@"; state=""; }; source ./saccade.zsh; _saccade_explore' >zsh.txt
  grep -qF -- '--sensor[' zsh.txt || { echo "zsh: no --sensor" >&2; failed=1; }
  expect zsh saccade expl -- explore
  expect zsh saccade explore --sens -- --sensor
  expect zsh saccade robot re -- reach
fi
if command -v fish >/dev/null; then
  fish -n saccade.fish
  check_completion fish folder/
fi

pages=(man/*.1)
((${#pages[@]} > 15)) || { echo "only ${#pages[@]} manual pages" >&2; failed=1; }
grep -q 'sensor' man/saccade-explore.1
if command -v mandoc >/dev/null; then
  mandoc -T lint -W warning "${pages[@]}" || failed=1
fi
if command -v groff >/dev/null; then
  warnings="$(for page in "${pages[@]}"; do groff -K utf8 -man -ww -z "$page" 2>&1; done)"
  if [[ -n $warnings ]]; then printf '%s\n' "$warnings" >&2; failed=1; fi
fi
exit $failed
