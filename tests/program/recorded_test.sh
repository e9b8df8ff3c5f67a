#!/usr/bin/env bash
# Recorded runs, and cells of another program.   recorded_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
tracks=$scenes/tracks

# Few bodies: an answer, but no error bars, which is said.
expect 0 '12 bodies, 12 trials, 40 passages: 31 left, 7 trapped, 2 lost' \
  "$gatewalk" build "$tracks/runs.csv" --cell "$tracks/cell.toml" -o few.nc --json build.json
holds '.recorded.bodies == 12 and .recorded.lost == 2 and .inputs == 9' build.json
expect 0 'no error bars: they need 16 bodies' "$gatewalk" predict few.nc --json few.json
holds '.error_95 == null and (.endings | add) > 0.999 and (.endings | add) < 1.001' few.json
holds '.recorded.lost_bounds.if_trapped.trapped >= .recorded.lost_bounds.if_left.trapped' few.json
expect 0 '9 inputs x 10 outputs' "$gatewalk" show few.nc --rows
expect 0 'SVG\|^' "$gatewalk" predict few.nc --figure few.svg
expect 2 'has no meaning for recorded runs' "$gatewalk" build "$tracks/runs.csv" --cell "$tracks/cell.toml" -o x.nc --accuracy 0.1
expect 2 'whose runs were recorded' "$gatewalk" predict few.nc --first-runs 100
expect 2 'must be seen, or' "$gatewalk" predict few.nc --start Q:0,0,1

for command in walk analyze; do
  expect 2 "recorded runs" "$gatewalk" $command few.nc
done

# Many bodies that are alike: each goes up with chance 3/4 or is trapped, so 0.75^2 cross two rows.
cat >coin.toml <<'END'
[cell]
width_m = 0.1
length_m = 0.1
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[field]
columns = 1
rows = 2
max_gates = 0
END
awk 'BEGIN { srand(3); print "body,trial,in,s,out,out_s,time_s"
  for (b = 0; b < 400; ++b) { s = int(1000 * rand()) / 1e4
    for (k = 0; k < 6; ++k) {
      if (rand() < 0.25) { print b ",1,S," s ",trapped,,1"; break }
      next_s = int(1000 * rand()) / 1e4; print b ",1,S," s ",S," next_s ",1"; s = next_s } } }' >coin.csv
"$gatewalk" build coin.csv --cell coin.toml -o coin.nc --quiet >/dev/null || fail "build of coin.csv"
"$gatewalk" predict coin.nc --json coin.json --quiet >/dev/null || fail "predict of coin.nc"
holds '.endings_95.crossed[0] < 0.5625 and .endings_95.crossed[1] > 0.5625' coin.json
holds '.endings_95.crossed[1] - .endings_95.crossed[0] < 0.15' coin.json
"$gatewalk" predict coin.nc --json again.json --quiet --threads 1 >/dev/null
[ "$(jq -c '[.endings, .endings_95, .error_95]' coin.json)" = "$(jq -c '[.endings, .endings_95, .error_95]' again.json)" ] ||
  fail "another number of threads, another answer"

# Another program's cells.
if command -v python3 >/dev/null; then
  cat >pillars.toml <<'END'
[cell]
width_m = 1.0
length_m = 1.0
symmetric = true
[[cell.faces]]
name = "S"
move = [0, 1]
odd = ["s", "v"]
[[cell.faces]]
name = "N"
move = [0, -1]
odd = ["s", "v"]
[[cell.faces]]
name = "W"
move = [1, 0]
odd = []
[[cell.faces]]
name = "E"
move = [-1, 0]
odd = []
[[cell.coordinates]]
name = "s"
unit = "m"
[[cell.coordinates]]
name = "v"
unit = "m/s"
[field]
columns = 5
rows = 3
max_gates = 20
[start]
face = "S"
s_m = 0.1
v_m_per_s = 0.0
END
  expect 0 '^went back' "$gatewalk" predict pillars.toml --cell-program "python3 $scenes/programs/pillars.py" \
    --accuracy 0.1 --json pillars.json --threads 2
  holds '.reached and (.endings | add) > 0.999 and (.endings | add) < 1.001 and .endings.went_back > 0' pillars.json
  "$gatewalk" predict pillars.toml --cell-program "python3 $scenes/programs/pillars.py" --accuracy 0.1 \
    --json one.json --threads 1 --quiet >/dev/null
  [ "$(jq -c .final_gates pillars.json)" = "$(jq -c .final_gates one.json)" ] || fail "threads change bits"
  expect 1 'exit' "$gatewalk" predict pillars.toml --cell-program 'exit 3'
fi
finish
