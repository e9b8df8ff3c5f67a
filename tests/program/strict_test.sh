#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# With --strict a result that is not clean gives status 1; the result is written all the same.
#   strict_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200 --json paper.json --quiet
"$gatewalk" build "$scenes/field.toml" --set run.method=paper --trials 5 -o paper.nc --quiet >/dev/null 2>&1
expect 0 'paper.nc: the method showed faults: .* of [0-9]* gate runs' "$gatewalk" walk paper.nc --quiet --json paper-walk.json
holds '.matrix_status.clean == false' paper-walk.json
expect 1 'strict: .* the exit status is 1; the result is written' "$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200 --json strict.json --quiet --strict
cmp -s strict.json paper.json || fail "--strict: another result"
expect 0 'traversed' "$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --strict
expect 1 'strict' "$gatewalk" sweep "$scenes/single_gate.toml" --trials 50 --vary run.method=stable,paper --strict
expect 1 'strict' "$gatewalk" lattice "$scenes/field.toml" --set run.method=paper --trials 50 --strict
expect 1 'strict' "$gatewalk" build "$scenes/field.toml" --set run.method=paper --trials 5 -o strict.nc --strict
cmp -s strict.nc paper.nc || fail "--strict: another matrix"
expect 1 'strict' "$gatewalk" predict paper.nc --strict
expect 1 'strict' "$gatewalk" walk paper.nc --strict
expect 0 'trapped' "$gatewalk" predict m.nc --strict

finish
