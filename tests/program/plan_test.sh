#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests plan: which action to take in each gate.   plan_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

actions=(--set actions.slow.forces.propulsion_N=6 --set actions.fast.forces.propulsion_N=9)
small=("$scenes/field.toml" --set run.method=moreau --set field.rows=3 --accuracy 0.1)
expect 0 '^Chance to cross: [0-9.]* \[[0-9., ]*\] % in 97 new trials that were not used in the search.$' "$gatewalk" plan "${small[@]}" "${actions[@]}" --json plan.json --figure plan.svg --policy fast.json
holds '.crossed > 0 and .crossed_95[0] < .crossed and .crossed < .crossed_95[1] and .trials == 97 and [.actions[].name] == ["fast", "slow"] and (.best_alone == "fast" or .best_alone == "slow") and (.most_taken | length) == 3 and .most_taken[0][4] != null and .most_taken[0][0] == null' plan.json
# At the start each trial takes one action.
holds '[.actions[].taken[0][4]] | add | . > 0.999999 and . < 1.000001' plan.json
grep -q 'most frequent action' plan.svg || fail "no map of actions"
# A single action is the field with its keys. A plan gains nothing over itself, and this zero is no estimate.
holds '[.actions[] | .crossed - .crossed_95[0] > 0 and (.gain_95 == null or .gain_95[0] < .gain and .gain < .gain_95[1])] | all' plan.json
grep -q '^The best policy found takes fast all the time.$' out.txt || fail "this plan is to be one action: $(head -n 2 out.txt)"
holds '.actions[0].gain == 0 and .actions[0].gain_95 == null and .actions[1].gain_95 != null and .by_gate.gain == 0 and .by_gate.gain_95 == null' plan.json
[ "$(grep -c ' 0.00  *100.0 %$\| 0.00$' out.txt)" = 2 ] || fail "the gain of a plan over itself: $(grep -e fast -e 'gate alone' out.txt)"
# The same bits on one thread, and from a scene's own tables; kept pieces are resumed.
{ cat "$scenes/field.toml"; printf '[actions.slow]\nforces.propulsion_N = 6\n[actions.fast]\nforces.propulsion_N = 9\n'; } >own.toml
"$gatewalk" plan own.toml --set run.method=moreau --set field.rows=3 --accuracy 0.1 --threads 1 --checkpoint kept --quiet --json own.json
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' plan.json own.json | grep -q true || fail "plan: other results on one thread"
"$gatewalk" plan own.toml --set run.method=moreau --set field.rows=3 --accuracy 0.1 --checkpoint kept --resume --quiet --force --json again.json
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' plan.json again.json | grep -q true || fail "plan: other results when resumed"
# Other commands ignore the actions.
"$gatewalk" gate own.toml --trials 20 --quiet --json with.json
"$gatewalk" gate "$scenes/field.toml" --trials 20 --quiet --json without.json
jq -s '.[0].fates == .[1].fates' with.json without.json | grep -q true || fail "a scene's actions change its gate"
expect 0 '^actions.fast.forces.propulsion_N  *9.0 ' "$gatewalk" scene own.toml
expect 0 '^actions: fast, slow, wait (the scene as it is)$' "$gatewalk" scene own.toml --set actions.wait={} --json scene.json
holds '.actions == ["fast", "slow", "wait"]' scene.json
# Gates of several types; an action that is the scene as it is.
expect 0 '^Chance to cross: ' "$gatewalk" plan "$scenes/mixed.toml" --set run.method=moreau --set field.max_gates=30 --set actions.fast.forces.propulsion_N=12 --set actions.wait={} --accuracy 0.2 --json mixed.json
holds '.most_taken | length == 9' mixed.json
# The full dynamics runs the policy file: it crosses as often as the plan says, the same in every run.
{ cat "$scenes/field.toml"; printf '[actions.left]\nbeams.stiffness_left_Nm_per_rad = 200\n[actions.right]\nbeams.stiffness_right_Nm_per_rad = 200\n'; } >sides.toml
sides=(sides.toml --set run.method=moreau --set field.rows=4 --set field.max_gates=6)
"$gatewalk" plan "${sides[@]}" --accuracy 0.03 --quiet --json sides.json --policy sides.policy.json --gate-policy gates.policy.json
holds '.chain != null and .actions[0].gain > 0' sides.json
expect 0 '^crossed' "$gatewalk" lattice "${sides[@]}" --policy sides.policy.json --trials 2000 --seed 3 --json run.json
jq -s '.[0].crossed_95 as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02' sides.json run.json | grep -q true || fail "the policy crosses less or more often than planned"
"$gatewalk" lattice "${sides[@]}" --policy sides.policy.json --trials 2000 --seed 3 --threads 1 --quiet --json again.json --force
cmp -s run.json again.json || fail "a policy runs otherwise on one thread"
# The same trials can be filmed; the film names the action of each step.
"$gatewalk" trace "${sides[@]}" --policy sides.policy.json --trials 30 --seed 3 --quiet --json watched.json --replay watched.html
"$gatewalk" lattice "${sides[@]}" --policy sides.policy.json --trials 30 --seed 3 --quiet --force --json few.json
jq -s '(.[0].runs | map(.ending) | group_by(.) | map({key: (.[0] | gsub(" "; "_")), value: length}) | from_entries) == (.[1].endings | with_entries(select(.value > 0)))' watched.json few.json | grep -q true || fail "other trials are watched than counted"
holds '.actions == ["left", "right"] and (.runs | map(.type | unique) | add | unique) == [0, 1] and .title == "sides.toml: actions left, right"' watched.json
expect 2 'start.y_m' "$gatewalk" trace "${sides[@]}" --set start.y_m=1 --policy sides.policy.json
expect 2 'sides.policy.json: was made for another scene: ' "$gatewalk" trace own.toml --policy sides.policy.json
# A policy that depends on the gate alone.
holds '.by_gate.crossed > 0 and .by_gate.gain_95[0] <= .by_gate.gain and (.by_gate.action | length) == 4 and (.by_gate.action[0] | length) == 9 and (.by_gate.action | add | unique | inside(["left", "right"]))' sides.json
"$gatewalk" lattice "${sides[@]}" --policy gates.policy.json --trials 2000 --seed 3 --quiet --json run.json --force
jq -s '.[0].by_gate.crossed_95 as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02' sides.json run.json | grep -q true || fail "the policy by gates crosses less or more often than planned"
# Policies that cost less, beginning with the plan's own; the one that is written crosses as often as asked for.
least=("$scenes/field.toml" --set run.method=moreau --set field.rows=2 --set actions.slow.forces.propulsion_N=5 --set actions.fast.forces.propulsion_N=11 --accuracy 0.05)
expect 0 '^Policies that take less (work of the propulsion), with the same random numbers:$' "$gatewalk" plan "${least[@]}" --least work_J --points 4 --json least.json
holds '.least == "work_J" and (.front | length) > 1 and (.front | length) <= 4 and .front[0].crossed == .crossed and .front[0].price == 0 and (.front | map(.price) | . == sort) and (.front | map(.chosen) | any | not)' least.json
holds '.front | map(.per_crossing / .mean * .crossed | . > 0.999 and . < 1.001) | all' least.json
chance=$(jq '.front[-1].crossed' least.json)
expect 0 '^[*] ' "$gatewalk" plan "${least[@]}" --least work_J --points 4 --chance "$chance" --policy least.policy.json --json chosen.json
holds ".front | map(select(.chosen)) | length == 1 and .[0].crossed >= $chance" chosen.json
"$gatewalk" lattice "${least[@]:0:9}" --policy least.policy.json --trials 2000 --seed 3 --quiet --json run.json --force
jq -s '(.[0].front | map(select(.chosen))[0].crossed_95) as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02' chosen.json run.json | grep -q true || fail "the policy that takes less crosses less or more often than said"
expect 0 'none of these policies crosses so often' "$gatewalk" plan "${least[@]}" --accuracy 0.1 --least time_s --points 2 --chance 0.99
expect 2 "'heat_J' is none of time_s, forward_m, work_J, random_work_J, lost_J" "$gatewalk" plan "${least[@]}" --least heat_J
expect 2 '--points: only with --least' "$gatewalk" plan "${least[@]}" --points 3
expect 2 '--chance: must lie between 0 and 1' "$gatewalk" plan "${least[@]}" --least time_s --chance 1
# The best policy in the worst case, and its probability there.
expect 0 "^Worst case, each row of the chain 1.96 standard errors worse: [0-9.]* % cross.$" "$gatewalk" plan "${sides[@]}" --accuracy 0.05 --robust --json robust.json --policy robust.policy.json
holds '.worst_case >= 0 and .worst_case < .crossed_95[1] and .chain == null' robust.json
holds 'has("worst_case") | not' sides.json
"$gatewalk" lattice "${sides[@]}" --policy robust.policy.json --trials 2000 --seed 3 --quiet --json run.json --force
jq -s '.[0].crossed_95 as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02' robust.json run.json | grep -q true || fail "the robust policy crosses less or more often than planned"
expect 2 '--robust: not with --least' "$gatewalk" plan "${least[@]}" --robust --least time_s
# A single action is the scene with its keys.
"$gatewalk" lattice "${small[@]:0:5}" "${actions[@]}" --policy fast.json --trials 300 --quiet --json policy.json
"$gatewalk" lattice "${small[@]:0:5}" --set forces.propulsion_N=9 --trials 300 --quiet --json keys.json
jq -s '.[0].final_gates == .[1].final_gates and .[0].endings == .[1].endings' policy.json keys.json | grep -q true || fail "one action all the time is not the scene with its keys"
expect 2 'sides.policy.json: was made for another scene: "columns = 7" here, "columns = 9" there' "$gatewalk" lattice "${sides[@]}" --set field.columns=7 --policy sides.policy.json
expect 2 'sides.policy.json: was made for another scene: ' "$gatewalk" lattice own.toml --policy sides.policy.json
for change in '.trees[0].cut[0] = 1e9' '.trees[0].axis[0] = 7' '.action[3] = "0"' '.action[0] |= sub("[01]"; "9")' 'del(.points)' '.action |= .[1:]'; do
  jq -c "$change" sides.policy.json >bad.json
  expect 2 '^gatewalk: bad.json: ' "$gatewalk" lattice "${sides[@]}" --policy bad.json
