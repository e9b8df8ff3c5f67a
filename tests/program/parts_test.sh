#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests --shard, --first-trial and merge: the parts of a run give the bits of the whole run.
#   parts_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# What the commands write, without times and the list of parts.
plain() { jq -S 'walk(if type == "object" then del(.parts, .seconds, .run_seconds, .direct_seconds, .chain_seconds, .speed_ratio) else . end)' "$1"; }
same() {
  case $1 in
    *.json) cmp -s <(plain "$1") <(plain "$2") ;;
    *) cmp -s "$1" "$2" ;;
  esac || fail "$2 is not $1, of one run"
}
# divided PARTS OUTPUT COMMAND...: runs the command, which writes OUTPUT, in one run and in parts.
divided() {
  local parts=$1 output=$2 i
  shift 2
  "$gatewalk" "$@" --quiet >/dev/null 2>err.txt || fail "$* ($(cat err.txt))"
  mv "$output" "one-$output"
  rm -f part*
  for ((i = parts; i >= 1; --i)); do
    "$gatewalk" "$@" --quiet --shard "$i/$parts" --part "part$i" >out.txt 2>err.txt || fail "part $i of $* ($(cat err.txt))"
    [ ! -e "$output" ] || fail "a part wrote $output: $*"
  done
  "$gatewalk" merge part* --quiet >/dev/null 2>err.txt || fail "merge of $* ($(cat err.txt))"
  same "one-$output" "$output"
  rm -f "$output"
}
field=("$scenes/field.toml" --set run.method=moreau --seed 5)
divided 7 gate.json gate "${field[@]}" --trials 1000 --json gate.json
divided 2 sweep.csv sweep "$scenes/single_gate.toml" --vary forces.propulsion_N=5:1:8 --trials 90 --csv sweep.csv
divided 3 sweep.json sweep "$scenes/single_gate.toml" --set run.method=auto --set run.time_limit_s=2 --vary forces.propulsion_N=6,8 --trials 90 --json sweep.json
divided 2 bins.nc build "${field[@]}" --bins paper --trials 20 -o bins.nc
divided 3 bins.nc build "$scenes/mixed.toml" --set run.method=moreau --bins paper --trials 5 -o bins.nc
divided 2 tree.nc build "${field[@]}" --bins tree --trials 400 -o tree.nc
divided 3 tree.nc build "${field[@]}" --bins tree --starts all --trials 400 -o tree.nc
divided 2 lattice.json lattice "${field[@]}" --trials 500 --json lattice.json
[ -z "${GATEWALK_LONG:-}" ] || divided 100 lattice.json lattice "${field[@]}" --trials 250 --json lattice.json
divided 2 runs.csv lattice "${field[@]}" --trials 200 --passages runs.csv
divided 2 rare.json rare "${field[@]}" --row 4 --split-trials 1500 --trials 300 --json rare.json
divided 2 validate.json validate "${field[@]}" --bins paper --matrix-trials 10 --trials 210 --null-draws 99 --json validate.json
divided 2 trees.json validate "${field[@]}" --accuracy 0.1 --trials 120 --null-draws 99 --json trees.json
divided 2 force.json validate "${field[@]}" --bins paper --matrix-trials 10 --trials 100 --null-draws 99 --memory --start 0,0,15 --start 4,5,10 --json force.json
if command -v python3 >/dev/null; then
  cp "$scenes/programs/pillars.toml" .
  program=(--cell-program "python3 $scenes/programs/pillars.py" --seed 5)
  divided 2 cell.json lattice pillars.toml "${program[@]}" --trials 200 --json cell.json
  divided 2 cell.nc build pillars.toml "${program[@]}" --trials 200 -o cell.nc
fi

# Parts by trial numbers, in any division, also of a later run on another machine.
one=(lattice "${field[@]}" --quiet)
"$gatewalk" "${one[@]}" --trials 300 --json one.json
for range in 0:100 250:50 100:150; do
  "$gatewalk" "${one[@]}" --first-trial "${range%:*}" --trials "${range#*:}" --part "from${range%:*}" 2>/dev/null
