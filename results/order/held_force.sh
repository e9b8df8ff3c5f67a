#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Should the chain know the random force that a body carries from gate to gate?
#   results/order/held_force.sh [BUILD]      five minutes on two cores, needs jq
# Writes held_force.csv, held_force.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build}")/gatewalk
. "$root/results/manifest.sh"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo "random_rate_Hz,random_N,passages,gain,low,high,matters" >"$here/held_force.csv"
# The same diffusion: the force grows with the square root of the rate.
for force in 50,50 10,22.36 5,15.81 2,10 1,7.071; do
  rate=${force%,*}
  "$gatewalk" validate "$root/scenes/field.toml" --set forces.random_rate_Hz="$rate" \
    --set forces.random_N="${force#*,}" --order 0:1 --trials 2000 --json "$scratch/$rate.json" --quiet >/dev/null
  jq -r --arg force "$force" '.remembered | "\($force),\(.passages),\(.gain),\(.gain_95[0]),\(.gain_95[1]),\(.matters)"' \
    "$scratch/$rate.json" >>"$here/held_force.csv"
done
manifest "results/order/held_force.sh" >"$here/held_force.txt"