done
echo '{}' >bad.json
expect 2 'bad.json: is no policy that gatewalk plan --policy wrote' "$gatewalk" lattice "${sides[@]}" --policy bad.json
# What cannot be planned.
# Without actions: the best start, in a terrain in any column, with the probability of trials from there.
expect 0 '^  best .* start d -*[0-9.]* m, vx 0 m/s, vy [0-9.]* m/s, i_x -*[0-4]$' "$gatewalk" plan "$scenes/mixed.toml" --set run.method=moreau --set field.rows=4 --accuracy 0.1 --json start.json --figure start.svg
holds '.is_own == false and .gain_95[0] > 0 and .crossed > .own.crossed and (.starts | length) == 9 and (.starts[0].chance | length) == 40 and (.starts[0].chance[0] | length) == 40 and ([.starts[].chance[][]] | min >= 0 and max <= 1)' start.json
grep -q 'by the chain; x: best' start.svg || fail "no map of starts"
"$gatewalk" plan "$scenes/mixed.toml" --set run.method=moreau --set field.rows=4 --accuracy 0.1 --threads 1 --quiet --json again.json --force
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' start.json again.json | grep -q true || fail "plan: another start on one thread"
"$gatewalk" plan "${small[@]:0:5}" --accuracy 0.05 --over start.x_cm=-500:500 --over start.vy_m_per_s=5:25 --quiet --json start.json --force
holds '.ranges == {"d_m": [-5, 5], "vy_m_per_s": [5, 25]} and (.starts | length) == 1 and .start.i_x == 0' start.json
start=$(jq -r '.start | "\(.d_m),\(.vx_m_per_s),\(.vy_m_per_s)"' start.json)
"$gatewalk" lattice "${small[@]:0:5}" --set start.x_m="${start%%,*}" --set start.vy_m_per_s="${start##*,}" --trials 2000 --seed 3 --quiet --json run.json --force
jq -s '.[0].crossed_95 as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02' start.json run.json | grep -q true || fail "bodies from the best start cross less or more often than planned"
expect 2 'over: is for a scene without actions' "$gatewalk" plan "${small[@]}" "${actions[@]}" --over start.x_m=-5:5
expect 2 'a start is planned over start.x_m, start.vx_m_per_s and start.vy_m_per_s alone' "$gatewalk" plan "${small[@]}" --over forces.propulsion_N=5:9
expect 2 'start.x_m = -30 is not permitted' "$gatewalk" plan "${small[@]}" --over start.x_m=-30:30
expect 2 'policy: is for a scene with actions' "$gatewalk" plan "${small[@]}" --policy p.json
expect 2 'has no actions (tables .*). Give the scene, and the --set, of the gatewalk plan that made the policy' "$gatewalk" lattice "$scenes/single_gate.toml" --policy fast.json
expect 2 'has one action, and a policy chooses among two or more' "$gatewalk" plan "$scenes/field.toml" --set actions.a.forces.propulsion_N=9
expect 2 'accuracy: must lie in \[0.001, 0.5)' "$gatewalk" plan own.toml --accuracy 0.6
expect 2 'a plan is made for one start' "$gatewalk" plan own.toml --start 0,0,15 --start 4,0,15
expect 2 'actions.a.contact.restitution is not permitted: a body cannot choose it' "$gatewalk" plan own.toml --set actions.a.contact.restitution=0.5
"$gatewalk" build "$scenes/field.toml" --accuracy 0.2 -o tree.nc --quiet
expect 2 'is a matrix (HDF5), and a scene (TOML) is needed here' "$gatewalk" plan tree.nc
# A gain ends at 100 points.
expect 0 '^  0 a .* +100.00 \[[0-9.]*, 100.00\] ' "$gatewalk" plan "$scenes/walker.toml" --set actions.a.forces.propulsion_N=0.05 --set actions.b.forces.propulsion_N=0.5 --accuracy 0.2
# No body can cross.
expect 0 'none of 25 trials crossed: too rare to choose by' "$gatewalk" plan own.toml --set run.method=moreau --set field.max_gates=2 --accuracy 0.2

