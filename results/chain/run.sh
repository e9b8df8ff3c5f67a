#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The chain's error against its cost, beside direct simulation at the same cost.
#   results/chain/run.sh [GATEWALK]      about 3 minutes on two cores
# Writes chain.csv, chain.json, chain.svg, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

"$gatewalk" chart chain "scenes/field.toml" --truth-trials 1e5 --visited 1000 --seed 1 \
  -o "$here" --force >"$here/chain.txt"
manifest "results/chain/run.sh" >"$here/manifest.txt"
