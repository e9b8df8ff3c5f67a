#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# same_results.sh finds no difference where there is none, and all that there are.   same_results_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

same_results=$scenes/../tests/same_results.sh
lines='^0 (scene own.toml --json|gate own|trace own|lattice own)'
expect 0 '^4 command lines with the same results, 0 with others$' "$same_results" --lines "$lines" "$gatewalk" "$gatewalk"
# A program that differs by a little.
printf '#!/bin/sh\nexec "%s" "$@" --set contact.restitution=0.79\n' "$gatewalk" >changed
chmod +x changed
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" "$gatewalk" changed
[ "$(grep -c '^DIFFERS: gatewalk ' out.txt)" = 4 ] || fail "same_results.sh: not a word on each line"
# One that fails where it should not, and one that does nothing.
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" "$gatewalk" /bin/false
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" /bin/true /bin/true
expect 2 'no line has' "$same_results" --lines nothing-like-it "$gatewalk" "$gatewalk"

finish
