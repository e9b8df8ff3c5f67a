#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests predict with large fields, and with rows of other gates.   large_field_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
# A large field: a map that fits a screen, JSON with every gate, two solvers.
large="--set field.max_gates=0 --set field.columns=301 --set field.rows=301"
# shellcheck disable=SC2086
{
expect 0 '^elsewhere in the 301 x 301 gates: 0.0' "$gatewalk" predict --details m.nc $large --json large.json
[ "$(wc -l <out.txt)" -lt 50 ] || fail "predict: $(wc -l <out.txt) lines for a large field"
holds '(.final_gates | length == 301 and (map(length) | unique == [301])) and (([.final_gates[][]] | add) - 1 | fabs) < 1e-11' large.json
"$gatewalk" walk m.nc $large --walks 20000 --json large-walk.json --quiet
# Rows of 20000 walks: the mean distance by chance is below 0.01.
jq -s '[[.[0].final_gates[] | add], [.[1].final_gates[] | add / 20000]] | transpose | map(.[0] - .[1] | fabs) | add / 2 < 0.02' large.json large-walk.json |
  grep -q true || fail "walk and predict disagree on a large field"
}
# Rows of other gates do not change the rows below them; a copy of the base changes nothing; two solvers agree.
"$gatewalk" build "$scenes/field.toml" --trials 20 --seed 1 --set beams.stiffness_left_Nm_per_rad=2000 -o stiff.nc --quiet >/dev/null
cp m.nc copy.nc
for limit in 13 0; do
  "$gatewalk" predict m.nc --set field.max_gates=$limit --json base.json --quiet
  "$gatewalk" predict m.nc --set field.max_gates=$limit --row 0-8=copy.nc --json same.json --quiet
  jq -s '.[0].final_gates == .[1].final_gates' base.json same.json | grep -q true || fail "predict: rows of the same gates change something"
  expect 0 '^Rows 4 to 6 have the gates of stiff.nc.$' "$gatewalk" predict m.nc --details --set field.max_gates=$limit --row 4-6=stiff.nc --row 2=copy.nc --json rows.json
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

finish
