#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests analyze --first-passage: committors and mean first passage times.   first_passage_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# A fair game, won at row 4: from row n of 4 it is won with (n + 1) / 5, and a winning game takes (25 - (n + 1)^2) / 3
# steps.
printf 'state,name,move_x,move_y\n0,won,0,1\n1,"lost, again",0,-1\n' >games.csv
printf 'from,to,count\nwon,won,5\nwon,"lost, again",5\n"lost, again",won,5\n"lost, again","lost, again",5\n' >fair.csv
"$gatewalk" import fair.csv --states games.csv --start won --set field.rows=4 --set field.columns=1 --set field.max_gates=0 -o fair.nc --quiet
"$gatewalk" analyze fair.nc --first-passage crossed --json won.json --quiet || fail "first passage to an ending"
holds '.first_passage | .states | length == 2' won.json
holds '.first_passage | [.of_states.probability[][0][0] * 5] | map(. * 1e12 | round / 1e12) == [1, 2, 3, 4]' won.json
holds '[range(4) as $n | .first_passage.of_states.mean_gates[$n][0][0] - (25 - ($n + 1) * ($n + 1)) / 3 | fabs < 1e-12] | all' won.json
holds '.first_passage | .probability == .of_states.probability[0][0][.states | index("won")] and .mean_time_s == null and .of_states.mean_time_s != 0' won.json
# The same for a gate, and for a state by name and by number; bodies that are there already have arrived.
"$gatewalk" analyze fair.nc --first-passage 0,3 --json gate.json --quiet
holds '.first_passage | [.of_states.probability[][0][0] * 4] | map(. * 1e12 | round / 1e12) == [1, 2, 3, 4]' gate.json
holds '.first_passage.of_states.mean_gates[3][0] == [0, 0]' gate.json
for state in 'lost, again' 1; do
  "$gatewalk" analyze fair.nc --first-passage "$state" --json lost.json --quiet || fail "first passage to state $state"
  holds '.first_passage | (.states | index("lost, again")) as $lost | .probability_95 == null and .of_states.probability[2][0][$lost] == 1' lost.json
  # All steps up to the end are won, or the first one is lost and leads out of the field.
  holds '.first_passage | (.states | index("won")) as $won | [.of_states.probability[][0][$won]] == [0.4375, 0.875, 0.75, 0.5]' lost.json
done
"$gatewalk" analyze fair.nc --first-passage "0,2,lost, again" --json one.json --quiet || fail "a state of one gate"
holds '.first_passage.of_states.probability[2][0] | add > 1 and (add < 2)' one.json
# An unknown time is null, not 0, also for bodies that are there already; so is its spread for each ending.
"$gatewalk" analyze fair.nc --first-passage won --json there.json --quiet
holds '(.first_passage | .probability == 1 and .mean_gates == 0 and .mean_time_s == null and .of_states.mean_time_s == null) and ([.by_ending[] | .mean_time_s, .sd_time_s] | all(. == null))' there.json
# Endings may be in capitals, unless a state has that name.
"$gatewalk" analyze fair.nc --first-passage Crossed --json capitals.json --quiet || fail "an ending in capitals"
jq -s '[.[].first_passage | del(.target)] | .[0] == .[1]' won.json capitals.json | grep -q true || fail "an ending in capitals is another one"
sed 's/won/Trapped/' games.csv >named.csv
sed 's/won/Trapped/g' fair.csv >named.from.csv
"$gatewalk" import named.from.csv --states named.csv --start Trapped --set field.rows=4 --set field.columns=1 --set field.max_gates=0 -o named.nc --quiet
"$gatewalk" analyze named.nc --first-passage Trapped --json named.json --quiet
holds '.first_passage | .probability == 1 and .mean_gates == 0' named.json
# With a limit of two gates only the last two rows can win: 1/2 from the last, after 1 gate, and 1/4 after 2.
"$gatewalk" analyze fair.nc --set field.max_gates=2 --first-passage crossed --json two.json --csv two.csv --quiet
holds '.first_passage.of_states | [.probability[][0][0]] == [0, 0, 0.25, 0.5] and [.mean_gates[][0][0]] == [null, null, 2, 1]' two.json
grep -q '^first_passage.of_states.probability.2.0,0,,0.25,,$' two.csv || fail "first passages in CSV"

# A chain of trees has an interval for the start, consistent with the endings, and none for the states.
fast=(--set run.method=moreau --set field.rows=4 --set forces.propulsion_N=8.5)
"$gatewalk" build "$scenes/field.toml" "${fast[@]}" --accuracy 0.05 -o fast.nc --quiet
"$gatewalk" analyze fast.nc --runs 0 --first-passage crossed --json trees.json --quiet
holds '.first_passage | .probability_95[0] < .probability and .probability < .probability_95[1] and .mean_time_s_95[0] < .mean_time_s and .mean_gates_95[1] > .mean_gates' trees.json
holds '(.first_passage.probability - .by_ending.crossed.probability | fabs) < 1e-9 and (.first_passage.mean_time_s / .by_ending.crossed.mean_time_s - 1 | fabs) < 1e-9' trees.json
state=$(jq -r '.first_passage.states[9]' trees.json)
expect 0 "^First passage to state 9 ($state): " "$gatewalk" analyze fast.nc --runs 0 --first-passage 9
expect 0 "^First passage to state $state: " "$gatewalk" analyze fast.nc --runs 0 --first-passage "$state" --json state.json
holds '.first_passage | .probability_95 == null and .mean_gates_95 == null and ([.of_states.probability[][][9]] | all(. == 1))' state.json
for text in lost 0,4 -5,0 0, EN_99999 0,0,x; do
  expect 2 'must be an ending (crossed' "$gatewalk" analyze fast.nc --first-passage "$text"
done
# The start's own state is entered by no passage.
own=$(jq -r '.first_passage.states | length' trees.json)
expect 2 'is the start itself, in which every body begins' "$gatewalk" analyze fast.nc --first-passage "$own"
expect 2 'states are those of a matrix' "$gatewalk" analyze "$scenes/field.toml" --first-passage EN_3
# Without the option the result says nothing of first passages.
"$gatewalk" analyze fair.nc --json without.json --quiet
holds 'has("first_passage") | not' without.json
holds '.quasi_stationary | (.time_scales_gates | length) == (.eigenvalues | length)' trees.json
finish
