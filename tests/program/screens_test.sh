#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A command's first screen has at most fifteen lines for one start and no line over 100 characters, also with --details;
# it says what to do next, and what it says runs and does what its comment says.   screens_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

cp -r "$scenes"/*.toml "$scenes/observed.csv" "$scenes/tracks" .
cat >small.toml <<'END'
forces = { propulsion_N = 8, random_N = 50 }
field = { columns = 5, rows = 3 }
END
# advice FILE: the commands that a screen proposes, each on a line; a command that a backslash continues is joined.
advice() {
  awk '/^Next: / { sub(/^Next: /, "      "); on = 1 }
    on && /^      / { sub(/^ +/, ""); more = sub(/ \\$/, " "); line = line $0; if (!more) { print line; line = "" }; next }
    { on = 0 }' "$1"
}
# Shapes of screens: how many lines, how wide, and how they end.
wide() { awk -v most=100 'length($0) > most' "$1" | head -n 1; }
# first LINES COMMAND...: the first screen has at most so many lines besides a map of gates, and Next lines; kept in screen.txt.
first() {
  local most=$1 lines
  shift
  "$gatewalk" "$@" --force >screen.txt 2>err.txt || { fail "$*: $(head -n 1 err.txt)" && return; }
  lines=$(grep -c -v -e '^ *[0-9]* |' -e '^  i_x ' screen.txt)
  [ "$lines" -le "$most" ] || fail "$lines lines: $*"
  [ -z "$(wide screen.txt)" ] || fail "a line is too wide: $*: $(wide screen.txt)"
  [ "$(wc -l <err.txt)" -le 2 ] || fail "more than two remarks: $*: $(cat err.txt)"
  [ "$1" = chart ] || grep -q '^Next: ' screen.txt || fail "does not say what to do next: $*"
  tail -n 1 screen.txt | grep -q -e '^--details shows ' || fail "does not say that there are details: $*"
  advice screen.txt >lines.txt
  grep -v -x 'gatewalk [a-z].*  # [a-zA-Z].*' lines.txt >odd.txt && fail "no whole command with a comment: $*: $(cat odd.txt)"
  # Each line with the command that proposed it.
  while read -r line; do printf '%s\t%s\n' "$line" "${*@Q}"; done <lines.txt >>next.txt
}
# screens COMMAND...: its first screen, and the whole one, which has all of the first but for the advice on details.
screens() {
  first 15 "$@"
  "$gatewalk" "$@" --force --details >whole.txt 2>/dev/null || { fail "$* --details" && return; }
  [ -z "$(wide whole.txt)" ] || fail "with --details a line is too wide: $*: $(wide whole.txt)"
  [ "$(wc -l <whole.txt)" -gt "$(wc -l <screen.txt)" ] || fail "--details shows nothing more: $*"
  grep -q 'p = 0\.[1-9][0-9][0-9]' whole.txt && fail "p in two forms: $*: $(grep 'p = 0\.[1-9][0-9][0-9]' whole.txt)"
  grep -q -e '--details shows ' whole.txt && fail "--details advises --details: $*"
  grep -v -e '--details shows ' -e '^Next: ' -e '^      ' screen.txt | grep -v -x -F -f whole.txt >missing.txt
  # What was timed differs from run to run.
  grep -v ' [0-9.]* s\b' missing.txt && fail "--details leaves out what the first screen has: $*: $(head -n 1 missing.txt)"
}

: >next.txt
screens gate single_gate.toml --trials 50
screens lattice walker.toml --trials 50
screens lattice mixed.toml --trials 50
screens build small.toml --trials 5 -o bins.nc
screens build small.toml --accuracy 0.2 -o tree.nc
screens build tracks/runs.csv --cell tracks/cell.toml -o few.nc
screens show bins.nc
screens show tree.nc
first 200 show tree.nc --rows
first 200 show bins.nc --row 3
screens walk bins.nc --walks 50
screens predict bins.nc
screens predict tree.nc
screens predict walker.toml --accuracy 0.2
screens predict field.toml --accuracy 0.3
screens predict mixed.toml --accuracy 0.3
screens predict few.nc
screens rare small.toml --row 2 --accuracy 0.3
screens validate small.toml --matrix tree.nc --trials 40 --null-draws 99 --memory
screens validate small.toml --bins paper --matrix-trials 5 --trials 40 --null-draws 99
screens validate field.toml --observed observed.csv --trials 1200 --accuracy 0.3 --null-draws 99
# Studies: influences, how many trials, plans, fits, grids.
screens analyze small.toml --accuracy 0.3 --runs 100
screens analyze small.toml --accuracy 0.3 --runs 100 --trials 100 --lump 2,1,1
screens analyze tree.nc --runs 0 --first-passage crossed
screens analyze small.toml --accuracy 0.3 --runs 0 --over forces.propulsion_N=6:9 --over forces.random_N=40:60 --over-trials 4096
screens analyze bins.nc --runs 0
screens power small.toml --accuracy 0.3
screens power small.toml --accuracy 0.3 --trials 60
screens power small.toml --accuracy 0.3 --trials 60 --versus forces.random_N=60
screens plan small.toml --accuracy 0.2
actions=(--set actions.a.forces.propulsion_N=5 --set actions.b.forces.propulsion_N=11)
screens plan small.toml --accuracy 0.2 "${actions[@]}" --policy policy.json
screens plan small.toml --accuracy 0.2 "${actions[@]}" --least work_J
screens design mixed.toml --set field.rows=2 --accuracy 0.2
printf 'ending,count\ncrossed,20\ntrapped,30\nleft side,5\n' >ends.csv
screens fit small.toml ends.csv --free forces.propulsion_N=6:9 --free forces.random_N=40:60 --trials 24576 --set field.rows=2 --set field.columns=3
screens sweep fig8.toml --trials 3
first 15 sweep single_gate.toml --trials 10 --vary forces.propulsion_N=6:1:9
# One gate, single runs, tracks, scenes.
screens landscape single_gate.toml -o land --trials 20
screens trace soft_left.toml --trials 9
screens trace field.toml --field --trials 2 --replay runs.html
screens passages tracks/tracks.csv --cell tracks/cell.toml -o again.csv --fps 10 --metres-per-unit 0.001 --fastest 0.4 --lattice 9,9 \
  --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y
# Charts: 40 trials show the shape of the screen.
screens chart field small.toml -o fidelity --trials 20 --start 0,0,15
screens chart chain small.toml -o chain --truth-trials 200 --runs-limit 2000 --bins 0.5 --bins 1 --start 0,0,15
screens chart limits single_gate.toml -o limits --quick --trials 1 --set run.time_limit_s=1
screens chart methods single_gate.toml -o methods --trials 20 --repeats 1 --methods moreau,stable
# A scene's table is long, not wide, and its meaning comes first.
for scene in *.toml; do
  "$gatewalk" scene "$scene" >screen.txt 2>/dev/null || continue
  [ -z "$(wide screen.txt)" ] || fail "scene $scene: a line is too wide: $(wide screen.txt)"
  head -n 1 screen.txt | grep -q '^What these numbers mean' || fail "scene $scene: its meaning does not come first"
done
# Several starts: the answer of each, the rest once.
first 23 predict small.toml --accuracy 0.3 --start 0,0,15 --start 4.3,5.1,10.2
[ "$(grep -c '^crossed' screen.txt)" = 2 ] && [ "$(grep -c '^The 95 % intervals' screen.txt)" = 1 ] || fail "predict: several starts: $(cat screen.txt)"
screens validate field.toml --accuracy 0.3 --trials 40 --null-draws 99
head -n 1 screen.txt | grep -q '^The chain .* from .* starts' || fail "validate: no verdict of all starts"
# Recorded bodies, one half against the other.
"$gatewalk" passages tracks/tracks.csv --cell tracks/cell.toml -o passages.csv --fps 10 --metres-per-unit 0.001 --fastest 0.4 \
  --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y --quiet >/dev/null 2>err.txt || fail "passages: $(cat err.txt)"
screens build passages.csv --cell tracks/cell.toml -o bodies.nc
screens predict bodies.nc
screens validate bodies.nc --null-draws 99
head -n 1 screen.txt | grep -q '^One half of the bodies ' || fail "validate: no verdict of the halves"
# A chain that was made elsewhere.
printf 'from,to,count\n0,0,4\n0,1,3\n0,2,2\n1,0,2\n1,1,6\n1,2,1\n' >counts.csv
printf 'state,move_x,move_y\n0,0,1\n1,1,0\n' >states.csv
"$gatewalk" import counts.csv --states states.csv --start 0 --set field.rows=3 --set field.columns=3 -o own.nc --quiet >/dev/null
screens show own.nc
screens walk own.nc --walks 50
screens predict own.nc
# A chain of which no move goes left: the left side is impossible, and the screen says so.
grep -q '^left side *0.00 %  -$' screen.txt && grep -q '^-: impossible' screen.txt || fail "an impossible ending has an interval: $(cat screen.txt)"
# What to do next runs, a shell's own comment behind it; with less accuracy where that takes long.
sort -u -t$'\t' -k1,1 next.txt >all.txt
[ "$(wc -l <all.txt)" -ge 15 ] || fail "few lines of advice: $(cat all.txt)"
gatewalk() {
  local rough=()
  case " $* " in *' --accuracy '* | *.nc' '*) ;; *) rough=(--accuracy 0.3) ;; esac
  case $1 in
    analyze) set -- "$@" --runs 0 --json advised.json "${rough[@]}" ;;
    plan | power) set -- "$@" --accuracy 0.3 ;;
    sweep) set -- "$@" --trials 3 ;;
    validate) set -- "$@" --null-draws 99 --json advised.json ;;
    predict) set -- "$@" --json advised.json "${rough[@]}" ;;
    rare | lattice) set -- "$@" --json advised.json ;;
  esac
  command "$program" "$@" --force
}
program=$gatewalk
export program
export -f gatewalk
# claims EXPRESSION: it holds for the results of the command that was advised, b, and of the one that advised it, a.
claims() {
  eval "\"\$gatewalk\" $first --json first.json --quiet --force" >/dev/null 2>&1
  jq -e -n --slurpfile a first.json --slurpfile b advised.json "\$a[0] as \$a | \$b[0] as \$b | $1" >/dev/null ||
    fail "the comment is false ($1): $line (proposed by $first)"
  tried="$tried ${line##*  # }"
}
tried=
while IFS=$'\t' read -r line first; do
  file=$(printf '%s\n' "$line" | sed -n 's/.* --\(figure\|csv\|output\|replay\|policy\) \([^ ]*\)  # .*/\2/p')
  [ -z "$file" ] || rm -f "$file"
  bash -c "$line" >out.txt 2>err.txt </dev/null || { fail "advice does not run: $line: $(head -n 1 err.txt)" && continue; }
  [ -z "$file" ] || [ -s "$file" ] || fail "advice does not write $file: $line"
  case $line in
    *'# halves the error bar of the final gates') claims 'def worst: [.. | .error_95? | numbers] | max; ($b | worst) < 0.7 * ($a | worst)' ;;
    *'# halves the standard error') claims '$b.relative_standard_error < 0.7 * $a.relative_standard_error' ;;
    *'# reveals smaller differences')
      claims 'def chance: [.starts[].trials_and_matrix.total_variation_by_chance.mean] | add; $b.trials > $a.trials and ($b | chance) < ($a | chance)' ;;
    *'# with 1 % more of it') claims '([$b.made_by.command, $a.made_by.command] | map(tostring) | .[0] != .[1]) and $b.endings != null' ;;
    *'# says what 100 trials detect') grep -q '100 trials detect' out.txt || fail "the comment is false: $line" ;;
    *'# simulates one such experiment') [ "$(jq .trials advised.json)" = 60 ] || fail "the comment is false: $line" ;;
    *'# predicts all endings from there' | *'# which number of the scene matters most')
      jq -e '.. | .endings? | objects' advised.json >/dev/null || fail "no endings: $line" ;;
  esac
