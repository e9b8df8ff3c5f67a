#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Speed against accuracy of every method: the six scenes with 10^5 trials per setting, and, apart,
# overdamped beams with 1000, where most methods are slow or fail.
#   results/accuracy/run.sh [GATEWALK]      about an hour on two cores
# Writes chart.csv, chart.json, chart.svg; overdamped/ the same; manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"
mkdir -p "$here/overdamped"

scenes=()
for scene in single_gate field soft_left wading undamped stiff; do scenes+=("scenes/$scene.toml"); done
"$gatewalk" chart methods "${scenes[@]}" --trials 1e5 --seed 1 -o "$here" --force >"$here/chart.txt"
"$gatewalk" chart methods "scenes/overdamped.toml" --trials 1000 --seed 1 -o "$here/overdamped" --force >"$here/overdamped/chart.txt"
manifest "results/accuracy/run.sh" >"$here/manifest.txt"
