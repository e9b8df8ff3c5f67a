#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests recorded runs, and cells of another program.   recorded_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
tracks=$scenes/tracks

# Few bodies: an answer without error bars, with a message.
expect 0 '^Recorded: 12 bodies, 12 trials, 40 passages; 31 left their cell, 7 were trapped, 2 lost.$' \
  "$gatewalk" build "$tracks/runs.csv" --cell "$tracks/cell.toml" -o few.nc --json build.json
holds '.recorded.bodies == 12 and .recorded.lost == 2 and .inputs == 9' build.json
expect 0 'no error bars: they need 16 bodies' "$gatewalk" predict few.nc --json few.json
holds '.error_95 == null and (.endings | add) > 0.999 and (.endings | add) < 1.001' few.json
holds '.recorded.lost_bounds.if_trapped.trapped >= .recorded.lost_bounds.if_left.trapped' few.json
expect 0 '9 rows, 10 columns' "$gatewalk" show few.nc --rows
expect 0 'SVG\|^' "$gatewalk" predict few.nc --figure few.svg
expect 2 'has no meaning for recorded runs' "$gatewalk" build "$tracks/runs.csv" --cell "$tracks/cell.toml" -o x.nc --accuracy 0.1
expect 2 'whose runs were recorded' "$gatewalk" predict few.nc --gate-runs 100
expect 2 'is for a matrix of a scene' "$gatewalk" predict few.nc --first-runs 100
expect 2 'must be seen, or' "$gatewalk" predict few.nc --start Q:0,0,1

expect 0 'all entries that were seen first' "$gatewalk" walk few.nc --details --walks 100 --json walk.json
holds '.start_state == "as seen" and .walks == 100' walk.json
expect 0 '^From .* and a chain of [0-9]* states\|^From a chain of [0-9]* states' "$gatewalk" analyze few.nc --json analyze.json
holds '.expected_time_s > 0 and .expected_time_s_95 == null and .sensitivities.parameters == []' analyze.json
expect 2 '16 bodies or more' "$gatewalk" power few.nc
expect 2 'whose runs were recorded' "$gatewalk" analyze few.nc --trials 100
expect 2 'is a matrix' "$gatewalk" rare few.nc

# Many equal bodies: each goes up with probability 3/4 or is trapped, so 0.75^2 cross two rows.
cat >coin.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[field]
columns = 1
rows = 2
max_gates = 0
END
awk 'BEGIN { srand(3); print "body,trial,in,s,out,out_s,time_s"
  for (b = 0; b < 400; ++b) { s = int(1000 * rand()) / 1e4
    for (k = 0; k < 6; ++k) {
      if (rand() < 0.25) { print b ",1,S," s ",trapped,,1"; break }
      next_s = int(1000 * rand()) / 1e4; print b ",1,S," s ",S," next_s ",1"; s = next_s } } }' >coin.csv
"$gatewalk" build coin.csv --cell coin.toml -o coin.nc --quiet >/dev/null || fail "build of coin.csv"
"$gatewalk" predict coin.nc --json coin.json --quiet >/dev/null || fail "predict of coin.nc"
holds '.endings_95.crossed[0] < 0.5625 and .endings_95.crossed[1] > 0.5625' coin.json
holds '.endings_95.crossed[1] - .endings_95.crossed[0] < 0.15' coin.json
"$gatewalk" predict coin.nc --json again.json --quiet --threads 1 >/dev/null
[ "$(jq -c '[.endings, .endings_95, .error_95]' coin.json)" = "$(jq -c '[.endings, .endings_95, .error_95]' again.json)" ] ||
  fail "another number of threads, another answer"

# Known answers: 1 + 3/4 cells of a second each.
"$gatewalk" analyze coin.nc --json coins.json --quiet >/dev/null || fail "analyze of coin.nc"
holds '.expected_gates_95[0] < 1.75 and .expected_gates_95[1] > 1.75 and ((.expected_time_s - .expected_gates) | fabs) < 1e-9' coins.json
"$gatewalk" walk coin.nc --walks 100000 --json walks.json --quiet >/dev/null || fail "walk of coin.nc"
# Walks draw from the states of the file, which are larger than those of the predicted endings.
[ "$(jq -n --slurpfile w walks.json --slurpfile p coin.json \
  '$p[0].endings_95.crossed as $i | $w[0].endings.crossed / 1e5 | . > $i[0] and . < $i[1]')" = true ] || fail "walks of coin.nc"
