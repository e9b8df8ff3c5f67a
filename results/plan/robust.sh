#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What do robust plans gain or lose, and is their worst case one?   [BUILD=build] results/plan/robust.sh     some five minutes
# robust.csv: six rows of the field, two actions, 24 seeds; the chance to cross by the plan with and without --robust, and what
# the chain says of it (empty: one action all the time), or its worst case. robust.txt: the means.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
gatewalk=${BUILD:-$root/build}/gatewalk
out=$root/results/plan
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sides=(--set actions.left.beams.stiffness_left_Nm_per_rad=200 --set actions.right.beams.stiffness_right_Nm_per_rad=200)
{
  echo seed,crossed,chain,crossed_robust,worst_case
  for seed in $(seq 11 34); do
    for how in plain robust; do
      robust=()
      [ $how = plain ] || robust=(--robust)
      "$gatewalk" plan "$root/scenes/field.toml" "${sides[@]}" --set run.method=moreau --set field.rows=6 --accuracy 0.04 \
        --seed "$seed" "${robust[@]}" --quiet --force --json "$work/$how.json" >/dev/null 2>>"$work/words"
    done
    jq -r -s --arg seed "$seed" '[$seed, .[0].crossed, .[0].chain, .[1].crossed, .[1].worst_case] | @csv' \
      "$work/plain.json" "$work/robust.json" | tr -d '"'
  done
} >"$work/robust.csv"
mv "$work/robust.csv" "$out/robust.csv"
{
  manifest "results/plan/robust.sh"
  awk -F, 'NR > 1 { n++; a += $2; b += $4; d = $4 - $2; s += d; q += d * d
      if ($3 != "") { m++; if ($3 > $2) { over++; if ($3 - $2 > most) most = $3 - $2 } }
      if ($5 > $4) above++ }
    END { printf "crossed: %.1f %%, robust %.1f %% of the trials, mean of %d plans each; difference %.1f points, standard error %.1f\n",
        100 * a / n, 100 * b / n, n, 100 * s / n, 100 * sqrt((q / n - s * s / n / n) / (n - 1))
      printf "the chain says too much of %d of %d plans that choose by the way in, by up to %.0f points\n", over, m, 100 * most
      printf "the worst case lies above the share of the trials in %d of %d robust plans\n", above, n }' "$out/robust.csv"
} >"$work/robust.txt"
mv "$work/robust.txt" "$out/robust.txt"
