#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# No output may be an input, under any name: the command refuses it before any work and leaves the input unchanged.
#   inputs_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
mkdir -p safe/folder
cp "$scenes/single_gate.toml" safe/own.toml
cp m.nc safe/m.nc
cp m.nc safe/other.nc
cd safe || exit 1
ln -s own.toml soft.toml
ln own.toml hard.toml
ln -s ../safe link
cp own.toml landscape.csv; cp own.toml chart.json; cp own.toml fidelity.svg; cp own.toml chain.csv
inputs() { cat own.toml m.nc other.nc landscape.csv chart.json fidelity.svg chain.csv | cksum; }
untouched=$(inputs)
destroyers=0
destroys() {
  destroyers=$((destroyers + 1))
  expect 2 'are the same file: an output needs a file of its own' "$@"
  [ "$(inputs)" = "$untouched" ] || { fail "an input was destroyed: $*"; untouched=$(inputs); }
}
destroys "$gatewalk" gate own.toml --json own.toml
destroys "$gatewalk" gate own.toml --json ./own.toml
destroys "$gatewalk" gate own.toml --json "$PWD/own.toml"
destroys "$gatewalk" gate own.toml --json folder/../own.toml
destroys "$gatewalk" gate own.toml --json link/own.toml
destroys "$gatewalk" gate own.toml --json soft.toml
destroys "$gatewalk" gate own.toml --json hard.toml
destroys "$gatewalk" gate soft.toml --json own.toml
destroys "$gatewalk" gate /dev/stdin --json own.toml <own.toml
destroys "$gatewalk" sweep own.toml --vary forces.random_N=1 --csv own.toml
destroys "$gatewalk" sweep own.toml --vary forces.random_N=1 --json own.toml --csv x.csv
destroys "$gatewalk" trace own.toml --csv own.toml
destroys "$gatewalk" trace own.toml --netcdf own.toml
destroys "$gatewalk" trace own.toml --replay own.toml
destroys "$gatewalk" trace own.toml --video own.toml
destroys "$gatewalk" trace own.toml --json own.toml
destroys "$gatewalk" build own.toml -o own.toml
destroys "$gatewalk" build own.toml -o x.nc --json own.toml
destroys "$gatewalk" show m.nc --json m.nc
destroys "$gatewalk" walk m.nc --json m.nc
destroys "$gatewalk" walk m.nc own.toml --json own.toml
destroys "$gatewalk" predict m.nc --json m.nc
destroys "$gatewalk" predict m.nc own.toml --json own.toml
destroys "$gatewalk" predict m.nc --row 4=other.nc --json other.nc
destroys "$gatewalk" lattice own.toml --json own.toml
destroys "$gatewalk" validate own.toml --json own.toml
destroys "$gatewalk" validate own.toml --matrix m.nc --json m.nc
destroys "$gatewalk" landscape landscape.csv -o .
destroys "$gatewalk" landscape own.toml -o folder --json own.toml
destroys "$gatewalk" chart methods own.toml chart.json -o .
destroys "$gatewalk" chart methods own.toml m.nc -o folder --json own.toml
destroys "$gatewalk" chart field fidelity.svg -o .
destroys "$gatewalk" chart chain chain.csv -o "$PWD"
# Two outputs may not be the same file, and standard output may not be another file of the command.
destroys "$gatewalk" trace own.toml --csv folder/new --json link/folder/new
destroys "$gatewalk" landscape own.toml -o folder --json folder/landscape.json
destroys "$gatewalk" build own.toml -o link/new.nc --json new.nc
[ $destroyers -ge 20 ] || fail "only $destroyers commands were tried"
"$gatewalk" gate own.toml >>own.toml 2>err.txt
[ $? = 2 ] && grep -q 'standard output are the same file' err.txt || fail "appended a table to the scene: $(cat err.txt)"
"$gatewalk" gate own.toml --json table.txt >table.txt 2>err.txt
[ $? = 2 ] && grep -q 'standard output and --json table.txt are the same file' err.txt || fail "two outputs in one file: $(cat err.txt)"
rm -f table.txt err.txt out.txt
[ "$(inputs)" = "$untouched" ] || fail "an input was destroyed"
[ "$(ls folder | wc -l)" = 0 ] || fail "refused commands left $(ls folder)"
mkdir -p folder/scenes && echo '# my own' >folder/scenes/field.toml
expect 2 'is not empty and holds no report, .* choose another folder, or give --force' "$gatewalk" reproduce -o folder --quick
[ "$(find folder -type f)" = folder/scenes/field.toml ] || fail "reproduce, refused, wrote $(find folder -type f)"
expect 2 'would be replaced; choose another folder' "$gatewalk" reproduce -o folder --quick --force
[ "$(cat folder/scenes/field.toml)" = '# my own' ] || fail "reproduce replaced a scene of the user's own"
# The map that a scene names may not be an output, wherever the scene is named.
mkdir maps
printf '.s.\n...\n' >maps/map.csv
cp maps/map.csv maps/other.csv
printf 'field = { columns = 3, rows = 2 }\n[terrain]\nmap_file = "map.csv"\n[terrain.types.s.forces]\npropulsion_N = 6\n' >maps/map.toml
inputs() { cat "$work"/safe/maps/*.csv "$work/safe/maps/map.toml" | cksum; }
untouched=$(inputs)
other='terrain.map_file="maps/other.csv"'
destroys "$gatewalk" gate maps/map.toml --json maps/map.csv
destroys "$gatewalk" gate maps/map.toml --force --json folder/../maps/map.csv
destroys "$gatewalk" gate maps/map.toml --set "$other" --json maps/other.csv
destroys "$gatewalk" gate maps/map.toml --set "$other" --json maps/map.csv
destroys "$gatewalk" gate own.toml --set field.columns=3 --set field.rows=2 --set "$other" --json maps/other.csv
destroys "$gatewalk" build maps/map.toml -o maps/map.csv
destroys "$gatewalk" predict m.nc maps/map.toml --json maps/map.csv
destroys "$gatewalk" predict maps/map.toml --figure plot.svg --json maps/map.csv
destroys "$gatewalk" scene maps/map.toml --new -o maps/map.csv
destroys "$gatewalk" power maps/map.toml --versus "$other" --json maps/other.csv
destroys "$gatewalk" chart methods own.toml maps/map.toml -o folder --json maps/map.csv
cd maps && destroys "$gatewalk" trace map.toml --csv map.csv; cd ..
destroys "$gatewalk" validate maps/map.toml --matrix m.nc --json maps/map.csv
cd ..

finish