expect 0 'you need [a-z ]*[0-9]* trials' "$gatewalk" power coin.nc --json power.json
holds '.from_prediction.endings.crossed[2].trials > 10' power.json

# Five coordinates, of which a and b matter: a body goes on with probability 0.9 if they have the same sign, else 0.3,
# and each keeps its sign with probability 0.8. So 0.2619 cross three rows; without a and b it would be 0.6^3.
{
  sed 's/^rows = 2/rows = 3/' coin.toml | sed '/^\[\[cell.coordinates/,/^scale/d'
  for name in a b c d e; do printf '[[cell.coordinates]]\nname = "%s"\nunit = "1"\n' $name; done
} >five.toml
awk 'function draw() { x = x * 16807 % 2147483647; return x / 2147483647 }
  function size() { return 0.01 + int(1000 * draw()) / 1000 }
  function keep(v) { return (v > 0) == (draw() < 0.8) ? size() : -size() }
  function entry() { return a "," b "," (draw() - 0.5) "," (draw() - 0.5) "," (draw() - 0.5) }
  BEGIN { x = 5; print "body,trial,in,a,b,c,d,e,out,out_a,out_b,out_c,out_d,out_e,time_s"
    for (body = 0; body < 3000; ++body) { a = keep(draw() - 0.5); b = keep(draw() - 0.5); now = entry()
      for (k = 0; k < 6; ++k) {
        if (draw() > (a * b > 0 ? 0.9 : 0.3)) { print body ",1,S," now ",trapped,,,,,,1"; break }
        a = keep(a); b = keep(b); after = entry(); print body ",1,S," now ",S," after ",1"; now = after } } }' >five.csv
"$gatewalk" build five.csv --cell five.toml -o five.nc --quiet >/dev/null || fail "build of five.csv"
"$gatewalk" predict five.nc --json five.json --quiet >/dev/null || fail "predict of five.nc"
holds '.endings_95.crossed[0] < 0.26188 and .endings_95.crossed[1] > 0.26188' five.json
holds '.endings_95.crossed[0] > 0.6 * 0.6 * 0.6 and .endings_95.crossed[1] - .endings_95.crossed[0] < 0.08' five.json
expect 0 'd \[' "$gatewalk" show five.nc --row 2
expect 0 'start a 0.3' "$gatewalk" predict five.nc --start S:0.3,0.3,0,0,0
expect 2 'must be' "$gatewalk" predict five.nc --start S:0.3,0.3,0
{
  cat five.toml
  for name in f g h i; do printf '[[cell.coordinates]]\nname = "%s"\nunit = "1"\n' $name; done
} >nine.toml
expect 2 'more than 8 are not permitted' "$gatewalk" build five.csv --cell nine.toml -o x.nc

# Simulated trials as recorded ones: the table reads back, and its chain is the trials' own.
expect 0 'crossed' "$gatewalk" lattice "$scenes/field.toml" --set field.rows=2 --set forces.propulsion_N=9 --trials 2000 \
  --passages runs.csv --cell-file gates.toml --json lattice.json
"$gatewalk" lattice "$scenes/field.toml" --set field.rows=2 --set forces.propulsion_N=9 --trials 2000 --json plain.json --quiet >/dev/null
[ "$(jq -c '[.endings, .final_gates, .costs]' lattice.json)" = "$(jq -c '[.endings, .final_gates, .costs]' plain.json)" ] ||
  fail "--passages changes the trials"
expect 0 '2000 bodies, 2000 trials' "$gatewalk" build runs.csv --cell gates.toml -o gates.nc
"$gatewalk" predict gates.nc --json gates.json --quiet >/dev/null || fail "predict of gates.nc"
jq -n --slurpfile l lattice.json --slurpfile p gates.json '[$l[0].endings | to_entries[] |
  select($p[0].endings_95[.key][0] - 0.02 > .value / 2000 or $p[0].endings_95[.key][1] + 0.02 < .value / 2000)] | length == 0' |
  grep -q true || fail "the chain of passages is not the trials'"

