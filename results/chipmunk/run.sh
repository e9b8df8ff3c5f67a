#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The gate in another engine, Debian's Chipmunk, as a cell program: both engines side by side, and whether a chain's
# bars hold at 300 starts.
#   results/chipmunk/run.sh [BUILD]      BUILD: with tests and libchipmunk-dev
# Writes engines.csv, endings.csv, gates.csv, direct.csv (trials by start), chain.csv (predictions), cost.csv, held.csv (a line per
# pool and start), summary.txt, chipmunk.svg, manifest.txt. Lines of direct.csv that are there are not run again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
program=$build/tests/chipmunk_gate
. "$root/results/manifest.sh"
export PYTHONDONTWRITEBYTECODE=1
python3 "$here/engines.py" "$gatewalk" "$program" "$here" "$root/scenes/programs/chipmunk_gate.cpp"
python3 "$here/chains.py" "$gatewalk" "$program" "$here"
python3 "$here/trials.py" "$gatewalk" "$program" "$here" 2
python3 "$here/study.py" "$here"
gnuplot -c "$here/plot.gp" "$here/held.csv" "$here/endings.csv" "$here/chipmunk.svg"
light_or_dark "$here/chipmunk.svg"
{
  manifest "results/chipmunk/run.sh"
  echo "chipmunk: $(dpkg-query -W -f '${Package} ${Version}' libchipmunk7)"
} >"$here/manifest.txt"