done <all.txt
for claim in 'halves the error bar of the final gates' 'with 1 % more of it' 'halves the standard error' 'reveals smaller differences'; do
  case $tried in *"$claim"*) ;; *) fail "no screen says: $claim" ;; esac
done
# What follows a prediction is of the same prediction.
first 15 predict small.toml --accuracy 0.3 --seed 7 --json first.json
line=$(advice screen.txt | grep '^gatewalk analyze ')
bash -c "$line" >/dev/null 2>&1
jq -e -n --slurpfile a first.json --slurpfile b advised.json '$a[0].endings == $b[0].endings' >/dev/null || fail "analyze has other endings than predict: $line"
# A long command goes on behind a backslash, as it is pasted.
first 15 predict small.toml --accuracy 0.3 --set forces.propulsion_N=8 --set forces.random_N=50 --set field.rows=3 --set field.columns=5
grep -q ' \\$' screen.txt || fail "no long command: $(cat screen.txt)"
sed -n 's/^Next: //; /^gatewalk\|^      /p' screen.txt >pasted.sh
bash -e pasted.sh >/dev/null 2>err.txt </dev/null || fail "what is pasted does not run: $(head -n 1 err.txt): $(cat pasted.sh)"
# Runs added by no command: no such advice. Rows of other gates: no analysis of the same gates.
first 15 predict tree.nc --start 4.3,5.1,10.2 --first-runs 0
advice screen.txt | grep -e '--accuracy' && fail "advice that is refused"
"$gatewalk" predict bins.nc --row 1=bins.nc 2>/dev/null | grep 'gatewalk analyze' && fail "an analysis of other gates"
# What the first screen must not hide: faults of the method, an accuracy that was not reached.
"$gatewalk" gate single_gate.toml --set run.method=paper --trials 50 2>/dev/null | grep -q '^Beware: the numerical method showed faults' || fail "gate hides faults"
"$gatewalk" predict small.toml --accuracy 0.01 --gate-runs 1500 2>/dev/null | grep -q '^Beware: the accuracy of 0.01 was not reached' || fail "predict hides its accuracy"
"$gatewalk" rare small.toml --row 2 --accuracy 0.01 --gate-runs 3000 2>/dev/null | grep -q '^Beware: the relative standard error of 0.01 needs more' || fail "rare hides its accuracy"
# From standard input nothing can be asked again.
"$gatewalk" gate - --trials 5 <small.toml >screen.txt 2>/dev/null
grep -q 'gatewalk .* -' screen.txt && fail "asks standard input again: $(cat screen.txt)"

# What is not what it is taken for.
for command in validate gate lattice rare trace scene; do expect 2 'tree.nc: is a matrix (HDF5), and .* scene' "$gatewalk" $command tree.nc; done
for command in show walk; do expect 2 'a matrix is not read from standard input' "$gatewalk" $command -; done
expect 2 'there is no option --trials (did you mean --walks?)' "$gatewalk" walk bins.nc --trials 5
expect 0 'm.toml: a matrix is written as NetCDF' "$gatewalk" build small.toml --trials 1 -o m.toml
finish
