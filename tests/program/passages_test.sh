#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests passages: tracks from a lab become recorded runs.   passages_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

cat >cell.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
symmetric = true
[[cell.faces]]
name = "S"
move = [0, 1]
odd = ["s", "vx"]
[[cell.faces]]
name = "W"
move = [1, 0]
odd = ["vx"]
[[cell.faces]]
name = "E"
move = [-1, 0]
odd = ["vx"]
[[cell.coordinates]]
name = "s"
unit = "m"
[[cell.coordinates]]
name = "vx"
unit = "m/s"
[[cell.coordinates]]
name = "vy"
unit = "m/s"
[field]
columns = 3
rows = 3
max_gates = 9
END
# Two bodies in mm, 100 frames a second: a goes up at 0.5 m/s and to the right at 0.2, b to the left at 0.1. Body a is
# missing in frame 60, b is uncertain in frame 30; the names swap in frame 90.
awk 'BEGIN {
  for (f = 0; f < 120; f++) for (b = 0; b < 2; b++) {
    who = f < 90 ? b : 1 - b
    vx = who == 0 ? 200 : -100
    x = sprintf("%.4f", 50 + 300 * who + vx * f / 100); y = sprintf("%.4f", 20 + 500 * f / 100)
    c = b == 1 && f == 30 ? 0.2 : 1
    if (b == 0 && f == 60) x = y = "nan"
    print f, b, x, y, c
  }
}' >places.txt
awk 'BEGIN { print "LABEL,TRACK_ID,FRAME,POSITION_X,POSITION_Y,QUALITY"; print "Label,Track ID,Frame,X,Y,Quality"
  print "Label,Track ID,Frame,X,Y,Quality"; print ",,,(mm),(mm),(quality)" }
  { a[NR] = "S" NR "," ($2 == 0 ? "a" : "b") "," $1 "," ($3 == "nan" ? "" : $3) "," ($4 == "nan" ? "" : $4) "," $5 }
  END { for (i = NR; i > 0; i--) print a[i]; print "S0,,3,1,1,1" }' places.txt >spots.csv
awk 'BEGIN { print "scorer,n,n,n,n,n,n\nindividuals,a,a,a,b,b,b\nbodyparts,nose,nose,nose,nose,nose,nose"
  print "coords,x,y,likelihood,x,y,likelihood" }
  $2 == 0 { line = $1 "," $3 "," $4 "," $5 } $2 == 1 { print line "," $3 "," $4 "," $5 }' places.txt >dlc.csv
awk '{ t = t (NR % 2 ? (NR > 1 ? "," : "") $1 : ""); x[NR] = $3; y[NR] = $4; c = c (NR > 1 ? "," : "") $5 }
  END {
    print "netcdf t { dimensions: time = 120 ; space = 2 ; keypoints = 1 ; individuals = 2 ; variables: int64 time(time) ;"
    print "string space(space) ; string keypoints(keypoints) ; string individuals(individuals) ;"
    print "double position(time, space, keypoints, individuals) ; double confidence(time, keypoints, individuals) ;"
    print ":fps = 100. ; :time_unit = \"frames\" ; data: time = " t " ; space = \"x\", \"y\" ; keypoints = \"nose\" ;"
    print "individuals = \"a\", \"b\" ; confidence = " c " ; position = "
    for (i = 1; i <= NR; i += 2) printf "%s%s,%s,%s,%s", (i > 1 ? "," : ""), x[i], x[i + 1], y[i], y[i + 1]
    print " ; }"
  }' places.txt | sed 's/nan/NaN/g' >t.cdl
ncgen -4 -o movement.nc t.cdl || fail "ncgen"

