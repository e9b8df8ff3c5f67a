#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests scene: every key with its source, a scene of the user's own, and no loss of what the user wrote.
#   scene_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

printf 'body.mass_kg = 0.25\nbody.radius_m = 0.08\nforces.propulsion_N = 0.8\n' >mine.toml
expect 0 '^body.radius_m  *0.08  *m  *mine.toml:2$' "$gatewalk" scene mine.toml
"$gatewalk" scene mine.toml --json keys.json --quiet
holds '[.keys[] | select(.key == "beams.length_m" or .key == "run.traverse_y_m") | .source == "derived" and (.value == "0.2" or .value == "0.48")] == [true, true]' keys.json
"$gatewalk" scene mine.toml --new -o full.toml
for file in mine.toml full.toml; do "$gatewalk" gate $file --trials 50 --quiet --json out-$file.json; done
jq -s 'map(del(.made_by)) | .[0] == .[1]' out-mine.toml.json out-full.toml.json | grep -q true || fail "scene --new: another scene"
holds '.made_by.derived | index("run.time_limit_s") != null' out-mine.toml.json
echo '# edited' >>full.toml
expect 0 'kept as full.toml.~1~$' "$gatewalk" scene mine.toml --new -o full.toml
[ "$(tail -n 1 full.toml.~1~)" = '# edited' ] || fail "scene --new: an edited scene is lost"
expect 0 'mine.toml leaves out [1-9][0-9]* keys: .* .gatewalk scene mine.toml shows them.$' "$gatewalk" gate mine.toml --trials 10
# Keys that the file leaves out follow from the file, whatever is overridden.
"$gatewalk" scene mine.toml --set forces.propulsion_N=1.6 --json set.json --quiet
holds '[.keys[] | select(.key == "beams.stiffness_left_Nm_per_rad") | .value][0] == "0.31999999999999995"' set.json
# The table has seven digits, JSON all; a value of the file is written as it was given.
"$gatewalk" scene mine.toml --set forces.propulsion_N=1.6 >set.txt
grep -q '^beams.stiffness_left_Nm_per_rad  *0.32  *N m/rad  *derived$' set.txt || fail "scene: a number in full length: $(grep stiffness_left set.txt)"
printf 'body.radius_m = 0.0812345678901\n' >long.toml
"$gatewalk" scene long.toml >long.txt
"$gatewalk" scene long.toml --new -o long-new.toml
grep -h '[0-9]\.[0-9]*[1-9][0-9]\{7,\}' set.txt long.txt && fail "scene: more than seven digits"
grep -q '^radius_m = 0.0812345678901 ' long-new.toml || fail "scene --new: a value of the file was rounded"
grep -o ', in [[(][^])]*' long-new.toml | grep '[0-9]\.[0-9]*[1-9][0-9]\{7,\}' && fail "scene --new: a range in full length"
# A field longer than its limit of gates cannot be crossed, with the reason.
expect 0 'field.max_gates = 13 is less than field.rows = 20' "$gatewalk" lattice "$scenes/field.toml" --set field.rows=20 --trials 10
# Other units: the scene is the same, both values are shown; two units for one key are refused.
printf 'body.mass_g = 250\nbody.radius_cm = 8\nforces.propulsion_mN = 800\n' >units.toml
expect 0 '^body.radius_m  *0.08  *m  *units.toml:2 .radius_cm = 8.$' "$gatewalk" scene units.toml
"$gatewalk" scene units.toml --json units.json --quiet
jq -s '.[0].scene == .[1].scene' keys.json units.json | grep -q true || fail "scene: other units make another scene"
printf 'body.radius_m = 0.08\n' >>units.toml
expect 2 '^gatewalk: units.toml:4: body.radius_m = 0.08 is the same quantity as body.radius_cm = 8 .units.toml:2.' "$gatewalk" scene units.toml
# The meaning of the numbers, and that they fit no robot: a worked example and three keys of a small body.
expect 0 'the beams hold the push of 0.24 N at 25.3 degrees' "$gatewalk" scene "$scenes/walker.toml"
"$gatewalk" scene "$scenes/walker.toml" --json walker.json --quiet
holds '.meaning | .far_from_walkers == [] and .top_speed_m_per_s > 0.29 and .top_speed_m_per_s < 0.31' walker.json
"$gatewalk" scene --set body.mass_g=90 --set body.radius_cm=6 --set forces.propulsion_N=1 --json small.json --quiet
holds '[.meaning.far_from_walkers[].name] == ["froude", "push_per_weight", "random_per_weight", "draws_per_body_length", "passages_waited"]' small.json
expect 0 'this scene is unusual for a walking animal or robot: .*, and [1-9] more .gatewalk scene mine.toml says why.$' "$gatewalk" gate mine.toml --trials 10
expect 2 'figure has no meaning beside --new' "$gatewalk" scene mine.toml --new --figure three.svg
# A push in the file changes the keys that are left out, an override does not. A command says so if an option replaces the
# push, and scene if the file gives the push; neither if the file has these numbers.
printf 'body.mass_kg = 0.25\nbody.radius_m = 0.08\n' >bare.toml
follows='^gatewalk: your options change the push, but not beams.stiffness_left_Nm_per_rad, .*, forces.drag_Ns_per_m and start.vy_m_per_s, which bare.toml leaves out$'
expect 0 "$follows" "$gatewalk" gate bare.toml --set forces.propulsion_N=0.03 --trials 10
expect 0 "$follows" "$gatewalk" sweep bare.toml --vary forces.propulsion_N=0.01,0.03 --trials 10
[ "$(grep -c 'change the push' out.txt)" = 1 ] || fail "sweep: says more than once what follows the push"
expect 0 "$follows" "$gatewalk" power bare.toml --versus forces.propulsion_mN=30 --trials 20 --accuracy 0.5
# Only the keys that were computed are named.
for key in beams.stiffness_right_Nm_per_rad beams.damping_Nms_per_rad forces.random_N forces.random_rate_Hz; do
  grep -q "change the push, but not .* $key[, ]" out.txt || fail "the push: $key follows it and is not named"
