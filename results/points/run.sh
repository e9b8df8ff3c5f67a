#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Less chance by points in the noise: variances over replicates, with points beside plain runs, and what points cost.
#   results/points/run.sh [BUILD]      BUILD: with tests; about 5 minutes on two cores
# Writes points.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
one() {
  local name=$1 scene=$2
  shift 2
  "$build/tests/points_bench" "$root/scenes/$scene.toml" run.method=moreau "$@" | sed "s/^/$name,/" >"$scratch/$name"
}
export -f one
export build root scratch
printf '%s\0' "A field" "B field forces.propulsion_N=8 forces.random_N=10" \
  "C field forces.propulsion_N=8.5 forces.random_N=25 beams.stiffness_left_Nm_per_rad=300 beams.stiffness_right_Nm_per_rad=450" \
  "robot robot" "mixed mixed" | xargs -0 -P "$(nproc)" -I{} bash -c 'set -e; one {}'
{
  echo "scene,what,trials,replicates,plain,points"
  for name in A B C robot mixed; do cat "$scratch/$name"; done
} >"$here/points.csv"
manifest "results/points/run.sh" >"$here/manifest.txt"
