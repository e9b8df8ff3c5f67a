#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests sample: each sample is what it says, and the commands that need one read it. Also tests results as a table of
# numbers.
#   sample_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

expect 0 '^  walker  ' "$gatewalk" sample
"$gatewalk" sample --json all.json --quiet || fail "the list as JSON"
[ "$(jq '.samples | length' all.json)" = "$(find "$scenes" "$scenes/tracks" -maxdepth 1 -name '*.toml' -o -maxdepth 1 -name '*.csv' | sort -u | wc -l)" ] ||
  fail "other samples than files: $(jq -c '[.samples[].file]' all.json)"
for name in $(jq -r '.samples[].name' all.json); do
  file=$(jq -r --arg name "$name" '.samples[] | select(.name == $name) | .file' all.json)
  "$gatewalk" sample "$name" | cmp -s - "$scenes/../$file" || fail "$name is not $file"
done
expect 2 "there is no sample 'wlaker'; did you mean walker?" "$gatewalk" sample wlaker
expect 2 '^gatewalk: -o without NAME: name a sample' "$gatewalk" sample -o x.toml
"$gatewalk" sample walker -o mine.toml || fail "sample walker"
cmp -s mine.toml "$scenes/walker.toml" || fail "sample -o"
expect 0 'kept as mine.toml.~1~' "$gatewalk" sample field -o mine.toml

# Tracks become passages, and passages a chain; counts are compared with the model.
for name in tracks runs observed; do "$gatewalk" sample $name -o $name.csv; done
"$gatewalk" sample cell -o cell.toml
expect 0 'in 48 trials' "$gatewalk" passages tracks.csv --cell cell.toml -o passages.csv --fps 10 --metres-per-unit 0.001 \
  --fastest 0.4 --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y
grep -q '^18 of 29 lost tracks ended within one step of the outer border: film beyond the cells' out.txt &&
  ! grep -q -e '--bridge' out.txt || fail "passages: what to do about lost tracks: $(cat out.txt)"
expect 0 '^Beware: the options do not fit the tracks. Check --origin' "$gatewalk" passages tracks.csv --cell cell.toml -o off.csv \
  --fps 10 --metres-per-unit 0.001 --fastest 0.4 --origin 0,830 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y
grep -q 'gatewalk build' out.txt && fail "passages: proposes a chain of tracks that do not fit: $(cat out.txt)"
expect 0 '48 bodies' "$gatewalk" build passages.csv --cell cell.toml -o passages.nc
expect 0 '^Beware: 29 of the 48 bodies were lost from sight' "$gatewalk" predict passages.nc --set field.columns=5 --set field.rows=4
grep -q '^  crossed [0-9.]* or [0-9.]* %; left side [0-9.]* or [0-9.]* %\.$' out.txt || fail "predict: the bounds of lost bodies: $(cat out.txt)"
expect 0 'of 12 differences .* than chance alone' "$gatewalk" validate passages.nc
# Without the body that once came from above.
awk -F, '$3 == "N" || $8 == "N" { print $1 }' passages.csv | sort -u >back.txt
awk -F, 'NR == FNR { back[$1]; next } !($1 in back)' back.txt passages.csv >ahead.csv
expect 0 '^gatewalk: no body went through face N; you need not act' "$gatewalk" build ahead.csv --cell cell.toml -o ahead.nc
expect 2 'nobody was seen to enter so' "$gatewalk" predict ahead.nc --start N:0.01,0,-0.15
expect 0 'crossed' "$gatewalk" predict passages.nc --start W:0.01,0.1,0.1
expect 0 '12 bodies' "$gatewalk" build runs.csv --cell cell.toml -o runs.nc
expect 0 'observed' "$gatewalk" validate "$scenes/field.toml" --observed observed.csv --trials 200 --accuracy 0.2

# --csv has every number of the JSON with its limits, and no other.
"$gatewalk" predict "$scenes/field.toml" --accuracy 0.2 --json p.json --csv p.csv --quiet >out.txt || fail "predict --csv"
[ -s out.txt ] && fail "--csv --quiet prints: $(cat out.txt)"
head -n 1 p.csv | grep -qx 'quantity,i,j,value,low_95,high_95' || fail "names of columns: $(head -n 1 p.csv)"
numbers='[paths(type == "number" or type == "boolean" or . == null)
  | select(.[0] != "made_by" and .[0] != "format_version" and ([.[] | strings | select(endswith("_95") and . != "error_95"
    and . != "corrcoef_95" and . != "rmse_per_100_95" and . != "kernel_error_95")] | length) == 0)] | length'
[ "$(jq "$numbers" p.json)" = "$(($(wc -l <p.csv) - 1))" ] ||
  fail "$(jq "$numbers" p.json) numbers in JSON, $(($(wc -l <p.csv) - 1)) in CSV"
csv_value() { awk -F, -v key="$1" '$1","$2","$3 == key { print $4","$5","$6 }' p.csv; }
[ "$(csv_value endings.trapped,,)" = "$(jq -r '[.endings.trapped, .endings_95.trapped[]] | map(tostring) | join(",")' p.json)" ] ||
  fail "trapped: $(csv_value endings.trapped,,)"
[ "$(csv_value final_gates,1,4)" = "$(jq -r '[.final_gates[1][4], .final_gates_95[1][4][]] | map(tostring) | join(",")' p.json)" ] ||
  fail "final gates: $(csv_value final_gates,1,4)"
[ "$(csv_value exits.left_side.2.share,,)" = "$(jq -r '.exits.left_side[2] | [.share, .share_95[]] | map(tostring) | join(",")' p.json)" ] ||
  fail "exits: $(csv_value exits.left_side.2.share,,)"
"$gatewalk" gate "$scenes/field.toml" --csv - --quiet >gate.csv
"$gatewalk" gate "$scenes/field.toml" --json gate.json --quiet
# The limits of a count are counts, as in JSON.
[ "$(grep '^trapped,' gate.csv)" = "$(jq -r '[.trapped, .trapped_95[]] | map(tostring) | "trapped,,," + join(",")' gate.json)" ] || fail "$(cat gate.csv)"
for command in "gate $scenes/field.toml" "lattice $scenes/field.toml --trials 50" "validate $scenes/field.toml --trials 50 --walks 700 --accuracy 0.2" "walk walk.nc"; do
  [ -e walk.nc ] || paper_matrix walk.nc
  # shellcheck disable=SC2086
  "$gatewalk" $command --csv limits.csv --quiet >/dev/null 2>&1
  awk -F, 'NR > 1 && $5 != "" { n++; if (!($5 <= $4 + 1e-12 && $4 <= $6 + 1e-12)) { print; bad = 1 } } END { exit bad || !n }' limits.csv || fail "$command: limits beside other numbers"
  grep -q ',null\|,-\?nan' limits.csv && fail "$command: words among numbers"
done
expect 2 'only one thing can go to standard output' "$gatewalk" gate "$scenes/field.toml" --csv - --json -
holds '.format_version == 2 and (keys_unsorted[0] == "format_version")' gate.json
finish
