#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# After a signal the status is 130, a message says so, and old files are unchanged.   interrupt_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" gate "$scenes/single_gate.toml" --trials 20 --json gate.json --quiet
"$gatewalk" lattice "$scenes/field.toml" --trials 20 --json lattice.json --quiet
"$gatewalk" chart methods "$scenes/stiff.toml" -o charts --trials 20 --repeats 1 --methods stable --quiet >/dev/null
# Ctrl-C: within 2 s, status 130, a message, the old file unchanged.
for command in "gate $scenes/single_gate.toml --trials 1e9 --json gate.json" \
               "build $scenes/field.toml --trials 1e7 -o m.nc" \
               "lattice $scenes/field.toml --trials 1e9 --json lattice.json" \
               "chart field $scenes/field.toml --trials 1e9 -o new/chart" \
               "chart chain $scenes/field.toml -o charts/x --truth-trials 1e9" \
               "chart methods $scenes/field.toml --trials 1e7 -o charts"; do
  before=$(cat gate.json m.nc lattice.json $(find charts -type f | sort) | cksum)
  # shellcheck disable=SC2086
  "$gatewalk" $command >out.txt 2>&1 &
  pid=$!
  sleep 1
  start=$(date +%s%N)
  kill -TERM $pid
  wait $pid
  status=$?
  took=$((($(date +%s%N) - start) / 1000000))
  [ $status = 130 ] || fail "ctrl-C: status $status of $command"
  [ $took -lt 2000 ] || fail "ctrl-C took $took ms: $command"
  grep -q "stopped before the end" out.txt || fail "ctrl-C without a word: $command"
  [ "$before" = "$(cat gate.json m.nc lattice.json $(find charts -type f | sort) | cksum)" ] || fail "ctrl-C changed a file: $command"
done

# SIGHUP ends a run like ctrl-C; a signal that was ignored at the start stays ignored.
"$gatewalk" gate "$scenes/single_gate.toml" --trials 1e9 --json gate.json >out.txt 2>&1 &
pid=$!
sleep 1
kill -HUP $pid
wait $pid
[ $? = 130 ] && grep -q 'stopped before the end' out.txt || fail "SIGHUP: $(cat out.txt)"
(trap '' INT HUP; exec "$gatewalk" gate "$scenes/single_gate.toml" --trials 1e9 --json gate.json >out.txt 2>&1) &
pid=$!
sleep 1
kill -INT $pid; kill -HUP $pid; kill -INT $pid
sleep 1.5
kill -0 $pid 2>/dev/null || fail "an ignored signal ended the program"
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail "SIGTERM beside ignored signals"
ls -A | grep -q '^\.gatewalk-' && fail "temporary files stayed behind: $(ls -A)"

finish