scale=(--metres-per-unit 0.001)
shared=(--cell cell.toml "${scale[@]}" --fastest 1 --confidence 0.9 --lattice all --quiet)
table=(spots.csv --fps 100 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y,confidence=QUALITY "${shared[@]}")
"$gatewalk" passages "${table[@]}" -o runs.csv --json runs.json --figure tracks.svg >table.txt 2>err.txt || fail "passages: $(cat err.txt)"
"$gatewalk" passages dlc.csv --fps 100 "${shared[@]}" -o dlc_runs.csv --json dlc.json || fail "passages: DeepLabCut"
"$gatewalk" passages movement.nc "${shared[@]}" -o nc_runs.csv --json nc.json || fail "passages: movement"
# Bodies stand in the file's order, which is reversed here.
for file in dlc nc; do sort "${file}_runs.csv" | cmp -s - <(sort runs.csv) || fail "passages: $file has other runs"; done
holds '.endings == {left: 9, trapped: 0, lost: 6} and .lost_by == {gap: 2, jump: 2, wall: 0, end: 2}' runs.json
holds '.trials == 6 and .passages == 15 and .left_by == {S: 7, W: 1, E: 1}' runs.json
holds '.tracks.bodies == 2 and .tracks.places == 240 and .tracks.places_without_number == 1 and .tracks.places_unsure == 1' runs.json
holds '.tracks.unit_rows_left_out == 3 and .tracks.lines_of_no_body == 1 and .gaps == 2 and .jumps == 2' runs.json
holds '.noise_m < 1e-6 and .path_noise_m < 1e-6 and (.made_by.scene | test("width_m"))' runs.json
holds '.tracks.kind == "DeepLabCut" and (.tracks.remarks | any(test("key point, nose")))' dlc.json
holds '.tracks.kind == "movement" and .tracks.frame_interval_s == 0.01' nc.json
head -n 1 runs.csv | grep -qx 'body,trial,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s' || fail "passages: $(head -n 1 runs.csv)"
# a enters the second row after 0.16 s, at x = 0.082: 0.032 m right of the cell's middle.
awk -F, '$1 == "a" && !seen++ { bad = $3 != "S" || ($4 - 0.032)^2 + ($5 - 0.2)^2 + ($6 - 0.5)^2 > 1e-12 || $7 != "W" || ($11 - 0.09)^2 > 1e-12
  if (bad) print; exit bad }' runs.csv || fail "passages: where a crosses"
grep -q '<svg' tracks.svg && grep -q 'lost 6' tracks.svg || fail "passages: no picture"
"$gatewalk" passages "${table[@]:0:$((${#table[@]} - 1))}" -o runs.csv --force --details >table.txt 2>err.txt || fail "passages: table"
for words in '3 rows of descriptions and units' 'y grows upwards' '^noise: ' 'turned back within the noise' 'lost  *6' 'gap 2, jump 2'; do
  grep -q "$words" table.txt || fail "passages: no '$words' in $(cat table.txt)"
done
# Seen from above, the other direction is up, and it lacks a face.
expect 2 'by a move of (0, -1).*: no face of cell.toml has that move' "$gatewalk" passages "${table[@]}" -o x.csv --y-down
"$gatewalk" passages "${table[@]}" -o x.csv --lattice 5,9 --origin=0,-30 --bridge 1 --json x.json || fail "passages: options"
holds '.lost_by == {gap: 0, jump: 2, wall: 0, end: 2}' x.json
[ "$(grep -c , runs.csv)" = 16 ] || fail "passages: $(wc -l <runs.csv) lines"

# Cells are those of [field], from the origin on: rows 0 to 2, columns 0 to 2, until y = 0.3 m after 0.56 s. Before,
# each body enters row 1 and row 2; a also column 1, and b column 2 from column 3, before its first row: y = 0.02 + 0.5
# t.
field=("${table[@]/all/3,3}")
"$gatewalk" passages "${field[@]}" -o given.csv --json given.json || fail "passages: --lattice 3,3"
own=()
for word in "${table[@]}"; do [ "$word" = --lattice ] || [ "$word" = all ] || own+=("$word"); done
"$gatewalk" passages "${own[@]}" -o own.csv --json own.json || fail "passages: the field"
cmp -s own.csv given.csv || fail "passages: the field's cells are not the default"
holds '.lattice == {columns: 3, rows: 3} and .places_outside > 100 and .bodies_outside == 0' own.json
holds '.lattice == null and .places_outside == 0' runs.json
"$gatewalk" passages "${own[@]:0:$((${#own[@]} - 1))}" -o own.csv --force --details >table.txt || fail "passages: the field's table"
grep -q '3 columns and 3 rows from the origin on' table.txt && grep -q 'places lie outside the cells, 0 bodies are never seen in a cell' table.txt ||
  fail "passages: nothing is said of what lies outside: $(cat table.txt)"
sed '/^\[field\]/,$d' cell.toml >no_field.toml
expect 2 'no_field.toml does not say how many cells there are: give columns and rows of \[field\], or --lattice' \
  "$gatewalk" passages "${own[@]}" -o x.csv --cell no_field.toml

