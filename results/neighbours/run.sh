#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# How alike are the final gates of neighbouring starts?
#   results/neighbours/run.sh [GATEWALK]      about 3 minutes on two cores, needs python3
# Writes neighbours.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
python3 "$here/study.py" "$gatewalk" "$here"
manifest "results/neighbours/run.sh" >"$here/manifest.txt"
