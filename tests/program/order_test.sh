#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Chains that remember turns: validate --order, build --order, and what works with their files.
#   order_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

cat >cell.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
symmetric = false
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.faces]]
name = "E"
move = [-1, 0]
[[cell.faces]]
name = "N"
move = [0, -1]
[[cell.faces]]
name = "W"
move = [1, 0]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[field]
columns = 5
rows = 5
max_gates = 10
END
# 40 bodies that turn left after right and right after left in 8 of 10 cells, else at random.
awk 'BEGIN {
  srand(7); split("S E N W", face, " ")
  print "body,trial,in,s,out,out_s,time_s"
  for (body = 1; body <= 40; ++body) {
    at = 0; turn = 1
    for (k = 0; k < 60; ++k) {
      turn = rand() < 0.8 ? (turn == 1 ? 3 : 1) : int(4 * rand())
      next_at = (at + turn) % 4
      printf "%d,1,%s,0,%s,0,0.5\n", body, face[at + 1], face[next_at + 1]
      at = next_at
    }
  }
}' >runs.csv

expect 0 '^The chain must remember 1 turn (orders 0 to 2 compared)' "$gatewalk" validate runs.csv --cell cell.toml \
  --order 0:2 --json order.json --csv order.csv --figure order.svg --details
holds '.order == 1 and .best_order >= 1 and .order_of == "turns" and .passages == 2400 and .max_gates == 10' order.json
holds '.orders[0].gain_to_best > 0.2 and .orders[0].gain_to_best_95[0] > 0 and (.orders[0].enough | not)' order.json
holds '.orders[1].enough and .orders[0].likelihood < .orders[1].likelihood' order.json
holds '[.orders[].halves[].total_variation.value] | length == 6 and all(. >= 0 and . <= 1)' order.json
expect 0 'build runs.csv --cell cell.toml --order 1 -o chain.nc' "$gatewalk" validate runs.csv --cell cell.toml --order 0:2
expect 0 'must remember 1 face before' "$gatewalk" validate runs.csv --cell cell.toml --order 0:2 --order-of faces
expect 0 'must remember 1 state before' "$gatewalk" validate runs.csv --cell cell.toml --order 0:2 --order-of states
# Halves without a build before them, and the same from the file.
expect 0 '^Next: gatewalk build runs.csv --cell cell.toml -o chain.nc' "$gatewalk" validate runs.csv --cell cell.toml --json halves.json
expect 0 'transition matrix of 4 states' "$gatewalk" build runs.csv --cell cell.toml -o plain.nc
expect 0 . "$gatewalk" validate plain.nc --json halves_of_file.json
[ "$(jq -c .halves halves.json)" = "$(jq -c .halves halves_of_file.json)" ] || fail "halves of a table and of its file differ"

expect 0 'transition matrix of 20 states' "$gatewalk" build runs.csv --cell cell.toml --order 1 -o chain.nc --json build.json
holds '.recorded.passages == 2400 and .inputs == 20' build.json
# Order 0 is no memory: the same file but for its command.
expect 0 . "$gatewalk" build runs.csv --cell cell.toml --order 0 -o zero.nc
[ "$(ncdump zero.nc | grep -v 'command\|checksum\|^netcdf')" = "$(ncdump plain.nc | grep -v 'command\|checksum\|^netcdf')" ] ||
  fail "order 0 is not the chain without memory"
ncdump -h plain.nc | grep -q 'format_version = 2' || fail "files without words have another version"
ncdump -h chain.nc | grep -q 'format_version = 3' || fail "files with words do not have version 3"

expect 0 'let the chain remember turns: validate --order' "$gatewalk" predict plain.nc --json plain.json
expect 0 '^cut off' "$gatewalk" predict chain.nc --json chain.json --csv chain.csv --figure chain.svg --page chain.html
holds '(.endings | add) > 0.999 and (.endings | add) < 1.001' chain.json
# Bodies that alternate walk along a diagonal, to the right: the chain without memory does not know.
seen=$(jq '[.halves[].seen.endings.right_side] | add / length' halves.json)
holds "(.[0].endings.right_side - $seen | fabs) < 0.08 and $seen - .[1].endings.right_side > 0.2" <(jq -s . chain.json plain.json)
expect 0 'seen' "$gatewalk" walk chain.nc --walks 500 --details
expect 0 '^From a chain of 20 states' "$gatewalk" analyze chain.nc
expect 0 'you detect' "$gatewalk" power chain.nc --trials 100
expect 0 . "$gatewalk" export chain.nc -o chain.npz
expect 0 'S\.l ' "$gatewalk" show chain.nc --rows
expect 0 '^The chain must remember 1 turn' "$gatewalk" validate chain.nc --order 0:2
expect 0 . "$gatewalk" predict chain.nc --start S:0 --json from_s.json
holds '(.starts[0].endings | add) > 0.999' from_s.json

