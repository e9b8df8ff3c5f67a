#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests validate --observed with an experiment's counts: read as people write them, compared with dynamics and chain,
# one verdict.
#   experiment_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" lattice "$scenes/field.toml" --trials 60 --seed 77 --json sixty.json --quiet
jq -r '["ending", "count"], (.endings | to_entries[] | [.key, .value]) | @csv' sixty.json >ends.csv
jq -r '["gate_x", "gate_y", "count"], (.final_gates | to_entries[] | .key as $y | .value | to_entries[] | [.key - 4, $y, .value]) | @csv' sixty.json >gates.csv
beside=(validate "$scenes/field.toml" --matrix m.nc --null-draws 499)
"$gatewalk" "${beside[@]}" --observed ends.csv --observed gates.csv --trials 2000 --details --json observed.json >observed.txt 2>err.txt || fail "validate --observed: $(cat err.txt)"
[ -s err.txt ] && fail "validate --observed warns of: $(cat err.txt)"
# The scene's own start, not Table IV's four; and the sixty trials themselves.
holds '.starts | length == 1 and .[0].start.d_m == 0 and .[0].start.vy_m_per_s == 15' observed.json
jq -s '.[0].observed as $seen | .[1] | $seen.endings == .endings and $seen.final_gates == .final_gates and $seen.endings_95 == .endings_95' observed.json sixty.json | grep -q true ||
  fail "validate --observed: not what was observed"
holds '.observed | .trials == 60 and .files == ["ends.csv", "gates.csv"] and (.against_dynamics.differs | not) and (.verdict | startswith("these 60 trials do not differ from the dynamics by more than chance (p = "))' observed.json
holds '.observed.against_dynamics | ([.p_adjusted | .. | numbers] | min) as $least | .p == $least and .null_draws == 499 and (.final_gates | .corrcoef_floor > 0 and .total_variation > 0) and .p_endings.trapped > 0' observed.json
holds '.observed.smallest_difference | .power == 0.8 and .level == 0.05 and .final_gates_total_variation > 0.1 and .endings_total_variation > 0.05 and (.endings_percentage_points | length == 5 and .trapped.more > 5 and .trapped.fewer > 5 and .crossed.fewer == null)' observed.json
head -1 observed.txt | grep -q '^No difference found between 60 trials and the full dynamics (p = .*) or the chain (p = .*)\.$' || fail "validate --observed: the verdict does not come first"
grep -q '^Detectable: the smallest shift, in points, that 60 trials reveal (power 80 %)' observed.txt && grep -q '^trapped .* +[0-9.]* / -[0-9.]*$' observed.txt || fail "validate --observed: what the trials detect is not said"
grep -q '^From 60 observed trials and 2000 trials of the full dynamics\.$' observed.txt || fail "validate --observed: its basis"
tr '\n' ' ' <observed.txt | grep -q 'To quote: "The endings and final gates of 60 trials did not differ detectably from the full dynamics of the model (p = ' || fail "validate --observed: no sentence to quote"
# Everything else is the same as without --observed.
"$gatewalk" "${beside[@]}" --trials 2000 --start 0,0,15 --json without.json --quiet
jq -S 'walk(if type == "object" then del(.seconds, .speed_ratio, .made_by, .observed) else . end)' observed.json >with.txt
jq -S 'walk(if type == "object" then del(.seconds, .speed_ratio, .made_by) else . end)' without.json | cmp -s - with.txt || fail "--observed changes what validate says beside it"
# One table is enough; the number of trials follows from it; a difference is said in plain words.
printf 'ending,count\ncrossed,60\n' >far.csv
fast=("$scenes/field.toml" --set run.method=moreau --set run.step_s=0.02)
"$gatewalk" build "${fast[@]}" --trials 20 -o fast.nc --quiet >/dev/null 2>&1
expect 0 '^The 60 observed trials differ from the full dynamics (p = 0.00[0-9])' "$gatewalk" validate "${fast[@]}" --matrix fast.nc --null-draws 499 --observed far.csv --json far.json
grep -q 'no row for .*trapped, which counts as 0 (dynamics: ' out.txt || fail "validate --observed: an ending that is left out is not named"
holds '.trials == 10000 and (.observed | (has("final_gates") | not) and .against_dynamics.p_adjusted.total_variation == null and .against_chain.differs)' far.json
printf '\357\273\277# roaches\r\n\r\n "gate_y" ,gate_x,"count"\r\n8, -4 ,"60"\r\n' >corner.csv
expect 0 '^Final gates: total variation 1.000 from the full dynamics; chance alone makes 0' "$gatewalk" "${beside[@]}" --trials 2000 --observed corner.csv --start 4,5,10 --json corner.json
holds '.starts[0].start.d_m == 4 and .observed.final_gates[8][0] == 60 and (.observed | has("endings") | not)' corner.json
expect 0 'trials 100: take 1200 or more for 60 observed' "$gatewalk" "${beside[@]}" --trials 100 --observed gates.csv
expect 0 'no row for .*left side, which counts as 0' "$gatewalk" "${beside[@]}" --trials 2000 --observed far.csv

