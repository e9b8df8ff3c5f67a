#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests chart chain: the chain's error against its cost.   chart_chain_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

echo text >m.nc  # a file in the place of a folder
expect 2 'bins 100.0: makes fewer than 1' "$gatewalk" chart chain "$scenes/field.toml" --set beams.length_m=20 -o refused --bins 100 --truth-trials 100
# The command makes a folder with three files; errors and their parts are those of distributions.
chart() { "$gatewalk" chart chain "$scenes/field.toml" --truth-trials 150 --runs-limit 1e3 --bins 0.5 --bins 1 \
            --start 0,0,15 --start 4,5,10 --seed 2 --visited 50 "$@"; }
expect 0 'direct simulation' chart -o charts/a --json charts.json --threads 2
cmp -s charts.json charts/a/chain.json || fail "chart chain: --json and chain.json differ"
grep -q '</svg>' charts/a/chain.svg || fail "chart chain: no figure"
holds '[.points[] | [.bins, .trials_per_row]] == [[0.5, 10], [0.5, 20], [1, 10], [0.5, 10], [0.5, 20], [1, 10]]' charts/a/chain.json
holds '[.points[].states] == [23, 23, 87, 23, 23, 87] and [.points[0:3][].gate_runs] == [230, 460, 870]' charts/a/chain.json
holds '[.points[].matrices] == [2, 1, 1, 2, 1, 1]' charts/a/chain.json
holds '[.points[].starts[] | .exact, .walks_10000, .walks_1000000 | .total_variation > 0 and .total_variation < 1] | all' charts/a/chain.json
# A million walks are within 1/2 sqrt(2/pi 81/1e6) = 0.004 of infinitely many on average; the limit is twice that.
holds '[.points[].starts[] | .exact.total_variation - .walks_1000000.total_variation | fabs < 0.008] | all' charts/a/chain.json
# 2000 draws of a number that varies by about 15 %: five standard errors.
holds '.starts[0].direct_simulation | map(.drawn.total_variation / .formula.total_variation - 1 | fabs < 0.02) | all' charts/a/chain.json
# Both errors include the truth's sampling error, that of 150 trials. (Times decide how many trials are charted.)
holds '.starts[0] | .truth.floor.total_variation as $noise | .direct_simulation | .[-1].trials >= 50 and (map(.formula.total_variation >= $noise) | all)' charts/a/chain.json
holds '.starts[0].truth.trials == 150 and ([.starts[0].truth.final_gates[][]] | add) == 150' charts/a/chain.json
holds '[.points[].row_starts] == ["uniform", "uniform", "uniform", "visited", "visited", "visited"]' charts/a/chain.json
holds '.points[0].build_s < .points[3].build_s' charts/a/chain.json  # includes the time of the trials that found the entries
holds '.points[0].starts[0].exact != .points[3].starts[0].exact' charts/a/chain.json
holds '.starts[0].summary | .cheapest_near_best.seconds <= .best.seconds' charts/a/chain.json
[ "$(awk -F, '{ print NF }' charts/a/chain.csv | sort -u)" = 25 ] || fail "chart chain: uneven lines in chain.csv"
[ "$(grep -c ',exact,' charts/a/chain.csv)" = 12 ] || fail "chart chain: not one line per matrix and start in chain.csv"
# Trees of up to 20000 runs; they keep their numbers, except for the truth's sampling error.
"$gatewalk" chart chain "$scenes/field.toml" --truth-trials 2000 --runs-limit 2e4 --bins 0.5 --start 0,0,15 \
  --set run.method=moreau --set run.step_s=0.02 -o charts/t --quiet >charts/t.txt 2>/dev/null
holds '.starts[0] | .truth.floor.total_variation as $noise | .trees | length >= 2 and (map(.total_variation < .error_95 + 2 * $noise and .gate_runs > 0 and .seconds > 0) | all)' charts/t/chain.json
[ "$(grep -c ',tree,' charts/t/chain.csv)" = "$(jq '.starts[0].trees | length' charts/t/chain.json)" ] || fail "chart chain: not one line per tree in chain.csv"
grep -q '^Trees (predict --accuracy): TV ' charts/t.txt || fail "chart chain: no word on trees"
# One thread gives the same, except for times.
chart -o charts/b --threads 1 --quiet >/dev/null 2>&1
timeless='.starts[0].truth.final_gates, (.points[] | del(.build_s) | .starts[] |= del(.exact_s, .walks_10000_s, .walks_1000000_s))'
[ "$(jq -c "$timeless" charts/a/chain.json)" = "$(jq -c "$timeless" charts/b/chain.json)" ] ||
  fail "chart chain: another number of threads gave other errors"
expect 2 'missing -o' "$gatewalk" chart chain "$scenes/field.toml"
expect 2 'missing SCENE' "$gatewalk" chart chain -o charts/x
expect 2 "runs-limit" "$gatewalk" chart chain "$scenes/field.toml" -o charts/x --runs-limit 40
expect 2 'must be at least 100' "$gatewalk" chart chain "$scenes/field.toml" -o charts/x --truth-trials 99
expect 2 'the same factor twice' chart -o charts/x --bins 1
expect 2 'inside the gate' chart -o charts/x --start 25,0,15
expect 2 'are the same file' chart -o charts/a --json charts/../charts/a/chain.csv
[ -e charts/x ] && fail "chart chain: wrong use made a folder"
expect 2 'm.nc' chart -o m.nc

cp charts/a/chain.svg two_starts.svg
kept two_starts.svg charts/t/chain.svg
finish
