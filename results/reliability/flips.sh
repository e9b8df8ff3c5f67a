#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A bit of a file is flipped, a thousand times for each kind of file that this program writes and reads again (bins,
# trees, several types of gates, recorded runs, an imported chain, a checkpoint, a part), and a map that is a picture.   [BUILD=build] results/reliability/flips.sh
# Writes flips.csv: file, bytes, flips, and what became of them: refused, cut_short (the last pieces are missing and
# done again), same (the pixels of a picture), silent (none may be). Takes some minutes.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
build=${BUILD:-$root/build}
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
field=("$root/scenes/field.toml" --set run.method=moreau --seed 1 --quiet)
"$gatewalk" build "${field[@]}" --bins paper --trials 5 -o bins.nc >/dev/null
"$gatewalk" build "${field[@]}" --bins tree --trials 200 -o tree.nc >/dev/null
"$gatewalk" build "$root/scenes/mixed.toml" --set run.method=moreau --bins paper --trials 2 -o types.nc --quiet >/dev/null
"$gatewalk" build "$root/scenes/tracks/runs.csv" --cell "$root/scenes/tracks/cell.toml" -o recorded.nc --quiet >/dev/null
printf 'state,move_x,move_y\n0,0,1\n1,1,0\n2,-1,0\n' >states.csv
printf 'from,to,count\n0,0,5\n0,trapped,2\n1,2,7\n2,0,1\n' >chain.csv
"$gatewalk" import chain.csv --states states.csv -o imported.nc --quiet >/dev/null
"$gatewalk" lattice "${field[@]}" --trials 1e7 --checkpoint checkpoint --max-time 3s --json never.json >/dev/null 2>&1 || [ $? = 75 ]
"$gatewalk" lattice "${field[@]}" --trials 400 --shard 1/2 --part part 2>/dev/null
"$build/tests/fuzz/fuzz_flips" 1000 bins.nc tree.nc types.nc recorded.nc imported.nc checkpoint part "$root/tests/fuzz/corpus/terrain_png/grey8" >flips.csv
cp flips.csv "$root/results/reliability/flips.csv"
manifest results/reliability/flips.sh >"$root/results/reliability/flips.txt"
echo "date: $(date -I)" >>"$root/results/reliability/flips.txt"
