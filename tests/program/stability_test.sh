#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# stability: maps of where methods break.   stability_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# stability: five maps of five methods.
"$gatewalk" stability -o maps --quick --figure stability.svg --quiet >/dev/null 2>maps.err || fail "stability: $(head -n 3 maps.err)"
holds '.maps | length == 25' maps/stability.json
holds '[.maps[] | (.status | length) == (.y.values | length)] | all' maps/stability.json
holds '[.maps[] | select(.method == "stable" and .map == "restitution_threshold") | .status[][]] | unique == ["ok"]' maps/stability.json
[ "$(ls maps/*.svg | wc -l)" = 5 ] || fail "stability: $(ls maps)"
expect 2 'missing -o' "$gatewalk" stability
for name in stability.csv stability.json lever_speed.svg; do
  expect 2 'are the same file' timeout 20 "$gatewalk" stability -o maps --quick --json maps/$name
done
mkdir -p blocked/grazing_speed.svg
expect 2 'grazing_speed.svg' "$gatewalk" stability -o blocked --quick  # before any work
[ "$(ls blocked)" = grazing_speed.svg ] || fail "stability: wrote $(ls blocked) though a figure has no place"
expect 2 'no meaning' "$gatewalk" stability -o maps --set forces.random_N=1

kept stability.svg maps/*.svg
finish
