#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests analyze, from a scene and from its matrix file: the keys that scripts rely on, and the mean times and works of trials.
#   analyze_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

fast=(--set run.method=moreau --set field.rows=4 --set forces.propulsion_N=8.5)
"$gatewalk" analyze "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 --runs 300 --trials 4000 --json analysis.json --quiet
holds '.endings_95.crossed[0] < .endings.crossed and .endings.trapped > 0.3' analysis.json
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
expect 0 'no body ends as "cut off" here' "$gatewalk" analyze fast.nc --set field.max_gates=0 --target cut_off --runs 100
expect 0 'every body ends as "crossed" here' "$gatewalk" analyze "$scenes/walker.toml" --accuracy 0.2 --json certain.json
holds '.sensitivities.parameters == [] and .sensitivities.gate_runs == 0' certain.json
expect 2 'must lie in \[1e-06, 0.5\]' "$gatewalk" analyze fast.nc --step 0.7
for lump in 3,1 3,1,2,1 0,1,1 3,1,x; do expect 2 'must be 3 whole numbers from 1 to 1000' "$gatewalk" analyze fast.nc --lump $lump; done
expect 0 '^Merged into [0-9]* states (--lump), the chain errs by a total variation of 0' "$gatewalk" analyze fast.nc --runs 0 --lump 3,1,2 --json lump.json
holds '.lumping | .parts == [3, 1, 2] and .count > 6 and .count <= 31 and .error.final_gates > 0' lump.json
"$gatewalk" build "$scenes/field.toml" --bins paper --trials 2 -o bins.nc --quiet
"$gatewalk" analyze bins.nc --runs 200 --json bins.json --quiet
holds '.expected_seconds > 10 and .expected_seconds_95 == null and .endings_95.trapped[0] > 0 and .quasi_stationary.survival_per_gate > 0' bins.json
expect 2 'keeps no gate runs' "$gatewalk" analyze bins.nc --accuracy 0.1
"$gatewalk" lattice "$scenes/field.toml" "${fast[@]}" --trials 500 --json lattice_costs.json --quiet
holds '.costs.all | .trials == 500 and .mean_time_s > 0 and .quantiles_time_s[0] < .quantiles_time_s[4]' lattice_costs.json
holds '([.costs | to_entries[] | select(.key != "all") | .value.trials] | add) == 500' lattice_costs.json

# An influence is a slope over one step: the screen says what that step changed, or "steep" where 1 % or the step changes more
# than a tenth of the chance, or where more and less differ; a smaller step changes none of this.
printf 'forces = { propulsion_N = 8, random_N = 50 }\nbeams = { joint_x_cm = 2500 }\nfield = { columns = 5, rows = 3 }\n' >small.toml
for step in 0.02 0.001; do
  "$gatewalk" analyze small.toml --accuracy 0.2 --runs 400 --step $step --json steps.json --force >steps.txt 2>/dev/null
  percent=$(jq -n "$step * 100")
  grep -q "^Largest influences on \"crossed\" (a slope: % of its chance per % of the number, over +-$percent %):$" steps.txt || fail "analyze: no slopes: $(cat steps.txt)"
  grep -q 'becomes' steps.txt && fail "analyze: a slope is told as an effect"
  sed -n 's/^  \([a-z]*\.[a-zA-Z_]*\)  .*/\1/p' steps.txt >keys.txt
  [ -s keys.txt ] || fail "analyze: no influences: $(cat steps.txt)"
  while read -r key; do
    steep=$(jq --arg key "$key" --argjson step $step '.sensitivities.parameters[] | select(.key == $key) | .bends or
      ([.elasticity, .with_more, .with_less] | map(select(. != null) | fabs * ([$step, 0.01] | max)) | max > 0.1)' steps.json)
    points=$(jq --arg key "$key" --argjson step $step '.endings.crossed as $p | .sensitivities.parameters[] | select(.key == $key) | 100 * $p * $step * .elasticity' steps.json)
    case $steep in
      true) grep -q "^  $key .* steep$" steps.txt || fail "analyze: $key is steep: $(cat steps.txt)" ;;
      *) grep -q "^  $key .* $(printf '%+.2f' "$points") points for $percent % more$\|^  $key .*no interval" steps.txt || fail "analyze: $key changes $points points: $(cat steps.txt)" ;;
    esac
  done <keys.txt
  ! grep -q ' steep$' steps.txt || grep -q '^Beware: steep: the slope may not hold for 1 %; gatewalk predict SCENE --set KEY=VALUE tells.$' steps.txt || fail "analyze: does not warn of steep slopes: $(cat steps.txt)"
  cp steps.txt steps-$step.txt
