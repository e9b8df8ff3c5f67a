#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# power: how many trials.   power_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# power: how many trials; what so many show; two scenes.
power=(power "$scenes/field.toml" --accuracy 0.05)
"$gatewalk" "${power[@]}" --trials 60 --versus beams.stiffness_left_Nm_per_rad=200 --versus beams.stiffness_right_Nm_per_rad=200 --details --json power.json >power.txt 2>err.txt || fail "power: $(cat err.txt)"
holds '.power == 0.8 and .level == 0.05 and .trials == 60 and .error_95 <= 0.05 and ((.endings | add) - 1 | fabs) < 1e-6' power.json
holds '[.from_prediction.endings[] | length == 4 and (map(.trials) | . == (sort | reverse)) and (map(.trials_if_all_are_looked_at >= .trials) | all) and (map(.power) | . == sort)] | all' power.json
holds '.from_prediction.endings | [.trapped[].percentage_points] == [2, 5, 10, 20] and .trapped[3].trials > 20 and .trapped[3].trials < 80' power.json
holds '.from_prediction.final_gates | [.[].total_variation] == [0.05, 0.1, 0.2] and .[0].trials > 3 * .[1].trials and .[1].trials > 3 * .[2].trials and .[2].power < 0.8' power.json
holds '.smallest_difference | .final_gates_total_variation > 0.2 and .endings_percentage_points.trapped.more > 10 and .endings_percentage_points_if_all_are_looked_at.trapped.more > .endings_percentage_points.trapped.more' power.json
holds '.versus | .set == ["beams.stiffness_left_Nm_per_rad=200", "beams.stiffness_right_Nm_per_rad=200"] and (.scene | test("stiffness_left_Nm_per_rad = 200")) and .apart.final_gates.trials > 2 and (.apart.endings | length) == 5' power.json
# It begins with two sentences: what these trials show, what it takes.
holds '.summary as [$shows, $takes] | .smallest_difference.final_gates_total_variation as $least | .versus.apart.final_gates as $apart | ($shows | test("^With 60 trials \\(power 80 %\\) you detect a shift of [0-9.]+ points in crossed, ([0-9.]+ in (left side|right side|trapped|cut off), ){4}or a total variation of 0.[0-9]+ in the final gates.$")) and ($takes | startswith("To tell this scene from beams.stiffness_left_Nm_per_rad=200, beams.stiffness_right_Nm_per_rad=200 (power 80 %) you need \($apart.trials) trials of each by the final gates, ")) and ($takes | test(" 60 trials of each tell them apart in [0-9]+ of 100 experiments, by the final gates.$"))' power.json
tr '\n' ' ' <power.txt | grep -qF "$(value '.summary[0]' power.json)" && tr '\n' ' ' <power.txt | grep -q "^$(value '.summary[1]' power.json)" || fail "power: the sentences do not come first"
# The sentence has the numbers of the table.
said=$(value '.summary[0]' power.json | sed 's/.* points in crossed, \([0-9.]*\) in left side.*/\1/')
grep -q "^left side .*(+$said / " power.txt || fail "power: the table has another shift than $said: $(grep '^left side' power.txt)"
# Each table says what it is of; its marks stand below it, and none that it does not have.
for line in 'One experiment against the model: trials needed (power 80 %, level 5 %) to detect that' 'One experiment of 60 trials against the model: how likely ' \
  'Two experiments of 60 trials each, one with this scene, one with' 'beams.stiffness_left_Nm_per_rad=200, beams.stiffness_right_Nm_per_rad=200.'; do
  grep -q "^$line" power.txt || fail "power: no line '$line'"
done
[ "$(grep -c '^First number: trials if only this ending is tested; in brackets: if all endings are tested' power.txt)" = 3 ] || fail "power: brackets are not explained"
grep -q '^crossed .*+[0-9.]* / none' power.txt && grep -q '^none: no shift is detected this often' power.txt || fail "power: none is not explained"
grep -q '[0-9])?' power.txt && grep -q '^?: the prediction itself may be off by as much' power.txt || fail "power: ? is not explained"
grep -q '^>100000' power.txt && fail "power: a mark is explained that does not stand there"
small=("${power[@]}" --set field.columns=3 --set field.rows=2)
for threads in 1 2; do "$gatewalk" "${small[@]}" --trials 60 --versus beams.stiffness_left_Nm_per_rad=200 --json $threads.json --threads $threads --quiet; done
cmp -s 1.json 2.json || fail "power: another number of threads gave another file"
# Without a limit of gates nothing can be cut off: no trials are needed to see that.
"$gatewalk" "${small[@]}" --set field.max_gates=0 --trials 20 --details --json free.json >free.txt 2>err.txt || fail "power: $(cat err.txt)"
holds '.endings_95.cut_off == [0, 0] and (.from_prediction.endings | length == 4 and (has("cut_off") | not)) and (.smallest_difference.endings_percentage_points | has("cut_off") | not)' free.json
[ "$(grep -c '^trapped' free.txt)" = 5 ] && ! grep -q '^cut off' free.txt || fail "power: rows of who cannot be cut off"
# The same prediction as predict's.
"$gatewalk" predict "$scenes/field.toml" --accuracy 0.05 --json predicted.json --quiet
jq -s '.[0].endings == .[1].endings and .[0].final_gates == .[1].final_gates and .[0].error_95 == .[1].error_95' power.json predicted.json | grep -q true || fail "power: not the prediction of predict"
expect 2 '^gatewalk: --versus gives forces.random_N 2 times: the last one counts, forces.random_kN=0.06$' \
  "$gatewalk" "${power[@]}" --set forces.random_N=40 --versus forces.random_N=50 --versus forces.random_kN=0.06 --power 1.2
