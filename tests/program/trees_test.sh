#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Predictions from a scene, and chains of trees: as accurate as asked for, and one file for all commands.
#   trees_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc  # bins, for comparison
fast=(--set run.method=moreau --set run.step_s=0.02)
"$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --json direct.json --threads 1 --quiet >/dev/null 2>&1
"$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --json direct2.json --threads 2 --quiet >/dev/null 2>&1
holds '.reached and .error_95 <= 0.05 and .error_95 > 0 and .gate_runs > 1000 and .seconds >= .run_seconds and .direct_seconds > 0 and ([.final_gates[][]] | add | . > 0.999999 and . < 1.000001)' direct.json
holds '(.final_gates_95[0][4][0] <= .final_gates[0][4]) and (.final_gates[0][4] <= .final_gates_95[0][4][1]) and .endings_95.trapped[0] <= .endings.trapped and .endings.trapped <= .endings_95.trapped[1]' direct.json
jq -s '.[0].final_gates == .[1].final_gates and .[0].error_95 == .[1].error_95' direct.json direct2.json | grep -q true || fail "predict SCENE: other results on other threads"
expect 0 'was not reached' "$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 1e-6 --gate-runs 2000
expect 2 'must lie between 0 and 1' "$gatewalk" predict "$scenes/field.toml" --accuracy 5
expect 2 'row has no meaning' "$gatewalk" predict "$scenes/field.toml" --row 1=m.nc
expect 0 '^Start with a state of its own: 0,0,15$' "$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 -o tree.nc --details
"$gatewalk" predict tree.nc --json tree.json --quiet >/dev/null 2>&1
holds '.gate_runs == 0 and .error_95 <= 0.05 and .answer_from == "chain"' tree.json
"$gatewalk" predict tree.nc --start 4,5,10 --json other.json --quiet >/dev/null 2>&1
holds '.gate_runs > 0 and .starts[0].error_95 <= 0.05 and .starts[0].first_runs >= 500' other.json
expect 0 'no state of its own' "$gatewalk" predict tree.nc --start 4,5,10 --first-runs 0
expect 2 'keeps no gate runs' "$gatewalk" predict m.nc --accuracy 0.1
"$gatewalk" walk tree.nc --walks 1000 --json walk-tree.json --quiet >/dev/null 2>&1
holds '([.final_gates[][]] | add) == 1000' walk-tree.json
"$gatewalk" show tree.nc --json show-tree.json --quiet
# The file keeps the checks of the chain's assumptions; predict makes the same ones anew from its runs.
holds '[.assumptions[] | select(. != null and (.wrong | not) and .p > 0)] | length == 5' direct.json
for kept in "$(jq -c .state_space.assumptions show-tree.json)" "$(jq -c .assumptions tree.json)"; do
  [ "$kept" = "$(jq -c .assumptions direct.json)" ] || fail "the checks are not those of predict: $kept"
done
# Starts have rows of their own, and are no states.
rows=$(jq .inputs show-tree.json)
expect 0 "^tree.nc: transition matrix of $((rows - 1)) states and 1 start ($rows rows, " "$gatewalk" show tree.nc
expect 0 "^$((rows - 1)) states and 1 start of one gate, " "$gatewalk" export tree.nc --gate -o one.npz
expect 0 "the chain has $((rows - 1)) states" "$gatewalk" predict tree.nc --details
expect 0 "^States: $((rows - 1)), leaves of trees" "$gatewalk" show tree.nc --details
holds '.state_space.bins == "tree" and .inputs == (.rows | length) and .gate_runs < .counts' show-tree.json
"$gatewalk" validate "$scenes/field.toml" "${fast[@]}" --matrix tree.nc --trials 100 --start 0,0,15 --null-draws 19 --json validate-tree.json --quiet >/dev/null 2>&1
holds '.state_space.bins == "tree" and .markov.verdict != null' validate-tree.json
expect 0 'The limit of states changes the final gates' "$gatewalk" build --details "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --states 100 -o few.nc
expect 0 'the states are too large' "$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.02 --states 10 -o few.nc --force
expect 0 '^Good for starts with d' "$gatewalk" build --details "$scenes/field.toml" "${fast[@]}" --accuracy 0.2 --starts=-5:5,-5:5,12:16 -o range.nc
expect 2 'd must lie inside' "$gatewalk" build "$scenes/field.toml" --starts=-50:5,-5:5,12:16 -o x.nc
expect 2 'three ranges' "$gatewalk" build "$scenes/field.toml" --starts 1:2 -o x.nc
expect 2 'must be at least 16' "$gatewalk" build "$scenes/field.toml" --bins tree --trials 5 -o x.nc
expect 2 'no meaning for bins' "$gatewalk" build "$scenes/field.toml" --bins paper --accuracy 0.1 -o x.nc

finish
