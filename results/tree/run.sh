#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Chains of trees: error against cost beside direct simulation, and whether their error bars hold.
#   results/tree/run.sh [GATEWALK]      about 20 minutes on two cores (40 without truth.json), needs python3, gnuplot
# Writes points.csv, summary.txt, tree.svg, runs.svg, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
python3 "$here/study.py" "$gatewalk" "$here"
python3 "$here/chart.py" "$here"
light_or_dark "$here/tree.svg"
light_or_dark "$here/runs.svg"
manifest "results/tree/run.sh" >"$here/manifest.txt"
