#!/usr/bin/env bash
# The command line as a contract: what scripts rely on.   program_test.sh GATEWALK ROOT
set -u
gatewalk=$1
scenes=$2/scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
# expect STATUS TEXT COMMAND...: exit status, and TEXT (a grep pattern) in what it prints.
expect() {
  local status=$1 text=$2
  shift 2
  "$@" >out.txt 2>&1
  local got=$?
  [ "$got" = "$status" ] || fail "status $got instead of $status: $* ($(head -n 3 out.txt))"
  grep -q -e "$text" out.txt || fail "no '$text' in the output of: $* ($(head -n 3 out.txt))"
}
value() { jq -r "$1" "$2"; }
holds() { [ "$(jq "$1" "$2")" = true ] || fail "$1 does not hold in $2: $(jq -c 'del(.made_by)' "$2" | head -c 400)"; }

# Help and wrong use.
expect 0 'usage: gatewalk' "$gatewalk" --help
expect 0 '^gatewalk [0-9]' "$gatewalk" --version
expect 2 'usage: gatewalk' "$gatewalk"
expect 2 "no command 'fly'" "$gatewalk" fly
for command in $("$gatewalk" --help | awk '/^usage/ { list = 1; next } list && /^  [a-z]/ { print $1 }'); do
  expect 0 'Example:' "$gatewalk" $command --help
  expect 2 'unrecognised option' "$gatewalk" $command --no-such-option
done
expect 2 'missing SCENE' "$gatewalk" gate
expect 2 'missing -o' "$gatewalk" build "$scenes/field.toml"
expect 2 'unrecognised option' "$gatewalk" gate "$scenes/field.toml" --tri 5       # nothing is guessed
expect 2 'at least 1' "$gatewalk" gate "$scenes/field.toml" --trials 0
expect 2 "'1.5' is not a whole number" "$gatewalk" gate "$scenes/field.toml" --trials 1.5
expect 2 "'-1' is not a seed" "$gatewalk" gate "$scenes/field.toml" --seed -1
expect 2 'json needs' "$gatewalk" gate "$scenes/field.toml" --json ''
expect 2 'must lie in' "$gatewalk" gate "$scenes/field.toml" --set forces.random_N=-1
expect 2 'nosuch.toml' "$gatewalk" gate nosuch.toml
expect 2 'three numbers' "$gatewalk" validate "$scenes/field.toml" --start 1,2

# gate: counts add up; --json - is JSON and nothing else.
expect 0 '"trials": 200' "$gatewalk" gate "$scenes/single_gate.toml" --trials 2e2 --seed 3 --json - --quiet
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json gate.json --threads 2 >/dev/null 2>&1
holds '.traversed + .exited_left + .exited_right + .trapped == .trials' gate.json
holds '.traversed == .traversed_left + .traversed_right + .traversed_even' gate.json
holds '.status.clean' gate.json
holds '(.trapped / .trials) as $share | .intervals_95.trapped | .[0] < $share and $share < .[1]' gate.json
# Jeffreys' interval for none of 200: up to 0.012466 (beta quantile 0.975 of 0.5, 200.5).
holds '.traversed == 0 and .trials == 200 and .intervals_95.traversed[0] == 0 and (.intervals_95.traversed[1] - 0.012466 | fabs) < 1e-6' gate.json
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json - --threads 1 2>/dev/null | cmp -s - gate.json ||
  fail "gate: another number of threads gave another file"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 4 --json other.json --quiet
[ "$(value .trapped gate.json)$(value .exited_left gate.json)" != "$(value .trapped other.json)$(value .exited_left other.json)" ] ||
  fail "another seed gave the same outcomes"
expect 0 'sank into a beam' "$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200
"$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200 --json paper.json --quiet
holds '.status.clean == false' paper.json

# run.method = "auto": the result names what was chosen, on what evidence; any number of threads.
auto="$scenes/field.toml --set run.method=auto --set run.time_limit_s=2"
# shellcheck disable=SC2086
{
expect 0 '^method [a-z]*, run\..*: chosen on 4000 pilot trials, outcomes off by' "$gatewalk" gate $auto --trials 50 --json auto.json
"$gatewalk" gate $auto --trials 50 --json - --threads 1 --quiet | cmp -s - auto.json || fail "auto: another number of threads gave another file"
holds '.method | .asked == "auto" and .met and .tolerance == 0.005 and .pilot_starts == 1 and .reference.verdict == "ok"' auto.json
holds '.method.tried[-1] as $last | $last.verdict == "ok" and $last.outcome_total_variation + $last.uncertainty <= 0.005' auto.json
holds '.method.tried[-1] as $last | .method | $last.method == .method and ([.step_s, .event_tolerance_m] | index($last.value)) != null' auto.json
value .made_by.scene auto.json | grep -q "^method = \"$(value .method.method auto.json)\"$" || fail "auto: the scene of the result names another method"
expect 0 '^method [a-z]*, run\.' "$gatewalk" build $auto --trials 5 -o auto.nc --json auto-build.json
holds '.method.met and .method.pilot_starts == 9' auto-build.json
"$gatewalk" show auto.nc --json auto-show.json --quiet
jq -s '(.[0].text.method | fromjson) == .[1].method' auto-show.json auto-build.json | grep -q true || fail "auto: the matrix does not record the choice"
expect 0 '^trapped' "$gatewalk" predict auto.nc $auto
expect 0 '^trapped' "$gatewalk" predict auto.nc
"$gatewalk" validate $auto --matrix auto.nc --trials 20 --start 0,0,15 --json auto-validate.json --quiet
jq -s '.[0].method == .[1].method' auto-validate.json auto-build.json | grep -q true || fail "auto: validate took another method than the matrix"
"$gatewalk" lattice $auto --trials 20 --json auto-lattice.json --quiet
jq -s '.[0].method == .[1].method' auto-lattice.json auto-build.json | grep -q true || fail "auto: lattice and build chose differently"
# A matrix of a method by name is not what "auto" stands for; nor is one of another tolerance.
"$gatewalk" build "$scenes/field.toml" --set run.time_limit_s=2 --trials 1 -o named.nc --quiet >/dev/null
expect 2 'run.method: auto here, stable by name there' "$gatewalk" predict named.nc $auto
expect 2 'run.tolerance: 0.01 here, 0.005 there' "$gatewalk" predict auto.nc $auto --set run.tolerance=0.01
for tolerance in 0.99e-4 1.01 nan -1; do
  expect 2 "run.tolerance = .* must lie in \[1e-04, 1\]" "$gatewalk" gate $auto --set run.tolerance=$tolerance
done
# No exact method takes such beams; and one that does shows faults at such a speed: refused, and said.
expect 2 'run.method = "auto" is not permitted for this scene: no method is exact' "$gatewalk" gate $auto --set beams.mass_kg=1e-6 --set beams.stiffness_left_Nm_per_rad=1e12
too_fast="--set beams.stiffness_right_Nm_per_rad=1e12 --set run.time_limit_s=0.02 --set start.vy_m_per_s=1e10"
expect 0 'the reference itself shows faults' "$gatewalk" gate $auto $too_fast --trials 5 --quiet --json auto-faulty.json
holds '.method | .met == false and .method == .reference.method and .step_s == .reference.value' auto-faulty.json
}

# A step outside a method's region is refused or said, in text and JSON.
expect 0 'longer than the method.s stability bound' "$gatewalk" gate "$scenes/undamped.toml" --set run.method=paper --trials 20 --json beyond.json --quiet
holds '.status | .clean == false and .runs_beyond_the_stability_bound == 20' beyond.json
# Euler's bound is d/k = 10/500 s: at it and below nothing is said of it.
loose="$scenes/single_gate.toml --set run.method=paper --set beams.damping_Nms_per_rad=10 --trials 20 --quiet"
for step in 0.02 0.01; do
  # shellcheck disable=SC2086
  "$gatewalk" gate $loose --set run.step_s=$step --set beams.stiffness_left_Nm_per_rad=500 --json within.json 2>/dev/null
  holds '.status.runs_beyond_the_stability_bound == 0' within.json
done
# shellcheck disable=SC2086
"$gatewalk" gate $loose --set run.step_s=0.02 --set beams.stiffness_left_Nm_per_rad=501 --json beyond.json 2>/dev/null
holds '.status.runs_beyond_the_stability_bound == 20' beyond.json
expect 2 'run.step_s = 0.004 is not permitted.*method penalty permits at most' "$gatewalk" gate "$scenes/field.toml" --set run.method=penalty --set beams.stiffness_left_Nm_per_rad=1e9
# moreau has no bound on the step; what long steps do to it is seen.
expect 0 'sank into a beam' "$gatewalk" gate "$scenes/stiff.toml" --set run.method=moreau --set run.step_s=0.02 --trials 50 --json sunk.json --quiet
holds '.status | .clean == false and .runs_penetrating_over_1_percent > 0 and .runs_beyond_the_stability_bound == 0' sunk.json

# gatewalk scene: every key with its source; a scene of one's own; nothing of the user's is lost.
printf 'body.mass_kg = 0.25\nbody.radius_m = 0.08\nforces.propulsion_N = 0.8\n' >three.toml
expect 0 '^body.radius_m  *0.08  *m  *three.toml:2 ' "$gatewalk" scene three.toml
"$gatewalk" scene three.toml --json keys.json --quiet
holds '[.keys[] | select(.key == "beams.length_m" or .key == "run.traverse_y_m") | .source == "derived" and (.value == "0.2" or .value == "0.48")] == [true, true]' keys.json
"$gatewalk" scene three.toml --new -o mine.toml
for file in three.toml mine.toml; do "$gatewalk" gate $file --trials 50 --quiet --json out-$file.json; done
jq -s 'map(del(.made_by)) | .[0] == .[1]' out-three.toml.json out-mine.toml.json | grep -q true || fail "scene --new: another scene"
holds '.made_by.derived | index("run.time_limit_s") != null' out-three.toml.json
expect 2 'is there already' "$gatewalk" scene three.toml --new -o mine.toml
expect 0 'three.toml leaves out keys, .*beams.length_m = 0.2,' "$gatewalk" gate three.toml --trials 10
# What the file leaves out follows from the file, whatever is overridden.
"$gatewalk" scene three.toml --set forces.propulsion_N=1.6 --json set.json --quiet
holds '[.keys[] | select(.key == "beams.stiffness_left_Nm_per_rad") | .value][0] == "0.31999999999999995"' set.json
# A field longer than the gates that may be visited is not crossed, and why is said.
expect 0 'field.max_gates = 13 is less than field.rows = 20' "$gatewalk" lattice "$scenes/field.toml" --set field.rows=20 --trials 10
# A method that is wrong without a sign of it: checked by a better one. (Elastic, one beam without a spring.)
cat >elastic.toml <<'TOML'
body = { mass_kg = 100, radius_m = 14 }
beams = { length_m = 25, mass_kg = 1, stiffness_left_Nm_per_rad = 400, stiffness_right_Nm_per_rad = 0, damping_Nms_per_rad = 500, joint_x_m = 25, joint_y_m = 30 }
forces = { propulsion_N = 0, random_N = 10, random_rate_Hz = 5, drag_Ns_per_m = 1 }
contact = { restitution = 1, tip_restitution = 1 }
run = { method = "moreau", step_s = 0.004, time_limit_s = 12, traverse_y_m = 60 }
start = { x_m = 0, y_m = 0, vx_m_per_s = -10, vy_m_per_s = 15 }
TOML
expect 1 'a better method gives other outcomes for at least' "$gatewalk" gate elastic.toml --trials 200 --strict --json elastic.json --quiet
holds '.status.clean == false and .status.outcome_error_seen > 0.3 and .exited_right < 150' elastic.json
"$gatewalk" gate elastic.toml --set run.method=stable --set run.step_s=0.02 --trials 200 --strict --json elastic.json --quiet
holds '.exited_right == 200 and .status.clean' elastic.json
expect 1 'a better method gives other outcomes for at least' "$gatewalk" sweep elastic.toml --vary run.method=moreau,stable --set run.step_s=0.004 --trials 100 --strict --json elastic.json --quiet
holds '.points | map(.status.clean) == [false, true]' elastic.json
expect 1 'a better method gives other outcomes for at least' "$gatewalk" trace elastic.toml --strict --json elastic.json --quiet
expect 1 'a better method gives other outcomes for at least' "$gatewalk" landscape elastic.toml --trials 100 -o passes --strict --quiet

