#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests reproduce: the report is complete, each claim has a verdict, and finished studies are not run again.
#   reproduce_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

done_studies() { jq 'if type == "object" then length else 0 end' paper/data/done.json 2>/dev/null || echo 0; }
mkdir -p paper/data
echo '[1]' >paper/data/done.json  # a damaged record stops nothing
"$gatewalk" reproduce -o paper --quick >out.txt 2>&1 &
pid=$!
for _ in $(seq 240); do [ "$(done_studies)" -ge 1 ] && break; sleep 0.5; done
expect 1 'another gatewalk reproduce works in it' "$gatewalk" reproduce -o paper --quick
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail "reproduce: SIGTERM gives another status"
[ "$(done_studies)" -ge 1 ] || fail "reproduce: nothing was done in two minutes"
expect 0 'reproduced, .* agree, .* cannot be told, .* differ' "$gatewalk" reproduce -o paper --quick
grep -q '^[1-9].* studies are done already' out.txt || fail "reproduce: did not go on where it was"
# A third run repeats only studies that were cut short, whose file is not a result of the study, or whose record is
# damaged.
cp paper/claims.csv claims.csv
head -c 1000 paper/data/fig9_100.json >half && mv half paper/data/fig9_100.json
jq 'del(.runs[0].hits)' paper/data/exits.json >other && mv other paper/data/exits.json
jq 'del(.crossing.seconds)' paper/data/done.json >less && mv less paper/data/done.json
expect 0 '\[30/30\]  crossing' "$gatewalk" reproduce -o paper --quick --details
grep -q '^27 of 30 studies are done already' out.txt && [ "$(grep -c '^ *\[[0-9]*/30\]' out.txt)" = 3 ] || fail "reproduce: did again what was done"
cmp claims.csv paper/claims.csv || fail "reproduce: what was done again says something else"
# The first screen: a verdict for each start of Table IV, then what differs. With --details: every claim.
expect 0 '^paper/report.html says why a claim differs' "$gatewalk" reproduce -o paper --quick
[ "$(grep -c '^  d = .* m, v = .* m/s  .*\(reproduced\|agrees\|cannot tell\|differs\)$' out.txt)" = 4 ] || fail "reproduce: no verdict for the four starts"
[ "$(wc -l <out.txt)" -le 35 ] && ! grep -q '.\{101\}' out.txt || fail "reproduce: a screen of $(wc -l <out.txt) lines"
"$gatewalk" reproduce -o paper --quick --details >out.txt
[ "$(grep -c '^ *paper: ' out.txt)" = "$(jq '.claims | length' paper/report.json)" ] || fail "reproduce: --details has not all claims"
# Numbers go where --csv says, relative to the folder in which the command was given.
expect 0 'reproduced, .* agree' "$gatewalk" reproduce -o paper --quick --csv numbers.csv
grep -q '^quick,,,1,,$' numbers.csv || fail "reproduce: --csv wrote nothing"
kept paper/.
jq '.quick = false' paper/report.json >full && cp paper/report.json quick && mv full paper/report.json
expect 2 'holds a full report' "$gatewalk" reproduce -o paper --quick
mv quick paper/report.json
for figure in fig5 fig6 fig8 fig9 fig11 fig12 thirteen_eight barriers table4 speed crossings; do
  for end in csv svg pdf; do [ -s paper/$figure.$end ] || fail "reproduce: no $figure.$end"; done
done
holds '(.claims | length) >= 30 and (.claims | map(.verdict | IN("reproduced", "agrees", "cannot tell", "differs")) | all)' paper/report.json
holds '(.claims | map(.see)) - (.sections | map(.id)) == []' paper/report.json
holds '[.sections[] | select(.id != "replay") | .commands | length] | min >= 1' paper/report.json
[ "$(tail -n +2 paper/claims.csv | wc -l)" = "$(jq '.claims | length' paper/report.json)" ] || fail "reproduce: claims.csv has other claims"
expect 2 'missing -o' "$gatewalk" reproduce
expect 2 'set has no meaning' "$gatewalk" reproduce -o paper --set forces.random_N=1
# A command of the report, run where the report says.
(cd paper && eval "$(jq -r '.sections[] | select(.id == "fig9").commands[1]' report.json | sed "s#^gatewalk#$gatewalk#") --quiet --json again.json") || fail "reproduce: a command of the report does not work"
jq -s '.[0].runs == .[1].runs' paper/again.json paper/data/fig9_300.json | grep -q true || fail "reproduce: a command of the report gives something else"

finish
