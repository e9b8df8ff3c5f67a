#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests sweep: a point is what gate gives for its keys. Values as from:step:to, as lists, and from the scene's own grid.
#   sweep_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

"$gatewalk" sweep "$scenes/single_gate.toml" --trials 60 --seed 5 --vary forces.propulsion_N=8:0.5:9 \
  --vary run.method=stable,moreau --csv sweep.csv --json sweep.json --quiet 2>/dev/null || fail "sweep"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 60 --seed 5 --set forces.propulsion_N=8.5 --json point.json --quiet
holds '[.points[].at["forces.propulsion_N"]] == [8, 8, 8.5, 8.5, 9, 9]' sweep.json
[ "$(jq -cS '.points[2] | del(.at, .right_of_traversed, .right_of_traversed_95, .status.trials_checked)' sweep.json)" = "$(jq -cS 'del(.made_by, .format_version, .status.trials_checked)' point.json)" ] ||
  fail "sweep: a point is not what gate gives"
[ "$(wc -l <sweep.csv)" = 7 ] || fail "sweep: $(wc -l <sweep.csv) lines"
[ "$(head -n 1 sweep.csv | cut -d, -f1,2,3)" = "forces.propulsion_N,run.method,method" ] || fail "sweep: $(head -n 1 sweep.csv)"
expect 0 '^From 60 points of 1 trial,' "$gatewalk" sweep "$scenes/fig8.toml" --trials 1 --quiet
expect 0 '^From 216 points of 1 trial,' "$gatewalk" sweep "$scenes/fig12.toml" --trials 1 --quiet
expect 0 ' 12 points' "$gatewalk" sweep "$scenes/fig8.toml" --trials 1 --quiet --vary forces.random_N=20
expect 2 'nothing to vary' "$gatewalk" sweep "$scenes/field.toml"
expect 2 'closest known key is forces.random_N' "$gatewalk" sweep "$scenes/field.toml" --vary forces.randm_N=1
expect 2 'holds no value' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1:1:0
expect 2 "'2,' in" "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1:1:2,
expect 2 'lacks a value' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=
printf '[sweep]\nforces.random_N = []\n' >empty_sweep.toml
expect 2 'lacks a value' "$gatewalk" sweep empty_sweep.toml
expect 0 'sweep. of .* has no effect here' "$gatewalk" gate "$scenes/fig8.toml" --trials 1
expect 2 'lacks a value' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1,,2
expect 2 'has no effect' "$gatewalk" sweep "$scenes/fig8.toml" --set forces.random_N=1
expect 2 'step in' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1:0:2
expect 0 ' 7 points' "$gatewalk" sweep "$scenes/field.toml" --trials 1 --quiet --vary start.vx_m_per_s=-0.3:0.1:0.3
cat "$scenes/fig8.toml" | "$gatewalk" sweep /dev/stdin --trials 5 --quiet --vary forces.random_N=20 --csv - >piped.csv
"$gatewalk" sweep "$scenes/fig8.toml" --trials 5 --quiet --vary forces.random_N=20 --csv - | cmp - piped.csv || fail "sweep of a pipe"
# Ten points are all on the first screen, in their order; of eleven the best and the worst.
for n in 10 11; do "$gatewalk" sweep "$scenes/single_gate.toml" --trials 5 --vary forces.propulsion_N=1:1:$n --quiet >$n.txt; done
[ "$(grep -c '^ *[0-9]*  *[0-9.]* \[' 10.txt)" = 10 ] && ! grep -q 'points at which' 10.txt || fail "sweep: not all of ten points: $(cat 10.txt)"
grep -q '^4 of the points at which most runs traverse' 11.txt || fail "sweep: $(cat 11.txt)"
expect 2 'forces.propulsion_N .*a key has one value: run the command once for each value (sweep --vary' "$gatewalk" predict "$scenes/field.toml" --set forces.propulsion_N=0.5:0.1:1
expect 2 'varied twice' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1 --vary forces.random_N=2
expect 2 'must lie in' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1,-1
expect 2 'more than 100000' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=0:1e-9:1

finish