# Cells of another program, whose numbers are the actions, with known probabilities. A hopper with the push that the
# ground wants goes on 9 times of 10, else 3 times of 10, and lands on either ground equally often. It crosses three
# rows with 0.9^3 = 0.729 at best; with a single push, right or wrong for the first ground, with 0.9 or 0.3 times 0.6^2.
cp "$scenes/programs/hopper.toml" .
hopper=(hopper.toml --cell-program "$hopper_program")
expect 0 '^The best policy found gains ' "$gatewalk" plan "${hopper[@]}" --seed 2 --json hops.json --policy hops.policy.json --gate-policy push.policy.json --threads 2
holds '[.actions[].name] == ["gently", "hard"] and .trials == 2401 and .best_alone == "hard" and .settled' hops.json
holds '(.crossed - 0.729 | fabs) < 0.03 and (.actions[0].crossed - 0.108 | fabs) < 0.02 and (.actions[1].crossed - 0.324 | fabs) < 0.03 and (.by_gate.crossed - 0.324 | fabs) < 0.03' hops.json
# The same program in Python gives the same plan.
if command -v python3 >/dev/null; then
  "$gatewalk" plan "${hopper[@]}" --accuracy 0.2 --quiet --json awk.json --policy awk.policy.json
  "$gatewalk" plan hopper.toml --cell-program "python3 $scenes/programs/hopper.py" --accuracy 0.2 --quiet --json python.json --policy python.policy.json
  jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' awk.json python.json | grep -q true && cmp -s awk.policy.json python.policy.json || fail "a program in Python is planned otherwise than in awk"
