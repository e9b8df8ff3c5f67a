#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests tests/same_results.sh: it finds every difference, and none where there is none.
#   same_results_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

same_results=$scenes/../tests/same_results.sh
lines='^0 (scene own.toml --json|gate own|trace own|lattice own)'
expect 0 '^4 command lines with the same results, 0 with others$' "$same_results" --lines "$lines" "$gatewalk" "$gatewalk"
# A program that differs by a little.
printf '#!/bin/sh\nexec "%s" "$@" --set contact.restitution=0.79\n' "$gatewalk" >changed
chmod +x changed
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" "$gatewalk" changed
[ "$(grep -c '^DIFFERS: gatewalk ' out.txt)" = 4 ] || fail "same_results.sh: not a word on each line"
# Differences in one number of a CSV, one line of a help page, one word of a schema, one datum of a figure.
lines='^0 (gate field.toml --trials 300|help gate$|schema gate.schema.json)'
expect 0 '^3 command lines with the same results, 0 with others$' "$same_results" --lines "$lines" "$gatewalk" "$gatewalk"
mkdir -p other/{bin,plot}
other() { # TEXT FILE: other/bin/gatewalk, whose words follow, differs in FILE of one line alone
  chmod +x other/bin/gatewalk
  expect 1 '^2 command lines with the same results, 1 with others$' "$same_results" --lines "$lines" "$gatewalk" other/bin/gatewalk
  grep -A1 "^DIFFERS: gatewalk $1" out.txt | head -n 1 | grep -q "\./$2" || fail "same_results.sh: $1 does not differ in $2"
}
printf '#!/bin/sh\n"%s" "$@" && { [ ! -f numbers.csv ] || sed -i "/^trials,/s/[0-9]/9/" numbers.csv; }\n' "$gatewalk" >other/bin/gatewalk
other 'gate field.toml' numbers.csv
printf '#!/bin/sh\n"%s" "$@" | sed "s/^Simulates runs through one gate/Simulates runs through two gates/"\n' "$gatewalk" >other/bin/gatewalk
other 'help gate' stdout.txt
printf '#!/bin/sh\n"%s" "$@" && { [ "$2" != --write ] || sed -i "0,/\\"type\\": \\"integer\\"/s//\\"type\\": \\"number\\"/" "$3/gatewalk/schemas/gate.schema.json"; }\n' "$gatewalk" >other/bin/gatewalk
other 'schema gate' gate.schema.json
printf '#!/bin/sh\nsed "/ << EOD/{n;s/[0-9]/9/2}" | PATH=${PATH#*:} gnuplot "$@"\n' >other/plot/gnuplot
chmod +x other/plot/gnuplot
printf '#!/bin/sh\nPATH="%s:$PATH" exec "%s" "$@"\n' "$PWD/other/plot" "$gatewalk" >other/bin/gatewalk
other 'gate field.toml' 'figure-1.data'
# Schemas that a program lacks are not compared, with a message.
printf '#!/bin/sh\n[ "$2" != --write ] || exit 1\nexec "%s" "$@"\n' "$gatewalk" >bare && chmod +x bare
expect 0 'schemas are not compared: .*/bare has none beside it' "$same_results" --lines "$lines" "$gatewalk" bare
grep -q '^2 command lines with the same results, 0 with others$' out.txt || fail "same_results.sh: without schemas"
lines='^0 (scene own.toml --json|gate own|trace own|lattice own)'
# A program that fails wrongly, and a program that does nothing.
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" "$gatewalk" /bin/false
expect 1 '^0 command lines with the same results, 4 with others$' "$same_results" --lines "$lines" /bin/true /bin/true
expect 2 'no line has' "$same_results" --lines nothing-like-it "$gatewalk" "$gatewalk"

finish