expect 2 'power 1.2: must lie in \[0.5, 0.99\]' "$gatewalk" "${power[@]}" --power 1.2
expect 2 'level 0: must lie in \[0.01, 0.25\]' "$gatewalk" "${power[@]}" --level 0
expect 2 'trials 0: must be at least 1 and at most 100000' "$gatewalk" "${power[@]}" --trials 0
expect 2 'versus: field.columns and field.rows must stay' "$gatewalk" "${power[@]}" --versus field.rows=5
expect 2 '^gatewalk: --versus forces.randm_N=20: unknown key forces.randm_N; the closest known key is forces.random_N' "$gatewalk" "${power[@]}" --versus forces.randm_N=20
expect 2 'fidelity = "all" is not permitted for a chain' "$gatewalk" "${power[@]}" --set field.fidelity=all --set run.method=moreau
expect 2 'start.y_m must be 0' "$gatewalk" "${power[@]}" --set start.y_m=1

# Two groups, one of which ends as predicted. Fisher's test by its closed form: the normal approximation with the correction
# for continuity of Casagrande, Pike and Smith (1978), which is within some per cent of the exact number.
holds 'def trials($p; $q): (($p + $q) / 2) as $m | ($p - $q | fabs) as $d
    | (1.959964 * (2 * $m * (1 - $m) | sqrt) + 0.841621 * ($p * (1 - $p) + $q * (1 - $q) | sqrt) | . * . / ($d * $d)) as $n
    | ($n / 4) * (1 + (1 + 4 / ($n * $d) | sqrt) | . * .);
  . as $all | [.two_groups.endings | to_entries[] | $all.endings[.key] as $p | select($p > 0.02) | .value[] | (.percentage_points / 100) as $d
    | .trials / ([$p + $d, $p - $d | select(. >= 0 and . <= 1)] | map(trials($p; .)) | max)] | length == 12 and min > 0.94 and max < 1.06' power.json
holds '[.two_groups.endings[] | length == 3 and (map(.trials) | . == (sort | reverse)) and (map(.trials_if_all_are_looked_at >= .trials) | all) and (map(.power) | . == sort)] | all' power.json
grep -q '^Two groups, such as animals with and without a treatment: ' power.txt || fail "power: no table of two groups"

# Two groups of animals whose passages were recorded.
"$gatewalk" sample cell -o cell.toml --quiet
"$gatewalk" sample tracks -o tracks.csv --quiet
"$gatewalk" passages tracks.csv --cell cell.toml --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y --fps 10 --metres-per-unit 0.001 \
  --fastest 0.4 -o runs.csv --quiet
for group in 0 1; do
  awk -F, -v group=$group '!/^[0-9]/ || $1 % 2 == group' runs.csv >$group.csv
  "$gatewalk" build $group.csv --cell cell.toml -o $group.nc --quiet >/dev/null 2>&1 || fail "a matrix of group $group"
done
"$gatewalk" power 0.nc --versus 1.nc --trials 30 --details --json groups.json >groups.txt 2>err.txt || fail "power of two groups: $(cat err.txt)"
"$gatewalk" predict 1.nc --json one.json --quiet 2>/dev/null
"$gatewalk" predict 0.nc --json none.json --quiet 2>/dev/null
jq -s '.[0].versus.set == ["1.nc"] and .[0].versus.endings == .[1].endings and .[0].endings == .[2].endings and (.[0].versus | has("scene") | not)
  and (100 * (.[1].endings.crossed - .[2].endings.crossed) - .[0].versus.apart.endings.crossed.percentage_points | fabs) < 1e-9' groups.json one.json none.json |
  grep -q true || fail "power of two groups: not the predictions of both"
grep -q '^Two experiments of 30 trials each, one with this group, one with the group of$' groups.txt || fail "power: the groups are not named"
holds '[.versus.apart.endings[].power] | length == 5 and all(. >= 0 and . < 0.8)' groups.json
expect 2 '^gatewalk: --versus 0.nc: two matrices are compared where both are of recorded runs$' "$gatewalk" power "$scenes/field.toml" --versus 0.nc
expect 2 "of recorded runs give another group's matrix\$" "$gatewalk" power 0.nc --versus forces.random_N=2
expect 2 'are the same file' "$gatewalk" power 0.nc --versus 1.nc --json 1.nc
# What is no KEY=VALUE is taken for a file.
for first in 0.nc "$scenes/field.toml"; do
  expect 2 "^gatewalk: --versus nosuch.nc: there is no such file; must be the matrix of another group's recorded runs, or KEY=VALUE" "$gatewalk" power "$first" --versus nosuch.nc
done
expect 2 'mixed.toml: is no matrix; of two scenes give each key in which the other one differs, as --versus KEY=VALUE$' "$gatewalk" power "$scenes/field.toml" --versus "$scenes/mixed.toml"
expect 2 "^gatewalk: --versus 1.nc: a matrix of another group's recorded runs is given once, and alone\$" "$gatewalk" power 0.nc --versus 1.nc --versus 1.nc

finish
