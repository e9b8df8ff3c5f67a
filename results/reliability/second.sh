#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Gate, chain and field, by this program and by a second one (tests/second, Octave, written from the model alone):
# do they agree?   [BUILD=build] [RUNS=100000] [TRIALS=10000] [STEP=0.0005] results/reliability/second.sh
# Gates from rest in the middle of the first row. Writes second.csv (scene, what, runs of both, total variation, the
# floor of chance, p), second.txt. One scene a core: about 40 minutes on two.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
gatewalk=${BUILD:-$root/build}/gatewalk
runs=${RUNS:-100000} trials=${TRIALS:-10000} step=${STEP:-0.0005}
out=${OUT:-$root/results/reliability}
. "$root/results/manifest.sh"
. "$root/.ci/prepare"
packages+=(octave python3-numpy python3-scipy)
! command -v apt-get >/dev/null || install_missing
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=$root/scenes/field.toml
k_left=beams.stiffness_left_Nm_per_rad k_right=beams.stiffness_right_Nm_per_rad
# one NAME "KEY=VALUE ..." "NUMBER=VALUE ...": the scene for this program, for the second.
one() {
  local name=$1 sets=() words=() word
  for word in $2; do sets+=(--set "$word"); done
  for word in $3 step=$step; do words+=("$word"); done
  second() { octave-cli --quiet --no-history "$root/tests/second/second.m" "$@" "${words[@]}"; }
  ours() { "$gatewalk" "$@" --threads 1 --quiet >/dev/null; }
  second gate "$runs" 1 "$work/$name.gate.csv" vy=0
  second chain $(((runs + 86) / 87)) 2 "$work/$name.chain.csv"
  second field "$trials" 3 "$work/$name.field.csv"
  ours gate "$scene" "${sets[@]}" --set start.vy_m_per_s=0 --trials $((10 * runs)) --json "$work/$name.gate.json"
  ours build "$scene" "${sets[@]}" --bins paper --trials $((runs / 87 * 10)) -o "$work/$name.nc"
  ours predict "$work/$name.nc" --json "$work/$name.predicted.json"
  ours export "$work/$name.nc" --gate --counts -o "$work/$name.ours.csv"
  ours lattice "$scene" "${sets[@]}" --trials $((10 * trials)) --json "$work/$name.field.json"
  second predict "$work/$name.chain.csv" 50 4 "$work/$name.predicted.csv"
  # The program's own counts, its states numbered from 1.
  awk -F, 'NR == 1 { print "from,to,runs"; next }
    { split($1, from, "_"); split($2, to, "_"); print from[2] + 1 "," ($2 == "trapped" ? 88 : to[2] + 1) "," $3 }' \
    "$work/$name.ours.csv" >"$work/$name.numbers.csv"
  second predict "$work/$name.numbers.csv" 2 5 "$work/$name.again.csv"
}
export -f one
export root gatewalk runs trials step work scene
printf '%s\0' A "" "" \
  B "forces.propulsion_N=8 forces.random_N=10" "propulsion=8 random=10" \
  C "forces.propulsion_N=8.5 forces.random_N=25 $k_left=300 $k_right=450" \
  "propulsion=8.5 random=25 k_left=300 k_right=450" |
  xargs -0 -n 3 -P "${CORES:-$(nproc)}" bash -euc 'one "$1" "$2" "$3"' one
/usr/bin/python3 "$root/results/reliability/second.py" "$work" A B C >"$work/second.csv" || failed=1
[ "$(wc -l <"$work/second.csv")" -gt 1 ] || exit 1
cp "$work/second.csv" "$out/second.csv"
cat "$out/second.csv"
manifest "RUNS=$runs TRIALS=$trials STEP=$step results/reliability/second.sh" >"$out/second.txt"
echo "date: $(date -I)" >>"$out/second.txt"
exit "${failed:-0}"
