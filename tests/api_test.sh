#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The functions of the installed libraries (but those for one instruction set) are those of tests/files/api.txt: who takes
# one away or changes what it takes may break the programs of others, and says so in CHANGELOG.md.
#   tests/api_test.sh BUILD ROOT [--renew]      --renew: writes the list anew
set -euo pipefail
export LC_ALL=C
build=$1 list=$2/tests/files/api.txt
found=$(mktemp)
trap 'rm -f "$found"' EXIT
for module in dynamics markov lattice; do
  nm -C --defined-only "$build/$module/libgatewalk_$module.a" 2>/dev/null
done | sed -n 's/^[0-9a-f]* T \(gatewalk::\)/\1/p' | grep -v -E 'anonymous namespace|\[clone|::N_[A-Z0-9_]+::' | sed 's/\[abi:cxx11\]//g; s/std::__cxx11::/std::/g' | sort -u >"$found"
[ "$(wc -l <"$found")" -gt 500 ] || { echo "only $(wc -l <"$found") functions found in $build"; exit 1; }
if [ "${3-}" = --renew ]; then cp "$found" "$list"; fi
difference=$(diff "$list" "$found") && exit 0
echo "The libraries' functions have changed (< promised, > found); if that is meant: tests/api_test.sh BUILD ROOT --renew"
echo "$difference"
exit 1