refused() { printf "$2" >bad.csv; expect 2 "$1" timeout 20 "$gatewalk" validate "$scenes/field.toml" --matrix-trials 1e12 --observed bad.csv; }
# A line for each trial gives the same as tables of counts. Bodies that went back are left out, with a warning before
# the run.
"$gatewalk" lattice "$scenes/field.toml" --set field.max_gates=0 --trials 60 --seed 77 --json departed.json --quiet
jq -r '"trial,ending,gate_x,gate_y", ([.trapped_gates | to_entries[] | .key as $y | .value | to_entries[] | .key as $x | range(.value) | ["trapped", $x - 4, $y]] + [.departed_gates | to_entries[] | .key as $y | .value | to_entries[] | .key as $x | range(.value) | [(if $y == 8 then "crossed" elif $x == 0 then "left side" else "right_side" end), $x - 4, $y]] | to_entries[] | "\(.key),\(.value[0]),\(.value[1]),\(.value[2])")' departed.json >lines.csv
{ cat lines.csv; echo 'roach 61,went back,,'; } >back.csv
jq -r '["ending", "count"], (.endings | to_entries[] | [.key, .value]) | @csv' departed.json >ends0.csv
jq -r '["gate_x", "gate_y", "count"], (.final_gates | to_entries[] | .key as $y | .value | to_entries[] | [.key - 4, $y, .value]) | @csv' departed.json >gates0.csv
free=(validate "$scenes/field.toml" --matrix m.nc --set field.max_gates=60 --null-draws 199 --trials 1200)
"$gatewalk" "${free[@]}" --observed back.csv --json lines.json >/dev/null 2>err.txt
grep -q '^gatewalk: 1 of 61 trials went back, .* left out' err.txt || fail "validate --observed: who went back is not said: $(cat err.txt)"
"$gatewalk" "${free[@]}" --observed ends0.csv --observed gates0.csv --json tables.json --quiet
jq -s 'map(.observed | del(.files, .went_back)) | .[0] == .[1]' lines.json tables.json | grep -q true || fail "validate --observed: lines of trials are not their counts"
holds '.observed | .trials == 60 and .went_back == 1' lines.json
# Without a limit of gates no body is cut off, and no interval or row allows for it.
"$gatewalk" "${free[@]}" --set field.max_gates=0 --observed ends0.csv --details --json free.json >free.txt 2>err.txt
holds '.observed | .endings_95.cut_off == [0, 0] and (.smallest_difference.endings_percentage_points | has("cut_off") | not)' free.json
grep -q '^trapped .* / ' free.txt && ! grep -q '^cut off' free.txt || fail "validate --observed: a row of who cannot be cut off"
refused 'bad.csv:3: trial "1" was given in line 2 already' 'trial,ending\n1,crossed\n1,trapped\n'
# Too few trials cause a warning before any run (the run would take for ever).
printf 'trial,ending\n1,crossed\n2,trapped\n' >two.csv
timeout 10 "$gatewalk" validate "$scenes/field.toml" --matrix-trials 1e12 --observed two.csv --trials 30 >out.txt 2>err.txt
grep -q '^gatewalk: 2 trials detect a shift of more than 50 points' err.txt || fail "validate --observed: two trials: $(cat err.txt)"
grep -q 'trials 30: take 40 or more for 2 observed' err.txt || fail "validate --observed: --trials 30 for 2: $(cat err.txt)"
# Wrong tables are refused before any work, naming file, line, column and what is allowed.
refused 'bad.csv:1: unknown column "gatex": the columns must be trial,ending' 'gatex,gate_y,count\n'
refused 'bad.csv:1: the columns must be' 'gate_x,count\n0,1\n'
refused 'bad.csv:2: column gate_x: "5" is not permitted: must be a whole number from -4 to 4 (field.columns = 9)' 'gate_x,gate_y,count\n5,0,1\n'
refused 'bad.csv:2: column gate_y: "9" is not permitted: must be a whole number from 0 to 8 (field.rows = 9)' 'gate_x,gate_y,count\n4,9,1\n'
refused 'bad.csv:2: column count: "-1" is not permitted: must be a whole number from 0' 'gate_x,gate_y,count\n4,8,-1\n'
refused 'bad.csv:2: column count: "1.5" is not permitted' 'ending,count\ncrossed,1.5\n'
refused 'bad.csv:2: column ending: "turned back" is not permitted: must be one of crossed, left side, right side, trapped, cut off, or went back' 'ending,count\nturned back,1\n'
refused 'bad.csv:3: gate_x = 0, gate_y = 0 was given in line 2 already' 'gate_x,gate_y,count\n0,0,1\n0,0,2\n'
refused 'bad.csv:3: ending trapped was given already' 'ending,count\ntrapped,1\ntrapped,1\n'
unlimited() { printf "$2" >bad.csv; expect 2 "$1" timeout 20 "$gatewalk" validate "$scenes/field.toml" --matrix-trials 1e12 --set field.max_gates=0 --observed bad.csv; }
unlimited 'bad.csv:3: a body cannot have been cut off: field.max_gates = 0' 'ending,count\ncrossed,20\ncut off,1\n'
unlimited 'bad.csv:2: a body cannot have been cut off: field.max_gates = 0' 'trial,ending\n1,cut off\n'
refused 'bad.csv: has no trial' 'ending,count\ntrapped,0\n'
refused 'bad.csv: is empty' ''
# Two recordings of one experiment are added: 120 trials, those of both.
expect 0 '^The 120 observed trials ' "$gatewalk" "${beside[@]}" --trials 2000 --observed ends.csv --observed far.csv --json both.json
jq -s '.[0].observed.endings.crossed == .[1].observed.endings.crossed + 60' both.json observed.json | grep -q true || fail "two recordings: $(jq -c .observed.endings both.json)"
printf 'trial,ending\n1,crossed\n' >line.csv
expect 2 'line.csv: ends.csv has endings too; files that are added up have the same columns' "$gatewalk" "${beside[@]}" --observed ends.csv --observed line.csv
expect 2 'ends.csv: is given twice' "$gatewalk" "${beside[@]}" --observed ends.csv --observed ends.csv
printf 'ending,count\ncrossed,59\n' >fewer.csv
expect 2 'gates.csv has 60 trials, fewer.csv 59: both must be of the same trials' "$gatewalk" "${beside[@]}" --observed gates.csv --observed fewer.csv
expect 2 'nosuch.csv: cannot be read: No such file or directory' "$gatewalk" "${beside[@]}" --observed nosuch.csv
expect 2 'belong to one start, --start gives 2' "$gatewalk" "${beside[@]}" --observed ends.csv --start 0,0,15 --start 4,5,10
expect 2 'are the same file' "$gatewalk" "${beside[@]}" --observed gates.csv --observed ends.csv --json ends.csv

finish
