#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which method meets which of requirements 1 to 17, with the figures that the tests measured.
#   results/requirements/run.sh [GATEWALK [FOLDER]]      about 10 minutes on two cores
# GATEWALK_LONG=0: with the counts of ordinary tests, about 2 minutes.
# Writes requirements.csv, requirements.md, manifest.txt. Runs the tests built beside GATEWALK;
# figures 16 and 17 are those of results/accuracy/chart.json.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=${1:-$root/build/gatewalk}
folder=${2:-$here}
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

tests=$(dirname "$gatewalk")/tests/dynamics_tests
suites='Impact.*:Paper.*:Penalty*:Zeno.*:EnergyLedger.*:*/AnyMethod.*:*/ExactHits.*:*/BothAlike.*:*/EnergyInSteps.*'
suites+=':*/HeldContacts.*:*/Requirement.*:*/Gate.LateralSpeedHas*'
export GATEWALK_LONG=${GATEWALK_LONG:-1}
# A test that fails is a line of the table too.
status=0
"$tests" --gtest_filter="$suites" --gtest_output="json:$work/tests.json" >"$work/log" || status=$?
[ -s "$work/tests.json" ] || { tail "$work/log" >&2; exit 1; }

chart=$root/results/accuracy/chart.json
[ -e "$chart" ] || { echo null >"$work/chart.json"; chart=$work/chart.json; }
table() { jq -r --slurpfile chart "$chart" --arg form "$1" -f "$here/table.jq" "$work/tests.json"; }
mkdir -p "$folder"
table csv >"$work/requirements.csv"
table markdown >"$work/requirements.md"
mv "$work"/requirements.* "$folder"
manifest "GATEWALK_LONG=$GATEWALK_LONG results/requirements/run.sh" >"$folder/manifest.txt"
[ $status = 0 ] || grep "FAILED" "$work/log" >&2
exit $status