done
grep -q ' steep$' steps.txt || fail "analyze: nothing is steep at a small step: $(cat steps.txt)"
# The number that matters most, 1 % larger, in the unit of the file; of one gate a range for sweep.
grep -q '^Next: gatewalk predict small.toml --accuracy 0.2 --set beams.joint_x_cm=2525  # with 1 % more of it$' steps-0.02.txt || fail "analyze: proposes another value: $(cat steps-0.02.txt)"
"$gatewalk" analyze small.toml --accuracy 0.2 --runs 400 --set beams.joint_x_m=25.5 >set.txt 2>/dev/null
grep '^Next: ' -A 1 set.txt | tr -d '\n' | grep -q -e '--set beams.joint_x_m=25.5 .*--set [a-z]*[.][a-zA-Z_]*=[0-9.e-]*  # with 1 % more of it$' || fail "analyze: proposes no predict: $(cat set.txt)"
"$gatewalk" analyze small.toml --accuracy 0.2 --runs 400 --set field.columns=1 --set field.rows=1 >gate.txt 2>/dev/null
grep -q '^Next: gatewalk sweep small.toml ' gate.txt && grep -q -e '--vary [a-z]*[.].*:.*:.*  # varies it in one gate$' gate.txt || fail "analyze of one gate proposes no sweep"
# A field whose start is not in the middle: each command says so, and no other.
for command in "predict small.toml --accuracy 0.3" "lattice small.toml --trials 20" "analyze small.toml --accuracy 0.3 --runs 0" "validate small.toml --accuracy 0.3 --trials 20 --start 0,0,15 --null-draws 99"; do
  # shellcheck disable=SC2086
  "$gatewalk" $command --set field.columns=6 >even.txt 2>/dev/null
  [ "$(grep -c '^6 columns: 3 to the left of the start and 2 to its right. This alone makes the sides differ.$' even.txt)" = 1 ] || fail "an even number of columns: $command: $(cat even.txt)"
  [ "$(wc -l <even.txt)" -le 15 ] || fail "too many lines: $command: $(cat even.txt)"
  # shellcheck disable=SC2086
  "$gatewalk" $command 2>/dev/null | grep 'columns: ' && fail "an odd number of columns: $command"
done
# A share far below what the trials can show has no digits of its own.
sed -n '/^\$ cat mine.toml$/,/^\$ /p' "$scenes/../README.md" | grep -v '^\$' >mine.toml
"$gatewalk" predict mine.toml --accuracy 0.1 --json rare.json >rare.txt 2>/dev/null
holds '.endings.left_side | . > 0 and . < 5e-5' rare.json
grep -q '^left side  *0.00 %  \[0.00, 0.[0-9]*\]$' rare.txt || fail "more digits than the trials can tell: $(cat rare.txt)"

# The list of starts has at most the 300 that are entered most.
holds '(.starts | length) == 300 and .starts_in_all > 300 and ([.starts[].runs] | min) > 0' analysis.json
expect 0 "the 300 of $(jq .starts_in_all analysis.json) ways to enter" "$gatewalk" analyze fast.nc --runs 0 --details
holds '(.starts | length) == .starts_in_all' bins.json

# A face leads back, and there is no limit of gates. This is a gambler who has 1 of 5 and wins with probability 0.4:
# with r = 1.5 the probability is (r - 1) / (r^5 - 1) = 16/211, and the games are n / 0.2 - 5 / 0.2 times that.
printf 'state,name,move_x,move_y\n0,won,0,1\n1,lost,0,-1\n' >games.csv
printf 'from,to,count\nwon,won,2\nwon,lost,3\nlost,won,2\nlost,lost,3\n' >ruin.csv
"$gatewalk" import ruin.csv --states games.csv --start 0 --set field.rows=4 --set field.columns=1 --set field.max_gates=0 -o ruin.nc --quiet
"$gatewalk" analyze ruin.nc --json ruin.json --quiet || fail "analyze of a face that leads back"
holds '(.target_probability - 16 / 211 | fabs) < 1e-12 and (.expected_gates - (5 - 25 * 16 / 211) | fabs) < 1e-10' ruin.json

