#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# MPI processes share a run: 1 to 4 of them give the bits of one process. They stop together, and a run that lost a
# process can be resumed.   mpi_test.sh GATEWALK ROOT GATEWALK_MPI
here=$(realpath "$(dirname "$0")")
with_mpi=$(realpath "$3")
. "$here/program/preamble.sh" "$1" "$2"
. "$here/killed.sh"

# on N COMMAND...: also as root, and on more processes than there are processors. Under a sanitizer, Open MPI's leaks
# cannot be told from ours by name, because its modules are unloaded at the end.
on() {
  local n=$1
  shift
  env ${SANITIZED:+ASAN_OPTIONS=detect_leaks=0} OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout $((${SANITIZED:+10 *} 120)) \
    mpirun -n "$n" --oversubscribe "$with_mpi" "$@" --quiet --threads 1
}
# shared RANKS OUTPUT COMMAND...
shared() {
  local ranks=$1 output=$2 n
  shift 2
  "$gatewalk" "$@" --quiet --threads 1 >/dev/null 2>err.txt || fail "$* ($(cat err.txt))"
  mv "$output" "one-$output"
  for n in $ranks; do
    on $n "$@" >out.txt 2>err.txt || fail "$n ranks: $* ($(cat err.txt))"
    same "one-$output" "$output"
    rm -f "$output"
  done
}
shared "${GATEWALK_LONG:+1 3} 2 4" predict.json predict "${field[@]}" --accuracy 0.03 --json predict.json
shared 2 tree.nc build "${field[@]}" --starts all --accuracy 0.1 -o tree.nc
shared 3 bins.nc build "${field[@]}" --bins paper --trials 30 -o bins.nc
shared 3 lattice.json lattice "${field[@]}" --trials 3000 --json lattice.json
shared 3 rare.json rare "${field[@]}" --set run.method=moreau --row 3 --accuracy 0.1 --json rare.json
shared 3 validate.json validate "${field[@]}" --bins paper --matrix-trials 20 --trials 1000 --null-draws 99 --json validate.json
# Output is printed once.
[ "$(on 3 lattice "${field[@]}" --trials 100 | grep -c crossed)" = 1 ] || fail "not one table of three ranks"
on 2 lattice "${field[@]}" --trials 0 >out.txt 2>&1 && fail "--trials 0 is not refused"
[ "$(grep -c 'must be at least 1' out.txt)" = 1 ] || fail "not one complaint: $(cat out.txt)"

# Stopped together, then resumed by other numbers of processes, and by one.
long=(lattice "${field[@]}" --trials 60000 --json long.json)
"$gatewalk" "${long[@]}" --quiet && mv long.json one-long.json
on 3 "${long[@]}" --checkpoint pieces --max-time 1s >out.txt 2>&1 && fail "--max-time: status 0"
[ "$(grep -c 'kept in pieces' out.txt)" = 1 ] || fail "--max-time: $(cat out.txt)"
on 2 "${long[@]}" --checkpoint pieces --resume --max-time 1s >out.txt 2>&1
# A process that is lost ends all; the finished pieces are kept.
on 3 "${long[@]}" --checkpoint pieces --resume >out.txt 2>&1 &
sleep 1.5
pkill -KILL -n -f "^$with_mpi lattice.*pieces" || fail "no rank to kill"
wait $! && fail "a rank was killed: status 0"
[ -s pieces ] && [ ! -e long.json ] || fail "a rank was killed: no pieces, or a result"
"$gatewalk" "${long[@]}" --quiet --checkpoint pieces --resume
same one-long.json long.json
finish