done
"$gatewalk" merge from* -o all.json --quiet
same one.json all.json
holds '[.made_by.parts[].holds] == ["trials 0 to 99", "trials 100 to 249", "trials 250 to 299"]' all.json
# In any order, and with the default number of trials.
"$gatewalk" "${one[@]}" --first-trial 0 --part usual0 2>/dev/null
"$gatewalk" "${one[@]}" --first-trial 100 --trials 200 --part usual100 2>/dev/null
for order in "usual0 usual100" "usual100 usual0"; do
  # shellcheck disable=SC2086
  "$gatewalk" merge $order -o usual.json --quiet --force
  holds '.trials == 300' usual.json
done
# Without --part the result is that of these trials.
"$gatewalk" "${one[@]}" --first-trial 250 --trials 50 --json last.json
"$gatewalk" merge from250 -o again.json --quiet
same last.json again.json
# The outputs that the parts were given, other outputs, and the table.
"$gatewalk" "${one[@]}" --trials 300 --json told.json --shard 1/2 --part a 2>/dev/null
"$gatewalk" "${one[@]}" --trials 300 --json told.json --shard 2/2 --part b 2>/dev/null
expect 0 'crossed' "$gatewalk" merge a b -- --netcdf field.nc
[ -s told.json ] && [ -s field.nc ] || fail "merge: does not write what the parts were told, or what it is told"
expect 0 '' "$gatewalk" merge b a -o other.json --quiet
same told.json other.json

# Parts that are missing, given twice, or of another run are named.
"$gatewalk" "${one[@]}" --trials 300 --shard 1/3 --part c 2>/dev/null
"$gatewalk" "${one[@]}" --trials 300 --shard 3/3 --part d 2>/dev/null
expect 2 'missing: part 2 of 3' "$gatewalk" merge c d -o x.json
expect 2 'c: part 1 of 3 is given twice' "$gatewalk" merge c d c -o x.json
expect 2 'a: is part 1 of 2, and c is part 1 of 3' "$gatewalk" merge c a d -o x.json
"$gatewalk" "${one[@]}" --first-trial 50 --trials 100 --part overlap 2>/dev/null
expect 2 'both have items .* of field trials' "$gatewalk" merge from0 overlap -o x.json
expect 2 'missing: items 100 to 249 of field trials' "$gatewalk" merge from0 from250 -o x.json
"$gatewalk" "${one[@]}" --set forces.random_N=40 --trials 300 --shard 2/3 --part e 2>/dev/null
expect 2 'e: is of another run than c, the scene:' "$gatewalk" merge c e d -o x.json
grep -q 'forces.random_N' out.txt || fail "merge: does not name the key that differs: $(cat out.txt)"
"$gatewalk" lattice "${field[@]}" --seed 6 --trials 300 --shard 2/3 --part e --quiet --force 2>/dev/null
expect 2 'e: is of another run than c, there: .* --seed=6 .*; here: .* --seed=5 ' "$gatewalk" merge c e d -o x.json
head -c -60 d >cut
expect 2 "missing: part 2 of 3; not finished: cut (part 3 of 3); .* --shard 2/3, 3/3 and --resume" "$gatewalk" merge c cut -o x.json
expect 2 'field.toml: holds no pieces of a run' "$gatewalk" merge c "$scenes/field.toml" -o x.json
expect 2 'cannot be read' "$gatewalk" merge c nosuch -o x.json
# A part is also a checkpoint; it is no matrix.
expect 2 'd: holds what an earlier run has done' "$gatewalk" "${one[@]}" --trials 300 --shard 3/3 --part d
expect 0 'd is done' "$gatewalk" "${one[@]}" --trials 300 --shard 3/3 --part d --resume
expect 2 'd: holds part 3 of 3, and this is part 2 of 3' "$gatewalk" "${one[@]}" --trials 300 --shard 2/3 --part d --resume
expect 2 'MATRIX d: holds pieces of a run: gatewalk merge' "$gatewalk" predict d
# Faults count if one of the parts was strict, as in one run.
loose=(lattice "$scenes/field.toml" --set run.method=moreau --set run.step_s=0.02 --trials 1000 --strict --json strict.json --quiet)
"$gatewalk" "${loose[@]}" --force >/dev/null 2>&1
one_status=$?
for i in 1 2; do "$gatewalk" "${loose[@]}" --shard $i/2 --part strict$i 2>/dev/null; done
"$gatewalk" merge strict1 strict2 --quiet --force >/dev/null 2>&1
[ $? = $one_status ] && [ $one_status = 1 ] || fail "merge forgets --strict"
# A part of another program's cell is named.
if command -v python3 >/dev/null; then
  cp "$scenes/programs/pillars.py" own.py
  own=(lattice pillars.toml --cell-program "python3 own.py" --trials 40 --quiet)
  "$gatewalk" "${own[@]}" --shard 1/2 --part own1 2>/dev/null
  sed -i 's/"radius_m": 0.3/"radius_m": 0.2/' own.py
  "$gatewalk" "${own[@]}" --shard 2/2 --part own2 2>/dev/null
  expect 2 'own1: is of another run, there: .*radius_m = 0.3.*; here: .*radius_m = 0.2' "$gatewalk" merge own1 own2 -o x.json
