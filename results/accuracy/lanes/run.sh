#!/usr/bin/env bash
# Speed against accuracy of the two methods that matter most since `moreau` runs in vector lanes: `stable`
# and `moreau`, six scenes, 30 000 trials per setting.
#   results/accuracy/lanes/run.sh [GATEWALK]      about a quarter of an hour on two cores
# Writes chart.csv, chart.json, chart.svg, chart.txt, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

scenes=()
for scene in single_gate field soft_left wading undamped stiff; do scenes+=("scenes/$scene.toml"); done
"$gatewalk" chart "${scenes[@]}" --methods stable,moreau --trials 3e4 --seed 1 -o "$here" >"$here/chart.txt"
manifest "results/accuracy/lanes/run.sh" >"$here/manifest.txt"
