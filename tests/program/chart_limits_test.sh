#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests chart limits: where methods fail near the numbers of a scene.   chart_limits_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# Nine numbers, five methods; the table fits a screen.
short=(--quick --trials 8 --set run.time_limit_s=3)
"$gatewalk" chart limits "$scenes/field.toml" -o maps "${short[@]}" --figure all.svg >table.txt 2>maps.err || fail "chart limits: $(head -n 3 maps.err)"
holds '.scene == "field" and .trials_per_point == 8 and .types_not_charted == []' maps/limits.json
holds '.maps | length == 45' maps/limits.json
holds '[.maps[] | (.status | length) == (.y.values | length) and (.status[0] | length) == (.x.values | length)] | all' maps/limits.json
holds '.methods | map(.name) == ["paper", "stable", "moreau", "penalty", "event"]' maps/limits.json
holds '[.methods[] | .limits | length == 10] | all' maps/limits.json
holds '.methods[1] | .setting == "run.step_s" and .value == 0.02 and .limits[0].own == 0.02' maps/limits.json
[ "$(wc -l <table.txt)" -le 15 ] || fail "chart limits prints $(wc -l <table.txt) lines"
[ "$(ls maps/*.svg | wc -l)" = 9 ] || fail "chart limits: $(ls maps)"
[ "$(awk -F, '{ print NF }' maps/limits.csv | sort -u)" = 23 ] || fail "chart limits: uneven lines in limits.csv"
[ "$(awk -F, '$7 == 1' maps/limits.csv | wc -l)" = 35 ] || fail "chart limits: the scene is not in each of its maps"

# The verdict at the scene's own point is that of gate, and its sign stands in gate's warning.
faults='{runs, runs_penetrating_over_1_percent, runs_creating_energy, runs_beyond_the_stability_bound, runs_not_finite, impacts, worst_penetration_m}'
for k in 0 1 2 3 4; do
  method=$(value ".methods[$k].name" maps/limits.json) sign=$(value ".methods[$k] | select(.status != \"outcomes off\") | .sign" maps/limits.json)
  "$gatewalk" gate "$scenes/field.toml" --set run.method=$method --set run.time_limit_s=3 --trials 8 --json gate.json --quiet >/dev/null 2>gate.err
  jq -s "(.[0].methods[$k].health | $faults) == (.[1].status | $faults)" maps/limits.json gate.json | grep -q true || fail "$method: gate reports other faults"
  grep -q -F -e "$sign" gate.err || [ -z "$sign" ] || fail "$method: gate does not warn: $sign"
done
holds '[.methods[] | .status] | unique | length > 1' maps/limits.json  # the methods differ

# The first line names the methods without a fault at the scene's own numbers; no line advises the scene's own value.
head -n 1 table.txt | grep -q "^field: at the scene's own numbers [a-z, ]* shows* no fault; [a-z, ]* do" || fail "chart limits: $(head -n 2 table.txt)"
for k in 0 1 2 3 4; do
  name=$(value ".methods[$k].name" maps/limits.json)
  jq -e ".methods[$k].status == \"ok\"" maps/limits.json >/dev/null && side='numbers .*' rest=' no fault;' || { side='no fault; .*' rest=''; }
  head -n 2 table.txt | tr '\n' ' ' | grep -q "$side$name.*$rest" || fail "chart limits: $name is in the wrong list: $(head -n 2 table.txt)"
  own=$(jq -r ".methods[$k] | \"\(.setting)=\(.value)\"" maps/limits.json)
  grep -A 2 "^  $name " table.txt | sed '2,$ { /^  [a-z]/,$ d }' | grep -q "take $own$" && fail "chart limits: advises the scene's own value: $own"
done
# The remedy in the table can be given as printed, and helps.
line=$(grep -A 1 '^  moreau .*step x5: ' table.txt | tr -s '\n ' ' ' | grep -o 'step x5: [^;]*; there take run.step_s=[0-9.]*') || fail "chart limits: moreau has no finer step"
"$gatewalk" gate "$scenes/field.toml" --set run.method=moreau --set "run.step_s=${line##*=}" --set run.time_limit_s=3 --trials 8 --json helped.json --quiet >/dev/null ||
  fail "a step that helps is refused: $line"
holds '.status.clean' helped.json
# Each number of the result has its own line in the table of numbers.
"$gatewalk" chart limits "$scenes/single_gate.toml" -o maps --force --quick --trials 1 --set run.time_limit_s=1 --csv numbers.csv --quiet
[ -z "$(cut -d, -f1-3 numbers.csv | sort | uniq -d)" ] || fail "chart limits: equal names in numbers.csv: $(cut -d, -f1-3 numbers.csv | sort | uniq -d | head -n 2)"
# A tolerance that no map has.
for tolerance in 1e-20 1e5; do
  expect 0 '^single_gate: at the scene.s own numbers .* show' "$gatewalk" chart limits "$scenes/single_gate.toml" -o maps --force --quick --trials 1 --set run.time_limit_s=1 --set run.event_tolerance_m=$tolerance
done

# What the scene does not have is left out: damping, and the speed of a start at rest. Old figures are removed.
expect 0 '^undamped: at the scene.s own numbers ' "$gatewalk" chart limits "$scenes/undamped.toml" -o maps --force "${short[@]}"
holds '[.maps[].number] | unique == ["beam_mass", "graze", "impulse_threshold", "lever", "random_force", "restitution", "stiffness"]' maps/limits.json
[ "$(ls maps/*.svg | wc -l)" = 7 ] || fail "chart limits beside old figures: $(ls maps)"
# In a field with several types of gates the scene's own is charted, with a message. A step of the scene holds for all
# methods.
expect 0 '^mixed: at the scene.s own numbers ' "$gatewalk" chart limits "$scenes/mixed.toml" -o mixed "${short[@]}" --set run.step_s=0.01 --set forces.random_N=0
tr '\n' ' ' <out.txt | grep -q 'its own gate, not of type s or u)' || fail "chart limits: does not say of which type: $(cat out.txt)"
grep -q 'has no effect here: one gate is run' out.txt || fail "chart limits: silent about types of gates"
holds '.types_not_charted == ["s", "u"] and [.methods[0:4][] | .value == 0.01] == [true, true, true, true]' mixed/limits.json

expect 2 'missing -o' "$gatewalk" chart limits "$scenes/field.toml"
expect 2 'missing SCENE' "$gatewalk" chart limits -o x
expect 2 'has cells of another kind' "$gatewalk" chart limits "$scenes/tracks/cell.toml" -o x
paper_matrix m.nc
expect 2 'm.nc: is a matrix' "$gatewalk" chart limits m.nc -o x
expect 2 'trials 0: must be at least 1' "$gatewalk" chart limits "$scenes/field.toml" -o x --trials 0
[ -e x ] && fail "chart limits: wrong use made a folder"
for name in limits.csv limits.json lever.svg; do
  expect 2 'are the same file' timeout 20 "$gatewalk" chart limits "$scenes/field.toml" -o maps --quick --json maps/$name
done
mkdir -p blocked/graze.svg
expect 2 'graze.svg' timeout 20 "$gatewalk" chart limits "$scenes/field.toml" -o blocked  # before any work
[ "$(ls blocked)" = graze.svg ] || fail "chart limits: wrote $(ls blocked) though a figure has no place"

kept all.svg maps/*.svg
finish
