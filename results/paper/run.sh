#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every figure, table and number of the paper, with verdicts.
#   results/paper/run.sh [GATEWALK]      about 4 minutes on two cores
# Writes a CSV, an SVG and a PDF per figure, claims.csv, report.json (the page's data), manifest.txt.
# The page itself, report.html, stays in the folder that is named at the end (some 4 MB).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
work=$root/build/paper

"$gatewalk" reproduce -o "$work"
rm -f "$here"/*.csv "$here"/*.svg "$here"/*.pdf
cp "$work"/*.csv "$work"/*.svg "$work"/*.pdf "$work/report.json" "$here"
manifest "results/paper/run.sh" >"$here/manifest.txt"
echo "the page: $work/report.html"
