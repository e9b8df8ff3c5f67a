#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Do predictions from tracks keep what they promise? Bodies whose truth is known, as a camera sees them.
#   results/tracks/run.sh [BUILD]      BUILD: with tests; about 20 minutes on two cores, needs python3
# Writes truth.json, predict.json, validate.json, many.csv, turning_truth.json, turning_1.csv to turning_4.csv (by noise,
# mm), coverage.csv, summary.txt, halves.svg, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
study=$build/tests/tracks_study
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$study" truth "$here/cell.toml" "$here/truth.json"
"$study" film "$here/cell.toml" tracks.csv
"$gatewalk" passages tracks.csv --cell "$here/cell.toml" -o runs.csv --fastest 2 --fps 120 --metres-per-unit 0.001 \
  --columns body=body,frame=frame,x=x_mm,y=y_mm --lattice 5,3 --bridge 15 --quiet
"$gatewalk" build runs.csv --cell "$here/cell.toml" -o M.nc --quiet
"$gatewalk" predict M.nc --json "$here/predict.json" --force --quiet
"$gatewalk" validate M.nc --json "$here/validate.json" --figure "$here/halves.svg" --force --quiet
# Films 1 to 320, on two cores.
"$study" many "$here/cell.toml" first.csv 1 160 &
"$study" many "$here/cell.toml" second.csv 161 160
wait $!
{ cat first.csv; tail -n +2 second.csv; } >"$here/many.csv"
# Bodies that turn round at borders: 20 films for each noise of places, 1 to 4 mm.
"$study" truth "$here/cell.toml" "$here/turning_truth.json" 1 5
turning() { for noise in "$@"; do "$study" many "$here/cell.toml" "turning_$noise.csv" 1 20 "$noise" 5; done; }
turning 1 3 &
turning 2 4
wait $!
cp turning_?.csv "$here"
python3 "$here/summary.py" "$here" >"$here/summary.txt"
manifest "results/tracks/run.sh" >"$here/manifest.txt"
