#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests rare: the probability of reaching each row, beside the chain's and that of direct trials.
#   rare_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

expect 0 '^Chance to enter row 4: ' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --row 4 --accuracy 0.2 --gate-runs 40000 --trials 500 --json rare.json
holds '.row == 4 and (.rows | length) == 4 and .probability > 0 and .probability_95[0] < .probability and .probability < .probability_95[1] and .chain > 0 and .relative_standard_error <= 0.2 and .gate_runs > 1000 and .rows[0].direct_entered > 0 and .rows[0].direct_entered_95[0] > 0 and .chain_seconds < .seconds' rare.json
expect 2 'must lie between 0 and 1' "$gatewalk" rare "$scenes/field.toml" --accuracy 5
expect 0 'the relative standard error of 0.01 needs more' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --row 12 --accuracy 0.01 --gate-runs 20000
# If no body can move, the result is an upper bound, soon.
expect 0 '^Chance to enter row 2: at most 0.000369 (two-sided 95 %): none of 10000 trials did.$' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --set forces.propulsion_N=0 --set forces.random_N=0 --set start.vy_m_per_s=0 --row 2 --gate-runs 10000 --json none.json
holds '.probability == 0 and .probability_95[0] == 0 and .probability_95[1] > 3.68e-4 and .probability_95[1] < 3.7e-4 and .reached == false' none.json
expect 0 '^Chance to enter row 3: ' "$gatewalk" rare "$scenes/mixed.toml" --set run.method=moreau --row 3 --accuracy 0.2 --gate-runs 40000 --trials 500 --json rare.json
holds '(.rows | length) == 3 and .rows[2].probability > 0 and .rows[2].chain > 0 and .rows[2].direct_entered > 0' rare.json
"$gatewalk" lattice "$scenes/mixed.toml" --set run.method=moreau --set field.max_gates=0 --trials 500 --quiet --json lattice.json
"$gatewalk" rare "$scenes/mixed.toml" --set run.method=moreau --row 9 --gate-runs 40000 --trials 500 --quiet --json rare.json
jq -s '[range(8) as $r | .[0].final_gates[$r + 1:] | flatten | add] + [.[0].endings.crossed] == [.[1].rows[].direct_entered]' lattice.json rare.json | grep -q true || fail "rare: other direct trials than lattice"
expect 2 'mixed.toml: the terrain has 9 rows; the row to enter (--row) must be at most 9, or field.rows larger' "$gatewalk" rare "$scenes/mixed.toml" --row 10
# More runs than the limit are said to be so.
expect 0 '^These are more than 1000 gate runs (--gate-runs): the first 1000 trials always run.$' "$gatewalk" rare "$scenes/field.toml" --set run.method=moreau --row 4 --gate-runs 1000 --json over.json
holds '.gate_runs > 1000 and .split_trials == 1000' over.json

finish