# build, show, walk, predict, lattice.
expect 0 '87 x 88 matrix' "$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 -o m.nc
expect 0 'rows never sampled  0' "$gatewalk" show m.nc --rows
"$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 -o m1.nc --threads 1 --quiet
cmp -s m.nc m1.nc || fail "build: one thread gave another file"
"$gatewalk" walk m.nc "$scenes/field.toml" --walks 20000 --seed 1 --json walk.json --quiet
holds '([.final_gates[][]] | add) == 20000 and .trapped + .left_field + .cut_off == 20000' walk.json
holds '(.final_gates | length) == 9 and (.final_gates[0] | length) == 9' walk.json
"$gatewalk" predict m.nc "$scenes/field.toml" --json predict.json --quiet
holds '(([.final_gates[][]] | add) - 1 | fabs) < 1e-12' predict.json
holds '(.trapped + .left_field + .cut_off - 1 | fabs) < 1e-12' predict.json
"$gatewalk" predict m.nc --set field.max_gates=0 --json free.json --quiet
"$gatewalk" predict m.nc --set field.max_gates=0 --solver klu --json klu.json --quiet
holds '.cut_off == 0' free.json
jq -s '([[.[0].final_gates[][]], [.[1].final_gates[][]]] | transpose | map(.[0] - .[1] | fabs) | add) <= .[0].error_at_most + .[1].error_at_most' free.json klu.json |
  grep -q true || fail "the two solvers disagree by more than they own to"
for file in predict free klu; do
  holds '.rounding_at_most > 1e-15 and .error_at_most == .still_walking + .rounding_at_most and .error_at_most < 1e-11' $file.json
done
expect 0 '^Rounding and walks not finished, .*: at most [0-9.]*e-1[0-9] in all shares together$' "$gatewalk" predict m.nc
# Several starts: an entry each, in order, as each alone; none given: the scene's.
expect 0 '^start d 4 m, vx 5 m/s, vy 10.5 m/s$' "$gatewalk" predict m.nc --start 0,0,15 --start 4,5,10.5 --json starts.json
[ "$(grep -c '^trapped' out.txt)" = 2 ] || fail "predict: not a result per start"
expect 2 'start d 0 m, vx 0 m/s, vy -3 m/s lies outside the chain.s bins, EN d \[-25, 25\] m, .*--bins auto .*\[bins\]' "$gatewalk" predict m.nc --start 0,0,15 --start 0,0,-3
"$gatewalk" predict m.nc --set start.x_m=4 --set start.vx_m_per_s=5 --set start.vy_m_per_s=10.5 --json start.json --quiet
for k in 0 1; do
  jq -s ".[0].starts[$k] as \$one | .[1] | to_entries | map(select(.key | IN(\"final_gates\", \"trapped\", \"left_field\", \"cut_off\", \"steps\", \"start_state\")) | .value == \$one[.key]) | length == 6 and all" \
    starts.json "$([ $k = 0 ] && echo predict.json || echo start.json)" | grep -q true || fail "predict: start $k is not as alone"
done
holds '[.starts[].start_state.clamped] == [false, false] and (has("final_gates") | not)' starts.json
holds '.starts[1].start == {"d_m": 4, "vx_m_per_s": 5, "vy_m_per_s": 10.5}' starts.json
for solver in march klu propagate; do
  "$gatewalk" predict m.nc --set field.max_gates=0 --solver $solver --start 0,0,15 --start 4,5,10 --json starts-$solver.json --quiet
  jq -s '[[.[0].starts[].final_gates[][]], [.[1].starts[].final_gates[][]]] | transpose | (length == 162) and (map(.[0] - .[1] | fabs) | max < 1e-10)' \
    starts-$solver.json starts-march.json | grep -q true || fail "predict: march and $solver disagree"
done
expect 2 'three numbers' "$gatewalk" predict m.nc --start 1,2
# A large field: a map that fits a screen, JSON with every gate, two routes.
large="--set field.max_gates=0 --set field.columns=301 --set field.rows=301"
# shellcheck disable=SC2086
{
expect 0 '^elsewhere in the 301 x 301 gates: 0.0' "$gatewalk" predict m.nc $large --json large.json
[ "$(wc -l <out.txt)" -lt 50 ] || fail "predict: $(wc -l <out.txt) lines for a large field"
holds '(.final_gates | length == 301 and (map(length) | unique == [301])) and (([.final_gates[][]] | add) - 1 | fabs) < 1e-11' large.json
"$gatewalk" walk m.nc $large --walks 20000 --json large-walk.json --quiet
# Rows of 20000 walks: mean distance by chance below 0.01.
jq -s '[[.[0].final_gates[] | add], [.[1].final_gates[] | add / 20000]] | transpose | map(.[0] - .[1] | fabs) | add / 2 < 0.02' large.json large-walk.json |
  grep -q true || fail "walk and predict disagree on a large field"
}
# Rows of other gates: below them nothing changes; a copy of the base changes nothing; two routes agree.
"$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 --set beams.stiffness_left_Nm_per_rad=2000 -o stiff.nc --quiet >/dev/null
cp m.nc copy.nc
for limit in 13 0; do
  "$gatewalk" predict m.nc --set field.max_gates=$limit --json base.json --quiet
  "$gatewalk" predict m.nc --set field.max_gates=$limit --row 0-8=copy.nc --json same.json --quiet
  jq -s '.[0].final_gates == .[1].final_gates' base.json same.json | grep -q true || fail "predict: rows of the same gates change something"
  expect 0 '^rows 4 to 6: gates of stiff.nc$' "$gatewalk" predict m.nc --set field.max_gates=$limit --row 4-6=stiff.nc --row 2=copy.nc --json rows.json
  jq -s '[.[0].final_gates[0:4] == .[1].final_gates[0:4], .[0].final_gates[4] == .[1].final_gates[4]] == [true, false]' base.json rows.json |
    grep -q true || fail "predict: other gates in rows 4 to 6 change rows below, or not row 4"
  holds '(([.final_gates[][]] | add) - 1 | fabs) < 1e-12 and (.rows | map([.first, .last, .matrix])) == [[4, 6, "stiff.nc"], [2, 2, "copy.nc"]]' rows.json
done
"$gatewalk" predict m.nc --set field.max_gates=0 --row 4-6=stiff.nc --row 2=copy.nc --solver klu --json rows-klu.json --quiet
jq -s '[[.[0].final_gates[][]], [.[1].final_gates[][]]] | transpose | map(.[0] - .[1] | fabs) | max < 1e-10' rows.json rows-klu.json |
  grep -q true || fail "predict: march and klu disagree on rows of other gates"
for rows in 4-6 4-6= =stiff.nc 4.5=stiff.nc "4 =stiff.nc" 4-=stiff.nc 1-2-3=stiff.nc -1=stiff.nc; do
  expect 2 'must be rows i_y and a matrix' "$gatewalk" predict m.nc --row "$rows"
done
expect 2 'rows of this field are 0 to 8' "$gatewalk" predict m.nc --row 4-9=stiff.nc
expect 2 'lower row comes first' "$gatewalk" predict m.nc --row 6-4=stiff.nc
expect 2 'row 6 is given twice' "$gatewalk" predict m.nc --row 4-6=stiff.nc --row 6-8=copy.nc
expect 2 'nosuch.nc' "$gatewalk" predict m.nc --row 4=nosuch.nc
expect 2 'are the same file' "$gatewalk" predict m.nc --row 4=copy.nc --json copy.nc
"$gatewalk" build "$scenes/field.toml" --trials 1 --bins 0.5 -o other-bins.nc --quiet >/dev/null
expect 2 'other bins' "$gatewalk" predict m.nc --row 4=other-bins.nc
"$gatewalk" build "$scenes/field.toml" --trials 1 --set body.mass_kg=2 -o other-body.nc --quiet >/dev/null
expect 2 'another body' "$gatewalk" predict m.nc --row 4=other-body.nc
"$gatewalk" build "$scenes/field.toml" --trials 1 --set beams.joint_x_m=26 -o other-gates.nc --quiet >/dev/null
expect 2 '52.000 m wide' "$gatewalk" predict m.nc --row 4=other-gates.nc
expect 2 'inside the gate' "$gatewalk" predict m.nc --start 25,0,15
# trace: the trials that `gate` counts; CSV, NetCDF and JSON say the same; pages and files are whole.
expect 0 'traversed left' "$gatewalk" trace "$scenes/soft_left.toml" --trials 12 --seed 1 --csv runs.csv --netcdf runs.nc --json runs.json --replay runs.html
"$gatewalk" gate "$scenes/soft_left.toml" --trials 12 --seed 1 --json counted.json --quiet
jq -s '(.[0].runs | map(.ending)) as $e | .[1] | [.traversed_left, .exited_left, .exited_right, .trapped] == ([("traversed left", "exited left", "exited right", "trapped") as $x | $e | map(select(. == $x)) | length])' runs.json counted.json |
  grep -q true || fail "trace: other endings than gate"
[ "$(tail -n +2 runs.csv | wc -l)" = "$(jq '[.runs[].t | length] | add' runs.json)" ] || fail "trace: CSV and JSON have other samples"
head -n 1 runs.csv | grep -q '^trial,time_s,gate_x,gate_y,x_m,y_m,' || fail "trace: other columns: $(head -n 1 runs.csv)"
ncdump -v row_size runs.nc | tr -d ' \n;}' | grep -q "row_size=$(jq -r '[.runs[].t | length] | join(",")' runs.json)" || fail "trace: NetCDF has other runs"
ncdump -h runs.nc | grep -q 'contact_left:flag_meanings = "free hit held"' || fail "trace: no meanings of contact codes"
grep -q 'gatewalkReplay' runs.html || fail "trace: the page has no player"
"$gatewalk" trace "$scenes/soft_left.toml" --trials 40 --only traversed --json some.json --quiet
holds '.recorded == (.runs | length) and .trials == 40 and (.runs | map(.ending | startswith("traversed")) | all) and .recorded > 5 and .recorded < 35' some.json
"$gatewalk" trace "$scenes/soft_left.toml" --trial 7 --json one.json --quiet
jq -s '.[0].runs[7] == .[1].runs[0]' runs.json one.json | grep -q true || fail "trace: trial 7 alone is another one"
"$gatewalk" trace "$scenes/field.toml" --field --trials 8 --seed 3 --json crossings.json --quiet
"$gatewalk" lattice "$scenes/field.toml" --trials 8 --seed 3 --json counted.json --quiet
jq -s '(.[0].runs | map(.ending)) as $e | .[1].endings | [.crossed, .left_side, .right_side, .trapped, .cut_off] ==
  ([("crossed", "left field left side", "left field right side", "trapped", "cut off") as $x | $e | map(select(. == $x)) | length])' \
  crossings.json counted.json | grep -q true || fail "trace --field: other endings than lattice"
"$gatewalk" trace "$scenes/field.toml" --set field.rows=2 --field --trials 40 --seed 3 --only 'left field' --json some.json --quiet
"$gatewalk" trace "$scenes/field.toml" --set field.rows=2 --field --trials 40 --seed 3 --only crossed --json crossed.json --quiet
jq -s '(.[0].runs | map(select(.ending == "crossed"))) == .[1].runs and .[0].recorded > .[1].recorded' some.json crossed.json | grep -q true ||
  fail "trace --only: who crossed left the field"
"$gatewalk" trace "$scenes/soft_left.toml" --set run.time_limit_s=0.5 --video short.gif --quiet >/dev/null && [ "$(head -c 6 short.gif)" = GIF89a ] ||
  fail "trace: no GIF"
expect 2 '^gatewalk: --video short.avi: a video is FILE.mp4 or FILE.gif$' "$gatewalk" trace "$scenes/soft_left.toml" --video short.avi
expect 0 '^trial,' "$gatewalk" trace "$scenes/soft_left.toml" --csv -
expect 2 'a run ends as one of' "$gatewalk" trace "$scenes/soft_left.toml" --only stuck
expect 2 'bins 100.0: makes fewer than 1' "$gatewalk" chart-chain "$scenes/field.toml" --set beams.length_m=20 -o refused --bins 100 --truth-trials 100
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

# reproduce: everything is there, each claim has a verdict; what is done is not done again; the page asks nobody.
"$gatewalk" reproduce -o paper --quick >out.txt 2>&1 &
pid=$!
for _ in $(seq 120); do [ "$(jq length paper/data/done.json 2>/dev/null || echo 0)" -ge 1 ] && break; sleep 0.5; done
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail "reproduce: SIGTERM gives another status"
[ "$(jq length paper/data/done.json)" -ge 1 ] || fail "reproduce: nothing was done in a minute"
expect 0 'reproduced, .* agree, .* cannot be told, .* differ' "$gatewalk" reproduce -o paper --quick
grep -q '^[1-9].* studies are done already' out.txt || fail "reproduce: did not go on where it was"
expect 0 'studies are done already' "$gatewalk" reproduce -o paper --quick
head -c 1000 paper/data/fig12.json >half && mv half paper/data/fig12.json
expect 0 '\[30/30\]  fig12' "$gatewalk" reproduce -o paper --quick
echo '[1]' >paper/data/done.json
"$gatewalk" reproduce -o paper --quick --quiet &
pid=$!
sleep 1
expect 1 'another gatewalk reproduce works in it' "$gatewalk" reproduce -o paper --quick
wait $pid || fail "reproduce: an odd record stopped it"
jq '.quick = false' paper/report.json >full && cp paper/report.json keep && mv full paper/report.json
expect 2 'holds a full report' "$gatewalk" reproduce -o paper --quick
mv keep paper/report.json
for figure in fig5 fig6 fig8 fig9 fig11 fig12 thirteen_eight barriers table4 speed crossings; do
  for end in csv svg pdf; do [ -s paper/$figure.$end ] || fail "reproduce: no $figure.$end"; done
