#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shares that the endings leave out are named in the table, in JSON and in a warning, each number once.
#   rest_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

field=(--start 0 --set field.columns=3)
printf 'state,name,move_x,move_y\n0,up,0,1\n1,right,1,0\n2,left,-1,0\n' >s.csv
printf 'from,to,count\nup,up,5\nup,right,5\n' >half.csv
"$gatewalk" import half.csv --states s.csv "${field[@]}" --set field.rows=2 --set field.max_gates=20 -o half.nc --quiet

# No body was seen to leave "right". Of half.csv's walks 1/2 enter it in the first gate, 1/4 in the second: 1/4 cross.
expect 0 'the endings add up to 25.00 %: 75.00 % reach a state that was never sampled' "$gatewalk" predict half.nc --json predict.json
expect 0 'the endings add up to 25.00 %: 75.00 % reach a state that was never sampled' "$gatewalk" analyze half.nc --start up --json analyze.json
expect 0 '^Share that reaches a state without any run: 75.0000 %$' "$gatewalk" analyze half.nc --start up --details
for file in predict analyze; do holds '.never_sampled == 0.75 and .still_walking == 0' $file.json; done
holds '([.endings[]] | add) + .never_sampled == 1' analyze.json
expect 0 'the endings add up to [0-9.]* %: [0-9.]* % reach a state that was never sampled' "$gatewalk" walk half.nc --walks 4000 --json walk.json
# 3000 of 4000, within six standard deviations of 27.
holds '.never_sampled > 2836 and .never_sampled < 3164 and ([.endings[]] | add) + .never_sampled == .walks and .still_walking == 0 and .still_walking_95 == [0, 0]' walk.json
# With several starts each has its own share.
expect 0 '^gatewalk: start right: the endings add up to 0.00 %: 100.00 % reach' "$gatewalk" predict half.nc --start up --start right --json two.json
expect 0 '^gatewalk: start up: the endings add up to 25.00 %: 75.00 % reach' "$gatewalk" predict half.nc --start up --start right
holds '[.starts[].never_sampled] == [0.75, 1]' two.json
# No message if nothing is left out.
printf 'from,to,count\nup,up,5\nup,right,5\nright,trapped,3\n' >whole.csv
"$gatewalk" import whole.csv --states s.csv "${field[@]}" --set field.rows=2 --set field.max_gates=20 -o whole.nc --quiet
for command in predict analyze "walk --walks 100"; do
  # shellcheck disable=SC2086
  "$gatewalk" ${command%% *} whole.nc $(printf '%s' "${command#"${command%% *}"}") --json whole.json --force >whole.txt 2>&1 || fail "$command whole.nc"
  ! grep -e 'add up' -e 'never sampled' -e 'without any run' -e 'still walking' whole.txt || fail "$command: says that something is left out"
  holds '.never_sampled == 0 and .still_walking < 1e-12' whole.json
done

# Half of these walks go to and fro for ever. In a field without a limit of gates they are not cut off.
printf 'from,to,count\nup,right,50\nup,trapped,50\nright,left,1\nleft,right,1\n' >circles.csv
"$gatewalk" import circles.csv --states s.csv "${field[@]}" --set field.rows=2 --set field.max_gates=0 -o circles.nc --quiet
expect 0 '^Walks stopped after 1000000 gates, still walking: [0-9.]* \[[0-9.]*, [0-9.]*\] %$' "$gatewalk" walk circles.nc --details --walks 20 --json circles.json
expect 0 '% were still walking after 1000000 gates, where walks are stopped' "$gatewalk" walk circles.nc --walks 20
expect 0 '^No body is cut off: field.max_gates = 0 sets no limit.$' "$gatewalk" walk circles.nc --walks 20 --details
! grep -q '^cut off' out.txt || fail "walk: an ending that is not possible has a line"
holds '.endings.cut_off == 0 and .cut_off == 0 and .still_walking > 0 and .still_walking + .endings.trapped == 20 and .still_walking_95[0] < .still_walking and .still_walking < .still_walking_95[1]' circles.json
holds '([.final_gates[][]] | add) == .endings.trapped' circles.json
# Walks under way may end in any way except cut off. None of 20 crossed, so up to all that walk, or what chance allows
# for 20.
holds '.still_walking_95[1] as $more | .endings_95 | .crossed == [0, $more] and .left_side == [0, $more] and .trapped[1] == 20 and .cut_off == [0, 0]' circles.json
# With a limit of gates they are cut off.
"$gatewalk" walk circles.nc --walks 20 --set field.max_gates=100 --quiet --json limit.json
jq -s '.[0].still_walking == .[1].cut_off and .[1].still_walking == 0' circles.json limit.json | grep -q true || fail "a limit of the field is none: $(jq -c .endings limit.json)"