fi
# The first action is always taken on hard ground.
holds '.most_taken[0] == [null, "hard", null] and .actions[0].taken[0][1] == 0' hops.json
"$gatewalk" lattice "${hopper[@]}" --policy hops.policy.json --trials 4000 --seed 3 --quiet --json hopped.json --threads 2
jq -s '(.[0].crossed_95 as [$low, $high] | .[1].endings.crossed / .[1].trials | . > $low - 0.02 and . < $high + 0.02) and .[1].actions == ["gently", "hard"] and .[1].methods == null and (.[1].made_by.cell | contains("[actions.hard]\nparameters.push_J = 3.0"))' hops.json hopped.json | grep -q true || fail "a program's policy crosses less or more often than planned"
"$gatewalk" lattice "${hopper[@]}" --policy push.policy.json --trials 4000 --seed 3 --quiet --json push.json
holds '.endings.crossed / .trials - 0.324 | fabs < 0.03' push.json
# The same bits on one thread, from --set, and after resuming kept pieces; pieces of another run are refused.
"$gatewalk" lattice "${hopper[@]}" --policy hops.policy.json --trials 4000 --seed 3 --quiet --json again.json --force --threads 1
cmp -s hopped.json again.json || fail "a program's policy runs otherwise on one thread"
sed '/^\[actions/,$d' hopper.toml >bare.toml
bare=(bare.toml "${hopper[@]:1}")
pushes=(--set actions.gently.parameters.push_J=1 --set actions.hard.parameters.push_J=3)
"$gatewalk" plan "${bare[@]}" "${pushes[@]}" --seed 2 --threads 1 --quiet --json sets.json --policy sets.policy.json
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' hops.json sets.json | grep -q true || fail "a program's plan is another one on one thread, or by --set"
cmp -s hops.policy.json sets.policy.json || fail "a program's policy is another one on one thread, or by --set"
expect 75 'kept in hops' "$gatewalk" plan "${hopper[@]}" --seed 2 --checkpoint hops --max-time 0.000001s
cp hops other
"$gatewalk" plan "${hopper[@]}" --seed 2 --checkpoint hops --resume --details --json again.json --force >hops.txt 2>/dev/null
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' hops.json again.json | grep -q true || fail "a program's plan is another one when resumed"
# --details lists when the plan takes which action: soft ground lies to the left of the middle, hard ground to the right.
grep -A 9 '^Actions in gate 0,[12], the most visited after the start.s, by how a body enters:$' hops.txt >regions.txt
sed -n '2,/^$/p' regions.txt | grep -v '^$' >lines.txt
[ "$(wc -l <lines.txt)" -ge 2 ] && [ "$(wc -l <lines.txt)" -le 9 ] || fail "a plan's actions in $(wc -l <lines.txt) lines: $(cat lines.txt)"
for side in 'gently.*: S s \[-0\.[0-9]*, -*[0-9.e-]*\] m' 'hard.*: S s \[-*[0-9.e-]*, 0\.[0-9]*\] m'; do
  head -n 2 lines.txt | grep -q "^  ${side%%.\**}, [0-9]* states: ${side#*: }$" || fail "a plan's actions by place: $(cat lines.txt)"
