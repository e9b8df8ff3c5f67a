#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What threads, ranks of MPI, parts and checkpoints cost and save on this machine.
#   results/scaling/run.sh [BUILD]      BUILD: with tests and libopenmpi-dev
# Writes runs.csv, summary.txt, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build}")
gatewalk=$build/gatewalk
. "$root/results/manifest.sh"
PYTHONDONTWRITEBYTECODE=1 python3 "$here/scaling.py" "$gatewalk" "$build/tests/gatewalk_mpi" "$root/scenes/field.toml" "$here"
manifest "results/scaling/run.sh" >"$here/manifest.txt"
