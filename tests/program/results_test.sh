#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cli/results.md and cli/scene.md list the keys of results and of scenes as the program does, so that a change of a key
# is seen.
#   results_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

"$gatewalk" help --write share || fail "help --write"
for page in results scene; do
  difference=$(diff "$scenes/../cli/$page.md" share/doc/gatewalk/$page.md) ||
    fail "keys have changed (< cli/$page.md, > the program); if that is meant: gatewalk help --write DIR, and
cp DIR/doc/gatewalk/$page.md cli/$page.md
$difference"
done
# Each key of a scene occurs once, and the keys that follow from others are those that gatewalk scene derives.
keys=$("$gatewalk" scene --set body.mass_kg=1 --set body.radius_m=1 --set forces.propulsion_N=1 --json - --quiet |
  jq -r '.keys[] | "\(.key) \(.source == "derived")"')
[ "$(wc -l <<<"$keys")" -gt 25 ] || fail "gatewalk scene has $(wc -l <<<"$keys") keys"
while read -r key follows; do
  line=$(grep -F "| \`$key\` |" share/doc/gatewalk/scene.md | grep "^| .$key. " || true)
  [ "$(grep -c . <<<"$line")" = 1 ] || fail "scene.md has $key not once: $line"
  from=$(awk -F' [|] ' '{ print $5 }' <<<"$line")
  [ "$follows" = "$([ -n "${from// /}" ] && echo true || echo false)" ] || fail "scene.md: $key follows from '$from'; derived: $follows"
done <<<"$keys"
for schema in share/gatewalk/schemas/*.json; do
  jq -e '.properties.format_version.const' "$schema" >/dev/null || fail "$schema is no schema of results"
done
finish
