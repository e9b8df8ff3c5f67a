#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What does Python cost? A call of gw.predict beside the library's own time for it, and a passage through a cell written in
# numpy beside the same cell in C++, each on one thread.
#   results/python/run.sh [BUILD]      BUILD: with tests and -DGATEWALK_PYTHON=ON; about half a minute
# Writes calls.csv, passages.csv, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$root/tests/bench/python_bench.py" \
  "$build/tests/python_bench" "$root/scenes/programs/pillars.toml" "$here"
manifest "results/python/run.sh" >"$here/manifest.txt"
