#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What must a chain remember of a mouse in a labyrinth?
#   results/mouse/run.sh FOLDER [GATEWALK]      two minutes on two cores, needs python3
# FOLDER: D9.csv, the passages of one animal through the squares of the maze, and maze_sequences.toml, its cell file;
# D9_tracks.csv.gz and maze_tracks.toml, its tracks; see README.md for where the data come from. They are not part of
# this project.
# Writes order.json, order.svg, forks.json (each fork by itself), tracks.json (the tracks, cut), manifest.txt.
set -euo pipefail
folder=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=$(realpath "${2:-$root/build/gatewalk}")
. "$root/results/manifest.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$folder/D9.csv" "$folder/maze_sequences.toml" .
"$gatewalk" validate D9.csv --cell maze_sequences.toml --order 0:6 --json "$here/order.json" --figure "$here/order.svg" \
  --force
python3 "$here/forks.py" D9.csv maze_sequences.toml forks.csv forks.toml
"$gatewalk" validate forks.csv --cell forks.toml --order 0:5 --json "$here/forks.json" --force
python3 "$here/tracks.py" "$gatewalk" "$folder" "$here/tracks.json"
manifest "results/mouse/run.sh FOLDER" >"$here/manifest.txt"