done
"$gatewalk" scene mine.toml --json mine.json --quiet
holds '.remarks | any(test("^push: gatewalk computed beams.stiffness_left_Nm_per_rad, .* and start.vy_m_per_s from the push; --set forces.propulsion_N=VALUE changes the push alone$"))' mine.json
# README's robot: only the damping follows the push, which lies near the beams' resistance, so a small error decides.
sed -n '/^\$ cat mine.toml$/,/^\$ /p' "$scenes/../README.md" | grep -v '^\$' >readme.toml
[ "$(wc -l <readme.toml)" -ge 5 ] || fail "README has no mine.toml"
"$gatewalk" scene readme.toml --json readme.json --quiet 2>/dev/null
holds '.remarks | any(. == "push: gatewalk computed beams.damping_Nms_per_rad from the push; --set forces.propulsion_N=VALUE changes the push alone")' readme.json
holds '.remarks | any(test("^threshold: the push is within 5 % of the beams. largest resistance: "))' readme.json
holds '.remarks | any(. == "size: the body is 16 cm wide, twice its radius; the joints of a gate are 40 cm apart")' readme.json
expect 0 '^gatewalk: readme.toml leaves out 6 keys: gatewalk scaled the paper.s values of 4 to this body, and took 2 of contact from the paper unchanged' "$gatewalk" gate readme.toml --trials 10
"$gatewalk" scene readme.toml --set forces.propulsion_N=0.7 --json far.json --quiet 2>/dev/null
holds '.remarks | any(startswith("threshold")) | not' far.json
{ cat bare.toml; printf 'beams.stiffness_left_Nm_per_rad = 0.0064\nbeams.damping_Nms_per_rad = 0.0008\n'; } >fixed.toml
expect 0 'change the push, but not forces.random_N, forces.random_rate_Hz, forces.drag_Ns_per_m and start.vy_m_per_s, which fixed.toml leaves out$' "$gatewalk" gate fixed.toml --set forces.propulsion_N=0.03 --trials 10
printf 'forces = { random_N = 0.08, random_rate_Hz = 50, drag_Ns_per_m = 0.015 }\nstart.vy_m_per_s = 0.5\n' >>fixed.toml
for line in "bare.toml" mine.toml "fixed.toml --set forces.propulsion_N=0.03" "$scenes/robot.toml --set forces.propulsion_N=0.9" "$scenes/field.toml --set forces.propulsion_N=8"; do
  # shellcheck disable=SC2086
  "$gatewalk" gate $line --trials 10 2>&1 | grep 'change the push' && fail "gate $line: nothing follows the push, or none is given"
done
# A start speed that gatewalk computed, above the top speed of the drag in the file.
fast=(--set body.mass_g=250 --set body.radius_cm=8 --set forces.propulsion_N=0.8 --set forces.drag_Ns_per_m=2)
expect 0 '^  start  *gatewalk computed the start speed 0.849 m/s, faster than the top speed of 0.4 m/s' "$gatewalk" scene "${fast[@]}"
"$gatewalk" scene "${fast[@]}" --set start.vy_m_per_s=0.4 | grep '^  start' && fail "scene: a start speed that is given counts as computed"
# The step at which a body creeps over its beams' resistance: at 1 % of the stiffness, not at 25 %.
creep='--set forces.random_N=0 --set forces.drag_Ns_per_m=7 --set beams.damping_Nms_per_rad=1 --set run.time_limit_s=1000 --set start.vy_m_per_s=1'
"$gatewalk" scene "$scenes/field.toml" $creep --json creep.json --quiet
at=$(jq '400 * 7 / .meaning.resistance_N' creep.json)
for share in 1 1.25; do
  k=$(jq -n "$at * $share")
  "$gatewalk" scene "$scenes/field.toml" $creep --set beams.stiffness_left_Nm_per_rad="$k" --set beams.stiffness_right_Nm_per_rad="$k" --json step-$share.json --quiet
done
holds '[.remarks[] | select(test("^threshold: with 1 % less of the stiffness.* the body crosses; with 1 % more it is trapped$"))] | length == 1' step-1.json
holds '[.remarks[] | select(startswith("threshold"))] == []' step-1.25.json

finish