# One half of the bodies against the other.
expect 0 'One half of the bodies predicts the other' "$gatewalk" validate coin.nc --json halves.json
holds '.differs == false and .p > 0.05 and (.halves | length == 2) and ([.halves[] | .bodies == 200 and .trials.compared == 200 and .trials.seen_to_their_end == 200] | all)' halves.json
holds '[.halves[] | ((.seen.endings | add) - 1 | fabs) < 1e-9 and ((.chain.endings | add) - 1 | fabs) < 1e-9] | all' halves.json
holds '.memory.runs == 0 and (.memory.verdict | test("cannot be asked"))' halves.json
"$gatewalk" validate coin.nc --json again.json --quiet --threads 1 >/dev/null
[ "$(jq -c '[.halves, .p, .memory]' halves.json)" = "$(jq -c '[.halves, .p, .memory]' again.json)" ] ||
  fail "validate: another number of threads, another answer"
# Half of the bodies mostly go up, the others mostly do not, which no chain of states predicts.
awk 'BEGIN { srand(4); print "body,trial,in,s,out,out_s,time_s"
  for (b = 0; b < 400; ++b) { s = int(1000 * rand()) / 1e4
    for (k = 0; k < 6; ++k) {
      if (rand() < (b % 2 ? 0.05 : 0.6)) { print b ",1,S," s ",trapped,,1"; break }
      next_s = int(1000 * rand()) / 1e4; print b ",1,S," s ",S," next_s ",1"; s = next_s } } }' >unlike.csv
"$gatewalk" build unlike.csv --cell coin.toml -o unlike.nc --quiet >/dev/null || fail "build of unlike.csv"
expect 0 '^Largest difference: crossed' "$gatewalk" validate unlike.nc --figure halves.svg --json unlike.json
holds '.differs and .p < 0.05' unlike.json
expect 2 'two halves need 32 bodies at least, these are 12' "$gatewalk" validate few.nc
expect 2 'has no meaning for' "$gatewalk" validate coin.nc --trials 100
# Recorded bodies get no more by a smaller --accuracy; counts are compared with a scene.
"$gatewalk" power unlike.nc --details >power.txt 2>/dev/null
grep -q "^Beware: ?: within the error bar (more recorded bodies help). Trials of one animal count less.$" power.txt && grep -q '^?: .* as much; more recorded bodies help' power.txt || fail "power: what helps recorded bodies: $(cat power.txt)"
grep -e '--accuracy' power.txt && fail "power of recorded bodies advises --accuracy"
expect 2 'counts are compared with a scene: gatewalk validate SCENE --observed seen.csv. Without --observed, ' "$gatewalk" validate coin.nc --observed seen.csv