# With few bodies the mean time has no interval, and says why: a group may have missed the slowest bodies.
cat >short.toml <<'END'
[body]
mass_kg = 2.427
radius_m = 85.23
[beams]
length_m = 213.1
mass_kg = 0.2427
stiffness_left_Nm_per_rad = 3.09e6
stiffness_right_Nm_per_rad = 3.369e6
damping_Nms_per_rad = 0.0
joint_x_m = 213.1
joint_y_m = 255.7
[forces]
propulsion_N = 2099.0
random_N = 5636.0
random_rate_Hz = 200.8
drag_Ns_per_m = 0.254
[contact]
restitution = 0
tip_restitution = 1
[run]
time_limit_s = 2.989
traverse_y_m = 511.4
[field]
columns = 4
rows = 6
max_gates = 5
[start]
x_m = 134.8
vx_m_per_s = 405.0
vy_m_per_s = 698.9
END
"$gatewalk" analyze short.toml --runs 0 --seed 100 --details --json short.json >short.txt 2>/dev/null
holds '.by_ending.trapped | .probability < 0.5 and .mean_time_s > 3 and .mean_time_s_95 == null and (.why_no_interval.mean_time_s | test("runs, fewer than 100$"))' short.json
holds '.by_ending.right_side | .probability > 0.7 and .mean_time_s_95[0] < .mean_time_s and .mean_time_s < .mean_time_s_95[1]' short.json
tr '\n' ' ' <short.txt | grep -q 'These means have no interval: .*trapped,  *[0-9]* runs, *fewer than 100' || fail "analyze: no word of a mean of few runs"

# The share of each number in the variance over its range.
over=(analyze "$scenes/field.toml" --set run.method=moreau --set field.rows=2 --accuracy 0.2 --runs 0 --quiet)
ranges=(--over forces.propulsion_N=4:9 --over beams.mass_kg=0.1:0.11)
"$gatewalk" "${over[@]}" "${ranges[@]}" --over-trials 30000 --json over.json --figure over.svg || fail "--over"
grep -q 'share of the variance' over.svg || fail "no picture of the variance"
holds '.variance_shares | .of == "crossed" and (.numbers | length) == 2 and .numbers[0].low == 4 and .trials <= 30000' over.json
holds '.variance_shares.numbers | .[0].first > 0.8 and .[0].total_95[0] > 0.8 and .[1].total < 0.2 and .[1].first_95[0] < 0.05' over.json
"$gatewalk" "${over[@]}" "${ranges[@]}" --over-trials 30000 --threads 1 --json - | jq .variance_shares.numbers >one.json
jq .variance_shares.numbers over.json | cmp -s - one.json || fail "--over: another number of threads gave another answer"
"$gatewalk" "${over[@]}" --json - | jq -e '.variance_shares == null' >/dev/null || fail "without --over there are shares"
expect 0 'it does not$\|it does not vary' "$gatewalk" "${over[@]:0:8}" --runs 0 --over beams.mass_kg=0.1:0.1001 --over-trials 10000
expect 0 'none of [0-9]* trials ended' "$gatewalk" "${over[@]:0:8}" --runs 0 --set field.rows=9 --set forces.random_N=0 \
  --over forces.propulsion_N=0.1:0.2 --over-trials 10000
expect 2 "varies the scene's start" "$gatewalk" "${over[@]}" --start 0,0,15 --over start.vy_m_per_s=10:20
expect 2 'must be KEY=LOW:HIGH' "$gatewalk" "${over[@]}" --over forces.propulsion_N=4
expect 2 "^gatewalk: --over field.rows=[0-9.]* *:\|--over field.rows" "$gatewalk" "${over[@]:0:4}" --over field.rows=3:9
expect 2 'has no effect: field.rows is varied' "$gatewalk" "${over[@]}" --over field.rows=3:9
expect 2 'at most 4 numbers' "$gatewalk" "${over[@]}" "${ranges[@]}" --over a=1:2 --over b=1:2 --over c=1:2
expect 2 'must be at least 4096' "$gatewalk" "${over[@]}" "${ranges[@]}" --over-trials 4000
expect 2 'is for --over' "$gatewalk" "${over[@]}" --over-trials 50000
expect 2 'is for a scene, or a program.s cells, whose numbers vary' "$gatewalk" analyze fast.nc "${ranges[@]}"
# The start is a ring on the map of visits and on that of starts, black on white (gnuplot's symbol gpPt5 in an SVG).
rings() { grep -o "#gpPt5' transform='translate([0-9.,]*)[^/]*color='rgb(  0,   0,   0)'" "$1" | sed 's/.*translate(\([0-9.]*\),\([0-9.]*\)).*/\1 \2/'; }
for start in -12,0,15 12,0,15 12,0,25; do
  "$gatewalk" analyze "$scenes/field.toml" --set run.method=moreau --accuracy 0.1 --runs 0 --target left_side --start=$start --figure start.svg --quiet >/dev/null
  rings start.svg >"rings_$start.txt"
  [ "$(wc -l <"rings_$start.txt")" = 2 ] || fail "not two rings for the start $start: $(cat "rings_$start.txt")"
done
# A start further right moves both rings; a faster start moves only the ring on the map of starts, upwards.
paste rings_-12,0,15.txt rings_12,0,15.txt rings_12,0,25.txt | awk '!($3 > $1) || NR == 1 && !($4 == $2 && $5 == $3 && $6 == $4) ||
  NR == 2 && $6 >= $4 { exit 1 }' || fail "rings are not where bodies start: $(paste rings_*.txt)"

finish