done
holds '(.claims | length) >= 30 and (.claims | map(.verdict | IN("reproduced", "agrees", "cannot tell", "differs")) | all)' paper/report.json
holds '(.claims | map(.see)) - (.sections | map(.id)) == []' paper/report.json
holds '[.sections[] | select(.id != "replay") | .commands | length] | min >= 1' paper/report.json
[ "$(tail -n +2 paper/claims.csv | wc -l)" = "$(jq '.claims | length' paper/report.json)" ] || fail "reproduce: claims.csv has other claims"
expect 2 'missing -o' "$gatewalk" reproduce
expect 2 'set has no meaning' "$gatewalk" reproduce -o paper --set forces.random_N=1
# A command of the report, run where it says.
(cd paper && eval "$(jq -r '.sections[] | select(.id == "fig9").commands[1]' report.json | sed "s#^gatewalk#$gatewalk#") --quiet --json again.json") || fail "reproduce: a command of the report does not work"
jq -s '.[0].runs == .[1].runs' paper/again.json paper/data/fig9_300.json | grep -q true || fail "reproduce: a command of the report gives something else"

# analyze: from a scene and from its file, the keys that scripts rely on; lattice takes as long.
fast=(--set run.method=moreau --set field.rows=4 --set forces.propulsion_N=8.5)
"$gatewalk" analyze "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --runs 300 --trials 4000 --json analysis.json --quiet
holds '.endings.crossed.interval_95[0] < .endings.crossed.probability and .endings.trapped.probability > 0.3' analysis.json
holds '([.expected_visits[][]] | add) as $visits | .expected_gates - $visits | fabs < 1e-9' analysis.json
holds '(.expected_visits | length) == 4 and (.expected_visits[0] | length) == 9' analysis.json
holds '(.expected_seconds / .direct.costs.all.mean_time_s - 1 | fabs) < 0.06 and (.expected_work_J / .direct.costs.all.mean_work_J - 1 | fabs) < 0.08' analysis.json
holds '.by_ending.all.kolmogorov_distance < 0.08 and .by_ending.crossed.mean_time_s > 0' analysis.json
holds '.lumping.error.final_gates > 0 and .lumping.largest_difference > 0' analysis.json
holds '.quasi_stationary | .survival_per_gate < 1 and .spectral_gap > 0 and ((.states | add) - 1 | fabs) < 1e-9' analysis.json
holds '(.sensitivities.parameters | length) >= 14 and .sensitivities.gate_runs > 8000 and .paths_complete and (.sensitivities.less_trapping | length) == 4' analysis.json
holds '(.paths | length) == 5 and .paths[0].probability > .paths[4].probability and .paths[0].gates[0] == {"i_x": 0, "i_y": 0}' analysis.json
"$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 -o fast.nc --quiet
"$gatewalk" analyze fast.nc --runs 0 --json from_file.json --quiet
holds '.gate_runs == 0 and .sensitivities.parameters == []' from_file.json
[ "$(value .expected_seconds analysis.json)" = "$(value .expected_seconds from_file.json)" ] ||
  fail "analyze: the file gave another time than its scene"
"$gatewalk" analyze fast.nc --runs 300 --threads 1 --json - 2>/dev/null | jq 'del(.seconds, .sensitivities.seconds)' >one.json
"$gatewalk" analyze fast.nc --runs 300 --threads 2 --json - 2>/dev/null | jq 'del(.seconds, .sensitivities.seconds)' | cmp -s - one.json ||
  fail "analyze: another number of threads gave another answer"
expect 2 'must be one of crossed' "$gatewalk" analyze fast.nc --target lost
expect 2 'is of one start' "$gatewalk" analyze fast.nc --start 0,0,15 --start 1,0,15
expect 2 'must be 0, or 100 or more' "$gatewalk" analyze fast.nc --runs 1
expect 0 'nobody ends so' "$gatewalk" analyze fast.nc --set field.max_gates=0 --target cut_off --runs 100
expect 2 'must lie between 0 and 0.5' "$gatewalk" analyze fast.nc --step 0.7
for lump in 3,1 3,1,2,1 0,1,1 3,1,x; do expect 2 'must be three whole numbers from 1 to 1000' "$gatewalk" analyze fast.nc --lump $lump; done
expect 0 'states (--lump), total variation to this chain: endings 0' "$gatewalk" analyze fast.nc --runs 0 --lump 3,1,2 --json lump.json
holds '.lumping | .parts == [3, 1, 2] and .count > 6 and .count <= 31 and .error.final_gates > 0' lump.json
"$gatewalk" build "$scenes/field.toml" --bins paper --trials 2 -o bins.nc --quiet
"$gatewalk" analyze bins.nc --runs 200 --json bins.json --quiet
holds '.expected_seconds > 10 and .expected_seconds_95 == null and .endings.trapped.interval_95[0] > 0 and .quasi_stationary.survival_per_gate > 0' bins.json
expect 2 'keeps no gate runs' "$gatewalk" analyze bins.nc --accuracy 0.1
"$gatewalk" lattice "$scenes/field.toml" "${fast[@]}" --trials 500 --json lattice_costs.json --quiet
holds '.costs.all | .trials == 500 and .mean_time_s > 0 and .quantiles_time_s[0] < .quantiles_time_s[4]' lattice_costs.json
holds '([.costs | to_entries[] | select(.key != "all") | .value.trials] | add) == 500' lattice_costs.json

# rare: every row's chance, the chain's beside it, as often as is asked for by direct trials.
expect 0 '^chance to enter row 4: ' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --row 4 --accuracy 0.2 --trials 500 --json rare.json
holds '.row == 4 and (.rows | length) == 4 and .probability > 0 and .interval_95[0] < .probability and .probability < .interval_95[1] and .chain > 0 and .relative_standard_error <= 0.2 and .gate_runs > 1000 and .rows[0].direct_entered > 0 and .rows[0].direct_interval_95[0] > 0 and .chain_seconds < .seconds' rare.json
expect 2 'must lie between 0 and 1' "$gatewalk" rare "$scenes/field.toml" --accuracy 5
expect 0 'was not reached' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --row 12 --accuracy 0.01 --gate-runs 20000
expect 0 '^chance to enter row 3: ' "$gatewalk" rare "$scenes/mixed.toml" --set run.method=moreau --row 3 --accuracy 0.2 --trials 500 --json rare.json
holds '(.rows | length) == 3 and .rows[2].probability > 0 and .rows[2].chain > 0 and .rows[2].direct_entered > 0' rare.json
"$gatewalk" lattice "$scenes/mixed.toml" --set run.method=moreau --set field.max_gates=0 --trials 500 --quiet --json lattice.json
"$gatewalk" rare "$scenes/mixed.toml" --set run.method=moreau --row 9 --accuracy 0.5 --trials 500 --quiet --json rare.json
jq -s '[range(8) as $r | .[0].final_gates[$r + 1:] | flatten | add] + [.[0].endings.crossed] == [.[1].rows[].direct_entered]' lattice.json rare.json | grep -q true || fail "rare: other direct trials than lattice"
expect 2 'mixed.toml: the terrain has 9 rows; the row to enter (--row) must be at most 9, or field.rows larger' "$gatewalk" rare "$scenes/mixed.toml" --row 10

# Predictions from a scene, and chains of trees: as accurate as asked for, one file for all commands.
fast=(--set run.method=moreau --set run.step_s=0.02)
"$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --json direct.json --threads 1 --quiet >/dev/null 2>&1
"$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --json direct2.json --threads 2 --quiet >/dev/null 2>&1
holds '.reached and .error_95 <= 0.05 and .error_95 > 0 and .gate_runs > 1000 and .seconds >= .run_seconds and .direct_seconds > 0 and ([.final_gates[][]] | add | . > 0.999999 and . < 1.000001)' direct.json
holds '(.final_gates_95.low[0][4] <= .final_gates[0][4]) and (.final_gates[0][4] <= .final_gates_95.high[0][4]) and .endings_95.trapped[0] <= .endings.trapped and .endings.trapped <= .endings_95.trapped[1]' direct.json
jq -s '.[0].final_gates == .[1].final_gates and .[0].error_95 == .[1].error_95' direct.json direct2.json | grep -q true || fail "predict SCENE: other results on other threads"
expect 0 'was not reached' "$gatewalk" predict "$scenes/field.toml" "${fast[@]}" --accuracy 1e-6 --gate-runs 2000
expect 2 'must lie between 0 and 1' "$gatewalk" predict "$scenes/field.toml" --accuracy 5
expect 2 'row has no meaning' "$gatewalk" predict "$scenes/field.toml" --row 1=m.nc
expect 0 'leaves of trees.*1 starts' "$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 -o tree.nc
"$gatewalk" predict tree.nc --json tree.json --quiet >/dev/null 2>&1
holds '.gate_runs == 0 and .error_95 <= 0.05 and .answer_from == "chain"' tree.json
"$gatewalk" predict tree.nc --start 4,5,10 --json other.json --quiet >/dev/null 2>&1
holds '.gate_runs > 0 and .starts[0].error_95 <= 0.05 and .starts[0].first_runs >= 500' other.json
expect 0 'no state of its own' "$gatewalk" predict tree.nc --start 4,5,10 --first-runs 0
expect 2 'keeps no gate runs' "$gatewalk" predict m.nc --accuracy 0.1
"$gatewalk" walk tree.nc --walks 1000 --json walk-tree.json --quiet >/dev/null 2>&1
holds '([.final_gates[][]] | add) == 1000' walk-tree.json
"$gatewalk" show tree.nc --json show-tree.json --quiet
holds '.state_space.bins == "tree" and .inputs == (.rows | length) and .gate_runs < .counts' show-tree.json
"$gatewalk" validate "$scenes/field.toml" "${fast[@]}" --matrix tree.nc --trials 100 --start 0,0,15 --null-draws 19 --json validate-tree.json --quiet >/dev/null 2>&1
holds '.state_space.bins == "tree" and .markov.verdict != null' validate-tree.json
expect 0 'fewer states than the runs allow' "$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --states 100 -o few.nc
expect 0 'for starts d' "$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.2 --starts=-5:5,-5:5,12:16 -o range.nc
expect 2 'd must lie inside' "$gatewalk" build "$scenes/field.toml" --starts=-50:5,-5:5,12:16 -o x.nc
expect 2 'three ranges' "$gatewalk" build "$scenes/field.toml" --starts 1:2 -o x.nc
expect 2 'runs per state' "$gatewalk" build "$scenes/field.toml" --bins tree --trials 5 -o x.nc
expect 2 'no meaning for bins' "$gatewalk" build "$scenes/field.toml" --bins paper --accuracy 0.1 -o x.nc

# Other bins than the paper's: recorded in the file, and every command takes them.
expect 0 '696 x 697 matrix' "$gatewalk" build "$scenes/field.toml" --trials 1 --bins 2 --seed 1 -o fine.nc
expect 0 '23 x 24 matrix' "$gatewalk" build "$scenes/field.toml" --trials 5 --bins 0.5 --seed 1 -o coarse.nc
expect 0 'bins  *2.0' "$gatewalk" show fine.nc --row 696
"$gatewalk" show coarse.nc --json coarse.json --quiet
holds '.text.bins == "0.5" and .inputs == 23 and (.rows | length) == 23' coarse.json
for bins in fine coarse; do
  "$gatewalk" walk $bins.nc --walks 1000 --json walk-$bins.json --quiet >/dev/null 2>&1
  holds '([.final_gates[][]] | add) == 1000' walk-$bins.json
  "$gatewalk" predict $bins.nc "$scenes/field.toml" --json predict-$bins.json --quiet >/dev/null 2>&1
  holds '(([.final_gates[][]] | add) - 1 | fabs) < 1e-12' predict-$bins.json
done
"$gatewalk" build "$scenes/field.toml" --trials 20 --bins 1 --seed 1 -o m1.nc --quiet >/dev/null
"$gatewalk" show m1.nc --json m1.json --quiet
"$gatewalk" show m.nc --json m.json --quiet
jq -s '.[0].rows == .[1].rows' m.json m1.json | grep -q true || fail "--bins 1 is not the paper's matrix"
for bins in 0 -1 nan 1e9; do expect 2 'bins' "$gatewalk" build "$scenes/field.toml" --bins $bins -o x.nc; done

# States from a pilot: the default of any other field. Twins, in other units, have the same matrix.
cat >cm.toml <<'END'
[body]
mass_kg = 0.25
radius_m = 0.08
[beams]
length_m = 0.17
mass_kg = 0.01
stiffness_left_Nm_per_rad = 0.15
stiffness_right_Nm_per_rad = 0.15
damping_Nms_per_rad = 0.005
joint_x_m = 0.23
joint_y_m = 0.20
[forces]
propulsion_N = 0.8
random_N = 1.0
random_rate_Hz = 10
drag_Ns_per_m = 1.0
[contact]
impulse_threshold_Ns = 1e-4
[run]
traverse_y_m = 0.40
[start]
vy_m_per_s = 0.4
END
expect 0 'bins from a pilot' "$gatewalk" build cm.toml --trials 2 --seed 3 -o auto.nc --json auto.json --threads 1
holds '.bins == "auto" and .clamped_share == 0 and .state_space.outermost_bins == "open" and .state_space.row_starts == "visited"' auto.json
holds '.state_space | .states > 100 and .pilot.trials == 2000 and .pilot.entries > 1000 and .resolution.poor == false and .starts_of_their_own == [{"d_m": 0, "vx_m_per_s": 0, "vy_m_per_s": 0.4}]' auto.json
holds '.state_space.resolution.unresolved_variance | [.d, .vx, .vy] | all(. > 0 and . < 0.5)' auto.json
"$gatewalk" build cm.toml --trials 2 --seed 3 -o auto2.nc --quiet --threads 2 >/dev/null
cmp -s auto.nc auto2.nc || fail "build: bins from a pilot depend on the threads"
expect 0 'states: .* pilot trials' "$gatewalk" show auto.nc
"$gatewalk" show auto.nc --json auto-show.json --quiet
# Where the scene is symmetric, so are its bins: EN's states, by d, then vx, turned about.
holds '[.rows[] | select(.boundary == "EN") | .vx_m_per_s] | flatten | unique | map(. + 0) | . == (map(-.) | sort)' <(jq '.rows |= .[:-1]' auto-show.json)
expect 0 '^start: EN d 0 m, vx 0 m/s, vy 0.4 m/s' "$gatewalk" predict auto.nc
expect 0 'beyond every entry that the bins were made from' "$gatewalk" predict auto.nc --start 0,0,9 --quiet
# A warning, and the way out, where the bins given do not resolve what bodies do.
expect 0 'resolve too little.*--bins auto' "$gatewalk" build cm.toml --set "bins.EN_vx_m_per_s=[-90, 90]" --set "bins.RD_vx_m_per_s=[-90, 0]" --set "bins.LD_vx_m_per_s=[0, 90]" --trials 1 -o own.nc --quiet
expect 2 'has a table \[bins\]' "$gatewalk" build cm.toml --set "bins.EN_vx_m_per_s=[-1, 1]" --bins auto -o x.nc
expect 2 'no meaning beside --matrix' "$gatewalk" validate cm.toml --matrix auto.nc --bins auto
expect 2 'must be paper, tree, auto' "$gatewalk" build cm.toml --bins many -o x.nc
# validate without --start: a scene's own start, but for the paper's field with the paper's start.
"$gatewalk" validate cm.toml --trials 100 --matrix-trials 2 --json own.json --quiet
holds '(.starts | map(.start.vy_m_per_s)) == [0.4] and .state_space.bins == "auto"' own.json
"$gatewalk" validate "$scenes/field.toml" --set start.x_m=3 --matrix m.nc --trials 20 --json own.json --quiet
holds '(.starts | map(.start.d_m)) == [3]' own.json
# Edges of one's own travel with the matrix, and another scene's are a difference.
{ cat "$scenes/field.toml"; printf '[bins]\nEN_d_m = [-25, -5, 5, 25]\nEN_vx_m_per_s = [-20, 0, 20]\n'; } >bins.toml
expect 0 '68 x 69 matrix' "$gatewalk" build bins.toml --trials 2 -o bins.nc --json bins.json
holds '.bins == "scene" and .state_space.outermost_bins == "closed"' bins.json
expect 0 '^trapped' "$gatewalk" predict bins.nc bins.toml
expect 2 '\[bins\]: none here, edges of its own there' "$gatewalk" predict bins.nc "$scenes/field.toml"
printf '[bins]\nEN_d_m = [5, -5]\n' >bad-bins.toml
expect 2 'bad-bins.toml:2: bins.EN_d_m' "$gatewalk" build bad-bins.toml -o x.nc
# Gates of several types: a matrix for each in one file, the same field for chain and dynamics.
mixed="$scenes/mixed.toml --set run.method=moreau"
expect 0 '^terrain.types.u.forces.propulsion_N  *8.0 ' "$gatewalk" scene $mixed
"$gatewalk" scene $mixed --json mixed.json --quiet
holds '(.map | length == 9 and all(test("^[.su]{9}$"))) and (.map | join("") | test("s.*u"))' mixed.json
"$gatewalk" scene $mixed --new >again.toml
"$gatewalk" scene again.toml --json again.json --quiet
jq -s '.[0].map == .[1].map' mixed.json again.json | grep -q true || fail "scene --new: another map"
"$gatewalk" build $mixed --bins paper --trials 3 -o mixed.nc --json mixed.json --quiet
holds '(.types | keys) == ["s", "u"] and .types.u.counts > 200' mixed.json
expect 0 '^  type u  ' "$gatewalk" show mixed.nc
expect 0 'outputs of input 13' "$gatewalk" show mixed.nc --type u --row 13
expect 2 'has no such type' "$gatewalk" show mixed.nc --type x
expect 0 '^trapped' "$gatewalk" walk mixed.nc --walks 1000
expect 0 '^trapped' "$gatewalk" predict mixed.nc --set terrain.seed=6
expect 0 '^trapped' "$gatewalk" predict $mixed --accuracy 0.1 --quiet
expect 0 'not asked of a field with several types' "$gatewalk" validate $mixed --matrix mixed.nc --trials 100
expect 2 'terrain.types.u.forces.propulsion_N: 9 here, 8 there' "$gatewalk" predict mixed.nc $mixed --set terrain.types.u.forces.propulsion_N=9
expect 2 'none here' "$gatewalk" walk mixed.nc "$scenes/field.toml" --set run.method=moreau
expect 2 'which says what stands where' "$gatewalk" predict mixed.nc --row 2=mixed.nc
expect 2 'not permitted for a comparison of fidelities' "$gatewalk" chart-field $mixed --trials 2 -o x
expect 0 'has no effect here: one gate is run' "$gatewalk" gate $mixed --trials 20 --quiet
"$gatewalk" trace $mixed --field --trial 3 --json trace.json --replay trace.html --quiet
holds '(.types | length) == 3 and (.type_of_gate | length) == 81 and .types[2].propulsion_N == 8' trace.json
# A field in other units (lengths x 16, times x 4, masses / 16) has the same counts.
sed -e 's/^impulse_threshold_Ns.*/impulse_threshold_Ns = 0.01/' -e 's/^mass_kg = 1.0/mass_kg = 0.0625/' -e 's/^mass_kg = 0.1/mass_kg = 0.00625/' \
  -e 's/^radius_m.*/radius_m = 160/' -e 's/^length_m.*/length_m = 400/' -e 's/^joint_x_m.*/joint_x_m = 400/' -e 's/^joint_y_m.*/joint_y_m = 480/' \
  -e 's/^traverse_y_m.*/traverse_y_m = 960/' -e 's/^random_rate_Hz.*/random_rate_Hz = 12.5/' -e 's/^drag_Ns_per_m.*/drag_Ns_per_m = 0.0009375/' \
  -e 's/^propulsion_N.*/propulsion_N = 0.4375/' -e 's/^random_N.*/random_N = 3.125/' -e 's/^vy_m_per_s.*/vy_m_per_s = 60/' \
  -e 's/^\(stiffness_[a-z]*_Nm_per_rad\).*/\1 = 400/' -e 's/^damping_Nms_per_rad.*/damping_Nms_per_rad = 200/' \
  -e 's/^time_limit_s.*/time_limit_s = 48.0\nstep_s = 0.08\nevent_tolerance_m = 0.16/' "$scenes/field.toml" >twin.toml
for bins in paper auto; do
  "$gatewalk" build "$scenes/field.toml" --set run.method=moreau --set run.step_s=0.01 --bins $bins --trials 2 -o one.nc --quiet >/dev/null 2>&1
  "$gatewalk" build twin.toml --set run.method=moreau --set run.step_s=0.04 --bins $bins --trials 2 -o two.nc --quiet >/dev/null 2>&1
  "$gatewalk" show one.nc --json one.json --quiet
  "$gatewalk" show two.nc --json two.json --quiet
  jq -s '[.[].rows | map([.trials, .clamped, .outputs])] | .[0] == .[1]' one.json two.json | grep -q true || fail "build --bins $bins: a twin has other counts"
  jq -s '(.[0].rows | map(.vx_m_per_s | map(. * 4))) == (.[1].rows | map(.vx_m_per_s))' one.json two.json | grep -q true || fail "build --bins $bins: a twin has other bins"
done
"$gatewalk" lattice "$scenes/field.toml" --trials 100 --seed 1 --json lattice.json --quiet
holds '([.final_gates[][]] | add) == 100 and .trapped + .left_field + .cut_off + .not_finite == 100' lattice.json
"$gatewalk" lattice "$scenes/field.toml" --set field.max_gates=1 --trials 50 --json one.json --quiet
holds '.final_gates[0][4] == 50' one.json
# A key that shapes nothing in a matrix of this method is no difference.
expect 0 '^trapped' "$gatewalk" predict m.nc "$scenes/field.toml" --set run.tolerance=0.01 --set run.event_tolerance_m=1e-4
expect 2 'forces.random_N' "$gatewalk" walk m.nc "$scenes/field.toml" --set forces.random_N=12
expect 2 'max_gates' "$gatewalk" predict m.nc --solver klu
expect 2 'is a matrix' "$gatewalk" gate m.nc
expect 2 'are the same file' "$gatewalk" build "$scenes/field.toml" -o x.nc --json ./x.nc
expect 2 'are the same file' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --json m.nc
expect 2 'no meaning' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --matrix-trials 5
expect 2 'a file of its own' "$gatewalk" build "$scenes/field.toml" -o -
expect 2 'run.traverse_y_m' "$gatewalk" lattice "$scenes/field.toml" --set run.traverse_y_m=35
expect 2 'field.toml.*run.step_s' "$gatewalk" gate "$scenes/field.toml" --set beams.damping_Nms_per_rad=1e12
# What cannot be taken at face value is said, even under --quiet.
for command in walk predict; do expect 2 'the start lies outside the chain' "$gatewalk" $command m.nc --set start.vy_m_per_s=-5; done
expect 2 'start   0    0  -15 lies outside the chain' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,-15 --start 0,0,15
expect 2 'start   0    0  -15 lies outside the chain' "$gatewalk" validate "$scenes/field.toml" --bins paper --trials 20 --start 0,0,-15
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --quiet --json out.json
holds '[.starts[].start.clamped] == [false, false, false, false]' out.json
holds '[.starts[].verdict | test("^the chain (agrees with|differs from) the dynamics .*p [=<] ")] | all' out.json
# The paper's numbers stand beside its own body and beams only.
expect 0 'fewer than 4' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20
expect 0 '|     -  ' "$gatewalk" validate "$scenes/field.toml" --trials 20 --matrix-trials 2 --set body.mass_kg=2
grep -q 'fewer than 4' out.txt && fail "validate: the paper's numbers beside another body"
expect 0 'run.step_s has no effect: run.method = "auto" chooses it' "$gatewalk" gate $auto --trials 5 --set run.step_s=0.01 --quiet --json out.json
expect 0 'run.event_tolerance_m has no effect' "$gatewalk" gate "$scenes/field.toml" --trials 5 --set run.event_tolerance_m=1e-6 --quiet --json out.json
"$gatewalk" build "$scenes/field.toml" --set run.method=paper --trials 5 -o paper.nc --quiet >/dev/null 2>&1
expect 0 'paper.nc: the method showed faults: .* of [0-9]* gate runs' "$gatewalk" walk paper.nc --quiet --json paper-walk.json
holds '.matrix_status.clean == false' paper-walk.json
expect 0 'hits may have been missed' "$gatewalk" gate "$scenes/field.toml" --set body.radius_m=0.01 --set start.x_m=-12 --trials 1 --quiet --set run.method=moreau
# A start and a seed have their own noise, the same in every command.
"$gatewalk" lattice "$scenes/field.toml" --trials 200 --seed 5 --json start.json --quiet
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 200 --seed 5 --start 4,5,10 --start 0,0,15 --json starts.json --quiet
jq -s '.[0].final_gates == .[1].starts[1].final_gates.dynamics' start.json starts.json | grep -q true ||
  fail "validate and lattice ran other trials for the same start"
expect 2 'start.y_m' "$gatewalk" predict m.nc --set start.y_m=5

# Fidelities need their method; the chart leaves CSV and JSON behind also when there is no gnuplot.
expect 2 'field.fidelity = "all" is not permitted with run.method = "stable"' "$gatewalk" lattice "$scenes/field.toml" --set field.fidelity=all
expect 2 'one of "active", "remember", "all"' "$gatewalk" lattice "$scenes/field.toml" --set field.fidelity=most
expect 2 'missing -o' "$gatewalk" chart-field "$scenes/field.toml"
expect 2 'three numbers' "$gatewalk" chart-field "$scenes/field.toml" -o chart --start 1,2
expect 2 'cannot be made' "$gatewalk" chart-field "$scenes/field.toml" -o m.nc/chart
"$gatewalk" lattice "$scenes/field.toml" --set run.method=moreau --set field.fidelity=all --trials 50 --json all.json --quiet 2>/dev/null
holds '([.final_gates[][]] | add) == 50 and .trapped + .left_field + .cut_off + .not_finite == 50' all.json
expect 2 'run.method = "auto" is not permitted.*run.step_s' "$gatewalk" chart-field "$scenes/field.toml" --set run.method=auto -o no-chart
[ -e no-chart ] && fail "chart-field: wrong use made a folder"
expect 0 '^Start 4, 5, 10: 20 trials cannot tell' "$gatewalk" chart-field "$scenes/field.toml" -o new/chart --trials 20 --start 4,5,10
[ "$(wc -l <new/chart/fidelity.csv)" = 5 ] || fail "chart-field: a line per fidelity and method was expected"
holds '.starts[0].runs | map(.fidelity) == ["active", "remember", "all", "active"]' new/chart/fidelity.json
holds '.starts[0].runs | all(([.final_gates[][]] | add) == 20 and (.fates | add | . - 1 | fabs) < 1e-12 and .seconds_per_trial > 0)' new/chart/fidelity.json
holds '.made_by.seed == 1 and (.made_by.scene | length) > 0 and (.machine | test("cores"))' new/chart/fidelity.json
expect 2 'are the same file' "$gatewalk" chart-field "$scenes/field.toml" -o new/chart --json ./new/chart/fidelity.csv
grep -q '</svg>' new/chart/fidelity.svg || fail "chart-field: no figure"
"$gatewalk" lattice "$scenes/field.toml" --set run.method=moreau --set field.fidelity=remember --set start.x_m=4 \
  --set start.vx_m_per_s=5 --set start.vy_m_per_s=10 --trials 20 --json remember.json --quiet 2>/dev/null
jq -s '.[0].starts[0].runs[1].final_gates == .[1].final_gates' new/chart/fidelity.json remember.json | grep -q true ||
  fail "chart-field and lattice ran other trials"
rm new/chart/*
expect 1 'gnuplot was not found.*are written' env PATH=/nonexistent "$gatewalk" chart-field "$scenes/field.toml" -o new/chart --trials 5 --start 0,0,15
[ "$(ls new/chart | xargs)" = "fidelity.csv fidelity.json" ] || fail "chart-field without gnuplot left $(ls new/chart)"

# One gate has no neighbours: no trial changes, and it takes 3/0.03 trials to know that few would.
one_gate="$scenes/field.toml --set field.columns=1 --set field.rows=1 --set run.step_s=0.02 --start 0,0,15"
# shellcheck disable=SC2086
{
expect 0 '^Start 0, 0, 15: 99 trials cannot tell .* 0.0000 +- 0.0303 ' "$gatewalk" chart-field $one_gate --trials 99 -o new/chart
holds '.starts[0].active_is_enough == null' new/chart/fidelity.json
expect 0 '^Start 0, 0, 15: active is enough: .* 0.0000 +- 0.0300 ' "$gatewalk" chart-field $one_gate --trials 100 -o new/chart
holds '.starts[0].active_is_enough == true and (.starts[0].runs | map(.step_s == 0.02) | all)' new/chart/fidelity.json
# The step is said, and what it does to moreau.
expect 0 '^gatewalk: .*(moreau), step 0.02 s: .* sank into a beam' "$gatewalk" chart-field $one_gate --trials 100 -o new/chart --quiet
expect 0 'step 0.02 s (moreau), 0.02 s (stable)' "$gatewalk" chart-field $one_gate --trials 5 -o new/chart
}

# Endings: in every result about a field, first in every table, as counts or probabilities that add up.
"$gatewalk" walk m.nc --walks 3000 --json ends-walk.json --quiet
"$gatewalk" predict m.nc --json ends-predict.json --quiet
"$gatewalk" lattice "$scenes/field.toml" --trials 150 --json ends-lattice.json --quiet
holds '(.endings | keys_unsorted) == ["crossed", "left_side", "right_side", "trapped", "cut_off"] and (.endings | add) + .never_sampled == 3000 and .endings.trapped == .trapped and .endings.cut_off == .cut_off and .endings.crossed + .endings.left_side + .endings.right_side == .left_field' ends-walk.json
holds '(.endings | add) + .not_finite == 150 and .endings.crossed + .endings.left_side + .endings.right_side == .left_field' ends-lattice.json
holds '((.endings | add) + .never_sampled - 1 | fabs) < 1e-12 and .endings.trapped == .trapped' ends-predict.json
for file in walk predict lattice; do
  holds '(.endings | add) as $all | .endings as $e | .endings_95 | to_entries | all(.value[0] <= $e[.key] / $all and $e[.key] / $all <= .value[1] and .value[0] >= 0 and .value[1] <= 1)' ends-$file.json
  holds '((.trapped_gates | flatten | add) - .trapped | fabs) < 1e-12 and ((.departed_gates | flatten | add) - .left_field | fabs) < 1e-12' ends-$file.json
  # Who left was last in the last row or an outer column.
  holds '[.departed_gates[:8][][1:8][]] | add == 0' ends-$file.json
done
holds '.matrix_sampling | .replicates == 200 and 0 < .total_variation_mean and .total_variation_mean < .total_variation_95 and .total_variation_95 < 1' ends-predict.json
"$gatewalk" predict m.nc --threads 1 --json ends-again.json --quiet
jq -s '.[0].endings_95 == .[1].endings_95' ends-predict.json ends-again.json | grep -q true || fail "predict: intervals depend on the threads"
"$gatewalk" predict m.nc --seed 2 --json ends-again.json --quiet
jq -s '.[0].endings_95 != .[1].endings_95 and .[0].endings == .[1].endings' ends-predict.json ends-again.json | grep -q true || fail "predict: --seed is not that of the intervals"
for args in "walk m.nc" "predict m.nc" "lattice $scenes/field.toml"; do
  "$gatewalk" $args --quiet >first.txt 2>/dev/null
  [ "$(head -5 first.txt | cut -c1-11 | tr -d ' ' | tr '\n' ,)" = "crossed,leftside,rightside,trapped,cutoff," ] || fail "$args: the endings do not come first"
  head -5 first.txt | grep -vq '%  \[' && fail "$args: an ending without interval"
done
"$gatewalk" predict m.nc --quiet | tail -1 | grep -q '^Rounding and walks not finished' || fail "predict: the numerical bound is not last"
# More runs a row, narrower intervals; also a matrix of 10^6 runs a row is resampled at once.
"$gatewalk" build "$scenes/field.toml" --trials 1 -o one.nc --quiet >/dev/null
"$gatewalk" predict one.nc --json ends-one.json --quiet
holds '.endings_95.trapped | .[1] - .[0] > 0.2' ends-one.json
# A field too large for many predictions has none, and says so.
expect 0 'the field is too large' "$gatewalk" predict m.nc --set field.max_gates=1446 --set field.columns=301 --set field.rows=301 --quiet
# validate: endings and one verdict that no p-value beside it contradicts.
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 300 --walks 500 --start 4.3,5.1,10.2 --start 0,0,15 --json ends-validate.json >ends-validate.txt 2>/dev/null
head -1 ends-validate.txt | grep -q '^Endings, % of 300 trials' || fail "validate: the endings do not come first"
grep -q '^   d   vx    vy  |  *crossed  *left side  *right side  *trapped  *cut off  *p$' ends-validate.txt || fail "validate: no header of the starts"
[ "$(grep -c '^ 4\.3  5\.1  10\.2  | ' ends-validate.txt)" -ge 5 ] || fail "validate: labels of starts are rounded"
holds '[.starts[] | (.endings.dynamics | add) == 300 and (.endings.walks | add) + .never_sampled == 500 and ((.endings.exact | add) + .never_sampled - 1 | fabs) < 1e-12] | all' ends-validate.json
holds '[.starts[].trials_and_matrix | ([.p_adjusted | .. | numbers] | min) as $least | .p == $least and .differs == (.p <= .level) and .null_draws >= 999 and .resampled_matrices == 999] | all' ends-validate.json
holds '[.starts[] | (.verdict | test("differs")) == .trials_and_matrix.differs] | all' ends-validate.json
# Is it Markov? Every question has its p and its sentence; the held force only when asked for.
holds '.markov | .walks == 600 and (.verdict | test("chain forgets")) and ([.gates_ahead, .gate_before, .visit, .row | .p > 0 and .p <= .p_adjusted and (.sentence | length > 20)] | all) and (.gates_ahead.steps | length == 7)' ends-validate.json
holds '[.starts[] | has("force_memory")] | any | not' ends-validate.json
grep -q '^Is it Markov?' ends-validate.txt || fail "validate: does not say whether it is Markov"
expect 0 'drawn anew at every crossing' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 30 --start 0,0,15 --memory --null-draws 99
# Beyond what is sensible: refused by name, with the range, before any work.
for value in 0 1e15; do expect 2 "null-draws.*at least 1 and at most 100000" "$gatewalk" validate "$scenes/field.toml" --null-draws $value --matrix-trials 1e12; done
expect 2 'walks 0: must be at least 1' "$gatewalk" validate "$scenes/field.toml" --walks 0 --matrix-trials 1e12
expect 2 'trials.*at most 1e15' "$gatewalk" validate "$scenes/field.toml" --trials 2000000000000000 --matrix-trials 1e12
expect 2 'inside the gate' "$gatewalk" validate "$scenes/field.toml" --start 25,0,15 --matrix-trials 1e12
# Walks take no memory each: a million and twenty million the same.
peak() {
  python3 -c 'import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$@"
}
few=$(peak "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,15 --walks 1e5 --null-draws 9 --threads 2 --quiet)
many=$(peak "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,15 --walks 2e7 --null-draws 9 --threads 2 --quiet)
[ $((many - few)) -lt 20000 ] || fail "validate: twenty million walks take $((many - few)) KiB more"

# A start that the paper's table has not.
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 200 --start 4,5,10 --json validate.json --quiet
holds '.starts | length == 1' validate.json
holds '.starts[0].exact | .p_values.chi_squared > 0 and .rmse_per_100_floor > 0 and .total_variation >= 0' validate.json

# An experiment's counts: read as people write them, held against dynamics and chain, one verdict.
"$gatewalk" lattice "$scenes/field.toml" --trials 60 --seed 77 --json sixty.json --quiet
jq -r '["ending", "count"], (.endings | to_entries[] | [.key, .value]) | @csv' sixty.json >ends.csv
jq -r '["gate_x", "gate_y", "count"], (.final_gates | to_entries[] | .key as $y | .value | to_entries[] | [.key - 4, $y, .value]) | @csv' sixty.json >gates.csv
beside=(validate "$scenes/field.toml" --matrix m.nc --null-draws 499)
"$gatewalk" "${beside[@]}" --observed ends.csv --observed gates.csv --trials 2000 --json observed.json >observed.txt 2>err.txt || fail "validate --observed: $(cat err.txt)"
[ -s err.txt ] && fail "validate --observed warns of: $(cat err.txt)"
# The scene's own start, not Table IV's four; and the sixty trials themselves.
holds '.starts | length == 1 and .[0].start.d_m == 0 and .[0].start.vy_m_per_s == 15' observed.json
jq -s '.[0].observed as $seen | .[1] | $seen.endings == .endings and $seen.final_gates == .final_gates and $seen.endings_95 == .endings_95' observed.json sixty.json | grep -q true ||
  fail "validate --observed: not what was observed"
holds '.observed | .trials == 60 and .files == ["ends.csv", "gates.csv"] and (.against_dynamics.differs | not) and (.verdict | startswith("these 60 trials do not differ from the dynamics by more than chance (p = "))' observed.json
holds '.observed.against_dynamics | ([.p_adjusted | .. | numbers] | min) as $least | .p == $least and .null_draws == 499 and (.final_gates | .corrcoef_floor > 0 and .total_variation > 0) and .p_endings.trapped > 0' observed.json
holds '.observed.smallest_difference | .power == 0.8 and .level == 0.05 and .final_gates_total_variation > 0.1 and .endings_total_variation > 0.05 and (.endings_percentage_points | length == 5 and .trapped.more > 5 and .trapped.fewer > 5 and .crossed.fewer == null)' observed.json
grep -q '^these 60 trials do not differ' observed.txt || fail "validate --observed: no verdict in the table"
head -1 observed.txt | grep -q '^Observed: 60 trials, beside 2000 of the full dynamics' || fail "validate --observed: the experiment does not come first"
# All else is as without it.
"$gatewalk" "${beside[@]}" --trials 2000 --start 0,0,15 --json without.json --quiet
jq -S 'walk(if type == "object" then del(.seconds, .speed_ratio, .made_by, .observed) else . end)' observed.json >with.txt
jq -S 'walk(if type == "object" then del(.seconds, .speed_ratio, .made_by) else . end)' without.json | cmp -s - with.txt || fail "--observed changes what validate says beside it"
# One table alone; the number of trials follows; a difference in plain words.
printf 'ending,count\ncrossed,60\n' >far.csv
expect 0 '^these 60 trials differ from the dynamics by more than chance (p = 0.00[0-9]): more cross, 100.00 ' "$gatewalk" "${beside[@]}" --observed far.csv --json far.json
grep -q 'no row for .*trapped, which counts as 0 (dynamics: ' out.txt || fail "validate --observed: an ending that is left out is not named"
holds '.trials == 10000 and (.observed | (has("final_gates") | not) and .against_dynamics.p_adjusted.total_variation == null and .against_chain.differs)' far.json
printf '\357\273\277# roaches\r\n\r\n "gate_y" ,gate_x,"count"\r\n8, -4 ,"60"\r\n' >corner.csv
expect 0 '^these 60 trials differ from the dynamics by more than chance (p = 0.002): they end in other gates, total variation 1.000' "$gatewalk" "${beside[@]}" --trials 2000 --observed corner.csv --start 4,5,10 --json corner.json
holds '.starts[0].start.d_m == 4 and .observed.final_gates[8][0] == 60 and (.observed | has("endings") | not)' corner.json
expect 0 'trials 100 for 60 observed: .* take 1200 or more' "$gatewalk" "${beside[@]}" --trials 100 --observed gates.csv
# Refused before any work, naming file, line, column and what is allowed.
refused() { printf "$2" >bad.csv; expect 2 "$1" timeout 20 "$gatewalk" validate "$scenes/field.toml" --matrix-trials 1e12 --observed bad.csv; }
refused 'bad.csv:1: unknown column "gatex": the first line must be gate_x,gate_y,count or ending,count' 'gatex,gate_y,count\n'
refused 'bad.csv:1: the columns must be' 'gate_x,count\n0,1\n'
refused 'bad.csv:2: column gate_x: "5" is not permitted: must be a whole number from -4 to 4 (field.columns = 9)' 'gate_x,gate_y,count\n5,0,1\n'
refused 'bad.csv:2: column gate_y: "9" is not permitted: must be a whole number from 0 to 8 (field.rows = 9)' 'gate_x,gate_y,count\n4,9,1\n'
refused 'bad.csv:2: column count: "-1" is not permitted: must be a whole number from 0' 'gate_x,gate_y,count\n4,8,-1\n'
refused 'bad.csv:2: column count: "1.5" is not permitted' 'ending,count\ncrossed,1.5\n'
refused 'bad.csv:2: column ending: "turned back" is not permitted: must be one of crossed, left_side, right_side, trapped, cut_off' 'ending,count\nturned back,1\n'
refused 'bad.csv:3: gate_x = 0, gate_y = 0 was given in line 2 already' 'gate_x,gate_y,count\n0,0,1\n0,0,2\n'
refused 'bad.csv:3: ending trapped was given already' 'ending,count\ntrapped,1\ntrapped,1\n'
refused 'bad.csv: has no trial' 'ending,count\ntrapped,0\n'
refused 'bad.csv: is empty' ''
expect 2 'ends.csv has 60\|far.csv: ends.csv has endings too' "$gatewalk" "${beside[@]}" --observed ends.csv --observed far.csv
printf 'ending,count\ncrossed,59\n' >fewer.csv
expect 2 'gates.csv has 60 trials, fewer.csv 59: both must be of the same trials' "$gatewalk" "${beside[@]}" --observed gates.csv --observed fewer.csv
expect 2 'observed nosuch.csv: cannot be read' "$gatewalk" "${beside[@]}" --observed nosuch.csv
expect 2 'belong to one start, --start gives 2' "$gatewalk" "${beside[@]}" --observed ends.csv --start 0,0,15 --start 4,5,10
expect 2 'are the same file' "$gatewalk" "${beside[@]}" --observed gates.csv --observed ends.csv --json ends.csv

# power: how many trials; what so many show; two scenes.
power=(power "$scenes/field.toml" --accuracy 0.05)
"$gatewalk" "${power[@]}" --trials 60 --versus beams.stiffness_left_Nm_per_rad=200 --versus beams.stiffness_right_Nm_per_rad=200 --json power.json >power.txt 2>err.txt || fail "power: $(cat err.txt)"
holds '.power == 0.8 and .level == 0.05 and .trials == 60 and .error_95 <= 0.05 and ((.endings | add) - 1 | fabs) < 1e-6' power.json
holds '[.from_prediction.endings[] | length == 4 and (map(.trials) | . == (sort | reverse)) and (map(.trials_if_all_are_looked_at >= .trials) | all) and (map(.power) | . == sort)] | all' power.json
holds '.from_prediction.endings | [.trapped[].percentage_points] == [2, 5, 10, 20] and .trapped[3].trials > 20 and .trapped[3].trials < 80' power.json
holds '.from_prediction.final_gates | [.[].total_variation] == [0.05, 0.1, 0.2] and .[0].trials > 3 * .[1].trials and .[1].trials > 3 * .[2].trials and .[2].power < 0.8' power.json
holds '.smallest_difference | .final_gates_total_variation > 0.2 and .endings_percentage_points.trapped.more > 10 and .endings_percentage_points_if_all_are_looked_at.trapped.more > .endings_percentage_points.trapped.more' power.json
holds '.versus | .set == ["beams.stiffness_left_Nm_per_rad=200", "beams.stiffness_right_Nm_per_rad=200"] and (.scene | test("stiffness_left_Nm_per_rad = 200")) and .apart.final_gates.trials > 2 and (.apart.endings | length) == 5' power.json
grep -q '^Trials needed, for 80 % power at a level of 5 %' power.txt || fail "power: no table"
grep -q '^Versus beams.stiffness_left_Nm_per_rad=200, beams.stiffness_right' power.txt || fail "power: does not name the other scene"
"$gatewalk" "${power[@]}" --trials 60 --versus beams.stiffness_left_Nm_per_rad=200 --versus beams.stiffness_right_Nm_per_rad=200 --json again.json --threads 1 --quiet
cmp -s power.json again.json || fail "power: another number of threads gave another file"
# The same prediction as predict's.
"$gatewalk" predict "$scenes/field.toml" --accuracy 0.05 --json predicted.json --quiet
jq -s '.[0].endings == .[1].endings and .[0].final_gates == .[1].final_gates and .[0].error_95 == .[1].error_95' power.json predicted.json | grep -q true || fail "power: not the prediction of predict"
expect 2 'power 1.2: must lie in \[0.5, 0.99\]' "$gatewalk" "${power[@]}" --power 1.2
expect 2 'level 0: must lie in \[0.01, 0.25\]' "$gatewalk" "${power[@]}" --level 0
expect 2 'trials 0: must be at least 1 and at most 100000' "$gatewalk" "${power[@]}" --trials 0
expect 2 'versus: field.columns and field.rows must stay' "$gatewalk" "${power[@]}" --versus field.rows=5
expect 2 '^gatewalk: --versus forces.randm_N=20: unknown key forces.randm_N; the closest known key is forces.random_N' "$gatewalk" "${power[@]}" --versus forces.randm_N=20
expect 2 'fidelity = "all" is not permitted for a chain' "$gatewalk" "${power[@]}" --set field.fidelity=all --set run.method=moreau
expect 2 'start.y_m must be 0' "$gatewalk" "${power[@]}" --set start.y_m=1

# chart-chain: three files in a folder that it makes; errors and their parts are distributions'.
chart() { "$gatewalk" chart-chain "$scenes/field.toml" --truth-trials 150 --runs-limit 1e3 --bins 0.5 --bins 1 \
            --start 0,0,15 --seed 2 --visited 50 "$@"; }
expect 0 'direct simulation' chart -o charts/a --json charts.json --threads 2
cmp -s charts.json charts/a/chain.json || fail "chart-chain: --json and chain.json differ"
grep -q '</svg>' charts/a/chain.svg || fail "chart-chain: no figure"
holds '[.points[] | [.bins, .trials_per_row]] == [[0.5, 10], [0.5, 20], [1, 10], [0.5, 10], [0.5, 20], [1, 10]]' charts/a/chain.json
holds '[.points[].states] == [23, 23, 87, 23, 23, 87] and [.points[0:3][].gate_runs] == [230, 460, 870]' charts/a/chain.json
holds '[.points[].matrices] == [2, 1, 1, 2, 1, 1]' charts/a/chain.json
holds '[.points[].starts[] | .exact, .walks_10000, .walks_1000000 | .total_variation > 0 and .total_variation < 1] | all' charts/a/chain.json
# A million walks: within 1/2 sqrt(2/pi 81/1e6) = 0.004 of infinitely many on average; twice that.
holds '[.points[].starts[] | .exact.total_variation - .walks_1000000.total_variation | fabs < 0.008] | all' charts/a/chain.json
# 2000 draws of a figure that varies by some 15 %: five standard errors.
holds '.starts[0].direct_simulation | map(.drawn.total_variation / .formula.total_variation - 1 | fabs < 0.02) | all' charts/a/chain.json
# The truth's noise, that of 150 trials, is in the errors of both. (How many trials are charted depends on times.)
holds '.starts[0] | .truth.floor.total_variation as $noise | .direct_simulation | .[-1].trials >= 50 and (map(.formula.total_variation >= $noise) | all)' charts/a/chain.json
holds '.starts[0].truth.trials == 150 and ([.starts[0].truth.final_gates[][]] | add) == 150' charts/a/chain.json
holds '[.points[].row_starts] == ["uniform", "uniform", "uniform", "visited", "visited", "visited"]' charts/a/chain.json
holds '.points[0].build_s < .points[3].build_s' charts/a/chain.json  # the trials that saw the entries cost
holds '.points[0].starts[0].exact != .points[3].starts[0].exact' charts/a/chain.json
holds '.starts[0].summary | .cheapest_near_best.seconds <= .best.seconds' charts/a/chain.json
[ "$(awk -F, '{ print NF }' charts/a/chain.csv | sort -u)" = 25 ] || fail "chart-chain: uneven lines in chain.csv"
[ "$(grep -c ',exact,' charts/a/chain.csv)" = 6 ] || fail "chart-chain: not one line per matrix in chain.csv"
# Trees as far as 20000 runs go; they keep what they say but for the truth's noise.
"$gatewalk" chart-chain "$scenes/field.toml" --truth-trials 2000 --runs-limit 2e4 --bins 0.5 --start 0,0,15 \
  --set run.method=moreau -o charts/t --quiet >charts/t.txt 2>/dev/null
holds '.starts[0] | .truth.floor.total_variation as $noise | .trees | length >= 2 and (map(.total_variation < .error_95 + 2 * $noise and .gate_runs > 0 and .seconds > 0) | all)' charts/t/chain.json
[ "$(grep -c ',tree,' charts/t/chain.csv)" = "$(jq '.starts[0].trees | length' charts/t/chain.json)" ] || fail "chart-chain: not one line per tree in chain.csv"
grep -q 'Trees (predict --accuracy): TV ' charts/t.txt || fail "chart-chain: no word on trees"
# Times aside, the same on one thread.
chart -o charts/b --threads 1 --quiet >/dev/null 2>&1
timeless='.starts[0].truth.final_gates, (.points[] | del(.build_s) | .starts[] |= del(.exact_s, .walks_10000_s, .walks_1000000_s))'
[ "$(jq -c "$timeless" charts/a/chain.json)" = "$(jq -c "$timeless" charts/b/chain.json)" ] ||
  fail "chart-chain: another number of threads gave other errors"
expect 2 'missing -o' "$gatewalk" chart-chain "$scenes/field.toml"
expect 2 'missing SCENE' "$gatewalk" chart-chain -o charts/x
expect 2 "runs-limit" "$gatewalk" chart-chain "$scenes/field.toml" -o charts/x --runs-limit 40
expect 2 'must be at least 100' "$gatewalk" chart-chain "$scenes/field.toml" -o charts/x --truth-trials 99
expect 2 'the same factor twice' chart -o charts/x --bins 1
expect 2 'inside the gate' chart -o charts/x --start 25,0,15
expect 2 'are the same file' chart -o charts/a --json charts/../charts/a/chain.csv
[ -e charts/x ] && fail "chart-chain: wrong use made a folder"
expect 2 'm.nc' chart -o m.nc

# Damaged and missing files; output that cannot be written leaves the old file.
head -c 5000 m.nc >cut.nc
expect 2 'cut.nc' "$gatewalk" show cut.nc
# A count changed by another program: refused, the row is named.
ncdump m.nc | sed -E '/^ count = /s/= ([0-9]+)/= 77/' >altered.cdl && ncgen -4 -o altered.nc altered.cdl
expect 2 'row 1 .*add up to' "$gatewalk" predict altered.nc
expect 2 'nosuch.nc' "$gatewalk" walk nosuch.nc
expect 2 'json: no/such/dir/x.json: cannot be written' "$gatewalk" gate "$scenes/single_gate.toml" --trials 10 --json no/such/dir/x.json
expect 2 'no-dir/m.nc: cannot be written' "$gatewalk" build "$scenes/field.toml" --trials 1 -o no-dir/m.nc
ls | grep -q tmp && fail "temporary files stayed behind: $(ls)"

# chart: a line per scene, method and setting; wrong use is said before any work.
"$gatewalk" chart "$scenes/field.toml" "$scenes/stiff.toml" -o charts --trials 20 --repeats 1 --seed 2 --quiet >/dev/null 2>chart.err ||
  fail "chart: $(head -n 3 chart.err)"
[ "$(wc -l <charts/chart.csv)" = 83 ] || fail "chart.csv has $(wc -l <charts/chart.csv) lines"
[ "$(cut -d, -f1-2 charts/chart.csv | sort | uniq -c | awk '$1 == ($2 ~ /moreau/ ? 9 : 8)' | wc -l)" = 10 ] || fail "chart.csv: settings per method"
holds '[.scenes[].settings[] | select(.status != "refused") | .health.runs == 20 and .microseconds_per_trial.min > 0] | all' charts/chart.json
holds '[.scenes[].reference.outcomes | add] == [20, 20]' charts/chart.json
holds '[.scenes[].settings[] | select(.default)] | length == 10' charts/chart.json
grep -q '</svg>' charts/chart.svg || fail "chart.svg is no whole figure"
"$gatewalk" chart "$scenes/stiff.toml" -o again --trials 20 --repeats 1 --seed 2 --methods stable --threads 1 --quiet >/dev/null
jq -s '[.[0].scenes[1].settings[] | select(.method == "stable") | .errors] == [.[1].scenes[0].settings[].errors]' charts/chart.json again/chart.json |
  grep -q true || fail "chart: one method on one thread gave other errors"
holds '[.scenes[].settings[].errors | select(.) | .strong | (.parted_share >= 0.5 or .compared == 0) == (.position_m.median == null)] | unique == [true]' charts/chart.json
holds '[.scenes[].settings[].errors | select(.) | .strong | select(.parted_share >= 0.5 and .compared > 0)] | length > 0' charts/chart.json
grep -q 'half or more parted' charts/chart.svg || fail "chart.svg is silent about settings of which half the trials parted"
cp "$scenes/stiff.toml" "a,b.toml"
"$gatewalk" chart "a,b.toml" -o quoted --trials 20 --repeats 1 --methods stable --quiet >/dev/null
grep -q '^"a,b",stable,run.step_s,' quoted/chart.csv || fail "chart.csv: a comma in a name makes two fields"
# Every line as long as the first, reasons in quotes aside.
[ "$(sed -E 's/"[^"]*"//' charts/chart.csv | awk -F, '{ print NF }' | sort -u | wc -l)" = 1 ] || fail "chart.csv: uneven lines"
# Settings with the reference's bits have a place in the figure: the disc misses every beam.
"$gatewalk" chart "$scenes/undamped.toml" -o exact --trials 20 --repeats 1 --methods stable,event --quiet --json - >exact.json
[ -n "$(value '.scenes[0].settings[] | select(.errors.strong.position_m.median.below? == 1e-8) | .value' exact.json)" ] ||
  fail "chart: no setting is below a billionth of R: $(jq -c '[.scenes[0].settings[] | [.method, .value, .errors.strong.position_m.median]]' exact.json)"
grep -q 'half or more parted' exact/chart.svg && fail "chart: exact settings are called parted"
# The table shows the least of the times, and chance beside the error.
"$gatewalk" chart "$scenes/stiff.toml" -o times --trials 50 --repeats 3 --methods event --json times.json >times.txt 2>/dev/null
for i in 0 1 2 3 4 5 6 7; do
  least=$(printf '%.1f' "$(value ".scenes[0].settings[$i].microseconds_per_trial.rounds | min" times.json)")
  grep -E -A8 'us/trial .* chance' times.txt | tail -n +$((i + 2)) | head -n 1 | grep -q " $least " || fail "chart: setting $i: not $least us in the table"
done
expect 2 'missing SCENE' "$gatewalk" chart -o charts
expect 2 'missing -o' "$gatewalk" chart "$scenes/field.toml"
expect 2 "no method 'euler'" "$gatewalk" chart "$scenes/field.toml" -o charts --methods euler
expect 2 'stands there twice' "$gatewalk" chart "$scenes/field.toml" -o charts --methods paper,paper
expect 2 'two scenes are called field' "$gatewalk" chart "$scenes/field.toml" "$scenes/field.toml" -o charts
expect 2 'at least 1' "$gatewalk" chart "$scenes/field.toml" -o charts --trials 0
expect 2 'nosuch.toml' "$gatewalk" chart "$scenes/field.toml" nosuch.toml -o charts
expect 2 'gate.json' "$gatewalk" chart "$scenes/field.toml" -o gate.json --trials 1
for name in csv json svg; do
  expect 2 'are the same file' "$gatewalk" chart "$scenes/field.toml" -o charts --trials 1 --json charts/../charts/chart.$name
done
# A scene that the reference method refuses is named before the first trial of the others.
sed -E 's/^stiffness_left_Nm_per_rad.*/stiffness_left_Nm_per_rad = 1e12/; s/^method = .*/method = "paper"/' \
  "$scenes/field.toml" >rigid.toml
expect 2 'rigid.toml: no reference' timeout 20 "$gatewalk" chart "$scenes/field.toml" rigid.toml -o charts --trials 1e7

# sweep: a point is what gate gives for those keys; from:step:to and lists; the scene's own grid.
"$gatewalk" sweep "$scenes/single_gate.toml" --trials 60 --seed 5 --vary forces.propulsion_N=8:0.5:9 \
  --vary run.method=stable,moreau --csv sweep.csv --json sweep.json --quiet 2>/dev/null || fail "sweep"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 60 --seed 5 --set forces.propulsion_N=8.5 --json point.json --quiet
holds '[.points[].at["forces.propulsion_N"]] == [8, 8, 8.5, 8.5, 9, 9]' sweep.json
[ "$(jq -cS '.points[2] | del(.at, .intervals_95.right_of_traversed, .status.trials_checked)' sweep.json)" = "$(jq -cS 'del(.made_by, .status.trials_checked)' point.json)" ] ||
  fail "sweep: a point is not what gate gives"
[ "$(wc -l <sweep.csv)" = 7 ] || fail "sweep: $(wc -l <sweep.csv) lines"
[ "$(head -n 1 sweep.csv | cut -d, -f1,2,3)" = "forces.propulsion_N,run.method,method" ] || fail "sweep: $(head -n 1 sweep.csv)"
expect 0 '60 points of 1 trials' "$gatewalk" sweep "$scenes/fig8.toml" --trials 1 --quiet
expect 0 '216 points of 1 trials' "$gatewalk" sweep "$scenes/fig12.toml" --trials 1 --quiet
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
expect 2 'varied twice' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1 --vary forces.random_N=2
expect 2 'must lie in' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1,-1
expect 2 'more than 100000' "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=0:1e-9:1

# landscape: the paper's grid, the pass of its equal beams, three files.
"$gatewalk" landscape "$scenes/single_gate.toml" -o land --trials 20 --quiet --set beams.stiffness_left_Nm_per_rad=500 \
  --set beams.stiffness_right_Nm_per_rad=500 >land.txt || fail "landscape"
holds '.passes[0].from_start.barrier_J | . > 32 and . < 32.1' land/landscape.json
holds '.passes[1].above_start_J | . > 18.15 and . < 20' land/landscape.json
[ "$(wc -l <land/landscape.csv)" = $((101 * 131 + 1)) ] || fail "landscape.csv has $(wc -l <land/landscape.csv) lines"
grep -q 'measured' land.txt && [ -s land/landscape.svg ] || fail "landscape: $(cat land.txt)"
expect 0 'no basin on the way' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --set beams.stiffness_left_Nm_per_rad=100
expect 0 '' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --beam right
expect 2 'must be both' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --beam top
expect 2 'must lie in' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --spacing 0
expect 2 'missing -o' "$gatewalk" landscape "$scenes/single_gate.toml"
# In other units (lengths / 4^5, masses * 4^2) the same grid and passes; videos keep the scene's own pace.
twin="--set body.radius_m=0.009765625 --set body.mass_kg=16 --set beams.length_m=0.0244140625 --set beams.mass_kg=1.6 --set beams.damping_Nms_per_rad=0.000762939453125
  --set beams.joint_x_m=0.0244140625 --set beams.joint_y_m=0.029296875 --set run.traverse_y_m=0.0634765625
  --set beams.stiffness_left_Nm_per_rad=0.00762939453125 --set beams.stiffness_right_Nm_per_rad=0.00762939453125
  --set forces.propulsion_N=0.109375 --set forces.random_N=0.15625"
# shellcheck disable=SC2086
{
"$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --set beams.stiffness_left_Nm_per_rad=500 --set beams.stiffness_right_Nm_per_rad=500 >/dev/null
"$gatewalk" landscape "$scenes/single_gate.toml" -o land-twin --quiet $twin >land-twin.txt || fail "landscape in other units"
jq '.spacing_m, (.passes[].from_start.energy_J, .passes[].from_basin.barrier_J), .passes[].from_basin.y_m' land/landscape.json >land.list
jq '.spacing_m * 1024, (.passes[].from_start.energy_J, .passes[].from_basin.barrier_J) * 65536, .passes[].from_basin.y_m * 1024' land-twin/landscape.json >land-twin.list
cmp -s land.list land-twin.list && [ "$(wc -l <land.list)" = 7 ] || fail "landscape in other units: $(paste land.list land-twin.list)"
[ "$(wc -l <land-twin/landscape.csv)" = "$(wc -l <land/landscape.csv)" ] || fail "landscape in other units: another grid"
expect 2 'video-speed: must lie in \[0.01, 100\]' "$gatewalk" trace "$scenes/field.toml" --video v.mp4 --video-speed 101
expect 2 'video-speed: must lie in \[2.56, 25600\]' "$gatewalk" trace "$scenes/field.toml" --video v.mp4 --video-speed 2 --set forces.random_rate_Hz=0.1953125 \
  --set forces.propulsion_N=0.0001 --set forces.random_N=0.0001
}

# stability: five maps of five methods.
"$gatewalk" stability -o maps --quick --quiet >/dev/null 2>maps.err || fail "stability: $(head -n 3 maps.err)"
holds '.maps | length == 25' maps/stability.json
holds '[.maps[] | (.status | length) == (.y.values | length)] | all' maps/stability.json
holds '[.maps[] | select(.method == "stable" and .map == "restitution_threshold") | .status[][]] | unique == ["ok"]' maps/stability.json
[ "$(ls maps/*.svg | wc -l)" = 5 ] || fail "stability: $(ls maps)"
expect 2 'missing -o' "$gatewalk" stability
for name in stability.csv stability.json lever_speed.svg; do
  expect 2 'are the same file' timeout 20 "$gatewalk" stability -o maps --quick --json maps/$name
done
mkdir -p blocked/grazing_speed.svg
expect 2 'grazing_speed.svg' "$gatewalk" stability -o blocked --quick  # before any work
[ "$(ls blocked)" = grazing_speed.svg ] || fail "stability: wrote $(ls blocked) though a figure has no place"
expect 2 'no meaning' "$gatewalk" stability -o maps --set forces.random_N=1

# Ctrl-C: within 2 s, status 130, a clear word, the old file unchanged.
for command in "gate $scenes/single_gate.toml --trials 1e9 --json gate.json" \
               "build $scenes/field.toml --trials 1e7 -o m.nc" \
               "lattice $scenes/field.toml --trials 1e9 --json lattice.json" \
               "chart-field $scenes/field.toml --trials 1e9 -o new/chart" \
               "chart-chain $scenes/field.toml -o charts/x --truth-trials 1e9" \
               "chart $scenes/field.toml --trials 1e7 -o charts"; do
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

# No output may be an input, under whatever name: refused before any work, the input as it was.
mkdir -p safe/folder
cp "$scenes/single_gate.toml" safe/own.toml
cp m.nc safe/m.nc
cp m.nc safe/other.nc
cd safe || exit 1
ln -s own.toml soft.toml
ln own.toml hard.toml
ln -s ../safe link
cp own.toml landscape.csv; cp own.toml chart.json; cp own.toml fidelity.svg; cp own.toml chain.csv
inputs() { cat own.toml m.nc other.nc landscape.csv chart.json fidelity.svg chain.csv | cksum; }
untouched=$(inputs)
destroyers=0
destroys() {
  destroyers=$((destroyers + 1))
  expect 2 'are the same file: an output needs a file of its own' "$@"
  [ "$(inputs)" = "$untouched" ] || { fail "an input was destroyed: $*"; untouched=$(inputs); }
}
destroys "$gatewalk" gate own.toml --json own.toml
destroys "$gatewalk" gate own.toml --json ./own.toml
destroys "$gatewalk" gate own.toml --json "$PWD/own.toml"
destroys "$gatewalk" gate own.toml --json folder/../own.toml
destroys "$gatewalk" gate own.toml --json link/own.toml
destroys "$gatewalk" gate own.toml --json soft.toml
destroys "$gatewalk" gate own.toml --json hard.toml
destroys "$gatewalk" gate soft.toml --json own.toml
destroys "$gatewalk" gate /dev/stdin --json own.toml <own.toml
destroys "$gatewalk" sweep own.toml --vary forces.random_N=1 --csv own.toml
destroys "$gatewalk" sweep own.toml --vary forces.random_N=1 --json own.toml --csv x.csv
destroys "$gatewalk" trace own.toml --csv own.toml
destroys "$gatewalk" trace own.toml --netcdf own.toml
destroys "$gatewalk" trace own.toml --replay own.toml
destroys "$gatewalk" trace own.toml --video own.toml
destroys "$gatewalk" trace own.toml --json own.toml
destroys "$gatewalk" build own.toml -o own.toml
destroys "$gatewalk" build own.toml -o x.nc --json own.toml
destroys "$gatewalk" show m.nc --json m.nc
destroys "$gatewalk" walk m.nc --json m.nc
destroys "$gatewalk" walk m.nc own.toml --json own.toml
destroys "$gatewalk" predict m.nc --json m.nc
destroys "$gatewalk" predict m.nc own.toml --json own.toml
destroys "$gatewalk" predict m.nc --row 4=other.nc --json other.nc
destroys "$gatewalk" lattice own.toml --json own.toml
destroys "$gatewalk" validate own.toml --json own.toml
destroys "$gatewalk" validate own.toml --matrix m.nc --json m.nc
destroys "$gatewalk" landscape landscape.csv -o .
destroys "$gatewalk" landscape own.toml -o folder --json own.toml
destroys "$gatewalk" chart own.toml chart.json -o .
destroys "$gatewalk" chart own.toml m.nc -o folder --json own.toml
destroys "$gatewalk" chart-field fidelity.svg -o .
destroys "$gatewalk" chart-chain chain.csv -o "$PWD"
# Nor may two outputs be one, nor standard output another file of the command.
destroys "$gatewalk" trace own.toml --csv folder/new --json link/folder/new
destroys "$gatewalk" landscape own.toml -o folder --json folder/landscape.json
destroys "$gatewalk" build own.toml -o link/new.nc --json new.nc
[ $destroyers -ge 20 ] || fail "only $destroyers commands were tried"
"$gatewalk" gate own.toml >>own.toml 2>err.txt
[ $? = 2 ] && grep -q 'standard output are the same file' err.txt || fail "appended a table to the scene: $(cat err.txt)"
"$gatewalk" gate own.toml --json table.txt >table.txt 2>err.txt
[ $? = 2 ] && grep -q 'standard output and --json table.txt are the same file' err.txt || fail "two outputs in one file: $(cat err.txt)"
rm -f table.txt err.txt out.txt
[ "$(inputs)" = "$untouched" ] || fail "an input was destroyed"
[ "$(ls folder | wc -l)" = 0 ] || fail "refused commands left $(ls folder)"
mkdir -p folder/scenes && echo '# my own' >folder/scenes/field.toml
expect 2 'would be replaced; choose another folder' "$gatewalk" reproduce -o folder --quick
[ "$(cat folder/scenes/field.toml)" = '# my own' ] || fail "reproduce replaced a scene of the user's own"
cd ..

# What cannot be written or is out of range is said before the work, naming the option.
long=$(printf 'n%.0s' $(seq 256))
quick() { expect 2 "$1" timeout 20 "$gatewalk" "${@:2}"; }
quick 'json: .*File name too long' gate "$scenes/field.toml" --trials 1e9 --json "$long"
quick 'csv: .*No such file or directory' trace "$scenes/field.toml" --field --trials 1000 --csv none/x.csv
quick 'o: .*cannot be made' landscape "$scenes/field.toml" --trials 1e9 -o "new/$long"
quick 'o: .*is no folder' chart "$scenes/field.toml" -o m.nc/charts
quick 'csv needs a file name' sweep "$scenes/fig8.toml" --trials 1e9 --csv ''
quick 'matrix needs a file name' validate "$scenes/field.toml" --trials 1e9 --matrix ''
quick 'o needs a file name' build "$scenes/field.toml" --trials 1e9 -o ''
quick 'o needs the name of a folder' stability -o ''
quick 'o --: looks like an option, so the value of -o is missing' build "$scenes/field.toml" --trials 1e9 -o --
quick 'json --output: looks like an option' gate "$scenes/field.toml" --trials 1e9 --json --output
quick 'json -x: looks like an option' gate "$scenes/field.toml" --trials 1e9 --json -x
quick "trials: '1e18' is out of range: at most 1e15" gate "$scenes/field.toml" --trials 1e18
quick "trials: '1000000000000000001' is out of range: at most 1e15" gate "$scenes/field.toml" --trials 1000000000000000001
quick "walks: '1e999' is out of range" walk m.nc --walks 1e999
quick "trials: 'nan' is not a whole number" gate "$scenes/field.toml" --trials nan
quick "seed: '1e3' is not a seed" gate "$scenes/field.toml" --seed 1e3
quick 'at most 10000000' chart "$scenes/field.toml" -o charts --trials 1e9
quick 'visited 1000000000: .* at most 1000000' chart-chain "$scenes/field.toml" -o charts --visited 1e9
quick 'trial 0 alone has more than .* run.step_s or a shorter run.time_limit_s' trace "$scenes/field.toml" --set run.step_s=1e-7 --csv x.csv
quick 'more than 100000 values' sweep "$scenes/field.toml" --vary forces.random_N=0:1e-6:10
quick 'must lie in' landscape "$scenes/field.toml" -o land --set beams.joint_x_m=900 --spacing 0.1
for set in 'forces.random_N=1' ' forces.random_N = 1' 'forces . random_N=1' 'forces."random_N"=1' '"forces".random_N=1'; do
  quick 'has no effect: forces.random_N is varied' sweep "$scenes/field.toml" --vary forces.random_N=1,2 --set "$set"
done

# Modes of files stay; a new file follows the umask. Pipes and devices are written into.
(umask 027; "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json mode.json --quiet; "$gatewalk" build "$scenes/single_gate.toml" --trials 1 -o mode.nc --quiet >/dev/null)
[ "$(stat -c %a mode.json mode.nc | xargs)" = '640 640' ] || fail "modes of new files: $(stat -c %a mode.json mode.nc | xargs)"
chmod 600 mode.json mode.nc
"$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json mode.json --quiet
"$gatewalk" build "$scenes/single_gate.toml" --trials 1 -o mode.nc --quiet >/dev/null
[ "$(stat -c %a mode.json mode.nc | xargs)" = '600 600' ] || fail "modes of replaced files: $(stat -c %a mode.json mode.nc | xargs)"
mkfifo pipe
timeout 20 cat pipe >piped.json &
reader=$!
timeout 20 "$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json pipe --quiet || fail "a named pipe"
wait $reader
cmp -s piped.json gate.json || fail "another result through a named pipe"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --quiet --json >(cat >substituted.json) || fail "a process substitution"
for _ in 1 2 3 4 5 6 7 8 9 10; do cmp -s substituted.json gate.json && break; sleep 0.1; done
cmp -s substituted.json gate.json || fail "another result through a process substitution"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json /dev/stdout | cmp -s - gate.json || fail "/dev/stdout is not standard output"
expect 0 'trapped' "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json /dev/null
expect 2 'cannot go to standard output' "$gatewalk" build "$scenes/single_gate.toml" -o /dev/stdout
expect 1 'No space left on device' "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json /dev/full

# A large file of another kind is refused at once and in little memory.
truncate -s 3G zeros.nc
(printf '\211HDF\r\n\032\n'; head -c 100 /dev/zero) >large.nc && truncate -s 3G large.nc
expect 2 'field.toml: not a NetCDF-4 file, but a scene .* gatewalk build' "$gatewalk" walk "$scenes/field.toml"
expect 2 'zeros.nc: not a NetCDF-4 file' bash -c "ulimit -v 2000000; $gatewalk show zeros.nc"
expect 2 'large.nc: has 3221225472 bytes, more than' bash -c "ulimit -v 2000000; $gatewalk show large.nc"
rm zeros.nc large.nc

# --strict: status 1 for a result that is not clean, which is written all the same.
expect 1 'strict: .* the exit status is 1; the result is written' "$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200 --json strict.json --quiet --strict
cmp -s strict.json paper.json || fail "--strict: another result"
expect 0 'traversed' "$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --strict
expect 1 'strict' "$gatewalk" sweep "$scenes/single_gate.toml" --trials 50 --vary run.method=stable,paper --strict
expect 1 'strict' "$gatewalk" lattice "$scenes/field.toml" --set run.method=paper --trials 50 --strict
expect 1 'strict' "$gatewalk" build "$scenes/field.toml" --set run.method=paper --trials 5 -o strict.nc --strict
cmp -s strict.nc paper.nc || fail "--strict: another matrix"
expect 1 'strict' "$gatewalk" predict paper.nc --strict
expect 1 'strict' "$gatewalk" walk paper.nc --strict
expect 0 'trapped' "$gatewalk" predict m.nc --strict

# Help of a command, and the command that was meant.
"$gatewalk" build --help >help.txt
"$gatewalk" help build | cmp -s - help.txt || fail "help build is not build --help"
expect 0 'usage: gatewalk' "$gatewalk" help
expect 0 'exit status: 0 fine, 1 failure (with --strict' "$gatewalk" --help
expect 2 'did you mean build?' "$gatewalk" biuld
expect 2 'did you mean predict?' "$gatewalk" help predictt
expect 2 'did you mean chart-field?' "$gatewalk" chart_field
"$gatewalk" fly 2>&1 | grep -q 'did you mean' && fail "fly is no misspelled command"

# Names that are no UTF-8 stop no command.
odd=$(printf 'odd\377')
cp "$scenes/field.toml" "$odd.toml"
expect 0 'traversed' "$gatewalk" gate "$odd.toml" --trials 5 --json odd.json
expect 0 '' "$gatewalk" trace "$odd.toml" --json odd.json --replay odd.html --netcdf odd.nc --csv odd.csv
expect 0 '' "$gatewalk" landscape "$odd.toml" -o "$odd" --trials 5
expect 0 '' "$gatewalk" build "$odd.toml" --trials 1 -o "$odd.nc" --json odd.json
expect 0 '' "$gatewalk" show "$odd.nc" --json odd.json
expect 0 '' "$gatewalk" predict "$odd.nc" --row "0=$odd.nc" --json odd.json
expect 0 '' "$gatewalk" chart "$odd.toml" -o odd-chart --trials 5 --repeats 1 --methods stable --quiet
jq -e . odd.json odd-chart/chart.json "$odd/landscape.json" >/dev/null || fail "a name that is no UTF-8 breaks the JSON"

# SIGHUP ends like ctrl-C; a signal that was ignored at the start stays ignored.
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

[ $failures = 0 ] || exit 1
echo "all fine"
