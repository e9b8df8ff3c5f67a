# SPDX-License-Identifier: MIT
# What every part of the command line's contract starts with: sourced with GATEWALK ROOT [KEEP] in $1 to $3.
# KEEP: a folder for what other tests look at.
# shellcheck shell=bash
set -u
gatewalk=$(realpath "$1")
scenes=$(realpath "$2")/scenes
# The cells of scenes/programs/hopper.toml.
hopper_program="mawk -W interactive -f $(realpath "$2")/tests/program/hopper.awk"
keep=${3:+$(realpath -m "$3")}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
# expect STATUS TEXT COMMAND...: checks the exit status, and TEXT (a grep pattern) in the output.
expect() {
  local status=$1 text=$2
  shift 2
  "$@" >out.txt 2>&1
  local got=$?
  [ "$got" = "$status" ] || fail "status $got instead of $status: $* ($(head -n 3 out.txt))"
  grep -q -e "$text" out.txt || fail "no '$text' in the output of: $* ($(head -n 3 out.txt))"
}
value() { jq -r "$1" "$2"; }
holds() { [ "$(jq "$1" "$2")" = true ] || fail "$1 does not hold in $2: $(jq -c 'del(.made_by)' "$2" | head -c 400)"; }
# paper_matrix FILE: builds a matrix with 20 runs from each of the paper's 87 states.
paper_matrix() { "$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 -o "$1" --quiet >/dev/null || exit 1; }
# kept FILE...: keeps files for tests that look at them.
kept() { [ -z "$keep" ] || { rm -rf "$keep" && mkdir -p "$keep" && cp -r "$@" "$keep"; } || fail "nothing kept in $keep"; }
finish() {
  [ $failures = 0 ] || exit 1
  echo "all fine"
}
