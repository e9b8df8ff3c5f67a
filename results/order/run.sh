#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Is the order of agents found whose memory is known, and how strong must a memory be to be found?
#   results/order/run.sh [BUILD]      BUILD: with tests; 15 minutes on two cores
# Writes agents.csv, summary.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
agents=100
{
  echo "order,effect,seed,found,best"
  for effect in 0.05 0.1 0.15 0.2 0.3; do "$build/tests/order_bench" "$effect" 1 "$agents"; done
} >"$here/agents.csv"
awk -F, 'NR > 1 { key = $1 "," $2; n[key]++; found[key] += $4 == $1; more[key] += $4 > $1 }
  END { for (key in n) print key "," n[key] "," found[key] "," more[key] }' "$here/agents.csv" | sort -t, -k1n -k2n |
  sed '1i order,effect,agents,found,exceeded' >"$here/summary.csv"
manifest "results/order/run.sh" >"$here/manifest.txt"