fi
# A file of somebody else is not replaced; merge refuses options of parts after --.
echo precious >notes.txt
expect 2 'notes.txt: is there and holds no pieces' "$gatewalk" "${one[@]}" --json x.json --checkpoint notes.txt
expect 2 'notes.txt: is there and holds no pieces' "$gatewalk" "${one[@]}" --shard 1/2 --part notes.txt
[ "$(cat notes.txt)" = precious ] || fail "a checkpoint replaced another file"
expect 2 'has no meaning in merge' "$gatewalk" merge c d -- --shard 1/2
expect 2 'name the same output' "$gatewalk" merge a b -o x.json --json y.json
expect 2 'must be at least 16' "$gatewalk" build "${field[@]}" --bins tree --trials 10 -o x.nc
# Each part makes progress under a time limit, also with the stages that all parts do.
part=(rare "${field[@]}" --row 4 --split-trials 2000 --shard 2/2 --part late --quiet --threads 1)
status=75
for _ in $(seq $((${SANITIZED:+20 *} 20))); do "$gatewalk" "${part[@]}" --max-time $((${SANITIZED:+3 +} 1))s --resume >/dev/null 2>&1; status=$?; [ $status = 75 ] || break; done
[ $status = 0 ] || fail "part 2 under --max-time: status $status"
# A part of another commit, with other keys; one whose inputs are not files.
"$gatewalk" "${one[@]}" --trials 300 --shard 1/2 --part whole --quiet 2>/dev/null
# changed PART SED-COMMAND: changes the second line, and its checksum.
changed() {
  sed -n 2p whole | sed "$2" | tr -d '\n' >head.txt
  check=$(gzip -c head.txt | tail -c 8 | od -An -tx4 -N4 | tr -d ' ')
  { echo "gatewalk pieces 1 l $(stat -c %s head.txt) $check"; cat head.txt; echo; } >"$1"
}
changed older 's/"commit":"[^"]*"/"commit":"older"/; s/"main_output"/"output"/'
changed no_file 's/"inputs":\[[^]]*\]/"inputs":[{}]/'
expect 2 'has no inputs as a run writes it' "$gatewalk" merge no_file
expect 2 'has no main_output as a run writes it; commit older wrote it, and this is ' "$gatewalk" merge older
# Wrong use.
expect 2 'must be I/N' "$gatewalk" "${one[@]}" --shard 0/3 --part x
expect 2 'must be I/N' "$gatewalk" "${one[@]}" --shard 4/3 --part x
expect 2 'must be I/N' "$gatewalk" "${one[@]}" --shard 1-3 --part x
expect 2 'needs --part' "$gatewalk" "${one[@]}" --shard 1/3
expect 2 'needs --shard' "$gatewalk" "${one[@]}" --part x
expect 2 'both say which part' "$gatewalk" "${one[@]}" --shard 1/3 --first-trial 5 --part x
expect 2 'needs --trials' "$gatewalk" build "${field[@]}" -o x.nc --shard 1/3 --part x
expect 2 'needs --split-trials' "$gatewalk" rare "${field[@]}" --shard 1/3 --part x
[ ! -e x ] && [ ! -e x.json ] || fail "wrong use wrote a file"

finish
