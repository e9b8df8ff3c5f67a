#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Walks that circle for long or for ever, and imported chains: each share has an answer or a bound, and lies within its
# interval.
#   circles_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
cat >states.csv <<'END'
state,name,move_x,move_y
0,ahead,0,1
1,right,1,0
2,left,-1,0
3,back,0,-1
END
# import FILE OUTPUT ROWS
import() { "$gatewalk" import "$1" --states states.csv --start 0 --set field.rows="$3" --set field.columns=3 --set field.max_gates=0 -o "$2" --force --quiet >/dev/null || fail "import $1"; }
# Every share strictly between 0 and 1 lies strictly within its interval.
within='def inside: .[0] as $s | .[1] as $i | $s <= 0 or $s >= 1 or ($i[0] < $s and $s < $i[1]);
  . as $all | [(.endings | keys[]) as $k | [$all.endings[$k], $all.endings_95[$k]] | inside] | all'

# 3 of 4 go right, and come out ahead after about 10^3 to 10^9 rounds; by hand, all cross in the end.
for others in 999 999999 999999999; do
  printf 'from,to,count\nahead,right,75\nahead,back,25\nright,left,1000\nleft,right,%d\nleft,ahead,1\nback,ahead,10\n' "$others" >long.csv
  import long.csv long.nc 3
  for solver in auto klu; do
    [ "$solver $others" = "klu 999999999" ] && continue # too few digits, and refused
    "$gatewalk" predict long.nc --solver $solver --json long.json --quiet || fail "predict by $solver, $others"
    holds '(.endings.crossed - 0.75 | fabs) < 1e-6 and (.endings.went_back - 0.25 | fabs) < 1e-6 and .still_walking < 1e-6' long.json
    holds "$within" long.json
    holds '.endings_95.crossed | .[0] > 0.6 and .[0] < 0.7 and .[1] > 0.8 and .[1] < 0.88' long.json
    holds '.left_out_matrices == 0' long.json
  done
done
# A sum that stops early because its solver was named says so, and each interval includes the rest.
printf 'from,to,count\nahead,right,75\nahead,back,25\nright,left,1000\nleft,right,999999\nleft,ahead,1\nback,ahead,10\n' >long.csv
import long.csv long.nc 3
expect 0 'were still walking when the sum was stopped' "$gatewalk" predict long.nc --solver propagate --json long.json
holds '.still_walking as $left | .endings_95.crossed[0] <= 0.75 and .endings_95.crossed[1] >= 0.75 and $left > 0.5' long.json

# Half of the walks get into two states without a way out.
printf 'from,to,count\nahead,right,50\nahead,trapped,50\nright,left,1000\nleft,right,1000\n' >never.csv
import never.csv never.nc 2
expect 0 'still walking in states without a way out: 50' "$gatewalk" predict never.nc --details --json never.json
grep -q '^gatewalk: .*50.00 % were still walking in states without a way out' out.txt || fail "no warning of walks that never end"
holds '.endings.trapped == 0.5 and .still_walking == 0.5 and .endings_95.trapped[0] > 0.38 and .endings_95.trapped[1] == 1 and .endings_95.crossed[1] >= 0.5' never.json
expect 2 "solver march .*solvers auto and klu" "$gatewalk" predict long.nc --solver march
"$gatewalk" walk never.nc --walks 20 --json walked.json --quiet 2>/dev/null || fail "walk"
holds '.still_walking as $left | .endings.cut_off == 0 and $left > 0 and .still_walking_95[0] < $left and $left < .still_walking_95[1]' walked.json
holds '([.final_gates[][]] | add) == 20 - .still_walking and .final_gates == .trapped_gates' walked.json

# A sum that would stop with walks under way gives no answer. Half of the walks circle for ever. A walk to and fro in
# 501 columns leaves after 251^2 gates, more than a sum adds up.
expect 0 'visits, times and costs are not known: 50 % of the walks' "$gatewalk" analyze never.nc --json analyzed.json
holds '.expected_gates == null and (.why_no_interval.expected_gates | startswith("50 %")) and .endings.trapped == 0.5 and .still_walking == 0.5' analyzed.json
holds '[.expected_visits[][] | . == null] | all' analyzed.json
printf 'from,to,count\nright,right,50\nright,left,50\nleft,left,50\nleft,right,50\n' >fro.csv
"$gatewalk" import fro.csv --states states.csv --start right --set field.rows=1 --set field.columns=501 --set field.max_gates=0 -o fro.nc --force --quiet >/dev/null || fail "import fro.csv"
expect 0 'visits, times and costs are not known' "$gatewalk" analyze fro.nc --paths 0 --json fro.json
holds '.expected_gates == null and (.endings.left_side + .endings.right_side - 1 | fabs) < 1e-6 and .still_walking < 1e-6' fro.json

