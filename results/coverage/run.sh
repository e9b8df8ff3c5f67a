#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Do 95 % intervals hold the truth 95 times in 100? Counted over many seeds, for each kind of interval by itself.
#   results/coverage/run.sh [GATEWALK [COMMAND...]]      about 2 hours on two cores (40 minutes more without truth.json)
# Needs python3. With commands (predict, lattice, analyze, validate, power, rare, build, recorded, imported, unseen)
# only their rows are made anew; each row names the program that made it.
# Writes coverage.csv, manifest.txt; truth.json if it is not there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
python3 "$here/study.py" "$gatewalk" "$here" "${@:2}"
manifest "results/coverage/run.sh${2:+ GATEWALK ${*:2}}" >"$here/manifest.txt"
