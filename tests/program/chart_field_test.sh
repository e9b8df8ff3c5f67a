#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests chart field, and which methods the kinds of field.fidelity need.   chart_field_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

echo text >m.nc  # a file in the place of a folder
# A fidelity is refused with a method that cannot do it; the chart leaves CSV and JSON behind even without gnuplot.
expect 2 'field.fidelity = "all" is not permitted with run.method = "stable"' "$gatewalk" lattice "$scenes/field.toml" --set field.fidelity=all
expect 2 'one of "active", "remember", "all"' "$gatewalk" lattice "$scenes/field.toml" --set field.fidelity=most
expect 2 'missing -o' "$gatewalk" chart field "$scenes/field.toml"
expect 2 '3 numbers d,vx,vy (m, m/s, m/s)' "$gatewalk" chart field "$scenes/field.toml" -o chart --start 1,2
expect 2 'cannot be made' "$gatewalk" chart field "$scenes/field.toml" -o m.nc/chart
"$gatewalk" lattice "$scenes/field.toml" --set run.method=moreau --set field.fidelity=all --trials 50 --json all.json --quiet 2>/dev/null
holds '([.final_gates[][]] | add) == 50 and .trapped + .departed + .cut_off + .not_finite == 50' all.json
expect 2 'run.method = "auto" is not permitted.*run.step_s' "$gatewalk" chart field "$scenes/field.toml" --set run.method=auto -o no-chart
[ -e no-chart ] && fail "chart field: wrong use made a folder"
expect 0 '^Start 4, 5, 10: 20 trials cannot tell' "$gatewalk" chart field "$scenes/field.toml" -o new/chart --trials 20 --start 4,5,10
[ "$(wc -l <new/chart/fidelity.csv)" = 5 ] || fail "chart field: a line per fidelity and method was expected"
holds '.starts[0].runs | map(.fidelity) == ["active", "remember", "all", "active"]' new/chart/fidelity.json
holds '.starts[0].runs | all(([.final_gates[][]] | add) == 20 and (.fates | add | . - 1 | fabs) < 1e-12 and .seconds_per_trial > 0)' new/chart/fidelity.json
holds '.made_by.seed == 1 and (.made_by.scene | length) > 0 and (.machine | test("cores"))' new/chart/fidelity.json
expect 2 'are the same file' "$gatewalk" chart field "$scenes/field.toml" -o new/chart --json ./new/chart/fidelity.csv
grep -q '</svg>' new/chart/fidelity.svg || fail "chart field: no figure"
"$gatewalk" lattice "$scenes/field.toml" --set run.method=moreau --set field.fidelity=remember --set start.x_m=4 \
  --set start.vx_m_per_s=5 --set start.vy_m_per_s=10 --trials 20 --json remember.json --quiet 2>/dev/null
jq -s '.[0].starts[0].runs[1].final_gates == .[1].final_gates' new/chart/fidelity.json remember.json | grep -q true ||
  fail "chart field and lattice ran other trials"
rm new/chart/*
expect 1 'gnuplot was not found.*are written' env PATH=/nonexistent "$gatewalk" chart field "$scenes/field.toml" -o new/chart --trials 5 --start 0,0,15
[ "$(ls new/chart | xargs)" = "fidelity.csv fidelity.json" ] || fail "chart field without gnuplot left $(ls new/chart)"

# One gate has no neighbours, so no trial changes; it takes 3/0.03 trials to know that few would.
one_gate="$scenes/field.toml --set field.columns=1 --set field.rows=1 --set run.step_s=0.02 --start 0,0,15"
# shellcheck disable=SC2086
{
expect 0 '^Start 0, 0, 15: 99 trials cannot tell .* 0.0000 +- 0.0303$' "$gatewalk" chart field $one_gate --trials 99 -o new/chart
holds '.starts[0].active_is_enough == null' new/chart/fidelity.json
expect 0 '^Start 0, 0, 15: active is enough: .* 0.0000 +- 0.0300 ' "$gatewalk" chart field $one_gate --trials 100 -o new/chart
holds '.starts[0].active_is_enough == true and (.starts[0].runs | map(.step_s == 0.02) | all)' new/chart/fidelity.json
# The step is named, with its effect on moreau.
expect 0 '^gatewalk: .*(moreau), step 0.02 s: .* sank into a beam' "$gatewalk" chart field $one_gate --trials 100 -o new/chart --quiet
expect 0 '^The step is 0.02 s (moreau), 0.02 s (stable).$' "$gatewalk" chart field $one_gate --trials 5 -o new/chart --details
}

finish
