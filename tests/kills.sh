#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Kills every kind of run with -9 at N random moments (125 each by default) and resumes it: tests/kills.sh GATEWALK ROOT
# [N]
n=${3:-125}
here=$(realpath "$(dirname "$0")")
. "$here/program/preamble.sh" "$1" "$2"
. "$here/killed.sh"

killed gate.json 0.6 "$n" gate "${field[@]}" --trials 30000 --json gate.json
killed sweep.csv 0.6 "$n" sweep "$scenes/single_gate.toml" --vary forces.propulsion_N=5:1:8 --trials 8000 --csv sweep.csv
killed bins.nc 0.6 "$n" build "${field[@]}" --bins paper --trials 500 -o bins.nc
killed tree.nc 1 "$n" build "${field[@]}" --accuracy 0.015 -o tree.nc
killed lattice.json 0.6 "$n" lattice "${field[@]}" --trials 10000 --json lattice.json
killed predict.json 0.8 "$n" predict "${field[@]}" --accuracy 0.015 --start 0,0,15 --start 4,5,10 --json predict.json
killed rare.json 1 "$n" rare "${field[@]}" --set run.method=moreau --row 4 --accuracy 0.1 --json rare.json
killed validate.json 1 "$n" validate "${field[@]}" --bins paper --matrix-trials 100 --trials 3000 --null-draws 99 --json validate.json
killed analyze.json 2 "$n" analyze "${field[@]}" --accuracy 0.05 --runs 500 --json analyze.json
echo "killed $kills times, with work to go on from $resumable times"
[ $resumable -gt $((kills / 4)) ] || fail "hardly any run was resumed: the moments do not fit this machine"
finish
