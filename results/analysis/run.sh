#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Times, work and derivatives of gatewalk analyze beside the full dynamics.
#   results/analysis/run.sh [GATEWALK]      about 25 minutes on two cores, needs python3
# Writes summary.txt, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
python3 "$here/study.py" "$gatewalk" "$here"
manifest "results/analysis/run.sh" >"$here/manifest.txt"
