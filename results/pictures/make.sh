#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The pictures of the READMEs, each by the command that stands beside it there. how.svg alone is drawn by
# hand.
#   results/pictures/make.sh [GATEWALK]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${1:-$root/build/gatewalk}")  # scenes are named from the root
. "$root/results/manifest.sh"
cd "$root"

draw() {  # FILE COMMAND...: made beside the old one, which it then replaces
  local file=$1 new=$here/new.${1##*.}
  shift
  "$gatewalk" "$@" "$new" --quiet >/dev/null
  mv "$new" "$here/$file"
}
draw prediction.svg predict scenes/field.toml --accuracy 0.01 --figure
draw gate.svg scene scenes/walker.toml --figure
draw mixed.svg predict scenes/mixed.toml --accuracy 0.01 --figure
draw analysis.svg analyze scenes/robot.toml --accuracy 0.01 --figure
draw crossing.gif trace scenes/field.toml --field --trial 322237 --video-speed 4 --video
manifest "results/pictures/make.sh" >"$here/manifest.txt"