# What the chain remembers is no memory that it lacks.
expect 0 'Memory' "$gatewalk" validate chain.nc --json chain_halves.json
holds '.memory.p == null or .memory.p > 0.01' chain_halves.json
expect 0 '^Memory: the state alone does not say all' "$gatewalk" validate plain.nc

# Simulated bodies, recorded or not.
"$gatewalk" lattice "$scenes/walker.toml" --trials 60 --passages walker.csv --cell-file walker_cell.toml --quiet >/dev/null ||
  fail "lattice records no passages"
expect 0 'transition matrix' "$gatewalk" build walker.csv --cell walker_cell.toml --order 1 -o walker.nc
expect 0 '^The chain need not remember turns' "$gatewalk" validate "$scenes/field.toml" --set field.rows=4 --set field.columns=5 --order 0:1

# Numbers that bodies carry: of the disc its force; of a program those with which its memory begins. This body turns
# right with probability 0.5 + grip / 2, and grips anew in each cell.
expect 0 'bodies do not show that the chain should know what bodies carry' "$gatewalk" validate "$scenes/walker.toml" --order 0:1 --json disc.json
holds '.remembered.numbers == ["held_draw", "held_for_s"] and (.remembered.matters | not) and .max_gates == 0' disc.json
expect 0 'chain forgets what bodies carry (held_draw, held_for_s): knowing it made each of' "$gatewalk" validate "$scenes/field.toml" \
  --set forces.random_rate_Hz=1 --set forces.random_N=8 --order 0:1 --trials 400
cat >grip.py <<'END'
import sys
key = sys.argv[1]
print('{"gatewalk": 1, "uniforms": 2, "coordinates": [{"name": "s", "unit": "m", "scale": 0.1}], "costs": [{"key": "time_s", "unit": "s"}],'
      f' {key} "faces": [{{"name": "S", "move": [0, 1]}}, {{"name": "L", "move": [-1, 0]}}, {{"name": "R", "move": [1, 0]}}]}}', flush=True)
for word in map(str.split, sys.stdin):
    if not word:
        sys.stdout.flush()
        continue
    number, face, s, seed, turns, grips, memory = word
    grip = 0 if memory == "-" else float(memory.split(",")[0])
    right = float(turns) < 0.5 + grip / 2
    print(number, "left", "R" if right else "L", 0, 1, f"{float(grips) - 0.5},more" if len(sys.argv) < 3 else sys.argv[2])
END
cat >grip.toml <<'END'
field = { columns = 9, rows = 3, max_gates = 12 }
start = { face = "S", s_m = 0.0 }
cell = { width_m = 1.0, length_m = 1.0, faces = [{ name = "S", move = [0, 1] }, { name = "L", move = [-1, 0] }, { name = "R", move = [1, 0] }], coordinates = [{ name = "s", unit = "m" }] }
END
grip() { "$gatewalk" validate grip.toml --cell-program "python3 grip.py '$1' ${2-}" --order 0:1 --trials 300 --json grip.json --force; }
expect 0 'chain forgets what bodies carry (grip): knowing it made each of' grip '"remembered": [{"key": "grip"}],'
holds '.remembered.matters and .remembered.gain_95[0] > 0.02 and .order == 0' grip.json
grep -q '"verdict": "The chain need not.*The chain forgets what' grip.json || fail "order: the verdict leaves out what bodies carry"
expect 0 'carry (grip) cannot be told' grip '"remembered": [{"key": "grip"}],' 1,
holds '.remembered.passages == 0 and .remembered.gain == null and (.remembered.matters | not)' grip.json
expect 0 'need not remember turns' grip ''
holds '.remembered == null' grip.json
expect 1 "memory: grip 'full' is not a finite number" grip '"remembered": [{"key": "grip"}],' full
expect 1 "memory: slip '' is not a finite number" grip '"remembered": [{"key": "grip"}, {"key": "slip"}],' 0.5

expect 2 'must be two whole numbers from 0 to 8' "$gatewalk" validate runs.csv --cell cell.toml --order 4
expect 2 'the first one smaller' "$gatewalk" validate runs.csv --cell cell.toml --order 2:1
expect 2 'must be turns, faces or states' "$gatewalk" validate runs.csv --cell cell.toml --order 0:2 --order-of steps
expect 2 'no meaning' "$gatewalk" validate runs.csv --cell cell.toml --order 0:2 --trials 100
expect 2 'there is no --order' "$gatewalk" build runs.csv --cell cell.toml --order-of faces -o x.nc
expect 2 'without --order' "$gatewalk" validate runs.csv --cell cell.toml --order-of faces
expect 0 '^[23] turns are enough' "$gatewalk" validate runs.csv --cell cell.toml --order 2:3
expect 2 'only validate --order takes it' "$gatewalk" build runs.csv --cell cell.toml --order 1 --order-of states -o x.nc
expect 2 'for recorded runs only' "$gatewalk" build "$scenes/field.toml" --order 1 -o x.nc
expect 2 'at least 0 and at most 8' "$gatewalk" build runs.csv --cell cell.toml --order 9 -o x.nc
[ ! -e x.nc ] || fail "a refused build wrote a file"
finish
