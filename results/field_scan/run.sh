#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which propulsion and random force did the paper use in its field? It does not say. The posterior of both from Table IV
# (posterior.py), by validations of 128 scenes over F_prop 5 to 9.5 N and Rm 10 to 100 N and of 128 where these put it.
#   [BUILD=build] results/field_scan/run.sh      11 minutes on two cores; seconds where points.csv is there
# points.csv: a line for each scene and start; posterior.csv, posterior.svg: on a grid; posterior.txt: the answer.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${BUILD:-$root/build}/gatewalk")
. "$root/results/manifest.sh"
text=$(mktemp)
trap 'rm -f "$text"' EXIT
{
  manifest "results/field_scan/run.sh"
  echo "date: $(date -I)"
  python3 "$here/posterior.py" "$gatewalk" "$root/scenes/field.toml" "$here"
} | tee "$text"
cat "$text" >"$here/posterior.txt"
gnuplot -c "$here/posterior.gp" "$here/posterior.csv" "$here/posterior.svg"
light_or_dark "$here/posterior.svg"
