#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests chart methods: speed against accuracy of the methods.   chart_methods_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

echo text >gate.json  # a file in the place of a folder
# A line for each scene, method and setting; wrong use is refused before any work.
"$gatewalk" chart methods "$scenes/field.toml" "$scenes/stiff.toml" -o charts --trials 20 --repeats 1 --seed 2 --quiet >/dev/null 2>chart.err ||
  fail "chart: $(head -n 3 chart.err)"
[ "$(wc -l <charts/chart.csv)" = 83 ] || fail "chart.csv has $(wc -l <charts/chart.csv) lines"
[ "$(cut -d, -f1-2 charts/chart.csv | sort | uniq -c | awk '$1 == ($2 ~ /moreau/ ? 9 : 8)' | wc -l)" = 10 ] || fail "chart.csv: settings per method"
holds '[.scenes[].settings[] | select(.status != "refused") | .health.runs == 20 and .microseconds_per_trial.min > 0] | all' charts/chart.json
holds '[.scenes[].reference.outcomes | add] == [20, 20]' charts/chart.json
holds '[.scenes[].settings[] | select(.default)] | length == 10' charts/chart.json
grep -q '</svg>' charts/chart.svg || fail "chart.svg is no whole figure"
"$gatewalk" chart methods "$scenes/stiff.toml" -o again --trials 20 --repeats 1 --seed 2 --methods stable --threads 1 --quiet >/dev/null
jq -s '[.[0].scenes[1].settings[] | select(.method == "stable") | .errors] == [.[1].scenes[0].settings[].errors]' charts/chart.json again/chart.json |
  grep -q true || fail "chart: one method on one thread gave other errors"
holds '[.scenes[].settings[].errors | select(.) | .strong | (.parted_share >= 0.5 or .compared == 0) == (.position_m.median == null)] | unique == [true]' charts/chart.json
holds '[.scenes[].settings[].errors | select(.) | .strong | select(.parted_share >= 0.5 and .compared > 0)] | length > 0' charts/chart.json
grep -q 'half or more parted' charts/chart.svg || fail "chart.svg is silent about settings of which half the trials parted"
cp "$scenes/stiff.toml" "a,b.toml"
"$gatewalk" chart methods "a,b.toml" -o quoted --trials 20 --repeats 1 --methods stable --quiet >/dev/null
grep -q '^"a,b",stable,run.step_s,' quoted/chart.csv || fail "chart.csv: a comma in a name makes two fields"
# Every line has as many fields as the first, apart from commas in quoted reasons.
[ "$(sed -E 's/"[^"]*"//' charts/chart.csv | awk -F, '{ print NF }' | sort -u | wc -l)" = 1 ] || fail "chart.csv: uneven lines"
# Settings with the reference's bits have a place in the figure: here the disc misses every beam.
"$gatewalk" chart methods "$scenes/undamped.toml" -o exact --trials 20 --repeats 1 --methods stable,event --quiet --json - >exact.json
[ -n "$(value '.scenes[0].settings[] | select(.errors.strong.position_m.median.below? == 1e-8) | .value' exact.json)" ] ||
  fail "chart: no setting is below a billionth of R: $(jq -c '[.scenes[0].settings[] | [.method, .value, .errors.strong.position_m.median]]' exact.json)"
grep -q 'half or more parted' exact/chart.svg && fail "chart: exact settings are called parted"
# The table shows the least time, and the error by chance beside the error.
"$gatewalk" chart methods "$scenes/stiff.toml" -o times --trials 50 --repeats 3 --methods event --details --json times.json >times.txt 2>/dev/null
for i in 0 1 2 3 4 5 6 7; do
  # awk rounds a double as the program does; the shell's printf rounds differently half-way between two numbers.
  least=$(value ".scenes[0].settings[$i].microseconds_per_trial.rounds | min" times.json | awk '{ printf "%.1f", $1 }')
  grep -E -A8 'us/trial .* chance' times.txt | tail -n +$((i + 2)) | head -n 1 | grep -q " $least " || fail "chart: setting $i: not $least us in the table"
done
expect 2 'missing SCENE' "$gatewalk" chart methods -o charts
expect 2 'missing -o' "$gatewalk" chart methods "$scenes/field.toml"
expect 2 "no method 'euler'" "$gatewalk" chart methods "$scenes/field.toml" -o charts --methods euler
expect 2 'stands there twice' "$gatewalk" chart methods "$scenes/field.toml" -o charts --methods paper,paper
expect 2 'two scenes are called field' "$gatewalk" chart methods "$scenes/field.toml" "$scenes/field.toml" -o charts
expect 2 'at least 1' "$gatewalk" chart methods "$scenes/field.toml" -o charts --trials 0
expect 2 'nosuch.toml' "$gatewalk" chart methods "$scenes/field.toml" nosuch.toml -o charts
expect 2 'gate.json' "$gatewalk" chart methods "$scenes/field.toml" -o gate.json --trials 1
for name in csv json svg; do
  expect 2 'are the same file' "$gatewalk" chart methods "$scenes/field.toml" -o charts --trials 1 --json charts/../charts/chart.$name
done
# A scene that the reference method refuses is named before the first trial of the other scenes.
sed -E 's/^stiffness_left_Nm_per_rad.*/stiffness_left_Nm_per_rad = 1e12/; s/^method = .*/method = "paper"/' \
  "$scenes/field.toml" >rigid.toml
expect 2 'rigid.toml: no reference' timeout 20 "$gatewalk" chart methods "$scenes/field.toml" rigid.toml -o charts --trials 1e7

kept charts/chart.svg
finish
