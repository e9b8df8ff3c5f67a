#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares the results of two builds of gatewalk on many command lines, byte by byte: JSON, CSV, NetCDF, tables, figures
# and pages, except for the program's version and commit, and measured times. Help pages and schemas are compared too.
# For a figure, gnuplot's data blocks are compared besides the picture, also for PDF and PNG, and where a picture shows
# times. For an SVG, its words are compared, and the pixels that gnuplot draws with the same script into a PNG.
#   tests/same_results.sh [--lines PATTERN] [--hashes FILE] [--other-byte-order] OLD NEW [SCENES]
# OLD, NEW: programs; SCENES: folder of scenes (scenes/); PATTERN: only the lines that this regular expression finds;
# FILE: gets a hash of OLD's output for each line. With --other-byte-order NEW reads matrices that it made itself,
# because netCDF 4.9 reads only files of its own order (netcdf-c, issue 2670); h5dump, which reads both, compares them.
# Schemas are those that a program writes (help --write); older programs use those installed with them
# (../share/gatewalk/schemas), or else those of the sources that their build folder names. Status 1: some results
# differ; 2: nothing was compared.
# To test this script, change a constant in a copy of the sources, such as kQuantile in
# lattice/statistics/group_spread.cpp, and compare the programs.
set -euf
pattern=. hashes='' other_order='' tools=(jq ncdump gnuplot)
while [ $# -gt 0 ]; do
  case $1 in
    --lines) pattern=$2 ;;
    --hashes) hashes=$(realpath "$2") ;;
    --other-byte-order) other_order=yes tools+=(h5dump) ;;
    *) break ;;
  esac
  [ "$1" = --other-byte-order ] || shift
  shift
