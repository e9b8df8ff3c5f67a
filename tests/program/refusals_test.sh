#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Wrong input is refused before the runs: within a second of work, not after hours.   refusals_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" build "$scenes/field.toml" --accuracy 0.2 -o t.nc --quiet >/dev/null || fail "a matrix of trees"
"$gatewalk" sample observed -o seen.csv --quiet
"$gatewalk" sample cell -o cell.toml --quiet
mkdir folder
field=$scenes/field.toml
actions=(--set actions.slow.forces.propulsion_N=6 --set actions.fast.forces.propulsion_N=9)

# before COMMAND... -- WRONG...: with each list of words WRONG the command exits with 2 within 2 s of CPU, naming one of
# them.
before() {
  local command=() wrong
  while [ "$1" != -- ]; do command+=("$1"); shift; done
  shift
  for wrong; do
    # shellcheck disable=SC2086
    (ulimit -t 2; exec "$gatewalk" "${command[@]}" $wrong) >out.txt 2>&1 </dev/null
    local status=$?
    [ $status = 2 ] || fail "status $status, not refused before the work: ${command[0]} $wrong ($(tail -n 1 out.txt))"
    tr ' =' '\n\n' <<<"${wrong//--/}" | grep -qFf - out.txt || fail "nothing is named: ${command[0]} $wrong ($(tail -n 1 out.txt))"
  done
}
outputs=('--json none/x.json' '--csv none/x.csv' '--json folder')
figures=("${outputs[@]}" '--figure x.gif' '--figure none/x.svg')
keys=('--set nosuch.key=1' '--set forces.random_N=-1' '--set forces.random_N=x' '--set run.method=nosuch')

before gate "$field" --trials 1e9 -- "${figures[@]}" "${keys[@]}" '--trials 0' '--trials -1'
before sweep "$field" --trials 1e9 --vary forces.propulsion_N=5,6 -- "${figures[@]}" "${keys[@]}" '--vary forces.nosuch_N=1,2' \
  '--vary forces.random_N=1,-1' '--vary forces.random_N=x' '--vary nosuch'
before landscape "$field" --trials 1e8 -o land -- "${figures[@]}" "${keys[@]}" '--spacing 0' '--spacing -1' '--trials -1'
before trace "$field" --field --trials 900 -- "${figures[@]}" "${keys[@]}" '--only nosuch' '--video x.avi' '--video-speed 0 --video x.mp4' \
  "--policy none.json ${actions[*]}" '--netcdf none/x.nc' '--replay none/x.html'
before predict "$field" --accuracy 0.0005 -- "${figures[@]}" "${keys[@]}" '--start nosuch' '--start 1,2' '--start 1e9,0,1' \
  '--bins nosuch' '--page none/x.html' '--netcdf none/x.nc' '--solver nosuch' '--accuracy 0' '--accuracy 2' '--gate-runs 0'
before predict t.nc --accuracy 0.0005 -- "${figures[@]}" '--row nosuch' '--row 1=none.nc' '--start 1,2'
before analyze "$field" --accuracy 0.0005 -- "${figures[@]}" "${keys[@]}" '--target nosuch' '--lump 0' '--lump x' '--runs 50' '--runs -1' \
  '--step 0' '--step 2' '--paths -1' '--trials 0' '--trials -1' '--over nosuch=1:2' '--over forces.random_N=2:1' '--over-trials 0' \
  '--page none/x.html' '--start 1,2'
before rare "$field" --row 60 --accuracy 0.001 -- "${figures[@]}" "${keys[@]}" '--row -1' '--accuracy 0' '--accuracy -1' '--trials 0' \
  '--trials -1' '--split-trials 0' '--gate-runs 0' '--shard 1/2'
before lattice "$field" --trials 1e9 -- "${figures[@]}" "${keys[@]}" '--passages none/x.csv' '--cell-file none/x.toml' '--netcdf none/x.nc' \
  "--policy none.json ${actions[*]}" '--first-trial -1'
before plan "$field" "${actions[@]}" --accuracy 0.001 -- "${figures[@]}" "${keys[@]}" '--least nosuch' '--least work_J --set field.max_gates=0' \
  '--least forward_m --set field.max_gates=0' '--least time_s --points 1' '--least time_s --chance 2' '--chance 0.5' '--points 3' \
  '--robust --least time_s' '--policy none/x.json' '--gate-policy none/x.json' '--over start.x_m=0:1' '--gate-runs 1' \
  '--set actions.slow.forces.nosuch_N=1'
before plan "$field" --accuracy 0.001 -- '--over start.nosuch=0:1' '--over forces.random_N=0:1' '--over start.x_m=1:0' '--least time_s' '--policy x.json'
before design "$scenes/mixed.toml" --accuracy 0.001 -- "${figures[@]}" "${keys[@]}" '--types nosuch' '--changes 0' '--changes 100' '--start 1,2' \
  '-o none/x.toml'
before build "$field" --accuracy 0.0005 -o b.nc -- "${outputs[@]}" "${keys[@]}" '--starts nosuch' '--starts 2:1,0:1,0:1' '--states 0' \
  '--bins nosuch' '--bins 0' '--first-trial 5' '--trials 10 --accuracy 0.1' '--start 1,2'
before build "$field" --bins paper --trials 1e9 -o b.nc -- "${outputs[@]}" "${keys[@]}" '--states 5' '--starts all'
before walk m.nc --walks 1e9 -- "${figures[@]}" '--netcdf none/x.nc' '--walks 0' '--set nosuch.key=1'
before validate "$field" --trials 1e7 --accuracy 0.001 -- "${figures[@]}" "${keys[@]}" '--observed none.csv' '--observed cell.toml' \
  '--matrix none.nc' '--null-draws 0' '--walks 0' '--start 1,2' '--bins nosuch' '--matrix m.nc --bins paper'
before power "$field" --accuracy 0.0005 -- "${outputs[@]}" "${keys[@]}" '--versus nosuch.key=1' '--versus field.rows=3' '--versus t.nc' \
  '--trials 0' '--power 2' '--level 0' '--accuracy 0'
before fit "$field" seen.csv --free forces.random_N=20:80 --trials 1e8 -- "${figures[@]}" "${keys[@]}" '--free nosuch=1:2' \
  '--free forces.propulsion_N=2:1' '--free forces.propulsion_N=x' '--free forces.random_N=1:2' '--trials 0'
before chart methods "$field" -o charts --trials 1e7 -- "${figures[@]}" "${keys[@]}" '--methods nosuch' '--repeats 0'
before chart field "$field" -o charts --trials 1e7 -- "${figures[@]}" "${keys[@]}" '--trials 0'
before chart chain "$field" -o charts -- "${figures[@]}" "${keys[@]}"
before chart limits "$field" -o charts --trials 1e5 -- "${figures[@]}" "${keys[@]}" '--methods nosuch' '--trials 0'
before reproduce -o report -- "${outputs[@]}"
ls | grep -qx -e land -e charts -e report && fail "a refused command made its folder: $(ls)"

# Values of --vary are named as the user gave them.
expect 2 '^gatewalk: --vary forces.random_N=1,-1: forces.random_N = -1 is not permitted' "$gatewalk" sweep "$field" --vary forces.random_N=1,-1

finish
