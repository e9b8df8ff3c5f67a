#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests build, show, walk, predict and lattice with a matrix of the paper's bins.   matrix_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

expect 0 '87 rows, 88 columns' "$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 -o m.nc
expect 0 'rows without runs   0' "$gatewalk" show m.nc --rows
"$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 -o m1.nc --threads 1 --quiet
cmp -s m.nc m1.nc || fail "build: one thread gave another file"
"$gatewalk" walk m.nc "$scenes/field.toml" --walks 20000 --seed 1 --json walk.json --quiet
holds '([.final_gates[][]] | add) == 20000 and .trapped + .departed + .cut_off == 20000' walk.json
holds '(.final_gates | length) == 9 and (.final_gates[0] | length) == 9' walk.json
"$gatewalk" predict m.nc "$scenes/field.toml" --json predict.json --quiet
holds '(([.final_gates[][]] | add) - 1 | fabs) < 1e-12' predict.json
holds '(.trapped + .departed + .cut_off - 1 | fabs) < 1e-12' predict.json
"$gatewalk" predict m.nc --set field.max_gates=0 --json free.json --quiet
"$gatewalk" predict m.nc --set field.max_gates=0 --solver klu --json klu.json --quiet
holds '.cut_off == 0' free.json
jq -s '([[.[0].final_gates[][]], [.[1].final_gates[][]]] | transpose | map(.[0] - .[1] | fabs) | add) <= .[0].error_at_most + .[1].error_at_most' free.json klu.json |
  grep -q true || fail "the two solvers disagree by more than they own to"
for file in predict free klu; do
  holds '.rounding_at_most > 1e-15 and .error_at_most == .still_walking + .rounding_at_most and .error_at_most < 1e-11' $file.json
done
expect 0 '^Rounding and unfinished walks change all shares together by at most [0-9.]*e-1[0-9].$' "$gatewalk" predict m.nc --details
# The intervals rest on the same number of resampled matrices with every solver.
for solver in auto klu; do
  "$gatewalk" predict m.nc --set field.max_gates=0 --set field.rows=12 --solver $solver --json $solver.json --quiet
  holds '.matrix_sampling.replicates == 999 and .steps == 0' $solver.json
done
# A key without effect on a matrix of this method is no difference.
expect 0 '^trapped' "$gatewalk" predict m.nc "$scenes/field.toml" --set run.tolerance=0.01 --set run.event_tolerance_m=1e-4
expect 2 'forces.random_N' "$gatewalk" walk m.nc "$scenes/field.toml" --set forces.random_N=12
expect 2 'max_gates' "$gatewalk" predict m.nc --solver klu
expect 2 'is a matrix' "$gatewalk" gate m.nc
expect 2 'start.y_m' "$gatewalk" predict m.nc --set start.y_m=5
# Warnings are printed even under --quiet.
for command in walk predict; do expect 2 'the start lies outside the chain' "$gatewalk" $command m.nc --set start.vy_m_per_s=-5; done

# Several starts give an entry each, in order, with the same numbers as alone; without --start: the scene's.
expect 0 '^start d 4 m, vx 5 m/s, vy 10.5 m/s$' "$gatewalk" predict m.nc --start 0,0,15 --start 4,5,10.5 --json starts.json
[ "$(grep -c '^trapped' out.txt)" = 2 ] || fail "predict: not a result per start"
expect 2 'start d 0 m, vx 0 m/s, vy -3 m/s lies outside the chain.s bins, EN d \[-25, 25\] m, .*--bins auto .*\[bins\]' "$gatewalk" predict m.nc --start 0,0,15 --start 0,0,-3
"$gatewalk" predict m.nc --set start.x_m=4 --set start.vx_m_per_s=5 --set start.vy_m_per_s=10.5 --json start.json --quiet
for k in 0 1; do
  jq -s ".[0].starts[$k] as \$one | .[1] | to_entries | map(select(.key | IN(\"final_gates\", \"trapped\", \"departed\", \"cut_off\", \"steps\", \"start_state\")) | .value == \$one[.key]) | length == 6 and all" \
    starts.json "$([ $k = 0 ] && echo predict.json || echo start.json)" | grep -q true || fail "predict: start $k is not as alone"
done
holds '[.starts[].start_state.clamped] == [false, false] and (has("final_gates") | not)' starts.json
holds '.starts[1].start == {"d_m": 4, "vx_m_per_s": 5, "vy_m_per_s": 10.5}' starts.json
for solver in march klu propagate; do
  "$gatewalk" predict m.nc --set field.max_gates=0 --solver $solver --start 0,0,15 --start 4,5,10 --json starts-$solver.json --quiet
  jq -s '[[.[0].starts[].final_gates[][]], [.[1].starts[].final_gates[][]]] | transpose | (length == 162) and (map(.[0] - .[1] | fabs) | max < 1e-10)' \
    starts-$solver.json starts-march.json | grep -q true || fail "predict: march and $solver disagree"
done
expect 2 '3 numbers d,vx,vy (m, m/s, m/s)' "$gatewalk" predict m.nc --start 1,2
expect 2 'inside the gate' "$gatewalk" predict m.nc --start 25,0,15

# Damaged files.
head -c 5000 m.nc >cut.nc
expect 2 'cut.nc: checksum does not match: cut short, damaged or altered since it was written$' "$gatewalk" show cut.nc
# A count that another program changed is refused, naming the row.
ncdump m.nc | sed -E '/^ count = /s/= ([0-9]+)/= 77/' >altered.cdl && ncgen -4 -o altered.nc altered.cdl
expect 2 'row 0 .*add up to' "$gatewalk" predict altered.nc

finish