# Two types without a map: the first stands everywhere, also where bodies began in the other. One type of cells traps no
# body, the other traps all.
cat >types.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[[cell.types]]
name = "soft"
[[cell.types]]
name = "hard"
[field]
columns = 1
rows = 2
max_gates = 0
END
awk 'BEGIN {
  print "body,trial,type,in,s,out,out_s,time_s"
  for (b = 0; b < 400; ++b) {
    s = 0.1 * b / 400
    if (b % 2) { print b ",1,soft,S," s ",S,0.05,1"; print b ",1,hard,S,0.05,trapped,,1" }
    else print b ",1,hard,S," s ",trapped,,1"
  }
}' >types.csv
expect 0 '^hard  ' "$gatewalk" build types.csv --cell types.toml -o types.nc
"$gatewalk" predict types.nc --json types.json --quiet >/dev/null
holds '.endings.crossed > 0.999' types.json
expect 0 '^One half of the bodies' "$gatewalk" validate types.nc --null-draws 99
expect 0 'crossed' "$gatewalk" analyze types.nc
# Symmetric cells do not make starts symmetric: all bodies enter on the right side, and leave to the left.
cat >sides.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
symmetric = true
[[cell.faces]]
name = "S"
move = [0, 1]
odd = ["s"]
[[cell.faces]]
name = "W"
move = [1, 0]
odd = []
[[cell.faces]]
name = "E"
move = [-1, 0]
odd = []
[[cell.coordinates]]
name = "s"
unit = "m"
[field]
columns = 1
rows = 1
max_gates = 0
END
awk 'BEGIN { print "body,trial,in,s,out,out_s,time_s"; for (b = 0; b < 100; ++b) print b ",1,S," 0.02 + 0.0002 * b ",E,0.01,1" }' >sides.csv
"$gatewalk" build sides.csv --cell sides.toml -o sides.nc --quiet >/dev/null 2>&1
"$gatewalk" predict sides.nc --json sides.json --quiet >/dev/null 2>&1
holds '.endings.left_side == 1 and .endings.right_side == 0' sides.json
# In millimetres, in place of metres.
awk -F, -v OFS=, 'NR > 1 { $4 *= 1000 } { print }' sides.csv >mm.csv
expect 0 's is up to 39.8 m, and a cell is 0.1 m large: is it in metres' "$gatewalk" build mm.csv --cell sides.toml -o mm.nc
# Files that are easily taken for a scene.
expect 2 'is a table, and no scene: .* gatewalk build TABLE --cell' "$gatewalk" predict sides.csv
expect 2 'is a table, and no scene' "$gatewalk" build sides.csv -o x.nc
expect 2 'has cells of another kind, \[cell\]: --cell-program' "$gatewalk" predict sides.toml
for command in gate lattice validate trace 'landscape -o folder' 'sweep --vary forces.random_N=1'; do
  # shellcheck disable=SC2086
  expect 2 '^gatewalk: sides.csv: is a table, and no scene: .* gatewalk build TABLE --cell' "$gatewalk" $command sides.csv
  # shellcheck disable=SC2086
  expect 2 '^gatewalk: sides.toml: has cells of another kind, \[cell\]: .* gatewalk build TABLE --cell sides.toml' "$gatewalk" $command sides.toml
done
for command in "build sides.csv" "passages sides.csv --fastest 1" "build sides.toml"; do
  # shellcheck disable=SC2086
  expect 2 '^gatewalk: sides.csv: is a table, and no file of cells, .*; with --cell CELL.toml the table stands before it$' "$gatewalk" $command --cell sides.csv -o x.nc
done
for command in show walk 'export -o x.mtx'; do
  # shellcheck disable=SC2086
  expect 2 'not a NetCDF-4 file, but a table by its name; of recorded runs gatewalk build TABLE --cell CELL.toml makes a matrix$' "$gatewalk" $command sides.csv
done
expect 2 'more arguments than the command takes (gatewalk passages cuts several recordings into one RUNS.csv); see' "$gatewalk" build sides.csv mm.csv --cell sides.toml -o x.nc
expect 2 'there is no option --cell here: gatewalk build TABLE --cell CELL.toml -o MATRIX.nc makes a matrix of recorded runs; see' "$gatewalk" power sides.csv --cell sides.toml
expect 0 'none on record: runs were recorded' "$gatewalk" show sides.nc
# Nothing is simulated, so nothing can be divided or stopped.
expect 2 'shard has no meaning' "$gatewalk" validate types.nc --shard 1/2 --part x
expect 2 'max-time has no meaning' "$gatewalk" build sides.csv --cell sides.toml -o x.nc --max-time 1s
# Keys of recorded runs can no longer be changed.
expect 2 'has its runs, and only keys of field, terrain and start can be set' "$gatewalk" predict sides.nc --set cell.symmetric=false
# Simulated trials of a scene with terrain come back as recorded runs.
"$gatewalk" lattice "$scenes/mixed.toml" --set run.method=moreau --trials 300 --passages mixed.csv --cell-file mixed.toml --quiet >/dev/null
expect 0 '300 bodies' "$gatewalk" build mixed.csv --cell mixed.toml -o mixed.nc