done
for tool in "${tools[@]}"; do command -v $tool >/dev/null || { echo "$tool is missing" >&2; exit 2; }; done
old=$(realpath "$1") new=$(realpath "$2")
scenes=$(realpath "${3:-$(dirname "$0")/../scenes}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/inputs" "$work/own" "$work/bin"

# gnuplot, which also keeps the data blocks of what it draws in the folder that it runs in.
cat >"$work/bin/gnuplot" <<END
#!/usr/bin/env bash
set -euf
script=\$(mktemp "$work/script.XXXXXX")
cat >"\$script"
if grep -q -e ' << EOD$' -e '^set terminal svg ' "\$script"; then
  number=1
  until (set -C; : >"figure-\$number.data") 2>/dev/null; do number=\$((number + 1)); done
  sed -n '/ << EOD\$/,/^EOD\$/p' "\$script" >"figure-\$number.data"
  if grep -q '^set terminal svg ' "\$script" && ! grep -q '^\$times <<' "\$script"; then
    sed -E 's/^set terminal svg size ([0-9]+),([0-9]+) (.*)/set terminal pngcairo size \1,\2 \3/' "\$script" |
      '$(command -v gnuplot)' >"figure-\$number.pixels" 2>figure.log || cat figure.log >&2
    rm -f figure.log
  fi
fi
status=0
'$(command -v gnuplot)' "\$@" <"\$script" || status=\$?
rm "\$script"
exit \$status
END
chmod +x "$work/bin/gnuplot"
PATH=$work/bin:$PATH

# The command lines, behind the exit status that each must have; each writes into the folder that it runs in.
# Where the result is JSON, or a folder of files, its CSV is asked for as well (numbers.csv). The longest comes first.
lines() {
  cat <<'END'
0 reproduce -o out --quick
0 gate field.toml --trials 300 --json out.json --figure out.svg
0 gate field.toml --set forces.random_rate_Hz=0.05 --trials 100 --json out.json
0 gate single_gate.toml --set run.method=paper --trials 200 --json out.json
0 gate soft_left.toml --set run.method=moreau --trials 500 --json out.json
0 gate soft_left.toml --set run.method=event --trials 100 --json out.json
0 gate single_gate.toml --set run.method=penalty --trials 50 --json out.json
0 gate stiff.toml --set run.method=auto --trials 200 --json out.json
0 trace stiff.toml --trials 2 --csv out.csv
0 gate overdamped.toml --trials 300 --json out.json
0 gate undamped.toml --trials 200 --json out.json
0 gate wading.toml --set run.method=event --trials 50 --json out.json
0 gate robot.toml --trials 500 --json out.json
0 gate own.toml --trials 200 --json out.json
0 gate mixed.toml --trials 100 --json out.json
0 gate elastic.toml --trials 200 --json out.json
1 gate single_gate.toml --set run.method=paper --trials 50 --strict --json out.json
0 scene field.toml
0 scene own.toml --json out.json
0 scene own.toml --new -o new.toml
0 scene mixed.toml --json out.json
0 scene map.toml --set forces.propulsion_N=8 --json out.json
0 sweep single_gate.toml --vary forces.propulsion_N=4:1:9 --vary forces.random_N=0,20 --trials 50 --csv out.csv --json out.json --figure out.svg
0 sweep soft_left.toml --vary run.method=stable,moreau,event,penalty,paper --trials 30 --csv out.csv
0 sweep fig8.toml --trials 3 --csv out.csv
0 sweep own.toml --vary body.radius_m=0.06:0.01:0.1 --trials 100 --csv out.csv --figure out.svg
0 landscape single_gate.toml --trials 100 -o out
0 landscape own.toml -o out
0 landscape soft_left.toml --beam right -o out
0 trace soft_left.toml --trials 4 --csv out.csv --netcdf out.nc --json out.json --replay out.html --figure out.svg
0 trace field.toml --field --trials 2 --seed 3 --json out.json --netcdf out.nc
0 trace map.toml --field --trials 3 --csv out.csv --replay out.html
0 trace overdamped.toml --trials 2 --csv out.csv
0 trace soft_left.toml --set run.method=moreau --trials 2 --csv out.csv
0 trace soft_left.toml --set run.method=penalty --trials 2 --csv out.csv
0 trace soft_left.toml --set run.method=paper --trials 2 --csv out.csv
0 trace soft_left.toml --set run.time_limit_s=0.3 --video out.gif
0 trace own.toml --set run.method=event --trials 20 --only exited --csv out.csv
0 build field.toml --trials 30 -o m.nc
0 build own.toml --trials 20 -o m.nc
0 build field.toml --bins 2 --trials 3 -o m.nc
0 build field.toml --bins auto --trials 20 -o m.nc
0 build bins.toml --trials 5 -o m.nc --json out.json
0 build map.toml --bins paper --trials 3 -o m.nc --json out.json
0 build field.toml --accuracy 0.1 -o m.nc --json out.json
0 build soft_left.toml --bins tree --gate-runs 2000 -o m.nc
0 build robot.toml --accuracy 0.2 --starts all -o m.nc
0 build field.toml --accuracy 0.1 --states 60 --starts=-5:5,-5:5,12:16 -o m.nc
0 build mixed.toml --set run.method=moreau --accuracy 0.2 -o m.nc
0 show matrix.nc --json out.json
0 show matrix.nc --row 13
0 show own.nc --rows
0 show tree.nc --json out.json --figure out.svg
0 show mixed.nc --type u --json out.json
0 walk matrix.nc --walks 2000 --json out.json --figure out.svg
0 export matrix.nc --set field.max_gates=0 -o out.drn --json out.json
0 export mixed.nc -o out.tra
0 export tree.nc --set field.max_gates=0 -o out.umb
0 walk own.nc --walks 2000 --json out.json
0 walk tree.nc --walks 2000 --set field.max_gates=0 --json out.json
0 walk mixed.nc --walks 2000 --json out.json
0 predict matrix.nc --json out.json --figure out.svg
0 predict matrix.nc --set field.max_gates=0 --json out.json
0 predict matrix.nc --set field.max_gates=0 --solver klu --json out.json
0 predict matrix.nc --set field.max_gates=0 --set field.columns=61 --set field.rows=40 --json out.json
0 predict matrix.nc --solver propagate --start 0,0,15 --start 4,5,10.5 --json out.json
0 predict matrix.nc --row 3=soft.nc --json out.json
0 predict own.nc --json out.json
0 predict tree.nc --json out.json
0 predict tree.nc --start 4,5,10 --start=-17,13,12 --json out.json --figure out.svg
0 predict tree.nc --start 4,5,10 --first-runs 0
0 predict mixed.nc --set terrain.seed=6 --json out.json
0 predict mixed.nc --set field.max_gates=0 --json out.json
0 predict field.toml --accuracy 0.1 --json out.json --figure out.svg
0 predict field.toml --set beams.stiffness_left_Nm_per_rad=250 --accuracy 0.1 --json out.json
0 predict own.toml --accuracy 0.1 --json out.json
0 predict robot.toml --accuracy 0.1 --start 0.02,0,0.4 --json out.json
0 predict overdamped.toml --set field.rows=4 --set run.traverse_y_m=60 --accuracy 0.2 --json out.json
0 predict field.toml --set run.method=event --accuracy 0.2 --gate-runs 1500 --json out.json
0 predict mixed.toml --accuracy 0.2 --json out.json
0 predict map.toml --accuracy 0.2 --json out.json --figure out.svg
0 lattice field.toml --trials 100 --json out.json --figure out.svg
0 lattice own.toml --trials 50 --json out.json
0 lattice field.toml --set run.method=moreau --set field.fidelity=all --trials 30 --json out.json
0 lattice field.toml --set run.method=moreau --set field.fidelity=remember --trials 30 --json out.json
0 lattice field.toml --set run.method=penalty --trials 3 --json out.json
0 lattice mixed.toml --set run.method=moreau --trials 100 --json out.json
0 lattice map.toml --trials 100 --json out.json
0 analyze field.toml --set run.method=moreau --accuracy 0.1 --runs 200 --trials 100 --json out.json --figure out.svg
0 analyze tree.nc --runs 0 --lump 3,1,2 --target trapped --json out.json
0 analyze tree.nc --set field.max_gates=0 --runs 0 --json out.json
0 analyze tree.nc --set field.max_gates=0 --set field.columns=41 --set field.rows=20 --runs 0 --json out.json
0 analyze matrix.nc --runs 100 --json out.json
0 analyze map.toml --set run.method=moreau --accuracy 0.2 --runs 100 --json out.json
0 analyze field.toml --set run.method=moreau --accuracy 0.2 --runs 100 --over forces.propulsion_N=6:9 --over-trials 4000 --json out.json
0 rare field.toml --set run.method=moreau --row 5 --gate-runs 20000 --trials 100 --json out.json --figure out.svg
0 rare mixed.toml --set run.method=moreau --row 3 --gate-runs 20000 --json out.json
0 plan field.toml --set run.method=moreau --set field.rows=3 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --accuracy 0.1 --json out.json --figure out.svg
0 design mixed.toml --set run.method=moreau --set field.rows=3 --changes 2 --accuracy 0.1 --json out.json --figure out.svg -o out.toml
0 fit field.toml gates.csv --set run.method=moreau --free forces.propulsion_N=5:9 --free forces.random_N=10:40 --trials 24576 --json out.json --figure out.svg --draws out.csv -o out.toml
0 validate field.toml --trials 50 --json out.json --quiet
0 validate field.toml --matrix matrix.nc --start 0,0,15 --trials 80 --walks 300 --memory --json out.json --figure out.svg
0 validate own.toml --trials 40 --matrix-trials 20 --json out.json --quiet
0 validate field.toml --matrix tree.nc --trials 60 --start 0,0,15 --null-draws 99 --json out.json
0 validate mixed.toml --set run.method=moreau --matrix mixed.nc --trials 60 --null-draws 99 --json out.json
0 validate field.toml --matrix matrix.nc --observed gates.csv --observed ends.csv --trials 200 --null-draws 99 --json out.json
0 power field.toml --accuracy 0.1 --trials 60 --json out.json
0 power field.toml --accuracy 0.1 --versus beams.stiffness_left_Nm_per_rad=200 --json out.json
0 chart methods soft_left.toml --trials 40 --repeats 1 --methods stable,moreau -o out
0 chart field field.toml --trials 20 -o out
0 chart chain field.toml --start 0,0,15 --truth-trials 400 --runs-limit 20000 --bins 0.5 -o out
0 chart limits soft_left.toml -o out --quick --trials 8
0 sample
0 sample walker -o out.toml --json out.json
0 passages tracks.csv --cell cell.toml -o out.csv --fps 10 --metres-per-unit 0.001 --fastest 0.4 --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y --json out.json --figure out.svg
0 build runs.csv --cell cell.toml -o m.nc --json out.json
0 build passages.csv --cell cell.toml -o m.nc --json out.json
0 predict passages.nc --json out.json --figure out.pdf
0 validate passages.nc --json out.json --figure out.png
0 import counts.csv --states states.csv --start 0 --set field.rows=3 --set field.columns=3 -o m.nc --json out.json
0 merge part1 part2 -o out.json
2 gate nothing.toml
2 gate field.toml --set body.mass_kg=-1
2 gate field.toml --set body.mas_kg=1
2 gate wrong.toml
2 scene wrong_map.toml
2 sweep field.toml --vary forces.random_N=1:0:2
2 build field.toml --trials 2
2 build field.toml --bins tree --trials 5 -o m.nc
2 walk matrix.nc --set forces.random_N=12
2 predict matrix.nc --accuracy 0.1
2 predict mixed.nc --row 2=mixed.nc
2 lattice field.toml --set field.fidelity=all
2 analyze tree.nc --target lost
2 rare mixed.toml --row 10
2 validate field.toml --matrix matrix.nc --observed wrong.csv
2 power field.toml --power 1.2
END
}

# The commands of both programs.
commands() { for side in old new; do "${!side}" help 2>/dev/null | sed -n 's/^  \([a-z-]*\( [a-z][a-z]*\)\{0,1\}\)  .*/\1/p'; done | sort -u; }

# The folder of a program's schemas; nothing where there is none.
schemas_of() {  # PROGRAM
  local here sources share
  share=$(mktemp -d "$work/share.XXXXXX")
  "$1" help --write "$share" >/dev/null 2>&1 || true
  here=$(dirname "$1")
  sources=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$here/CMakeCache.txt" 2>/dev/null || true)
  for folder in "$share/gatewalk/schemas" "$here/../share/gatewalk/schemas" "$sources/cli/schemas"; do
    [ ! -e "$folder/gate.schema.json" ] || { realpath "$folder"; return; }
  done
}

# What they read: scenes beside those of the folder, an experiment's counts, and matrices that OLD builds.
cp $(find "$scenes" -name '*.toml') "$work/inputs"
cd "$work/inputs"
cat >own.toml <<'END'
body = { mass_kg = 0.25, radius_m = 0.08 }
forces = { random_N = 0.4 }
END
cat >elastic.toml <<'END'
beams = { stiffness_right_Nm_per_rad = 0, damping_Nms_per_rad = 500 }
forces = { propulsion_N = 0, random_N = 10, random_rate_Hz = 5, drag_Ns_per_m = 1 }
contact = { restitution = 1, tip_restitution = 1 }
run = { method = "moreau", step_s = 0.004 }
start = { vx_m_per_s = -10, vy_m_per_s = 15 }
END
cat >map.toml <<'END'
forces = { propulsion_N = 8, random_N = 50 }
field = { columns = 5, rows = 4 }
terrain.map_file = "map.csv"
terrain.types.s.beams.stiffness_left_Nm_per_rad = 200.0
terrain.types.s.beams.stiffness_right_Nm_per_rad = 200.0
terrain.types.w.forces.drag_Ns_per_m = 0.2
terrain.types.w.contact.restitution = 0.4
END
printf '%s\n' .s.s. w.w.w s...s ..w.. >map.csv
sed 's/map.csv/wrong_map.csv/' map.toml >wrong_map.toml
printf '%s\n' .s.s. w.x.w s...s ..w.. >wrong_map.csv
printf 'body.radius_m = 10\n[beams]\nlength_m = "long"\n' >wrong.toml
{ cat field.toml; printf '[bins]\nEN_d_m = [-25, -5, 5, 25]\nEN_vx_m_per_s = [-20, 0, 20]\n'; } >bins.toml
printf 'ending,count\ntrapped,50\nleft_side,6\nright_side,4\n' >ends.csv
printf 'gate_x,gate_y,count\n0,0,8\n0,1,20\n1,1,12\n-1,2,20\n' >gates.csv
printf 'gate_x,gate_y,count\n0,9,8\n' >wrong.csv
printf 'from,to,count\n0,0,4\n0,1,3\n0,2,2\n1,0,2\n1,1,6\n1,2,1\n' >counts.csv
printf 'state,move_x,move_y\n0,0,1\n1,1,0\n' >states.csv
cp "$scenes"/tracks/{tracks.csv,runs.csv,cell.toml} .
old_schemas=$(schemas_of "$old") new_schemas=$(schemas_of "$new")
{
  lines
  echo '0 help '
  commands | sed 's/^/0 help /'
  if [ -n "$old_schemas" ] && [ -n "$new_schemas" ]; then
    (cd "$old_schemas" && ls; cd "$new_schemas" && ls) | sort -u | sed 's/^/0 schema /'
  else
    echo "schemas are not compared: $([ -n "$old_schemas" ] && echo "$new" || echo "$old") has none beside it" >&2
  fi
} | grep -E -e "$pattern" >"$work/lines" || { echo "no line has '$pattern'" >&2; exit 2; }
if grep -q 'passages\.' "$work/lines"; then
  "$old" $(lines | sed -n 's/ --json.*//; s/^0 \(passages .*\)-o out.csv/\1-o passages.csv/p') --quiet >/dev/null
fi
while read -r name arguments; do
  grep -q -w "$name.nc" "$work/lines" || continue
  "$old" build $arguments -o "$name.nc" --quiet >/dev/null 2>"$work/log" || { cat "$work/log" >&2; exit 2; }
  [ -n "$other_order" ] || continue
  "$new" build $arguments -o "$work/own/$name.nc" --quiet >/dev/null 2>"$work/log" || { cat "$work/log" >&2; exit 2; }
done <<'END'
matrix field.toml --trials 20
own own.toml --trials 20
soft field.toml --set beams.stiffness_left_Nm_per_rad=300 --trials 20
tree field.toml --accuracy 0.1
mixed mixed.toml --set run.method=moreau --bins paper --trials 3
passages passages.csv --cell cell.toml
END
# A program merges only its own parts.
if grep -q '^0 merge' "$work/lines"; then
  for part in 1 2; do
    for side in old new; do
      cd "$work/$([ $side = old ] && echo inputs || echo own)"
      "${!side}" gate "$work/inputs/field.toml" --trials 40 --shard $part/2 --part part$part --quiet 2>"$work/log" ||
        { cat "$work/log" >&2; exit 2; }
    done
  done
fi
for command in $(sed -E 's/^[0-9]+ //; s/^chart /chart-/; s/ .*//' "$work/lines" | sort -u); do
  # Both have it: a page of help tells where only one has.
  for side in old new; do "${!side}" help ${command/-/ } 2>/dev/null | grep -q -e ' --csv FILE' || continue 2; done
  echo "$command"
done >"$work/with_csv"

# What a file says but for what may differ: who made it, on how many threads, and what was timed. Where a table consists
# of times, its words stay; its other numbers are in the CSV beside it. What chart chain says of direct simulation depends
# on the times, and so do the claims of reproduce about speed, its page and its words.
plain() {  # COMMAND FILE
  case $1:$2 in
    reproduce:*/out/report.json)
      jq -S --arg timed "$timed" "$nameless | del(.lead) | .claims |= map(select(.see != \"speed\")) |
        .sections |= map(select(.id != \"speed\"))" "$2" ;;
    reproduce:*/out/claims.csv) grep -v ',speed$' "$2" ;;
    reproduce:*/out/speed.* | reproduce:*.html | reproduce:*.pdf | reproduce:*/stdout.txt) ;;
    *stderr.txt) grep -v -E '^gatewalk: .*: (some [0-9.]+ (s|min|h)|[0-9.]+ %(, .* left)?)$' "$2" || true ;;
    *.json) jq -S --arg timed "$timed" "$nameless" "$2" ;;
    *.nc) content "$2" ;;
    *numbers.csv) timed=$timed awk -F, '{ for (i = split($1, key, "."); i > 0; --i)
      if (key[i] ~ ENVIRON["timed"] || key[i] ~ /^(version|commit|program|machine)$/) next; print }' "$2" ;;
    chart-methods:*.data) sed 's/^[-+.0-9e]* //' "$2" ;;  # the time comes first
    chart-chain:*.data) sed '/^\$direct/,/^EOD/d; s/^[-+.0-9e]* //' "$2" ;;
    chart-field:*.data) sed 's/ [-+.0-9e]*$//' "$2" ;;  # it comes last
    reproduce:*.data) sed '/^\$times/,/^EOD/d' "$2" ;;
    chart*.csv) awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) skip[i] = $i ~ /^microseconds_|^seconds_|(build|answer|total)_s$/ }
      /,direct simulation,/ { next }
      { for (i = 1; i <= NF; ++i) printf "%s,", skip[i] ? "" : $i; print "" }' "$2" ;;
    chart*.svg | chart*.pixels | chart-chain:*.txt | *.pdf | *.png) ;;
    *.svg) grep -oE '>[^<>]+<' "$2" | sort || true ;;
    chart*.txt) sed -E 's/[0-9.]+(e[-+][0-9]+)?/N/g; s/ +/ /g' "$2" ;;
    *.txt) sed -E '/ dynamics\/exact  trial\/walk$/,/^$/d; s/[0-9.]+ s([;,]|$)/... s\1/g' "$2" ;;
    *) cat "$2" ;;
  esac
}
timed='^(threads|seconds|(run|direct|chain)_seconds|(micro)?seconds_per_trial|speed_ratio|(build|exact|walks_[0-9]+)_s'
timed+='|one_thread_s_per_.*|chain_pays_.*|summary|direct_simulation)$'
nameless='walk(if type == "object" then del(.version, .commit, .program, .machine) |
  with_entries(select(.key | test($timed) | not)) else . end)'

