#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests trace: the trials that gate and lattice count; CSV, NetCDF and JSON agree; pages and files are complete.
#   trace_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

expect 0 'traversed left' "$gatewalk" trace "$scenes/soft_left.toml" --trials 12 --seed 1 --csv runs.csv --netcdf runs.nc --json runs.json --replay runs.html
"$gatewalk" gate "$scenes/soft_left.toml" --trials 12 --seed 1 --json counted.json --quiet
jq -s '(.[0].runs | map(.ending)) as $e | .[1] | [.traversed_left, .exited_left, .exited_right, .trapped] == ([("traversed left", "exited left", "exited right", "trapped") as $x | $e | map(select(. == $x)) | length])' runs.json counted.json |
  grep -q true || fail "trace: other endings than gate"
[ "$(tail -n +2 runs.csv | wc -l)" = "$(jq '[.runs[].t | length] | add' runs.json)" ] || fail "trace: CSV and JSON have other samples"
head -n 1 runs.csv | grep -q '^trial,time_s,gate_x,gate_y,x_m,y_m,' || fail "trace: other columns: $(head -n 1 runs.csv)"
ncdump -v row_size runs.nc | tr -d ' \n;}' | grep -q "row_size=$(jq -r '[.runs[].t | length] | join(",")' runs.json)" || fail "trace: NetCDF has other runs"
# Trajectories as in the CF conventions.
for attribute in ':Conventions = "CF-1.10"' ':featureType = "trajectory"' 'run_trial:cf_role = "trajectory_id"' \
  'row_size:sample_dimension = "sample"' 'field_x_m:axis = "X"' 'x_m:coordinates = "time_s field_x_m field_y_m"'; do
  ncdump -h runs.nc | grep -q "$attribute" || fail "trace: NetCDF without $attribute"
done
ncdump -h runs.nc | grep -q 'contact_left:flag_meanings = "free hit held"' || fail "trace: no meanings of contact codes"
grep -q 'gatewalkReplay' runs.html || fail "trace: the page has no player"
"$gatewalk" trace "$scenes/soft_left.toml" --trials 40 --only traversed --json some.json --quiet
holds '.recorded == (.runs | length) and .trials == 40 and (.runs | map(.ending | startswith("traversed")) | all) and .recorded > 5 and .recorded < 35' some.json
"$gatewalk" trace "$scenes/soft_left.toml" --trial 7 --json one.json --quiet
jq -s '.[0].runs[7] == .[1].runs[0]' runs.json one.json | grep -q true || fail "trace: trial 7 alone is another one"
"$gatewalk" trace "$scenes/field.toml" --field --trials 8 --seed 3 --json crossings.json --quiet
"$gatewalk" lattice "$scenes/field.toml" --trials 8 --seed 3 --json counted.json --quiet
jq -s '(.[0].runs | map(.ending)) as $e | .[1].endings | [.crossed, .left_side, .right_side, .trapped, .cut_off] ==
  ([("crossed", "left side", "right side", "trapped", "cut off") as $x | $e | map(select(. == $x)) | length])' \
  crossings.json counted.json | grep -q true || fail "trace --field: other endings than lattice"
"$gatewalk" trace "$scenes/field.toml" --set field.rows=2 --field --trials 40 --seed 3 --only departed --json some.json --quiet
"$gatewalk" trace "$scenes/field.toml" --set field.rows=2 --field --trials 40 --seed 3 --only crossed --json crossed.json --quiet
jq -s '(.[0].runs | map(select(.ending == "crossed"))) == .[1].runs and .[0].recorded > .[1].recorded' some.json crossed.json | grep -q true ||
  fail "trace --only: who crossed has departed"
for side in left right; do
  "$gatewalk" trace "$scenes/field.toml" --field --trials 40 --seed 3 --only "$side side" --json a.json --quiet
  "$gatewalk" trace "$scenes/field.toml" --field --trials 40 --seed 3 --only ${side}_side --json b.json --quiet
  jq -s ".[0].runs == .[1].runs and (.[0].runs | map(.ending) | unique) == [\"$side side\"]" a.json b.json | grep -q true ||
    fail "trace --only: other runs by the $side side"
