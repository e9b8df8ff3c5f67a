#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Is a plan worth what it says?   [BUILD=build] [STARTS=100] results/plan/run.sh     some twenty minutes on two cores
# fields.csv: three fields with two or three actions; the chance to cross by the plan, as it says and as 20 000 new trials
# of its policy have it, that of the best action all the time, and the gain over it.
# starts.csv: one field from STARTS starts; what the plan says, with its interval, and 20 000 trials of its policy.
# inside.txt: how often the intervals hold these.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
gatewalk=${BUILD:-$root/build}/gatewalk
out=$root/results/plan
starts=${STARTS:-100}
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
left=(--set actions.left.beams.stiffness_left_Nm_per_rad=200 --set actions.right.beams.stiffness_right_Nm_per_rad=200)
trials=20000
# planned NAME SEED ACCURACY SCENE OPTION...: its line of the table
planned() {
  local name=$1 seed=$2 accuracy=$3
  shift 3
  "$gatewalk" plan "$@" --accuracy "$accuracy" --seed "$seed" --quiet --force --json "$work/plan.json" --policy "$work/policy.json" \
    >/dev/null 2>>"$work/words"
  # The start's own option is not one of `lattice`.
  local words=() start=()
  while [ $# -gt 0 ]; do
    case $1 in --start) start=("$2"); shift ;; *) words+=("$1") ;; esac
    shift
  done
  [ ${#start[@]} = 0 ] || IFS=, read -r x vx vy <<<"${start[0]}"
  [ ${#start[@]} = 0 ] || words+=(--set "start.x_m=$x" --set "start.vx_m_per_s=$vx" --set "start.vy_m_per_s=$vy")
  "$gatewalk" lattice "${words[@]}" --policy "$work/policy.json" --trials $trials --seed $((seed + 1000)) --quiet --force \
    --json "$work/run.json" >/dev/null 2>>"$work/words"
  jq -r -s --arg name "$name" '.[0] as $p | .[1] as $r | ($p.actions | map(select(.name == $p.best_alone))[0]) as $best |
    [$name, $p.trials, $p.crossed, $p.crossed_95[0], $p.crossed_95[1], $r.endings.crossed / $r.trials, $p.best_alone,
     $best.crossed, $best.gain, $best.gain_95[0], $best.gain_95[1], $p.rounds, $p.gate_runs, $p.seconds] | @csv' \
    "$work/plan.json" "$work/run.json" | tr -d '"'
}
head=trials,crossed,low_95,high_95,crossed_by_policy,best_alone,best_alone_crossed,gain,gain_low_95,gain_high_95,rounds,gate_runs,seconds
{
  echo "field,$head"
  planned "9 x 9: softer left or right" 1 0.01 "$root/scenes/field.toml" "${left[@]}"
  planned "soft left: push 5 or 6.5 or 8 N" 2 0.02 "$root/scenes/soft_left.toml" --set actions.p5.forces.propulsion_N=5 \
    --set actions.p6.forces.propulsion_N=6.5 --set actions.p8.forces.propulsion_N=8
  planned "mixed terrain: softer left or right" 3 0.02 "$root/scenes/mixed.toml" "${left[@]}"
} >"$work/fields.csv"
{
  echo "start,$head"
  for i in $(seq "$starts"); do
    start=$(awk -v i="$i" 'BEGIN { srand(i); printf "%.2f,%.2f,%.2f", 10 * rand() - 5, 10 * rand() - 5, 10 + 10 * rand() }')
    planned "${start//,/ }" "$i" 0.04 "$root/scenes/field.toml" --set field.rows=5 "${left[@]}" --start "$start"
  done
} >"$work/starts.csv"
cp "$work/fields.csv" "$work/starts.csv" "$out"
{
  manifest "STARTS=$starts results/plan/run.sh"
  echo "date: $(date -I)"
  # The trials of the policy have chance of their own: the squares of both add up.
  for table in starts fields; do
    awk -F, -v n=$trials -v table=$table 'NR > 1 { s = 1.96 * sqrt($6 * (1 - $6) / n); all++; sure += $10 > 0; worse += $11 < 0
        inside += $6 > $3 - sqrt(($3 - $4) ^ 2 + s ^ 2) && $6 < $3 + sqrt(($5 - $3) ^ 2 + s ^ 2) }
      END { printf "%s: %d of %d intervals hold what the policy does; for sure better than the best action alone: %d, worse: %d\n",
        table, inside, all, sure, worse }' "$out/$table.csv"
  done
} >"$out/inside.txt"
cat "$out/inside.txt"