# A chain with a known law: of 625 bodies a fifth stays in each of four rows, so 0.8^4 = 40.96 % cross. Two rows of open
# ground before them are no cells.
sed 's/columns = 3/columns = 1/; s/rows = 3/rows = 4/; s/symmetric = true/symmetric = true\ntrapped_after_s = 2/' cell.toml >law.toml
awk 'BEGIN {
  print "body,t_ms,x_cm,y_cm"
  srand(1)
  for (b = 0; b < 625; b++) {
    stays = b < 125 ? 5 : b < 225 ? 15 : b < 305 ? 25 : b < 369 ? 35 : 99
    for (f = 0; f < 180; f++) {
      y = -15 + 0.5 * f
      print b "," 25 * f "," 5 + 0.1 * (rand() - 0.5) "," (y < stays ? y : stays) + 0.1 * (rand() - 0.5)
    }
  }
}' >law.csv
"$gatewalk" passages law.csv --cell law.toml -o law_runs.csv --fastest 1 --columns body=body,time=t_ms,x=x_cm,y=y_cm --details --json law.json >law.txt ||
  fail "passages: a known law"
holds '.passages == 1845 and .trials == 625 and .endings == {left: 1476, trapped: 369, lost: 0}' law.json
grep -q 'column t_ms is in ms, by its name: converted to s' law.txt && grep -q 'places are in cm, by its name' law.txt ||
  fail "passages: units are not said: $(cat law.txt)"
"$gatewalk" build law_runs.csv --cell law.toml -o law.nc --quiet 2>err.txt && "$gatewalk" predict law.nc --json law.json --force --quiet 2>err.txt || fail "predict: a known law"
holds '.endings_95.crossed[0] < 0.4096 and .endings_95.crossed[1] > 0.4096' law.json

# A maze of two columns: up on the left, over at the top, down on the right; between the lower cells there is a wall,
# over which the body leans.
sed 's/symmetric = true/symmetric = false/; /\[field\]/,$d' cell.toml >maze.toml
cat >>maze.toml <<'END'
[[cell.faces]]
name = "N"
move = [0, -1]
[[cell.types]]
name = "left"
walls = ["E"]
[[cell.types]]
name = "open"
[field]
columns = 2
rows = 2
max_gates = 0
[terrain]
map = ["open,open", "left,open"]
END
awk 'BEGIN {
  print "body,t_s,x_m,y_m"
  for (f = 0; f < 300; f++) {
    x = f < 100 ? 0.05 + 0.055 * (f < 50 ? f : 100 - f) / 50 : f < 200 ? 0.05 + 0.1 * (f - 100) / 100 : 0.15
    y = f < 100 ? -0.05 + 0.2 * f / 100 : f < 200 ? 0.15 : 0.15 - 0.25 * (f - 200) / 100
    print "m," f / 100 "," x "," y
  }
}' >maze.csv
maze=(maze.csv --columns body=body,time=t_s,x=x_m,y=y_m --fastest 5 --quiet)
"$gatewalk" passages "${maze[@]}" --cell maze.toml -o maze_runs.csv --visits visits.csv --transitions moves.csv --json maze.json \
  --figure maze.svg || fail "passages: a maze"
# The figure shows the wall, half the height of the panel.
wall=$(sed -n '/\$walls using/,/gnuplot_plot_3a/s/.* d=.M\([0-9.]*\),[0-9.]* L\([0-9.]*\),[0-9.]* .*/\1 \2/p' maze.svg)
[ "$(wc -l <<<"$wall")" = 1 ] && [ -n "$wall" ] && [ "${wall% *}" = "${wall#* }" ] || fail "passages: walls in the figure: $wall"
holds '.passages == 4 and .lost_by.wall == 0 and .places_put_back > 3 and .left_by.N == 2' maze.json
[ "$(cut -d, -f1-6,8 visits.csv | tail -n +2 | tr '\n' ' ')" = "m,1,0,0,left,S,S m,1,0,1,open,S,W m,1,1,1,open,W,N m,1,1,0,open,N,N " ] ||
  fail "passages: visits: $(cat visits.csv)"
[ "$(cut -d, -f1-6,8 moves.csv | tail -n +2 | tr '\n' ' ')" = "0,0,S,0,1,1,1 1,0,N,1,-1,1,1 0,1,W,1,1,1,1 1,1,N,1,0,1,1 " ] ||
  fail "passages: transitions: $(cat moves.csv)"
