#!/usr/bin/env bash
# Whether two programs of gatewalk write the same results: JSON, CSV, NetCDF and tables of many command lines, byte by
# byte, but for what names the program itself (version, commit) and what was timed.
#   tests/same_results.sh OLD NEW [SCENES]     OLD, NEW: programs; SCENES: folder of scenes (scenes/)
set -eu
for tool in jq ncdump; do command -v $tool >/dev/null || { echo "$tool is missing" >&2; exit 2; }; done
old=$(realpath "$1") new=$(realpath "$2")
scenes=$(realpath "${3:-$(dirname "$0")/../scenes}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
same=0 other=0

# The command lines; each writes into the folder that it runs in.
lines() {
  cat <<'END'
gate field.toml --trials 300 --json out.json
gate single_gate.toml --set run.method=paper --trials 200 --json out.json
gate soft_left.toml --set run.method=moreau --trials 500 --json out.json
gate soft_left.toml --set run.method=event --trials 100 --json out.json
gate single_gate.toml --set run.method=penalty --trials 50 --json out.json
gate stiff.toml --set run.method=auto --trials 200 --json out.json
gate own.toml --trials 200 --json out.json
scene own.toml --json out.json
scene field.toml
sweep single_gate.toml --vary forces.propulsion_N=4:1:9 --vary forces.random_N=0,20 --trials 50 --csv out.csv --json out.json
landscape single_gate.toml --trials 100 -o out
landscape own.toml -o out
trace soft_left.toml --trials 4 --csv out.csv --netcdf out.nc --json out.json --replay out.html
trace field.toml --field --trials 2 --seed 3 --json out.json --netcdf out.nc
build field.toml --trials 30 -o m.nc
build own.toml --trials 20 -o m.nc
build field.toml --bins 2 --trials 3 -o m.nc
build field.toml --bins auto --trials 20 -o m.nc
show matrix.nc --json out.json
show own.nc --json out.json
walk matrix.nc --walks 2000 --json out.json
walk own.nc --walks 2000 --json out.json
predict matrix.nc --json out.json
predict matrix.nc --set field.max_gates=0 --json out.json
predict matrix.nc --set field.max_gates=0 --solver klu --json out.json
predict matrix.nc --solver propagate --json out.json
predict matrix.nc --row 3=soft.nc --json out.json
predict own.nc --json out.json
lattice field.toml --trials 100 --json out.json
lattice own.toml --trials 50 --json out.json
lattice field.toml --set run.method=moreau --set field.fidelity=all --trials 30 --json out.json
lattice field.toml --set run.method=moreau --set field.fidelity=remember --trials 30 --json out.json
validate field.toml --trials 50 --json out.json --quiet
validate field.toml --matrix matrix.nc --start 0,0,15 --trials 80 --walks 300 --json out.json --quiet
validate own.toml --trials 40 --matrix-trials 20 --json out.json --quiet
chart soft_left.toml --trials 40 --repeats 1 --methods stable,moreau -o out
chart-field field.toml --trials 20 -o out
chart-chain field.toml --start 0,0,15 --truth-trials 400 --runs-limit 20000 --bins 0.5 -o out
stability -o out --quick
gate nothing.toml
gate field.toml --set body.mass_kg=-1
build field.toml --trials 2
predict field.toml
END
}

cat >"$work/own.toml" <<'END'
body = { mass_kg = 0.25, radius_m = 0.08 }
forces = { random_N = 0.4 }
END
cp "$scenes"/*.toml "$work"
(cd "$work" && "$old" build field.toml --trials 20 -o matrix.nc --quiet && "$old" build own.toml --trials 20 -o own.nc --quiet &&
  "$old" build field.toml --set beams.stiffness_left_Nm_per_rad=300 --trials 20 -o soft.nc --quiet) \
  >/dev/null 2>"$work/log" || { cat "$work/log" >&2; exit 2; }

# What may differ: who made it, and seconds.
plain() {
  case $1 in
    *.json) jq -S 'walk(if type == "object" then del(.version, .commit, .program, .machine) | with_entries(select(.key | test("(^|_)seconds?(_|$)|_per_second|faster|speed_?up|^cost|machine|^timing") | not)) else . end)' "$1" ;;
    *.nc) ncdump "$1" | grep -v -E 'made_by|program|checksum|commit|version|^netcdf ' ;;
    *.svg | *.html | *.mp4) ;;  # drawn of the same numbers
    *) sed -E 's/[0-9]+\.[0-9]+ s\b//g; s/gatewalk [0-9][^ ]*//g' "$1" ;;
  esac
}
# A word that OLD itself writes otherwise when it runs again was timed: it and its column stand as
# "timed".
again=(again1 again2 again3)
words() { awk -F '[ ,]+' 'FNR == 1 { ++file }
  file == 1 { first[FNR] = $0; next }
  file <= runs { n = split(first[FNR], a); for (i = 1; i <= n; ++i) timed[NF, i] += a[i] != $i; next }
  { line = ""; for (i = 1; i <= NF; ++i) line = line " " (timed[NF, i] ? "timed" : $i); print line }' "$@"; }

while read -r line; do
  for side in old "${again[@]}" new; do
    rm -rf "${work:?}/$side"
    mkdir "$work/$side"
    cp "$work"/*.toml "$work"/*.nc "$work/$side"
    program=$old
    [ $side = new ] && program=$new
    (cd "$work/$side" && "$program" $line >stdout.txt 2>stderr.txt && echo 0 >status.txt || echo "$?" >status.txt)
    rm "$work/$side"/*.toml "$work/$side"/matrix.nc "$work/$side"/own.nc "$work/$side"/soft.nc
  done
  differ=()
  # The last lines are refused; a line that fails otherwise compares nothing.
  case $line in *nothing.toml* | *mass_kg=-1* | "build field.toml --trials 2" | "predict field.toml") wanted=2 ;; *) wanted=0 ;; esac
  [ "$(cat "$work/old/status.txt")" = $wanted ] || differ+=("status $(cat "$work/old/status.txt"): $(head -n 1 "$work/old/stderr.txt")")
  [ "$(cd "$work/old" && find . -type f | sort)" = "$(cd "$work/new" && find . -type f | sort)" ] || differ+=("other files")
  while read -r file; do
    for side in old "${again[@]}" new; do
      if [ -f "$work/$side/$file" ]; then plain "$work/$side/$file"; fi >"$work/$side.plain"
    done
    [ -s "$work/old.plain" ] || { cmp -s "$work/old.plain" "$work/new.plain" || differ+=("$file"); continue; }  # an empty one has no words
    for side in old new; do
      cp "$work/$side.plain" "$work/last.plain"
      words runs=4 "$work/old.plain" "$work/again1.plain" "$work/again2.plain" "$work/again3.plain" "$work/last.plain" >"$work/$side.words"
    done
    if ! cmp -s "$work/old.words" "$work/new.words"; then
      differ+=("$file")
      diff "$work/old.words" "$work/new.words" | head -n 6 || true
    fi
  done < <(cd "$work/old" && find . -type f)
  if [ ${#differ[@]} = 0 ]; then
    same=$((same + 1))
  else
    other=$((other + 1))
    echo "DIFFERS: gatewalk $line: ${differ[*]}"
  fi
done < <(lines)
echo "$same command lines with the same results, $other with others"
[ "$other" = 0 ]