# A row that half of the walks pass has a single run. It excludes hardly anything, however many runs the start has.
printf 'from,to,count\nahead,right,50000\nahead,trapped,50000\nright,ahead,1\n' >few.csv
import few.csv few.nc 1
"$gatewalk" predict few.nc --json few.json --quiet || fail "predict few.nc"
holds '.endings.crossed == 0.5 and .endings_95.crossed[0] < 0.1 and .endings_95.crossed[1] <= 1' few.json

# Counts that no experiment could give are no error.
printf 'from,to,count\nahead,ahead,300000000052\nahead,trapped,30000000004\n' >many.csv
import many.csv many.nc 2
"$gatewalk" predict many.nc --json many.json --quiet || fail "predict many.nc"
holds "$within" many.json

# Trees count a run together with its mirror image, and import knows it. In trajectories each run counts once.
"$gatewalk" build "$scenes/field.toml" --accuracy 0.05 -o tree.nc --quiet >/dev/null 2>&1
"$gatewalk" predict tree.nc --first-runs 0 --json own.json --quiet
start=$(jq .start_state.input own.json)
expect 0 'count each run and its mirror image' "$gatewalk" export tree.nc --gate --counts -o g.mtx
[ "$(head -n 1 g.states.csv | grep -c ',counts_per_run$')" = 1 ] || fail "no counts_per_run in g.states.csv"
# Matrix files of one name share the table of states, which therefore says the same for each of them.
cp g.states.csv first.csv
for file in g.csv g.dtrajs; do
  "$gatewalk" export tree.nc $([ $file = g.dtrajs ] || echo --gate) -o $file --quiet >/dev/null || fail "export $file"
  cmp -s g.states.csv first.csv || fail "$file: g.mtx lost its states"
done
expect 2 '^gatewalk: g.states.csv has the states of g.mtx, which are others: give -o another name$' "$gatewalk" export tree.nc -o g.npz
cmp -s g.states.csv first.csv && [ ! -e g.npz ] || fail "a refused export wrote files"
mkdir forced && cp g.mtx g.states.csv forced
expect 0 'g.states.csv has the states of forced/g.mtx, which are others: they are replaced$' "$gatewalk" export tree.nc -o forced/g.npz --force
"$gatewalk" export tree.nc -o runs.dtrajs --quiet >/dev/null
for file in g.mtx runs.dtrajs; do
  "$gatewalk" import $file --states g.states.csv --start "$start" --set field.rows=9 --set field.columns=9 --set field.max_gates=13 -o back.nc --force >back.txt 2>&1 || fail "import $file"
  "$gatewalk" predict back.nc --json $file.json --quiet
  holds "$within" $file.json
done
expect 0 'intervals count each run once' "$gatewalk" import g.mtx --states g.states.csv --start "$start" -o back.nc --force --json back.json
grep -q "^[0-9]* entries are above 0, from $(jq .gate_runs back.json) counted runs" out.txt || fail "import: runs are not named: $(cat out.txt)"
holds '2 * .gate_runs == .counts' back.json
expect 0 "^  counted runs  *$(jq .gate_runs back.json) (counts, with mirror images: $(jq .counts back.json))" "$gatewalk" show back.nc
# (The states have another order, so the intervals come from other draws.)
jq -s '[.[] | .endings.trapped, (.endings_95.trapped | .[1] - .[0]), .endings.cut_off] as [$a, $wa, $ca, $b, $wb, $cb] | (($a - $b) | fabs) < 1e-12 and (($ca - $cb) | fabs) < 1e-12 and (($wb / $wa - 1) | fabs) < 0.15' own.json g.mtx.json | grep -q true || fail "counts come back with other shares or intervals: $(jq -c '[.endings.trapped, .endings_95.trapped]' own.json g.mtx.json)"
# Without the mirror images the result is the same within its error, with intervals about as wide.
jq -s '[.[] | .endings.trapped, (.endings_95.trapped | .[1] - .[0])] as [$a, $wa, $b, $wb] | (($a - $b) | fabs) < $wa / 2 and $wb < 1.7 * $wa and $wb > 0.7 * $wa' own.json runs.dtrajs.json | grep -q true || fail "trajectories: $(jq -c '[.endings.trapped, .endings_95.trapped]' own.json runs.dtrajs.json)"
"$gatewalk" export back.nc --gate --counts -o again.mtx --quiet >/dev/null
cmp -s g.states.csv again.states.csv || [ "$(head -n 1 again.states.csv | grep -c ',counts_per_run$')" = 1 ] || fail "counts_per_run is lost"
sed 's/,2$/,3/' g.states.csv >bad.states.csv
expect 2 'bad.states.csv:[0-9]*: counts_per_run must be 1, or 2' "$gatewalk" import g.mtx --states bad.states.csv --start "$start" -o bad.nc
finish