awk -F, 'NR > 1 { t += $7; if ($9 <= 0) exit 1 } END { exit !(t > 0) }' visits.csv || fail "passages: times of visits"
"$gatewalk" build maze_runs.csv --cell maze.toml -o maze.nc --quiet || fail "build: a maze"
sed '2s/,left,S,/,left,E,/' maze_runs.csv >through.csv
expect 2 'through.csv:2: column in: a body cannot enter by face E: type left of maze.toml has a wall at E' "$gatewalk" build through.csv --cell maze.toml -o x.nc
expect 2 'cell.types.walls = .* is not permitted: must be an array of faces at which nothing crosses the border' "$gatewalk" build maze_runs.csv --cell <(sed 's/walls = \["E"\]/walls = ["B"]/' maze.toml) -o x.nc
# Without walls the body visits the cell on the right.
sed '/walls/d' maze.toml >no_walls.toml
"$gatewalk" passages "${maze[@]}" --cell no_walls.toml -o x.csv --json x.json --force || fail "passages: no walls"
holds '.passages == 6 and .left_by.E == 1' x.json

# Information that a file lacks, and settings that make no sense.
lacks() { expect 2 "$1" "$gatewalk" passages "${@:2}" -o x.csv --cell cell.toml; }
lacks 'which column is what (there are LABEL, TRACK_ID, .*): --columns.*frames per second: --fps N.*--metres-per-unit' spots.csv --fastest 1
lacks '--confidence X' spots.csv --fastest 1 --fps 100 "${scale[@]}" --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y,confidence=QUALITY
lacks 'missing --fastest M/S' spots.csv
lacks 'frames per second: --fps N' dlc.csv --fastest 1
lacks '--metres-per-unit X' movement.nc --fastest 1 --confidence 1
expect 2 'missing --cell CELL.toml' "$gatewalk" passages spots.csv -o x.csv
expect 2 'missing -o' "$gatewalk" passages spots.csv --cell cell.toml
expect 2 'missing TRACKS' "$gatewalk" passages --cell cell.toml -o x.csv
expect 2 'are the same file' "$gatewalk" passages "${table[@]}" -o spots.csv
expect 2 'are the same file' "$gatewalk" passages "${table[@]}" -o cell.toml
expect 2 'origin 1: must be two numbers' "$gatewalk" passages "${table[@]}" -o x.csv --origin 1
for lattice in 0,3 2.5,3 x 3; do expect 2 'lattice .*: must be two' "$gatewalk" passages "${table[@]}" -o x.csv --lattice $lattice; done
expect 2 'fastest -1: must be above 0' "$gatewalk" passages "${table[@]}" -o x.csv --fastest -1
expect 2 'no body is seen to enter a cell.*are --metres-per-unit, --origin, --fps and --fastest right' "$gatewalk" passages "${own[@]}" -o x.csv --origin 5000,0
expect 0 'spots.csv: column POSITION_X is in (mm), in the row of units, which is 0.001 m; --metres-per-unit 0.002 is used. Leave the option out to use' "$gatewalk" passages "${table[@]}" -o x.csv --force --fastest 5 --metres-per-unit 0.002
expect 2 'column x_cm is in cm, by its name, which is 0.01 m; --metres-per-unit says 0.001: leave it out' "$gatewalk" passages law.csv --cell law.toml -o x.csv --force --fastest 1 --columns body=body,time=t_ms,x=x_cm,y=y_cm --metres-per-unit 0.001
sed 's/^,,,(mm)/,,(frame),(mm)/' spots.csv >frames.csv
expect 2 'column FRAME is in (frame), in the row of units: give frame=FRAME of --columns in place of time=' "$gatewalk" passages frames.csv "${table[@]:1}" -o x.csv --columns body=TRACK_ID,time=FRAME,x=POSITION_X,y=POSITION_Y,confidence=QUALITY
sed 's/name = "vx"/name = "spin"/; s/"vx"/"spin"/' cell.toml >spin.toml
expect 2 'coordinate spin cannot be measured of tracks: these can, s' "$gatewalk" passages "${table[@]}" -o x.csv --cell spin.toml
sed '0,/odd = \["s", "vx"\]/s//odd = ["vx"]/' cell.toml >even.toml
expect 2 's of face S changes its sign in the mirror' "$gatewalk" passages "${table[@]}" -o x.csv --cell even.toml
expect 2 'nosuch.csv' "$gatewalk" passages nosuch.csv "${table[@]:1}" -o x.csv
: >empty.csv
expect 2 'empty.csv: is empty' "$gatewalk" passages empty.csv "${table[@]:1}" -o x.csv
kept tracks.svg

# The table is CSV under any name, except the ending of another format.
expect 2 '^gatewalk: -o runs.XLSX: no .xlsx is written; tables are CSV, which spreadsheets read: a name in .csv$' "$gatewalk" passages x.csv --cell c.toml -o runs.XLSX
finish