content() {  # MATRIX, but for who made it
  if [ -z "$other_order" ]; then
    ncdump "$1" | grep -v -E '^[[:space:]]+:(program|version|commit|checksum) = |^netcdf '
    return
  fi
  # Of any byte order, without the places of its parts.
  h5dump "$1" | sed -E '1d; s/(H5T_[A-Z0-9]+_[IUF][0-9]+)[BL]E/\1/; s/DATASET [0-9]+/DATASET/g' | awk '
    /ATTRIBUTE "(program|version|commit|checksum)"/ { match($0, /^ */); end = RLENGTH + 1; skip = 1 }
    !skip { print }
    skip && match($0, /^ *}/) && RLENGTH == end { skip = 0 }' | grep .
}

compare() {  # NUMBER of the line
  local wanted line command side file differ=() here=$work/$1
  read -r wanted line < <(sed -n "$1p" "$work/lines")
  command=${line/#chart /chart-} command=${command%% *}
  local words=($line)
  if [ "$wanted" != 2 ] && grep -q -x -e "$command" "$work/with_csv"; then
    case " $line " in *' --csv '*) ;; *' --json '* | *' -o out '* | *' -o out.json '*) words+=(--csv numbers.csv) ;; esac
  fi
  for side in old new; do
    mkdir -p "$here/$side"
    cp -r "$work/inputs/." "$here/$side"
    [ "$side" = old ] || cp -r "$work/own/." "$here/$side"
    cd "$here/$side"
    local status=0
    if [ "$command" = schema ]; then
      local schemas=${side}_schemas
      cp "${!schemas}/${words[1]}" . 2>stderr.txt || status=$?
    else
      "${!side}" "${words[@]}" >stdout.txt 2>stderr.txt || status=$?
    fi
    [ $status = "$wanted" ] || differ+=("status $status of $side: $(head -n 1 stderr.txt)")
    (cd "$work/inputs" && ls) | xargs rm -f
  done
  cd "$here"
  [ -n "$(find old -type f -size +0)" ] || differ+=("wrote nothing")
  [ "$(cd old && find . -type f | sort)" = "$(cd new && find . -type f | sort)" ] || differ+=("other files")
  while read -r file; do
    [ -f "new/$file" ] || continue
    for side in old new; do
      plain "$command" "$side/$file" >$side.plain || differ+=("$side/$file cannot be read")
    done
    cmp -s old.plain new.plain || differ+=("$file"$'\n'"$(diff old.plain new.plain | head -n 6 | cut -c1-300)")
  done < <(cd old && find . -type f | sort)
  if [ -n "$hashes" ]; then
    local hash
    # Without what was added to the lines, so that hashes of before hold.
    hash=$(find old -type f ! -name numbers.csv ! -name 'figure-*.data' | sort | while read -r file; do echo "$file"; plain "$command" "$file"; done | sha256sum)
    printf '%s,"%s"\n' "${hash:0:16}" "$line" >"$work/$1.hash"
  fi
  if [ ${#differ[@]} = 0 ]; then
    echo same >"$work/$1.verdict"
  else
    printf 'DIFFERS: gatewalk %s: %s\n' "${words[*]}" "${differ[*]}"
  fi
  rm -r "$here"
}
export old new old_schemas new_schemas work timed nameless hashes other_order PATH
export -f compare plain content
seq "$(wc -l <"$work/lines")" | xargs -P "$(nproc)" -I{} bash -c 'set -euf; compare {}' || true
if [ -n "$hashes" ]; then
  { echo hash,line; for number in $(seq "$(wc -l <"$work/lines")"); do cat "$work/$number.hash"; done; } >"$hashes"
fi
same=$(find "$work" -maxdepth 1 -name '*.verdict' | wc -l)
other=$(($(wc -l <"$work/lines") - same))
echo "$same command lines with the same results, $other with others"
[ "$other" = 0 ]
