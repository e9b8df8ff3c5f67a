#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tables as users write them: each way of writing one gives the same result, or an error in a sentence.
#   tables_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

cat >cell.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
symmetric = false
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.faces]]
name = "W"
move = [1, 0]
[[cell.faces]]
name = "E"
move = [-1, 0]
[[cell.coordinates]]
name = "s"
unit = "m"
[field]
columns = 3
rows = 3
max_gates = 9
END
# Two bodies go up through the middle column, in mm, 50 frames a second, with an error of a tenth of a mm.
awk 'BEGIN { srand(3); print "body,frame,x,y"
  for (f = 0; f < 80; f++) for (b = 1; b < 3; b++)
    printf "%d,%d,%.3f,%.3f\n", b, f, 130 + 20 * b + rand() / 5, 10 + 4 * f + rand() / 5 }' >plain.csv
columns=(--columns body=body,frame=frame,x=x,y=y --fps 50)
passages() { "$gatewalk" passages "$@" --cell cell.toml --fastest 2 --metres-per-unit 0.001 --force; }
passages plain.csv "${columns[@]}" -o plain_runs.csv >plain.txt 2>err.txt || fail "plain: $(cat err.txt)"
[ ! -s err.txt ] || fail "plain: $(cat err.txt)"
# same NAME WORDS [OPTION...]: NAME.csv has the runs of plain.csv, and the table says WORDS.
same() {
  passages "$1.csv" "${@:3}" -o "$1_runs.csv" --json "$1.json" >/dev/null 2>err.txt || fail "$1: $(cat err.txt)"
  cmp -s plain_runs.csv "$1_runs.csv" || fail "$1: other runs than plain.csv"
  jq -r '.tracks.remarks[]' "$1.json" | grep -q -e "$2" || fail "$1: nothing is said: $(jq -c .tracks.remarks "$1.json")"
}
tr ',.' ';,' <plain.csv >german.csv && same german 'decimal commas' "${columns[@]}"
tr ',' '\t' <plain.csv >tabs.csv && same tabs 'set apart by tabs' "${columns[@]}"
tr '\n' '\r' <plain.csv >cr.csv && same cr 'CR alone' "${columns[@]}"
{ printf 'video: a.mp4\nframes: 80\n\n' && cat plain.csv; } >below.csv && same below 'named in line 4; 2 lines' "${columns[@]}"
awk -F, '{ print (NR > 1 ? NR - 2 : "") "," $0 }' plain.csv >pandas.csv && same pandas 'y grows upwards' "${columns[@]}"
awk -F, '{ print (NR > 1 ? "\"" NR - 1 "\"," : "") $0 }' plain.csv >r.csv && same r 'numbers the rows' "${columns[@]}"
awk -F, '{ print $0 "," $3 }' plain.csv >twice.csv && same twice 'both named x, with the same content' "${columns[@]}"
sed 's/[^,]*/"&"/g; $s/$/\n,,,\n\n/' plain.csv >quoted.csv && same quoted 'y grows upwards' "${columns[@]}"
sed '1s/^/# /' plain.csv >savetxt.csv && same savetxt 'y grows upwards' "${columns[@]}"
sed '1s/.*/BODY,FRAME,X,Y/' plain.csv >capitals.csv && same capitals 'y grows upwards' "${columns[@]}"
awk -F, 'NR == 1 { print "seconds,x1,y1,x2,y2"; next } { t = $3 "," $4 } $1 == 1 { line = sprintf("%.3f,", $2 / 50) t; next } { print line "," t }' \
  plain.csv >wide.csv && same wide 'y grows upwards' --columns 'time=seconds,x=x*,y=y*' --fps 50
awk -F, 'NR == 1 { print "scorer;n;n;n;n;n;n\nindividuals;1;1;1;2;2;2\nbodyparts;p;p;p;p;p;p\ncoords;x;y;z;x;y;z"; next }
  { gsub(/[.]/, ","); split($0, f, ","); v = f[3] "," f[4] ";" f[5] "," f[6] ";0" } $1 == 1 { line = $2 ";" v; next } { print line ";" v }' \
  plain.csv >pose.csv && same pose 'coords z left out' --fps 50

