#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every reader, handed input of any kind: tests/fuzz/run.sh, so many seconds a target, and its table kept as fuzz.csv
# (target, executions, seconds, findings).   [SECONDS_EACH=60] [BUILD=build] results/reliability/fuzz.sh
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
gatewalk=${BUILD:-$root/build}/gatewalk
. "$root/results/manifest.sh"
env -u BUILD "$root/tests/fuzz/run.sh"
cp "$root/build-fuzz/fuzz.csv" "$root/results/reliability/fuzz.csv"
manifest "SECONDS_EACH=${SECONDS_EACH:-60} results/reliability/fuzz.sh" >"$root/results/reliability/fuzz.txt"
echo "date: $(date -I)" >>"$root/results/reliability/fuzz.txt"
