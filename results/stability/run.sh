#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Where each method breaks: five maps.
#   results/stability/run.sh [GATEWALK]      15 seconds on two cores
# Writes stability.csv, stability.json, a figure per map, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

"$gatewalk" stability --seed 1 -o "$here" --force >"$here/stability.txt"
manifest "results/stability/run.sh" >"$here/manifest.txt"
