#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Are wrong chains found out by the full trials that they were made from, and right ones left alone?
#   results/own_trials/run.sh [BUILD]      BUILD: with tests; about 10 minutes on two cores, needs jq, python3
# Writes own_trials.csv, summary.csv, manifest.txt. The truth is that of results/coverage.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
one() { # NAME FIRST CHAINS ACCURACY SCENE-OR-MEMORY [KEY=VALUE ...]
  local name=$1 numbers=("$2" "$3" "$4") what=("${@:5}")
  if [ -f "$root/scenes/$5.toml" ]; then
    what=("$scratch/$name.truth" "$root/scenes/$5.toml" run.method=moreau "${@:6}")
  fi
  "$build/tests/own_trials_bench" "${numbers[@]}" "${what[@]}" | sed "s/^/$name,/" >"$(mktemp "$scratch/XXXXXX.csv")"
}
for name in A B C mixed robot; do
  jq -r ".$name.final_gates[]" "$root/results/coverage/truth.json" >"$scratch/$name.truth"
done
export -f one
export build root scratch
B="field forces.propulsion_N=8 forces.random_N=10"
C="field forces.propulsion_N=8.5 forces.random_N=25 beams.stiffness_left_Nm_per_rad=300 beams.stiffness_right_Nm_per_rad=450"
{
  for first in 1 16; do
    for scene in "A field" "B $B" "C $C" "mixed mixed" "robot robot"; do
      read -r name what <<<"$scene"
      for accuracy in 0.04 0.02; do printf '%s\0' "$name $first 15 $accuracy $what"; done
    done
  done
  for accuracy in 0.04 0.02; do
    printf '%s\0' "handed 1 400 $accuracy 0"
    for memory in 0.2 0.3 0.4 0.6; do printf '%s\0' "handed 1 25 $accuracy $memory"; done
  done
} | xargs -0 -P "$(nproc)" -I{} bash -c 'set -eo pipefail; one {}'
{
  echo "scene,how,accuracy,trials,error,p,differs"
  sort "$scratch"/*.csv
} >"$here/own_trials.csv"
[ "$(wc -l <"$here/own_trials.csv")" = 2681 ] || { echo "chains are missing" >&2; exit 1; }
python3 "$here/summary.py" "$here"
manifest "results/own_trials/run.sh" >"$here/manifest.txt"
