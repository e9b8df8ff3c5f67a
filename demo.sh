#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The main job from end to end: installs what is missing, builds, fills the 87 x 88 matrix from
# single-gate runs, walks the 9 x 9 field, runs the full dynamics for the four starts of the paper's
# Table IV and prints that table side by side. Results land in demo-out/.
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
build_gatewalk -DBUILD_TESTING=OFF
mkdir -p demo-out
started=$(date +%s)

say() { printf '\n\033[1m%s\033[0m\n' "$*"; }

say "1. The matrix: 100 short runs of one gate for each of 87 input states"
build/gatewalk build scenes/field.toml --bins paper --trials 100 --seed 1 -o demo-out/matrix.nc --force

say "2. A million walks through the field, each gate one draw from the matrix"
build/gatewalk walk demo-out/matrix.nc scenes/field.toml --walks 1e6 --seed 1 --json demo-out/walks.json --force

say "3. What infinitely many walks would give"
build/gatewalk predict demo-out/matrix.nc scenes/field.toml --json demo-out/prediction.json --force

say "4. Against the full dynamics, for the four starts of the paper's Table IV"
build/gatewalk validate scenes/field.toml --matrix demo-out/matrix.nc --trials 1000 --seed 1 \
  --json demo-out/validation.json --force

say "5. Every claim of the paper, quickly: open demo-out/paper/report.html"
build/gatewalk reproduce -o demo-out/paper --quick

say "Computed in $(($(date +%s) - started)) s. Everything is in demo-out/; README.md says how to go on."
command -v ffmpeg >/dev/null || echo "Films (gatewalk trace --video) also need ffmpeg: apt-get install ffmpeg"