# A missing value is recognised in any spelling; so is a row without a body.
gaps=(--json gaps.json --bridge 1)
: >want.json
for nothing in '' NA None null '<NA>' N/A '#N/A' NaN inf - -inf '#DIV/0!' missing; do
  awk -F, -v n="$nothing" 'BEGIN { OFS = "," } $2 == 40 && $1 == 1 { $3 = n; $4 = n } { print } END { print n ",3,1,1" }' plain.csv >gaps.csv
  case $nothing in *inf) sed -i '$d' gaps.csv ;; esac # a body may be called so
  passages gaps.csv "${columns[@]}" "${gaps[@]}" -o gaps_runs.csv >/dev/null 2>&1 || fail "missing as '$nothing'"
  holds '.tracks.places_without_number == 1 and .tracks.bodies == 2' gaps.json
done

# A file that is no table is named by its first bytes; a missing column by the columns that exist.
refused() { expect 2 "$2" passages "$1" "${columns[@]}" -o x.csv; }
iconv -t UTF-16 plain.csv >utf16.csv && refused utf16.csv 'is text in UTF-16: save it as UTF-8'
gzip -k plain.csv && refused plain.csv.gz 'is packed by gzip: unpack it'
printf 'PK\003\004zip' >book.xlsx && refused book.xlsx 'save the sheet as CSV'
printf '<?xml version="1.0"?><TrackMate/>' >tracks.xml && refused tracks.xml 'is XML'
tail -n +2 plain.csv >bare.csv && refused bare.csv 'these are numbers: the first line must name the columns'
tr ',' ' ' <plain.csv >blanks.csv && refused blanks.csv 'not by blanks'
sed '5s/$/,7/' plain.csv >ragged.csv && refused ragged.csv 'ragged.csv:5: has 5 fields, the line of the columns (line 1) has 4'
sed 's/,x,/,x_,/' plain.csv >other.csv && refused other.csv 'other.csv:1: there is no column "x" .*there are body, frame, x_, y'
sed '7s/\./,/g; s/,/;/; s/,/;/; s/,/;/' plain.csv >mixed.csv && refused mixed.csv 'mixed.csv:7: '
passages plain.csv plain.csv "${columns[@]}" -o x.csv 2>err.txt && fail "one file twice"
cp plain.csv PLAIN.CSV && passages plain.csv PLAIN.CSV "${columns[@]}" -o both.csv >/dev/null || fail "two recordings"
cut -d, -f1 both.csv | sort -u | tr '\n' ' ' | grep -qx 'PLAIN/1 PLAIN/2 body plain/1 plain/2 ' || fail "two recordings: $(cut -d, -f1 both.csv | sort -u)"

# If nothing was seen, the message says why.
awk -F, 'BEGIN { OFS = "," } NR > 1 { $2 *= 5 } { print }' plain.csv >stride.csv
expect 2 'frames go up by 5 .*--bridge 4 bridges them' passages stride.csv --columns "${columns[1]}" --fps 250 -o x.csv
awk -F, 'NR == 1 || $2 % 10 != 7' plain.csv >lossy.csv
expect 0 '10.1 % of the frames are missing, 1 at a time: --bridge 1' passages lossy.csv "${columns[@]}" -o x.csv
awk -F, 'BEGIN { OFS = "," } NR == 1 { $5 = "t_s" } NR > 1 { $5 = $2 / 50 } { print }' plain.csv >times.csv
expect 0 'fps 250 is a frame every 0.004 s, but by its times a frame takes 0.02 s' passages times.csv --columns "${columns[1]}" --fps 250 -o x.csv

# Recorded runs and counts of an experiment.
"$gatewalk" build plain_runs.csv --cell cell.toml -o plain.nc --quiet >/dev/null 2>&1 || fail "build: plain"
for name in german tabs cr below r; do
  case $name in
    german) tr ',.' ';,' ;;
    tabs) tr ',' '\t' ;;
    cr) tr '\n' '\r' ;;
    below) printf 'made by hand\n\n' && cat ;;
    r) awk '{ print (NR > 1 ? "\"" NR - 1 "\"," : "") $0 }' ;;
  esac <plain_runs.csv >runs.csv
  "$gatewalk" build runs.csv --cell cell.toml -o runs.nc --force --quiet >/dev/null 2>err.txt || fail "build: $name: $(cat err.txt)"
  grep -q '^gatewalk: runs.csv: ' err.txt || fail "build: $name: nothing is said"
  "$gatewalk" predict runs.nc --json a.json --quiet --force 2>/dev/null && "$gatewalk" predict plain.nc --json b.json --quiet --force 2>/dev/null
  [ "$(jq -S 'del(.made_by, .seconds)' a.json)" = "$(jq -S 'del(.made_by, .seconds)' b.json)" ] || fail "build: $name predicts otherwise"
done
finish
