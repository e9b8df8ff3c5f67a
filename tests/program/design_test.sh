#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests design: which gates of a field to change.   design_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

small=("$scenes/mixed.toml" --set run.method=moreau --set field.rows=3 --changes 2 --types s,.)
expect 0 '^Chance to cross the changed field: [0-9.]* \[[0-9., ]*\] % in 385 new trials that were not used in' "$gatewalk" design "${small[@]}" --accuracy 0.05 --json design.json --figure design.svg -o changed.toml
holds '.gain_95[0] > 0 and .gain - (.crossed - .before.crossed) < 1e-12 and .gain - (.crossed - .before.crossed) > -1e-12 and .trials == 385 and .become == ["s", "."] and (.changes | length) == 2 and .changes[0].gate_x == 0 and ([.changes[].to] | unique) == ["s"]' design.json
holds '(.map | length) == 3 and .by_chain.optima[0].crossed >= .by_chain.optima[-1].crossed and ([.by_chain.optima[].searches] | add) == 9 and (.by_chain.best_change | length) == 3 and .by_chain.best_change[0][4] > 0' design.json
grep -q 'best change of a gate' design.svg || fail "no map of changes"
# The file is the changed scene, which crosses as often in full trials. It has no key that causes a warning and that
# nobody gave.
expect 0 '^crossed' "$gatewalk" lattice changed.toml --trials 10
! grep 'has no effect' out.txt || fail "design writes what its own reader warns of"
expect 0 'run.event_tolerance_m has no effect' "$gatewalk" design "${small[@]}" --set run.event_tolerance_m=0.02 --accuracy 0.2 -o given.toml
grep -q '^event_tolerance_m = 0.02$' given.toml || fail "design leaves out what was given"
"$gatewalk" scene changed.toml --quiet --json scene.json
"$gatewalk" lattice changed.toml --trials 4000 --quiet --json full.json
jq -s '.[0] as $d | (.[1].endings.crossed / .[1].trials) as $full | $full > $d.crossed_95[0] - 0.03 and $full < $d.crossed_95[1] + 0.03' design.json full.json | grep -q true || fail "the changed scene crosses otherwise"
# One thread gives the same bits; kept pieces are resumed; the opposite aim, harder to cross.
same() { jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' "$1" "$2" | grep -q true || fail "$3"; }
"$gatewalk" design "${small[@]}" --accuracy 0.05 --threads 1 --checkpoint kept --quiet --json one.json
same design.json one.json "design: other results on one thread"
"$gatewalk" design "${small[@]}" --accuracy 0.05 --checkpoint kept --resume --quiet --force --json again.json
same design.json again.json "design: other results when resumed"
"$gatewalk" design "${small[@]}" --accuracy 0.05 --least --quiet --json least.json
holds '.least and .crossed <= .before.crossed and .gain <= 0' least.json
# A type that stands in no gate is piloted too; the file has another start if one was given.
sed -E 's/^random = .*/map = [".........", "........."]/; /^seed = 5/d' "$scenes/mixed.toml" >plain.toml
"$gatewalk" design plain.toml --set run.method=auto --set field.rows=2 --types s --start 1,0,12 --accuracy 0.2 --quiet --json auto.json -o started.toml
holds '.start.d_m == 1 and .method.asked == "auto" and .method.pilot_starts > 0' auto.json
expect 0 '^start.x_m  *1' "$gatewalk" scene started.toml
# Without a limit of gates; a search that is not finished.
expect 0 'choosing was not finished after' "$gatewalk" design "${small[@]}" --set field.max_gates=0 --accuracy 0.1 --gate-runs 1000
# If no change helps, only the types are listed that are worst.
sed -E 's/^random = .*/map = ["sssssssss", "sssssssss"]/; /^seed = 5/d' "$scenes/mixed.toml" >soft.toml
expect 0 'No change that was simulated in full lets bodies cross more often' "$gatewalk" design soft.toml --set run.method=moreau --set field.rows=2 --types . --accuracy 0.1
expect 2 'all cells have the type that they may become' "$gatewalk" design soft.toml --set field.rows=2 --types s
expect 0 'trials crossed: ' "$gatewalk" design "$scenes/mixed.toml" --set run.method=moreau --accuracy 0.2

expect 2 'has one type of gates: a table \[terrain.types.NAME\] makes another' "$gatewalk" design "$scenes/field.toml"
expect 2 'types: "w" is no type of gate of .*: ., s, u' "$gatewalk" design "${small[@]}" --types s,w
expect 2 'changes: the field has 27 gates' "$gatewalk" design "$scenes/mixed.toml" --set field.rows=3 --changes 28
expect 2 'accuracy: must lie in \[0.001, 0.5)' "$gatewalk" design "${small[@]}" --accuracy 0.6
expect 2 'a field is designed for one start' "$gatewalk" design "${small[@]}" --start 0,0,15 --start 4,0,15
finish
