#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Where each method breaks near the numbers of a scene: the paper's gate, the same with rigid and with creeping beams,
# where methods refuse, and a small walking robot.
#   results/limits/run.sh [GATEWALK]      40 seconds on two cores
# Writes gate/ and walker/ (limits.csv, limits.json, a figure per number), gate.txt and walker.txt (the tables), a table
# and a figure of rigid and of creeping beams, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

near() {  # SCENE [OPTION...]
  local to
  to=$here/$(basename "$1" .toml)
  "$gatewalk" chart limits "$@" --seed 1 -o "$to" --force >"$to.txt"
}
near results/limits/gate.toml
# Where methods refuse: of each only the figure that shows it.
beyond() {  # NAME NUMBER OPTION...
  "$gatewalk" chart limits results/limits/gate.toml "${@:3}" --seed 1 -o "$work" --force >"$here/$1.txt"
  cp "$work/$2.svg" "$here/$1.svg"
}
beyond rigid stiffness --set beams.stiffness_left_Nm_per_rad=4e9 --set beams.stiffness_right_Nm_per_rad=4e9
beyond creeping damping --quick --set beams.damping_Nms_per_rad=5e4
near scenes/walker.toml --quick
manifest "results/limits/run.sh" >"$here/manifest.txt"
