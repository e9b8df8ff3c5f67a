#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a check that only prints, and keeps what it printed: results/reliability/record.sh NAME COMMAND...
# Writes NAME.txt (command, program, machine, date, status, minutes, what was printed). Status: the command's.
#   [BUILD=build] results/reliability/record.sh faults tests/faults.sh build/gatewalk . 4
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
gatewalk=${BUILD:-build}/gatewalk
. results/manifest.sh
name=$1
shift
printed=$(mktemp)
trap 'rm -f "$printed"' EXIT
"$@" | tee "$printed"
status=${PIPESTATUS[0]}
{
  manifest "$*"
  echo "date: $(date -I)"
  echo "status: $status, after $(((SECONDS + 30) / 60)) minutes"
  cat "$printed"
} >"results/reliability/$name.txt"
exit "$status"
