#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The chance to enter rows 1 to 40 of the paper's field: by direct simulation, by splitting, by the chain alone.
#   results/rare/run.sh [GATEWALK]      about 6 minutes on two cores
# Writes rare.csv (a line per row), rare.json (of splitting), rare.svg, manifest.txt.
# Seconds are those of one core (user time), whatever else the machine does.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
millions=5  # of direct trials, each with a seed of its own
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"

field=(scenes/field.toml --set run.method=moreau)
TIMEFORMAT=%U
for seed in $(seq $millions); do
  { time "$gatewalk" lattice "${field[@]}" --set field.rows=40 --set field.max_gates=0 --trials 1e6 --seed "$seed" \
    --json "$work/direct$seed.json" --quiet >/dev/null 2>&1; } 2>>"$work/direct.txt"
done
{ time "$gatewalk" rare "${field[@]}" --row 40 --accuracy 0.03 --gate-runs 1e8 --seed 1 --json "$here/rare.json" --force \
  --quiet >/dev/null 2>&1; } 2>"$work/rare.txt"

# Of direct trials Wilson's interval.
jq -rs '(.[0].rows | map(.row)) as $rows | .[0].rows as $split | .[1:] as $direct
  | ($direct | map(.trials) | add) as $n
  | ["row","splitting","splitting_low","splitting_high","direct_trials","direct_entered","direct","direct_low","direct_high","chain"],
    ($rows[] as $r | ($direct | map((([.final_gates[$r:][][]] | add) // 0) + if $r == 40 then .endings.crossed else 0 end) | add) as $k
     | ($k / $n) as $p | (1.959964 * 1.959964) as $z | (($p + $z / 2 / $n) / (1 + $z / $n)) as $middle
     | ((($p * (1 - $p) * $z / $n + $z * $z / 4 / $n / $n) | sqrt) / (1 + $z / $n)) as $half
     | $split[$r - 1] | [.row, .probability, .probability_95[], $n, $k, $p, $middle - $half, $middle + $half, .chain])
  | @csv' "$here/rare.json" "$work"/direct*.json | tr -d '"' >"$here/rare.csv"
direct=$(awk '{ s += $1 } END { printf "%.0f", s }' "$work/direct.txt")
chain=$(jq --argjson all "$(cat "$work/rare.txt")" '$all * .chain_seconds / .seconds | round' "$here/rare.json")
split=$(awk -v chain="$chain" '{ printf "%.0f", $1 - chain }' "$work/rare.txt")
{
  manifest "results/rare/run.sh"
  echo "seconds of one core: $direct direct trials, $split splitting, $chain the chain"
} >"$here/manifest.txt"
gnuplot -c "$here/plot.gp" "$here/rare.csv" "$here/rare.svg" "$direct" "$split" "$chain"
light_or_dark "$here/rare.svg"
