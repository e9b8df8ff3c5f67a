#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# gatewalk's speed beside its peers, and its cost against size. No part of the tests.
#   tests/bench/run.sh [FOLDER]      under 10 minutes on two quiet cores, without building
# Installs the peers (Debian 12), builds into build-bench/, writes to FOLDER (results/speed): CSV files,
# peers.svg, size.svg, speed.md, manifest.txt. Only what is measured side by side is compared; a quiet
# machine still helps.
set -euo pipefail
load=$(cut -d ' ' -f 1-3 /proc/loadavg)
cd "$(dirname "$0")/../.."
root=$PWD
folder=$(realpath -m "${1:-results/speed}")
here=$root/tests/bench
. ./.ci/prepare
. ./results/manifest.sh
packages+=(libbenchmark-dev libchipmunk-dev libbox2d-dev libode-dev pkg-config dpkg-dev octave r-base-core
  r-cran-matrix r-cran-markovchain python3-numpy python3-scipy)
command -v apt-get >/dev/null && install_missing
say() { echo "$*" >&2; }

cmake -S . -B build-bench -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DGATEWALK_BENCH=ON >/dev/null
cmake --build build-bench
gatewalk=$root/build-bench/gatewalk
bench=$root/build-bench/tests/bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Debian builds Chipmunk with its assertions on. The same source as Chipmunk's own Release profile:
chipmunk=$root/build-bench/chipmunk
optimised_chipmunk() {
  [ ! -e "$chipmunk/lib/src/libchipmunk.so.7" ] || return 0
  mkdir -p "$chipmunk/lists/partial"
  cd "$chipmunk"
  # Where this machine gets its packages from, asked for their sources.
  mkdir -p parts
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
    [ -f "$list" ] || continue
    sed -e 's/^deb /deb-src /' -e 's/^Types:.*/Types: deb-src/' "$list" >"parts/$(basename "$list" | sed 's/^sources.list$/main.list/')"
  done
  local apt=(apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$PWD/parts"
    -o Dir::State::Lists="$PWD/lists")
  "${apt[@]}" update && "${apt[@]}" source chipmunk &&
    cmake -S chipmunk-*/ -B lib -DCMAKE_BUILD_TYPE=Release -DBUILD_DEMOS=OFF -DBUILD_STATIC=OFF \
      -DINSTALL_STATIC=OFF &&
    cmake --build lib
}
(optimised_chipmunk) >"$work/chipmunk.log" 2>&1 || { tail "$work/chipmunk.log" >&2; exit 1; }

rounds=(--benchmark_enable_random_interleaving=true --benchmark_out_format=json)
run_bench() { "$@" >"$work/log" 2>&1 || { tail "$work/log" >&2; exit 1; }; }

say "1. One gate: our methods and general engines, same trials"
LD_LIBRARY_PATH=$chipmunk/lib/src run_bench "$bench/dynamics_bench" "${rounds[@]}" --benchmark_repetitions=7 \
  --benchmark_out="$work/dynamics.json"
run_bench "$bench/dynamics_bench" "${rounds[@]}" --benchmark_repetitions=5 --benchmark_filter='Chipmunk|stable' \
  --benchmark_out="$work/debian.json"
octave-cli -qf "$here/paper_euler.m" 40 >"$work/octave.csv" 2>"$work/log" || { cat "$work/log" >&2; exit 1; }
# The benchmark's scenes are those of scenes/, or its figures mean nothing.
for condition in "A 8 400 400" "B 7 300 500"; do
  read -r name force left right <<<"$condition"
  "$gatewalk" gate scenes/single_gate.toml --trials 14000 --seed 1 --quiet --json "$work/gate.json" \
    --set forces.propulsion_N=$force --set forces.random_N=10 \
    --set beams.stiffness_left_Nm_per_rad=$left --set beams.stiffness_right_Nm_per_rad=$right
  jq -e --arg name "stable/$name" --slurpfile bench "$work/dynamics.json" \
    '.exited_left + .exited_right == ([$bench[0].benchmarks[]
      | select(.run_type == "iteration" and (.name | startswith($name))) | .exited] | add)' \
    "$work/gate.json" >/dev/null ||
    { say "scenes.h and scenes/single_gate.toml differ"; exit 1; }
done

say "2. The chain: walks and exact predictions"
"$gatewalk" build scenes/field.toml --trials 100 --seed 1 --quiet -o "$work/matrix.nc" --json "$work/build.json"
for round in 1 2 3; do
  run_bench "$bench/chain_bench" "$work/matrix.nc" "$work" "${rounds[@]}" --benchmark_min_time=0.2 \
    --benchmark_out="$work/chain.$round.json"
  /usr/bin/python3 "$here/chain_scipy.py" "$work" >>"$work/peers.csv"
  Rscript --vanilla "$here/chain.R" "$work" >>"$work/peers.csv"
done

mkdir -p "$folder"
cost() { "$bench/cost_bench" "$@"; }
say "3. Cost against size"
{
  echo "study,size,threads,seconds,peak_MiB,note"
  for n in 100 1000 10000 100000; do cost size trials stable $n 1; done
  for n in 100 1000 10000 100000; do cost size trials moreau $n 1; done
  for n in 100000 1000000; do cost size trials stable $n 2; done
  for n in 100000 1000000; do cost size trials moreau $n 2; done
  for bins in 0.2 0.3 0.5 1 1.5 2; do cost size rows $bins 1; done
  for bins in 1 2; do cost size rows $bins 2; done
  for method in stable moreau; do
    for threads in 1 2; do cost size lattice $method 10000 $threads; done
    cost size lattice $method 100000 2
  done
  for n in 10000 100000 1000000 10000000; do cost size walks "$work/matrix.nc" $n 1; done
  cost size walks "$work/matrix.nc" 10000000 2
  for side in 9 33 101 301 1001; do
    cost size field "$work/matrix.nc" $side 0
    # As many gates for the size of the field as in the paper's: 13 of 9.
    timeout 40 "$bench/cost_bench" size field "$work/matrix.nc" $side $((13 * side / 9)) ||
      { [ $? = 124 ] && echo "field limited,$side,1,,,not done after 40 s"; }
  done
} >"$work/size.csv"

say "4. Lanes beside plain runs, evaluations, time to a total variation of 0.01"
{ echo "condition,method,trials,noise,total_variation,chance,chance_95,p"; cost lanes 100000; } >"$work/lanes.csv"
{ echo "scene,registers,microseconds,times_plain"; cost registers "$root/scenes"; } >"$work/registers.csv"
{ echo "scene,method,step_s,trials,steps_per_trial,evaluations_per_trial"; cost evaluations; } >"$work/evaluations.csv"
{ echo "what,value"; cost budget "$work/matrix.nc"; } >"$work/budget.csv"

cp "$work"/{size,lanes,registers,evaluations,budget}.csv "$folder"
/usr/bin/python3 "$here/report.py" "$work" "$folder"
gnuplot -c "$here/plot.gp" "$folder"
light_or_dark "$folder/peers.svg"
light_or_dark "$folder/size.svg"
{
  manifest "tests/bench/run.sh"
  echo "load before: $load"
  echo "peers: $(dpkg-query -W -f '${Package} ${Version}, ' libchipmunk7 libbox2d2 libode8 octave \
    r-cran-markovchain python3-numpy python3-scipy | sed 's/, $//')"
} >"$folder/manifest.txt"