# Another program's cells.
if command -v python3 >/dev/null; then
  cp "$scenes/programs/pillars.toml" .
  expect 0 '^went back' "$gatewalk" predict pillars.toml --cell-program "python3 $scenes/programs/pillars.py" \
    --accuracy 0.1 --json pillars.json --threads 2 --details
  grep -q '^Trapped: as the cell program says.$' out.txt || fail "predict: a cell program has no file of runs"
  holds '.reached and (.endings | add) > 0.999 and (.endings | add) < 1.001 and .endings.went_back > 0' pillars.json
  "$gatewalk" predict pillars.toml --cell-program "python3 $scenes/programs/pillars.py" --accuracy 0.1 \
    --json one.json --threads 1 --quiet >/dev/null
  [ "$(jq -c .final_gates pillars.json)" = "$(jq -c .final_gates one.json)" ] || fail "threads change bits"
  expect 1 'exit' "$gatewalk" predict pillars.toml --cell-program 'exit 3'
  pillars="python3 $scenes/programs/pillars.py"
  expect 0 '^went back' "$gatewalk" lattice pillars.toml --cell-program "$pillars" --trials 500 --json lattice.json
  holds '.trials == 500 and .endings.went_back > 400 and .costs.all.mean_time_s > 0' lattice.json
  expect 0 'turning_rad_per_sqrt_s' "$gatewalk" analyze pillars.toml --cell-program "$pillars" --accuracy 0.1 --runs 300 --details \
    --trials 200 --json analyze.json
  holds '.direct.trials == 200 and (.sensitivities.parameters | length) == 2' analyze.json
  expect 0 'p = ' "$gatewalk" validate pillars.toml --cell-program "$pillars" --accuracy 0.1 \
    --trials 500 --null-draws 199 --json validate.json
  holds '.starts[0].endings.dynamics.went_back > 400 and .crossings.by_face.N > 0' validate.json
  expect 0 'you need [a-z ]*[0-9]* trials' "$gatewalk" power pillars.toml --cell-program "$pillars" --accuracy 0.1 --set parameters.radius_m=0.2
  expect 2 'may move back' "$gatewalk" rare pillars.toml --cell-program "$pillars" --row 2
  expect 2 "no parameter 'radius'" "$gatewalk" predict pillars.toml --cell-program "$pillars" --set parameters.radius=0.2
  expect 0 'bodies' "$gatewalk" build pillars.toml --cell-program "$pillars" --accuracy 0.1 -o pillars.nc
  expect 0 '^went back' "$gatewalk" predict pillars.nc --json kept.json
  # The same runs, from a file or not; other starts add some.
  [ "$(jq -c .final_gates pillars.json)" = "$(jq -c .final_gates kept.json)" ] || fail "the file's runs are others"
  expect 0 '^start W' "$gatewalk" predict pillars.nc --cell-program "$pillars" --start W:0.1,0.2 --json west.json
  holds '.reached and .gate_runs > 0' west.json
  # A figure shows bodies that went back.
  "$gatewalk" predict pillars.nc --figure pillars.svg --quiet >/dev/null && grep -q 'went back' pillars.svg || fail "the figure leaves out who went back"
  # For starts that the file lacks, --first-runs gives their number, without other trials.
  "$gatewalk" predict pillars.nc --cell-program "$pillars" --start W:0.1,0.2 --start S:0.3,0 --first-runs 40 \
    --json first.json --quiet >/dev/null || fail "predict of pillars.nc with 40 first runs"
  holds '.gate_runs == 80 and ([.starts[].first_runs] == [40, 40])' first.json
  expect 2 'holds runs of the program with its own' "$gatewalk" predict pillars.nc --cell-program "$pillars" --set parameters.radius_m=0.2
  # The program's cell must be that of the file.
  sed 's/unit = "m"$/unit = "cm"/; s/s_m/s_cm/' pillars.toml >cm.toml
  expect 2 'the unit of s is m of its cell, cm in cm.toml' "$gatewalk" predict cm.toml --cell-program "$pillars"
  sed 's/move = \[0, -1\]/move = [0, -2]/' pillars.toml >moves.toml
  expect 2 'the move of face N is \[0, -1\] of its cell, \[0, -2\] in moves.toml' "$gatewalk" predict moves.toml --cell-program "$pillars"
  expect 2 'cell-timeout has no meaning without --cell-program' "$gatewalk" predict pillars.nc --cell-timeout 3
  expect 2 'it is for a matrix of a scene' "$gatewalk" predict pillars.nc --cell-program "$pillars" --first-runs 0
  expect 2 'it is for a matrix of a scene, or (above 0) of a cell program' "$gatewalk" predict pillars.nc --first-runs 40
  expect 2 'it is for a matrix of a scene, or (above 0) of a cell program' "$gatewalk" predict pillars.toml --cell-program "$pillars" --first-runs 40
fi
finish
