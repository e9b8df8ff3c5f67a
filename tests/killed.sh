# SPDX-License-Identifier: MIT
# Functions for runs that are killed at any moment and resumed. Sourced after tests/program/preamble.sh (`fail`).
# shellcheck shell=bash

field=("$scenes/field.toml" --seed 5)
plain() { jq -S 'walk(if type == "object" then del(.seconds, .run_seconds, .direct_seconds, .chain_seconds, .speed_ratio) else . end)' "$1"; }
same() {
  case $1 in
    *.json) cmp -s <(plain "$1") <(plain "$2") ;;
    *) cmp -s "$1" "$2" ;;
  esac || fail "$2 is not $1, of a run that was never stopped"
}
command -v jq >/dev/null || { echo "needs jq" >&2; exit 2; }
kills=0 resumable=0
# killed OUTPUT SECONDS KILLS COMMAND...: runs the command, which writes OUTPUT, without interruption. Then kills it
# with -9 at a random moment within SECONDS (about its running time) and resumes it, KILLS times in all. Each result
# must equal that of the uninterrupted run, no file may be damaged, and no checkpoint may remain after the result.
killed() {
  local output=$1 seconds=$2 wanted=$3 pid status killed=0 runs=0
  shift 3
  "$gatewalk" "$@" --quiet >/dev/null 2>err.txt || fail "$* ($(cat err.txt))"
  mv "$output" "one-$output"
  while [ $killed -lt "$wanted" ] && [ $runs -lt $((20 * wanted)) ]; do
    runs=$((runs + 1))
    "$gatewalk" "$@" --quiet --checkpoint pieces --resume >/dev/null 2>err.txt &
    pid=$!
    sleep "$(awk -v s="$seconds" -v r=$RANDOM 'BEGIN { print s * r / 32768 }')"
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    status=$?
    if [ $status = 0 ]; then
      same "one-$output" "$output"
      [ ! -e pieces ] || fail "the checkpoint is still there: $*"
      rm -f "$output"
      continue
    fi
    [ $status = 137 ] || fail "status $status of $* ($(cat err.txt))"
    killed=$((killed + 1))
    [ ! -s pieces ] || resumable=$((resumable + 1))
    # Killed after the result was written and before the checkpoint was removed: both files are whole.
    [ ! -e "$output" ] || { same "one-$output" "$output" && rm -f "$output"; }
  done
  [ $killed = "$wanted" ] || fail "killed $killed times only: $*"
  "$gatewalk" "$@" --quiet --checkpoint pieces --resume >/dev/null 2>err.txt || fail "resumed: $* ($(cat err.txt))"
  same "one-$output" "$output"
  [ ! -e pieces ] || fail "the checkpoint is still there: $*"
  rm -f "$output" .gatewalk-*  # temporary files of a run killed while it replaced a file
  kills=$((kills + killed))
}
