#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What beams that remember, and beams of neighbouring gates, change in the final gates, and their cost.
#   results/fidelity/run.sh [GATEWALK]      about 4 minutes on two cores
# Writes fidelity.csv, fidelity.json, fidelity.svg, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

"$gatewalk" chart field "scenes/field.toml" --trials 10000 --seed 1 --set run.step_s=0.001 \
  -o "$here" --force >"$here/fidelity.txt"
manifest "results/fidelity/run.sh" >"$here/manifest.txt"
