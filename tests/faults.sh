#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What becomes of results when the system fails: call number k of write, fsync, fdatasync, rename, ftruncate fails, once
# and from then on, for every k that a command makes; so does getting memory; /dev/full, a full disk, a folder that cannot
# be written, little memory. Never a silent success, never a damaged file.
#   faults.sh GATEWALK ROOT [MOST]    at most MOST values of k each; of memory, which is asked for 10^5 times, k grows by fifths
here=$(realpath "$(dirname "$0")")
most=${3:-12}
. "$here/program/preamble.sh" "$1" "$2"
. "$here/killed.sh"
cc -shared -fPIC -O1 -o faults.so "$here/faults.c" -ldl || exit 1
runs=0
is_old() { cmp -s "$1" <(echo old); }

# survives OUTPUT COMMAND...: an old output stays as it was, or the new one is whole; a status of 0 means that it is new.
survives() {
  local output=$1 call k ever error status
  shift
  rm -f "$output"
  "$gatewalk" "$@" --quiet >/dev/null 2>err.txt || fail "$* ($(cat err.txt))"
  mv "$output" "one-$output"
  for call in write fsync fdatasync rename ftruncate; do
    for ever in "" 1; do
      for k in $(seq "$most"); do
        for error in 28 5; do  # ENOSPC, EIO
          echo old >"$output"
          rm -f seen pieces
          env LD_PRELOAD=./faults.so FAULT_CALL=$call FAULT_AT="$k" ${ever:+FAULT_EVER=1} FAULT_ERRNO=$error FAULT_SEEN=seen \
            "$gatewalk" "$@" --quiet --force --checkpoint pieces >/dev/null 2>err.txt
          status=$?
          runs=$((runs + 1))
          if [ $status = 0 ]; then
            same "one-$output" "$output"
            [ ! -e seen ] || [ $call = fdatasync ] || [ $call = ftruncate ] || fail "$call $k failed ($error), and status 0: $*"
          else
            is_old "$output" || same "one-$output" "$output"
            grep -q '^gatewalk: ' err.txt || fail "$call $k failed without a word: $* ($(cat err.txt))"
            [ $status = 1 ] || fail "$call $k failed: status $status: $* ($(cat err.txt))"
          fi
          # What was kept serves.
          if [ -e pieces ]; then
            "$gatewalk" "$@" --quiet --force --checkpoint pieces --resume >/dev/null 2>err.txt || fail "not resumed after $call $k: $* ($(cat err.txt))"
            same "one-$output" "$output"
          fi
        done
        [ -e seen ] || break  # there are no more such calls
      done
    done
  done
  # Libraries may crash without memory: that is no success, and no file is damaged either.
  for ever in "" 1; do
    for ((k = 1000; k < 1000000; k += k / 5)); do
      echo old >"$output"
      rm -f seen pieces
      env LD_PRELOAD=./faults.so FAULT_CALL=malloc FAULT_AT="$k" ${ever:+FAULT_EVER=1} FAULT_ERRNO=12 FAULT_SEEN=seen \
        "$gatewalk" "$@" --quiet --force --checkpoint pieces >/dev/null 2>err.txt
      status=$?
      [ -e seen ] || break
      runs=$((runs + 1))
      case $status in
        0) same "one-$output" "$output" ;;
        1) grep -q '^gatewalk: ' err.txt || fail "without memory $k: no words: $*" ;;
        *) crashes=$((crashes + 1)) ;;
      esac
      [ $status = 0 ] || is_old "$output" || same "one-$output" "$output"
      [ -e pieces ] || continue
      "$gatewalk" "$@" --quiet --force --checkpoint pieces --resume >/dev/null 2>err.txt || fail "not resumed after memory $k: $* ($(cat err.txt))"
      same "one-$output" "$output"
    done
  done 2>/dev/null  # the shell's own words about crashes
  rm -f "$output" pieces
}
crashes=0
survives gate.json gate "${field[@]}" --trials 2000 --json gate.json
survives sweep.csv sweep "$scenes/single_gate.toml" --vary forces.propulsion_N=6,7 --trials 500 --csv sweep.csv
survives bins.nc build "${field[@]}" --bins paper --trials 10 -o bins.nc
survives tree.nc build "${field[@]}" --accuracy 0.1 -o tree.nc
survives lattice.json lattice "${field[@]}" --trials 500 --json lattice.json
survives predict.json predict "${field[@]}" --accuracy 0.1 --json predict.json

# Full and forbidden places.
one=(lattice "${field[@]}" --trials 100 --quiet)
expect 1 'cannot be written: No space left' "$gatewalk" "${one[@]}" --json /dev/full
"$gatewalk" "${one[@]}" --json - >/dev/full 2>err.txt
[ $? = 1 ] && grep -q 'No space left' err.txt || fail "standard output is full: $(cat err.txt)"
mkdir small && mount -t tmpfs -o size=256k none small 2>/dev/null && {
  "$gatewalk" "${one[@]}" --json one.json
  cp one.json small/old.json
  head -c 300000 /dev/zero >small/fill 2>/dev/null
  expect 1 'No space left' "$gatewalk" "${one[@]}" --json small/old.json --force
  cmp -s one.json small/old.json || fail "a full disk: the old file is damaged"
  expect 1 'No space left' "$gatewalk" "${one[@]}" --json new.json --checkpoint small/pieces
  [ ! -e new.json ] || fail "a full disk under the checkpoint: a result without a word"
  umount small
}
mkdir forbidden && chmod 500 forbidden
[ -w forbidden ] || expect 2 'Permission denied' "$gatewalk" "${one[@]}" --json forbidden/x.json
# Little memory: said, with what would help; the old file stays.
echo old >big.nc
(ulimit -v 400000; "$gatewalk" build "${field[@]}" --accuracy 0.001 --starts all -o big.nc --force --quiet --threads 1 >/dev/null 2>err.txt; [ $? = 1 ]) || fail "out of memory: another status"
grep -q 'out of memory' err.txt || fail "out of memory without a word: $(cat err.txt)"
[ "$(cat big.nc)" = old ] || fail "out of memory: the old file is gone"
echo "$runs runs with a failing call; without memory $crashes crashed in libraries"
finish
