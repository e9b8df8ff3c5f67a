#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Table IV with 10 000 trials per start, the converged single-gate figures, and the health of 10^5
# runs of method stable at each random force.
#   results/table4/run.sh [GATEWALK]      about 2 minutes on two cores
# Writes validation.txt (the table), single_gate.csv, health.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cd "$root"  # so that the screen names the scene as README does
"$gatewalk" validate scenes/field.toml --trials 10000 --bins paper --matrix-trials 100 --seed 1 --details \
  >"$here/validation.txt" 2>/dev/null

echo "method,damping,trials,traversed_left_percent,exited_percent,trapped_percent" >"$here/single_gate.csv"
for method in stable paper; do
  for d in 10 50; do
    "$gatewalk" gate "$root/scenes/single_gate.toml" --trials 20000 --seed 1 --quiet --json "$work/g.json" \
      --set run.method=$method --set forces.propulsion_N=7 --set forces.random_N=10 \
      --set beams.stiffness_left_Nm_per_rad=300 --set beams.stiffness_right_Nm_per_rad=500 \
      --set beams.damping_Nms_per_rad=$d
    jq -r --arg m $method --arg d $d '[$m, $d, .trials, .traversed_left * 100 / .trials,
      (.exited_left + .exited_right) * 100 / .trials, .trapped * 100 / .trials] | @csv' "$work/g.json" |
      tr -d '"' >>"$here/single_gate.csv"
  done
done

echo "scene,random_N,runs,broken,worst_penetration_m,worst_energy_created_J,worst_speed_m_per_s,steps_forced_to_hold,steps" >"$here/health.csv"
for scene in single_gate field; do
  for rm in 10 20 40 60; do
    "$gatewalk" gate "$root/scenes/$scene.toml" --trials 1e5 --seed 1 --quiet --json "$work/h.json" \
      --set forces.random_N=$rm
    jq -r --arg s $scene --arg rm $rm '.status | [$s, $rm, .runs, .runs_not_finite, .worst_penetration_m,
      .worst_energy_created_J, .worst_speed_m_per_s, .steps_forced_to_hold, .steps] | @csv' "$work/h.json" |
      tr -d '"' >>"$here/health.csv"
  done
done

manifest "results/table4/run.sh" >"$here/manifest.txt"
