#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Looks for input on which a reader fails: every target of tests/fuzz (or those named) by libFuzzer with clang's address
# and undefined-behaviour sanitizers, for so many seconds each.   [SECONDS_EACH=60] [BUILD=build-fuzz] tests/fuzz/run.sh [TARGET...]
# A finding is a crash, an exception that the reader does not document, a property that does not hold, an input that
# takes a second, or one that needs more than 256 MB. It is left in BUILD/findings; once mended it belongs into
# tests/fuzz/corpus/TARGET. Writes BUILD/fuzz.csv: target, executions, seconds, findings. Fails on any.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${BUILD:-build-fuzz}
seconds=${SECONDS_EACH:-60}
. ./.ci/prepare
packages+=(clang-16 libclang-rt-16-dev)
! command -v apt-get >/dev/null || install_missing
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O2 \
  -DGATEWALK_FUZZ=ON -DGATEWALK_PAGES=OFF -DBUILD_TESTING=OFF
cmake --build "$build" --target fuzz
[ $# -gt 0 ] || mapfile -t names < <(sed -n 's/^GATEWALK_FUZZ_TARGET(\(.*\))/\1/p' tests/fuzz/targets.def)
[ $# = 0 ] || names=("$@")
mkdir -p "$build/findings" "$build/corpus"
# One target: what it found goes to findings, its last lines to TARGET.log, its line of the table to TARGET.row.
one() {
  local name=$1 options=() status=0 began=$SECONDS findings executions longest=8192
  [ ! -f "tests/fuzz/dictionaries/$name.dict" ] || options+=("-dict=tests/fuzz/dictionaries/$name.dict")
  [ "$name" != matrix ] || longest=100000
  mkdir -p "$build/corpus/$name"
  LSAN_OPTIONS="print_suppressions=0:suppressions=$PWD/tests/sanitizers/fuzz_leaks.txt"
  export LSAN_OPTIONS
  # What sanitizers keep beside the program's own memory is no part of the 256 MB.
  ASAN_OPTIONS=quarantine_size_mb=16:allocator_may_return_null=0 "$build/tests/fuzz/fuzz_$name" -max_total_time="$seconds" \
    -timeout=1 -rss_limit_mb=512 -malloc_limit_mb=256 -max_len="$longest" -print_final_stats=1 "${options[@]}" \
    -artifact_prefix="$build/findings/$name-" "$build/corpus/$name" "tests/fuzz/corpus/$name" >"$build/$name.log" 2>&1 || status=$?
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$name.log")
  findings=$((status == 0 ? 0 : 1))
  echo "$name,${executions:-0},$((SECONDS - began)),$findings" >"$build/$name.row"
  echo "$name: ${executions:-0} executions, $findings findings"
  [ $status = 0 ] || tail -n 25 "$build/$name.log"
}
export build seconds
export -f one
for name in "${names[@]}"; do rm -f "$build/$name.row"; done
printf '%s\0' "${names[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'one "$1"' one
{
  echo "target,executions,seconds,findings"
  for name in "${names[@]}"; do cat "$build/$name.row"; done
} >"$build/fuzz.csv"
! grep -v '^target' "$build/fuzz.csv" | grep -qv ',0$'