# States are named wherever one is mentioned.
expect 0 '^   1  right  right ' "$gatewalk" show half.nc --rows
expect 0 '^     1        5  right$' "$gatewalk" show half.nc --row 0
"$gatewalk" show half.nc --quiet --json show.json
holds '[.rows[].name] == ["up", "right", "left"]' show.json
expect 0 '^State of the chain at the start: up$' "$gatewalk" walk half.nc --details
holds '.start_state.bin == "up"' walk.json
holds '.start_state.bin == "up"' predict.json
holds '[.starts[] | [.start.name, .start_state.bin]] == [["up", "up"], ["right", "right"]]' two.json
expect 0 '^start right$' "$gatewalk" predict half.nc --start up --start right
holds '[.starts[].name] == ["up"]' analyze.json
expect 0 'State 0 is up; ' "$gatewalk" export half.nc -o half.drn
# Also if the numbers of a face's states have gaps.
printf 'state,name,move_x,move_y\n0,up,0,1\n1,right,1,0\n2,up_again,0,1\n3,up_last,0,1\n' >gaps.csv
printf 'from,to,count\nup,up_last,5\nup_last,up_again,5\nup_again,right,3\nright,up,1\n' >gaps.from.csv
"$gatewalk" import gaps.from.csv --states gaps.csv --start up_last --set field.rows=2 --set field.max_gates=20 -o gaps.nc --quiet 2>/dev/null
"$gatewalk" show gaps.nc --quiet --json show.json --force
holds '[.rows[].name] == ["up", "right", "up_again", "up_last"]' show.json
for name in up up_again up_last right; do expect 0 "^State of the chain at the start: $name\$" "$gatewalk" predict gaps.nc --details --start $name; done

# The share of a part of a side is not larger than that of the side.
parts='. as $a | [.exits | to_entries[] | .key as $side | .value[] | .share_95[1] <= $a.endings_95[$side][1] + 1e-12 and .share_95[0] <= $a.endings_95[$side][0] + 1e-12] | all'
printf 'from,to,count\nup,right,75\nup,trapped,25\nright,left,100000\nleft,right,99999\nleft,up,1\n' >rarely.csv
"$gatewalk" import rarely.csv --states s.csv "${field[@]}" --set field.rows=3 --set field.max_gates=20 -o rarely.nc --quiet
"$gatewalk" predict rarely.nc --quiet --json rarely.json
holds "$parts" rarely.json
"$gatewalk" predict "$scenes/robot.toml" --accuracy 0.1 --quiet --json robot.json
holds "$parts" robot.json
# Without a limit of gates no body is cut off, and that has one interval.
"$gatewalk" lattice "$scenes/field.toml" --set field.max_gates=0 --trials 20 --quiet --json lattice.json
holds '.cut_off_95 == [0, 0] and .endings_95.cut_off == [0, 0]' lattice.json
# The probability behind the influences comes from another chain, and the table says which one is the answer.
"$gatewalk" analyze "$scenes/robot.toml" --accuracy 0.1 --runs 200 --details --json robot.json --force >robot.txt 2>/dev/null
jq -e '.endings.crossed != .sensitivities.probability' robot.json >/dev/null || fail "no two chances to tell apart"
share() { jq "$1 * 100" robot.json | xargs printf '%.2f %%'; }
of_these=$(share .sensitivities.probability)
tr '\n' ' ' <robot.txt | grep -q -F -e "on \"crossed\" ($of_these): slope, % of its chance per % of each number, over +-2 % ($of_these comes from the larger chain of $(value .sensitivities.chain_gate_runs robot.json) gate runs behind this table. The answer is the $(share .endings.crossed) above.)" ||
  fail "two chances to cross: $(grep 'the chance of' robot.txt)"
finish