done
expect 2 "'left field': a run ends as one of: crossed, left side, right side, trapped, cut off, not finite; departed is" \
  "$gatewalk" trace "$scenes/field.toml" --field --only 'left field'
expect 2 "'departed': a run ends as one of" "$gatewalk" trace "$scenes/soft_left.toml" --only departed
"$gatewalk" trace "$scenes/soft_left.toml" --set run.time_limit_s=0.5 --video short.gif --quiet >/dev/null && [ "$(head -c 6 short.gif)" = GIF89a ] ||
  fail "trace: no GIF"
# A film says how fast it plays, in its pictures, the table and JSON; by default in the scene's own unit of time.
"$gatewalk" trace "$scenes/soft_left.toml" --set run.time_limit_s=0.2 --video slow.gif --video-speed 0.25 --json slow.json >slow.txt
grep -q '^slow.gif: film of run 0, plays at 1/4 of real time$' slow.txt || fail "a film does not say its speed: $(cat slow.txt)"
holds '.video_speed == 0.25' slow.json
expect 0 '^real.gif: film of run 0, plays in real time$' "$gatewalk" trace "$scenes/soft_left.toml" --set run.time_limit_s=0.2 --video real.gif
# The proposed remedy for the limit of steps works, whatever it is.
"$gatewalk" trace "$scenes/field.toml" --field --trials 900 --csv many.csv >out.txt 2>&1 && fail "more than 500 000 steps are recorded"
fit=$(sed -n 's/.*: give --trials \([0-9]*\), --only ENDING, a smaller field.max_gates, a longer run.step_s or a shorter run.time_limit_s$/\1/p' out.txt)
"$gatewalk" trace "$scenes/field.toml" --field --trials "$fit" --csv many.csv >/dev/null || fail "--trials '$fit' is no way out of $(cat out.txt)"
"$gatewalk" trace "$scenes/field.toml" --field --trials $((fit + 1)) --csv many.csv >/dev/null 2>&1 && fail "--trials $fit is not the most that fit"
rm many.csv
expect 2 ', a smaller field.max_gates or a shorter run.time_limit_s$' "$gatewalk" trace "$scenes/field.toml" --field --trials 1000 \
  --set run.method=event --csv many.csv  # which has no step
expect 2 '^gatewalk: --video short.avi: a video is FILE.mp4 or FILE.gif$' "$gatewalk" trace "$scenes/soft_left.toml" --video short.avi
expect 0 '^trial,' "$gatewalk" trace "$scenes/soft_left.toml" --csv -
expect 2 'a run ends as one of' "$gatewalk" trace "$scenes/soft_left.toml" --only stuck
expect 1 'none of trials 0 to 4' "$gatewalk" trace "$scenes/single_gate.toml" --trials 5 --only 'traversed right'
expect 2 'at most 1000 runs' "$gatewalk" trace "$scenes/soft_left.toml" --trials 1001
expect 2 'are the same file' "$gatewalk" trace "$scenes/soft_left.toml" --csv x.csv --json x.csv
expect 2 'only "active" can be traced' "$gatewalk" trace "$scenes/field.toml" --field --set run.method=moreau --set field.fidelity=all
cp "$scenes/soft_left.toml" own.toml
expect 2 'are the same file' "$gatewalk" trace own.toml --csv own.toml
cmp -s own.toml "$scenes/soft_left.toml" || fail "trace: overwrote its scene"
expect 2 'only one thing can go to standard output' "$gatewalk" trace "$scenes/soft_left.toml" --csv - --replay -
expect 2 'trial: .9223372036854775807. is out of range: at most 1e15' "$gatewalk" trace "$scenes/soft_left.toml" --trial 9223372036854775807 --trials 2
"$gatewalk" trace "$scenes/soft_left.toml" --trial 12345678 --csv - | tail -n 1 | grep -q '^12345678,' || fail "trace: a trial's number lost digits"
expect 2 'cannot go to standard output' "$gatewalk" trace "$scenes/soft_left.toml" --netcdf -

finish
