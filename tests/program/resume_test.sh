#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests --checkpoint, --resume and --max-time: finished work is kept, and a resumed run gives the bits of an
# uninterrupted one.
#   resume_test.sh GATEWALK ROOT
here=$(realpath "$(dirname "$0")")
. "$here/preamble.sh"

. "$(realpath "$(dirname "$here")")/killed.sh"

killed bins.nc 0.6 3 build "${field[@]}" --bins paper --trials 500 -o bins.nc
killed lattice.json 0.6 3 lattice "${field[@]}" --trials 10000 --json lattice.json
killed predict.json 0.6 3 predict "${field[@]}" --accuracy 0.02 --start 0,0,15 --start 4,5,10 --json predict.json
killed validate.json 1 3 validate "${field[@]}" --bins paper --matrix-trials 100 --trials 3000 --null-draws 99 --json validate.json

# A stopped run that can be resumed has its own status, stops within two seconds, and says how to resume.
long=(lattice "${field[@]}" --trials 1e8 --json long.json)
for signal in TERM HUP USR1; do
  "$gatewalk" "${long[@]}" --checkpoint pieces --resume >out.txt 2>&1 &
  pid=$!
  sleep 1
  start=$(date +%s%N)
  kill -$signal $pid
  wait $pid
  status=$?
  took=$((($(date +%s%N) - start) / 1000000))
  [ $status = 75 ] || fail "SIG$signal: status $status ($(cat out.txt))"
  [ $took -lt 2000 ] || fail "SIG$signal took $took ms"
  grep -q 'what is done is kept in pieces: the same command with --resume goes on' out.txt || fail "SIG$signal: $(cat out.txt)"
done
[ -s pieces ] && [ ! -e long.json ] || fail "stopped: no pieces, or a result"
expect 75 'kept in pieces' "$gatewalk" "${long[@]}" --checkpoint pieces --resume --max-time 1s
rm pieces
# A time limit shorter than the start of a run: each run still does a piece.
before=0
for _ in 1 2 3; do
  expect 75 'kept in pieces' "$gatewalk" "${long[@]}" --checkpoint pieces --resume --max-time 0.000001s
  [ "$(stat -c %s pieces)" -gt $before ] || fail "--max-time: a run that does nothing"
  before=$(stat -c %s pieces)
done
rm pieces
# Two runs never write the same file.
"$gatewalk" "${long[@]}" --checkpoint pieces >/dev/null 2>&1 &
pid=$!
for _ in $(seq 40); do [ -s pieces ] && break; sleep 0.1; done
expect 1 'pieces: another gatewalk writes it' "$gatewalk" "${long[@]}" --checkpoint pieces --force --max-time 1s
expect 1 'pieces: another gatewalk writes it' "$gatewalk" "${long[@]}" --checkpoint pieces --resume
kill -TERM $pid
wait $pid
[ -s pieces ] || fail "the file of a run that writes it is gone"
rm pieces
# Without --checkpoint pieces are kept beside the output, from the first one if a time limit is given.
expect 75 'kept in long.json.unfinished' "$gatewalk" "${long[@]}" --max-time 1s
expect 2 'long.json.unfinished: holds what an earlier run has done: --resume goes on' "$gatewalk" "${long[@]}"
cp long.json.unfinished kept
# The torn end of the file is cut off, and whole pieces are used.
printf 'torn' >>long.json.unfinished
truncate -s -30 kept
for log in long.json.unfinished kept; do
  expect 75 "kept in $log" "$gatewalk" "${long[@]}" --checkpoint $log --resume --max-time 1s
done
# Pieces of another scene, seed or input are refused, naming the difference.
expect 2 'kept: is of another run, the scene:' "$gatewalk" "${long[@]}" --set forces.random_N=40 --checkpoint kept --resume
grep -q 'forces.random_N' out.txt || fail "--resume: does not name the key that differs"
expect 2 'kept: is of another run, there: .*--seed=5.*; here: .*--seed=5 --trials=10$\|kept: is of another run, there:' "$gatewalk" lattice "${field[@]}" --trials 10 --json long.json --checkpoint kept --resume
expect 2 'kept: is of another run, command: lattice there, gate here' "$gatewalk" gate "${field[@]}" --checkpoint kept --resume
cp "$scenes/field.toml" mine.toml
expect 75 'kept in mine' "$gatewalk" lattice mine.toml --trials 1e8 --checkpoint mine --max-time 1s
echo '# a remark' >>mine.toml
expect 2 'mine.toml has changed' "$gatewalk" lattice mine.toml --trials 1e8 --checkpoint mine --resume
# A changed byte, in the first of several pieces, is found.
"$gatewalk" lattice "${field[@]}" --trials 100 --json one.json --quiet
flip=(lattice "${field[@]}" --trials 1e6 --json two.json --threads 1 --checkpoint flipped --resume)
for _ in 1 2 3; do expect 75 '' "$gatewalk" "${flip[@]}" --max-time 0.5s; done
at=$(($(stat -c %s flipped) / 4))
byte=$(od -An -tu1 -j $at -N 1 flipped)
# shellcheck disable=SC2059
printf "\\x$(printf %x $((byte ^ 1)))" | dd of=flipped bs=1 seek=$at conv=notrunc status=none
expect 2 'flipped: is damaged at byte' "$gatewalk" "${flip[@]}"
# Without kept pieces a resumed run starts at the beginning.
expect 0 'crossed' "$gatewalk" lattice "${field[@]}" --trials 100 --checkpoint none --resume
[ ! -e none ] || fail "a checkpoint stays behind"
# Wrong use.
expect 2 'must be a time' "$gatewalk" "${long[@]}" --max-time 3
expect 2 'must be a time' "$gatewalk" "${long[@]}" --max-time=-3h
expect 2 'must be a time' "$gatewalk" "${long[@]}" --max-time=infs
expect 2 'needs an output file, or --checkpoint' "$gatewalk" lattice "${field[@]}" --max-time 3h
expect 2 'needs an output file, or --checkpoint' "$gatewalk" lattice "${field[@]}" --resume
expect 2 'are the same file' "$gatewalk" "${long[@]}" --checkpoint long.json
expect 2 'holds no pieces' "$gatewalk" "${long[@]}" --checkpoint one.json --resume
cmp -s one.json <(cat one.json) && [ -s one.json ] || fail "--resume touched another file"

finish
