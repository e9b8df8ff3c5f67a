#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cli/results.md, which says what each key of each result means, is what the program says: a change of a result is seen
# in it.   results_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

"$gatewalk" help --write share || fail "help --write"
difference=$(diff "$scenes/../cli/results.md" share/doc/gatewalk/results.md) ||
  fail "keys of results have changed (< cli/results.md, > the program); if that is meant: gatewalk help --write DIR, and
cp DIR/doc/gatewalk/results.md cli/results.md
$difference"
for schema in share/gatewalk/schemas/*.json; do
  jq -e '.properties.format_version.const' "$schema" >/dev/null || fail "$schema is no schema of results"
done
finish