done
sed -n '1,2s/.*\[\(.*\), \(.*\)\] m/\1 \2/p' lines.txt | awk '$1 < -0.05 && $2 > 0.05 { exit 1 }' || fail "a plan's actions on both sides: $(cat lines.txt)"
grep -q '^  0 gently .*\|^  1 hard ' hops.txt || fail "actions are not counted from 0: $(cat hops.txt)"
# trace shows no cells of a program, so its policy is for lattice alone.
grep '# writes the policy' hops.txt >next.txt && grep -q 'for gatewalk lattice$' next.txt || fail "a program's policy is promised to others: $(cat next.txt)"
sed -i.old 's/push_J = 3$/push_J = 2.5/' hopper.toml
expect 2 'other: ' "$gatewalk" plan "${hopper[@]}" --seed 2 --checkpoint other --resume
expect 2 'hops.policy.json: was made for another cell: "parameters.push_J = 2.5" here, "parameters.push_J = 3.0" there' "$gatewalk" lattice "${hopper[@]}" --policy hops.policy.json
mv hopper.toml.old hopper.toml
# Numbers that no action has also belong to a policy; an empty action is the cell as it is.
expect 0 '^  0 as_it_is  ' "$gatewalk" plan "${bare[@]}" --set parameters.push_J=3 --set actions.gently.parameters.push_J=1 --set 'actions.as_it_is={}' --policy as.policy.json --json as.json
holds '(.actions[0].crossed - 0.324 | fabs) < 0.03 and (.crossed - 0.729 | fabs) < 0.03' as.json
expect 2 'as.policy.json: was made for another cell: .*push_J = 2.*push_J = 3' "$gatewalk" lattice "${bare[@]}" --set parameters.push_J=2 --set actions.gently.parameters.push_J=1 --set 'actions.as_it_is={}' --policy as.policy.json
# Costs are those of the cell: the push that goes on most often also takes least time per crossing.
expect 0 '^No policy was found that takes less for each crossing (time_s).$' "$gatewalk" plan "${hopper[@]}" --accuracy 0.05 --least time_s --points 3
expect 2 "'lost_J' is none of time_s, work_J" "$gatewalk" plan "${hopper[@]}" --least lost_J
# Other commands ignore the actions, and a matrix keeps them.
"$gatewalk" lattice "${hopper[@]}" --trials 200 --quiet --json with.json --force
"$gatewalk" lattice "${bare[@]}" --trials 200 --quiet --json without.json --force
jq -s '.[0].final_gates == .[1].final_gates' with.json without.json | grep -q true || fail "actions change the cells of a program"
expect 0 'bodies' "$gatewalk" build "${hopper[@]}" --accuracy 0.1 -o hopper.nc
expect 0 '^crossed' "$gatewalk" predict hopper.nc --set field.rows=2
expect 0 '^crossed' "$gatewalk" predict hopper.nc "${hopper[@]:1}" --start S:-0.2
# What cannot be planned.
expect 2 'hopper.nc: is a matrix (HDF5), and a scene (TOML) is needed here' "$gatewalk" plan hopper.nc
expect 2 'hopper.nc: is a matrix (HDF5), and a scene (TOML) is needed here' "$gatewalk" lattice hopper.nc "${hopper[@]:1}" --policy hops.policy.json
expect 2 'hopper.toml: has cells of another kind, \[cell\]: --cell-program' "$gatewalk" plan hopper.toml
expect 2 'is a table, and no scene' "$gatewalk" plan "$scenes/tracks/runs.csv"
expect 2 'over: says where bodies may start, such as --over start.s_m=0:1' "$gatewalk" plan "${bare[@]}"
expect 2 'over: start.z_m is none of start.s_m' "$gatewalk" plan "${bare[@]}" --over start.z_m=0:1
# With a push of 1 J it goes on most often from the left.
"$gatewalk" plan "${bare[@]}" --set parameters.push_J=1 --over start.s_m=-0.5:0.5 --accuracy 0.05 --quiet --json start.json --force
holds '.start.s_m < 0 and .crossed > 0.25 and .crossed < 0.4 and .own.crossed < 0.2 and .gain_95[0] > 0 and (.starts | length) == 1 and (.starts[0].chance | length) == 1' start.json
expect 2 'bare.toml: has one action' "$gatewalk" plan "${bare[@]}" "${pushes[@]:0:2}"
expect 2 "^gatewalk: --set actions.hard.parameters.shove=1: actions.hard.parameters.shove: cell program: it has no parameter 'shove', but push_J$" "$gatewalk" plan "${hopper[@]}" --set actions.hard.parameters.shove=1
sed 's/push_J = 3$/push_J = 4/' hopper.toml >much.toml
expect 2 "^gatewalk: much.toml:[0-9]*: actions.hard.parameters.push_J: cell program: parameter 'push_J' must be a number from 1.0 to 3.0$" "$gatewalk" plan much.toml "${hopper[@]:1}"
expect 2 'actions.hard.parameters.push_J = "3" is not permitted: must be a number' "$gatewalk" plan "${hopper[@]}" --set 'actions.hard.parameters.push_J="3"'
expect 2 'actions.hard.forces.propulsion_N is not permitted: an action of cells has numbers of the program' "$gatewalk" plan "${hopper[@]}" --set actions.hard.forces.propulsion_N=9
expect 2 'actions.hard.parameters.push_J is not permitted\|unknown key' "$gatewalk" plan "$scenes/field.toml" --set actions.hard.parameters.push_J=3
# A policy of gates does not run in cells, nor the reverse.
expect 2 'sides.policy.json: was made for cells of another kind' "$gatewalk" lattice "${hopper[@]}" --policy sides.policy.json
expect 2 'hops.policy.json: was made for cells of another kind' "$gatewalk" lattice "${sides[@]}" --policy hops.policy.json
for change in '.action[0] = "0"' 'del(.cell)' '.trees[0].axis[0] = 1' '.action[0] |= sub("[01]"; "2")'; do
  jq -c "$change" hops.policy.json >bad.json
  expect 2 '^gatewalk: bad.json: ' "$gatewalk" lattice "${hopper[@]}" --policy bad.json
done
expect 1 'exit' "$gatewalk" plan hopper.toml --cell-program 'exit 3'

finish
