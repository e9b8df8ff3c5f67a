#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Are wrong chains found out, is the right cause named, and are right chains left alone?
#   results/assumptions/run.sh [BUILD [CHAINS]]      BUILD: with tests; needs python3; 25 minutes on two cores
# with 12 chains of each kind
# Writes assumptions.csv, summary.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
chains=${2:-12}
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
one() { # NAME HOW AMOUNT SCENE [KEY=VALUE ...]
  "$build/tests/assumptions_bench" "$2" "$3" 0.02 1 "$chains" "$root/scenes/$4.toml" run.method=moreau "${@:5}" |
    sed "s/^/$1,/" >"$(mktemp "$scratch/XXXXXX.csv")"
}
export -f one
export build root scratch chains
P="forces.propulsion_N=7.3 forces.random_N=40"
Q="forces.propulsion_N=8.2 forces.random_N=30 beams.stiffness_left_Nm_per_rad=360 beams.stiffness_right_Nm_per_rad=360"
R="forces.propulsion_N=9 forces.random_N=60"
U="forces.propulsion_N=8 forces.random_N=40 beams.stiffness_left_Nm_per_rad=350 beams.stiffness_right_Nm_per_rad=420"
far='terrain.map=["sssssssss","sssssssss","sssssssss","sssssssss","sssssssss","sssssssss",".........",".........","........."]'
left='terrain.map=["ssss.....","ssss.....","ssss.....","ssss.....","ssss.....","ssss.....","ssss.....","ssss.....","ssss....."]'
soft() { echo "terrain.types.s.beams.stiffness_left_Nm_per_rad=$1 terrain.types.s.beams.stiffness_right_Nm_per_rad=$1"; }
{
  for scene in "P field $P" "Q field $Q" "R field $R" "U field $U" "robot robot" "mixed mixed terrain.seed=8"; do
    read -r name what <<<"$scene"
    printf '%s\n' "$name right 0 $what"
  done
  for k in 280 320; do printf '%s\n' "P$k mirror 0 field $P beams.stiffness_left_Nm_per_rad=$k"; done
  for k in 280 310; do printf '%s\n' "Q$k mirror 0 field $Q beams.stiffness_left_Nm_per_rad=$k"; done
  for k in 260 310; do printf '%s\n' "R$k mirror 0 field $R beams.stiffness_left_Nm_per_rad=$k"; done
  for n in 30 60 100; do
    printf '%s\n' "P states $n field $P" "Q states $n field $Q" "U states $n field $U"
  done
  for q in 0.15 0.25; do
    printf '%s\n' "P keeps $q field $P" "Q keeps $q field $Q" "R traps $q field $R" "U traps $q field $U"
  done
  for seed in 6 7 8; do printf '%s\n' "mixed$seed types 0 mixed terrain.seed=$seed $(soft 330)"; done
  for k in 280 330; do
    printf '%s\n' "far$k types 0 field $far $(soft $k)" "left$k types 0 field $left $(soft $k)"
  done
} | xargs -P "$(nproc)" -d '\n' -I{} bash -c 'set -eo pipefail; read -ra words <<<"$1"; one "${words[@]}"' one {}
{
  echo "scene,how,amount,seed,error,own_p,wrong,mirror,states,face_before,quarters,cells"
  sort "$scratch"/*.csv
} >"$here/assumptions.csv"
python3 "$here/summary.py" "$here"
manifest "results/assumptions/run.sh" >"$here/manifest.txt"
