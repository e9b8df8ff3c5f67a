#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Gates of several types: one file has a matrix for each, and chain and dynamics see the same field.
#   terrain_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

mixed="$scenes/mixed.toml --set run.method=moreau"
expect 0 '^terrain.types.u.forces.propulsion_N  *8.0 ' "$gatewalk" scene $mixed
"$gatewalk" scene $mixed --json mixed.json --quiet
holds '(.map | length == 9 and all(test("^[.su]{9}$"))) and (.map | join("") | test("s.*u"))' mixed.json
"$gatewalk" scene $mixed --new >again.toml
"$gatewalk" scene again.toml --json again.json --quiet
jq -s '.[0].map == .[1].map' mixed.json again.json | grep -q true || fail "scene --new: another map"
"$gatewalk" build $mixed --bins paper --trials 3 -o mixed.nc --json mixed.json --quiet
holds '(.types | keys) == ["s", "u"] and .types.u.counts > 200' mixed.json
expect 0 '^u  ' "$gatewalk" show mixed.nc
expect 0 '^State 12: the states that follow' "$gatewalk" show mixed.nc --type u --row 12
expect 2 'has no such type' "$gatewalk" show mixed.nc --type x
expect 0 '^trapped' "$gatewalk" walk mixed.nc --walks 1000
expect 0 '^trapped' "$gatewalk" predict mixed.nc --set terrain.seed=6
expect 0 '^trapped' "$gatewalk" predict $mixed --accuracy 0.1 --quiet
expect 0 'not tested, because the field has several types' "$gatewalk" validate $mixed --details --matrix mixed.nc --trials 100
expect 2 'terrain.types.u.forces.propulsion_N: 9 here, 8 there' "$gatewalk" predict mixed.nc $mixed --set terrain.types.u.forces.propulsion_N=9
expect 2 'none here' "$gatewalk" walk mixed.nc "$scenes/field.toml" --set run.method=moreau
expect 2 'which says what stands where' "$gatewalk" predict mixed.nc --row 2=mixed.nc
expect 2 'not permitted for a comparison of fidelities' "$gatewalk" chart field $mixed --trials 2 -o x
expect 0 'has no effect here: one gate is run' "$gatewalk" gate $mixed --trials 20 --quiet
"$gatewalk" trace $mixed --field --trial 3 --json trace.json --replay trace.html --quiet
holds '(.types | length) == 3 and (.type_of_gate | length) == 81 and .types[2].propulsion_N == 8' trace.json

# By type of gate, trapped bodies add up to the ending. Limited states keep their own endings.
"$gatewalk" analyze $mixed --accuracy 0.15 --runs 0 --target trapped --json parts.json --quiet 2>/dev/null
holds '(([.types[].trapped] | add) / .endings.trapped - 1 | fabs) < 1e-9 and .target_probability == .endings.trapped' parts.json
"$gatewalk" build $mixed --accuracy 0.15 --states 60 -o few.nc --quiet 2>/dev/null
for with in '--solver propagate' ''; do "$gatewalk" predict few.nc $with --json "few${with:+_matrix}.json" --quiet 2>/dev/null; done
[ "$(jq -s 'map(.endings.trapped) | .[0] - .[1] | fabs < 1e-12' few.json few_matrix.json)" = true ] || fail "limited states, other endings: $(jq -c .endings few.json few_matrix.json)"
finish
