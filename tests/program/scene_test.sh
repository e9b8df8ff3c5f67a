#!/usr/bin/env bash
# scene: every key with its source; nothing of the user's is lost.   scene_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# gatewalk scene: every key with its source; a scene of one's own; nothing of the user's is lost.
printf 'body.mass_kg = 0.25\nbody.radius_m = 0.08\nforces.propulsion_N = 0.8\n' >three.toml
expect 0 '^body.radius_m  *0.08  *m  *three.toml:2 ' "$gatewalk" scene three.toml
"$gatewalk" scene three.toml --json keys.json --quiet
holds '[.keys[] | select(.key == "beams.length_m" or .key == "run.traverse_y_m") | .source == "derived" and (.value == "0.2" or .value == "0.48")] == [true, true]' keys.json
"$gatewalk" scene three.toml --new -o mine.toml
for file in three.toml mine.toml; do "$gatewalk" gate $file --trials 50 --quiet --json out-$file.json; done
jq -s 'map(del(.made_by)) | .[0] == .[1]' out-three.toml.json out-mine.toml.json | grep -q true || fail "scene --new: another scene"
holds '.made_by.derived | index("run.time_limit_s") != null' out-three.toml.json
echo '# edited' >>mine.toml
expect 0 'kept as mine.toml.~1~$' "$gatewalk" scene three.toml --new -o mine.toml
[ "$(tail -n 1 mine.toml.~1~)" = '# edited' ] || fail "scene --new: an edited scene is lost"
expect 0 'three.toml leaves out keys, .*beams.length_m = 0.2,' "$gatewalk" gate three.toml --trials 10
# What the file leaves out follows from the file, whatever is overridden.
"$gatewalk" scene three.toml --set forces.propulsion_N=1.6 --json set.json --quiet
holds '[.keys[] | select(.key == "beams.stiffness_left_Nm_per_rad") | .value][0] == "0.31999999999999995"' set.json
# A field longer than the gates that may be visited is not crossed, and why is said.
expect 0 'field.max_gates = 13 is less than field.rows = 20' "$gatewalk" lattice "$scenes/field.toml" --set field.rows=20 --trials 10

finish
