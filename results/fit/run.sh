#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Do posteriors of gatewalk fit say what they should?   [BUILD=build] [EXPERIMENTS=300] [TRIALS=100000] results/fit/run.sh
# Forty minutes on two cores. experiments.csv: made-up experiments whose four numbers are known (study.py); calibration.txt: how
# often intervals hold them, and whether their ranks are uniform. field.txt: four numbers of the whole field, with the time.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
gatewalk=$(realpath "${BUILD:-$root/build}/gatewalk")
out=$root/results/fit
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
  manifest "EXPERIMENTS=${EXPERIMENTS:-300} TRIALS=${TRIALS:-100000} results/fit/run.sh"
  echo "date: $(date -I)"
  python3 "$root/results/fit/study.py" "$gatewalk" "$root/scenes/field.toml" "${EXPERIMENTS:-300}" "${TRIALS:-100000}" "$out"
} | tee "$work/calibration.txt"
mv "$work/calibration.txt" "$out/calibration.txt"
"$gatewalk" lattice "$root/scenes/field.toml" --set forces.propulsion_N=7.2 --set forces.random_N=25 --trials 300 --seed 11 --quiet \
  --json "$work/truth.json"
jq -r '"gate_x,gate_y,count", (.final_gates | to_entries[] | .key as $y | .value | to_entries[] | "\(.key - 4),\($y),\(.value)")' \
  "$work/truth.json" >"$work/gates.csv"
{
  manifest "results/fit/run.sh"
  cp "$root/scenes/field.toml" "$work" && cd "$work"  # names of files stand in the picture
  "$gatewalk" fit field.toml gates.csv --free forces.propulsion_N=5:9 --free forces.random_N=10:40 \
    --free beams.stiffness_left_Nm_per_rad=300:500 --free beams.stiffness_right_Nm_per_rad=300:500 --force \
    --figure "$out/field.svg"
} >"$work/field.txt"
mv "$work/field.txt" "$out/field.txt"
