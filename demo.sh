#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The main job from end to end: installs what is missing, builds, fills the 87 x 88 matrix from
# single-gate runs, walks the 9 x 9 field, runs the full dynamics for the four starts of the paper's
# Table IV, and compares every claim of the paper. Results and full screens land in demo-out/.
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
mkdir -p demo-out
say() { printf '\n\033[1m%s\033[0m\n' "$*"; }
# run FILE COMMAND...: the whole screen is kept in demo-out/FILE; the command is shown.
run() {
  echo "   $ ${*:2}   > demo-out/$1"
  "${@:2}" --details >"demo-out/$1"
}

say "0. Build the program (two minutes; the compiler's messages are in demo-out/build.log)"
build_gatewalk -DBUILD_TESTING=OFF >demo-out/build.log 2>&1 || { tail -n 30 demo-out/build.log && exit 1; }
started=$(date +%s)

say "1. Simulate 100 short runs of one gate from each of 87 input states: the 87 x 88 matrix"
run matrix.txt build/gatewalk build scenes/field.toml --bins paper --trials 100 --seed 1 -o demo-out/matrix.nc --force
say "2. Walk the 9 x 9 field a million times; each gate is one draw from the matrix"
run walks.txt build/gatewalk walk demo-out/matrix.nc scenes/field.toml --walks 1e6 --seed 1 --json demo-out/walks.json --force
say "3. Compute what infinitely many walks would give"
run prediction.txt build/gatewalk predict demo-out/matrix.nc scenes/field.toml --json demo-out/prediction.json --force
say "4. Simulate the full dynamics from the four starts of the paper's Table IV and compare"
run validation.txt build/gatewalk validate scenes/field.toml --matrix demo-out/matrix.nc --trials 1000 --seed 1 \
  --json demo-out/validation.json --force
say "5. Test every claim of the paper, with fewer trials than gatewalk reproduce makes by default"
build/gatewalk reproduce -o demo-out/paper --quick

say "Computed in $(($(date +%s) - started)) s. Everything is in demo-out/; README.md says how to continue."
command -v ffmpeg >/dev/null || echo "Films (gatewalk trace --video) also need ffmpeg: apt-get install ffmpeg"
