#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Laws with exact values (tests/bench/physics_bench.cpp): energy is work over 10^6 elastic trials, drift, diffusion and
# work of the held force in free flight, order of convergence through contacts, Santalo's mean stay and the invariant
# measure of the Lorentz gas. Energy ledger, mirror images and time reversal are among results/requirements.
#   [BUILD=build] [TRIALS=1000000] results/reliability/physics.sh      BUILD: with tests; some 5 minutes on two cores
# Writes physics.csv (law, by, what, figure, unit, limit, kept, cases), physics.txt. Fails when a law is broken.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
build=${BUILD:-$root/build}
gatewalk=$build/gatewalk
out=$root/results/reliability
. "$root/results/manifest.sh"
"$build/tests/physics_bench" "${TRIALS:-1000000}" >"$out/physics.new" || failed=$?
[ "${failed:-0}" -le 1 ] || exit "$failed"  # it crashed
mv "$out/physics.new" "$out/physics.csv"
manifest "TRIALS=${TRIALS:-1000000} results/reliability/physics.sh" >"$out/physics.txt"
echo "date: $(date -I)" >>"$out/physics.txt"
grep NO "$out/physics.csv" || true
exit "${failed:-0}"
