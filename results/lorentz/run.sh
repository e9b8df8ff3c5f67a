#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What must a chain remember? The diffusion coefficient of the periodic Lorentz gas by chains of trees, beside
# direct simulation, hops without memory and with one step of it.
#   results/lorentz/run.sh [BUILD]      BUILD: with tests; about 5 minutes on two cores
# Writes lorentz.csv (a line per gap), leaves.csv (what leaves of finite size cost), seconds.csv (of CPU, by route),
# lorentz.svg, manifest.txt. reference.csv: see README.md.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
TIMEFORMAT=%U
{ seconds=$({ time "$build/tests/lorentz_study" "$here" 2>&3; } 2>&1); } 3>&2
gnuplot -c "$here/plot.gp" "$here/lorentz.csv" "$here/leaves.csv" "$here/lorentz.svg"
light_or_dark "$here/lorentz.svg"
{
  manifest "results/lorentz/run.sh"
  echo "seconds of one core: $seconds"
} >"$here/manifest.txt"
