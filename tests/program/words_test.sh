#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The same word for the same thing in every command; large fields; numbers of states.   words_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
field=$scenes/field.toml
"$gatewalk" predict m.nc --json predict.json --quiet
"$gatewalk" walk m.nc --walks 500 --json walk.json --quiet
for name in 'left side' left_side; do
  expect 0 'left side' "$gatewalk" analyze m.nc --target "$name" --runs 0
done
# Without a limit of gates no body is cut off: the share is 0, without a rounding error.
"$gatewalk" predict m.nc --set field.max_gates=0 --json free.json >free.txt
holds '.endings.cut_off == 0 and .cut_off == 0 and .rounding_at_most > 0' free.json

# NetCDF has the maps of any field, JSON those of up to 100000 gates, with a message.
"$gatewalk" predict m.nc --start 0,0,15 --start 4,5,10 --netcdf two.nc --json two.json --quiet
ncdump -v final_gates,i_x,crossed two.nc >dump.txt
grep -q 'final_gates(start, i_y, i_x)' dump.txt && grep -q 'start = 2 ;' dump.txt && grep -q 'final_gates:units = "1"' dump.txt || fail "netcdf: no final gates"
grep -q '^ i_x = -4, -3, -2, -1, 0, 1, 2, 3, 4 ;' dump.txt || fail "netcdf: i_x"
for name in trapped_gates departed_gates start_d start_vx start_vy; do grep -q "double $name(start" dump.txt || fail "netcdf: no $name"; done
ncdump -p 9,17 -v final_gates two.nc | awk '/^ final_gates =/ { on = 1; next } on { gsub(/[,;}]/, " "); print }' | tr -s ' ' '\n' | grep . >nc.txt
jq -r '.starts[].final_gates[][]' two.json >json.txt
[ "$(wc -l <nc.txt)" = 162 ] && paste nc.txt json.txt | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > 1e-15) exit 1 }' || fail "netcdf: other shares than JSON"
"$gatewalk" lattice "$field" --trials 5 --netcdf lattice.nc --quiet >/dev/null
"$gatewalk" walk m.nc --walks 100 --netcdf walk.nc --quiet >/dev/null
"$gatewalk" predict "$field" --accuracy 0.3 --netcdf tree.nc --quiet >/dev/null
for of in lattice walk tree; do ncdump -h $of.nc | grep -q ':Conventions = "CF-1.10"' || fail "$of: netcdf without conventions"; done
for of in lattice walk tree; do ncdump -h $of.nc | grep -q ':command = "gatewalk ' || fail "$of: netcdf does not say what made it"; done
ncdump -h tree.nc | grep -q 'double final_gates_low(start, i_y, i_x)' || fail "predict: netcdf without intervals"
"$gatewalk" walk m.nc --walks 100 --set field.columns=501 --set field.rows=501 --json large.json --netcdf large.nc --quiet
holds '.final_gates == null and .trapped_gates == null and (.left_out | test("501 x 501 gates.*--netcdf")) and (.endings | add) + .never_sampled == 100' large.json
ncdump -h large.nc | grep -q 'i_y = 501 ;' || fail "walk: netcdf of a large field"
holds 'has("left_out") | not' walk.json
expect 2 'are the same file' "$gatewalk" walk m.nc --netcdf m.nc

# States count from 0, in JSON, in tables and for --row, as in the file.
"$gatewalk" show m.nc --json show.json --quiet
holds '[.rows[].input] == [range(87)]' show.json
jq -s '.[0].start_state as $s | .[1].rows[$s.input] | .boundary == "EN" and .d_m == [-5, 5] and .vx_m_per_s == [-5, 5] and
  .vy_m_per_s == [10, 20] and $s.bin == "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s"' predict.json show.json | grep -q true ||
  fail "the state of the start is another row: $(jq -c .start_state predict.json)"
for row in 0 86; do
  "$gatewalk" show m.nc --row $row --quiet >row.txt || fail "show --row $row"
  [ "$(sed '1,/^State .*: the states that follow/d; /^$/,$d' row.txt | awk '{ print $1, $2 }')" = "$(jq -r ".rows[$row].outputs[] | \"\(.output) \(.count)\"" show.json)" ] ||
    fail "show --row $row: other outputs than in JSON: $(cat row.txt)"
done
expect 2 'row 87: must be at least 0 and at most 86' "$gatewalk" show m.nc --row 87

# A chain has field.fidelity "active"; another one is refused, not ignored.
"$gatewalk" build "$field" --trials 2 --set run.method=moreau --set run.step_s=0.005 -o moreau.nc --quiet >/dev/null
for command in predict walk analyze; do
  expect 2 'set field.fidelity=all: field.fidelity = "all" is not permitted for a chain: it has "active"' "$gatewalk" $command moreau.nc --set field.fidelity=all
done
"$gatewalk" build "$field" --trials 2 --set run.method=moreau --set run.step_s=0.005 --set field.fidelity=all -o all.nc --quiet >/dev/null 2>&1
expect 0 'all.nc (its scene): field.fidelity = "all" is of the full dynamics: a chain always has "active"' "$gatewalk" predict all.nc
expect 0 '^crossed' "$gatewalk" predict all.nc --set field.fidelity=active
printf '[sweep]\nforces.random_N = "1,2"\n' | cat "$field" - >swept.toml
expect 0 'the table \[sweep\] of swept.toml has no effect' "$gatewalk" predict m.nc swept.toml

# build and validate say for which starts their trees are.
expect 0 '^Start with a state of its own: 0,0,15$' "$gatewalk" build "$field" --accuracy 0.3 -o t.nc --details
grep -q '^States: [0-9]*, leaves of trees with 7 entries or more, from [0-9]* gate runs.$' out.txt || fail "build: no word on the states"
expect 0 '^Starts with a state of their own: 0,0,15; 23,-11,16; 4,5,10; -17,13,12$' "$gatewalk" validate "$field" --accuracy 0.3 --trials 20 --null-draws 99 --details

finish
