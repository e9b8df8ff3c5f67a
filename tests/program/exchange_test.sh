#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Chains to and from other programs: export and import give the same chain, an imported matrix answers like ours, and
# errors name the place.
#   exchange_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
paper_matrix p.nc
"$gatewalk" build "$scenes/field.toml" --gate-runs 500 -o tree.nc --quiet >/dev/null 2>&1

# The field's chain has the same states and transitions in every format.
for form in umb drn tra mtx csv npz; do
  "$gatewalk" export p.nc --set field.max_gates=0 -o field.$form --json field.json --force --quiet >/dev/null || fail "export $form"
  [ -s field.$form ] || fail "field.$form is empty"
  jq -c '[.states, .transitions, .endings]' field.json >sizes.$form
  cmp -s sizes.umb sizes.$form || fail "$form: $(cat sizes.$form), .umb has $(cat sizes.umb)"
done
[ "$(wc -l <field.csv)" = "$(($(jq .transitions field.json) + 1))" ] || fail "lines of field.csv"
[ "$(grep -vc '^%' field.mtx)" = "$(($(jq .transitions field.json) + 1))" ] || fail "lines of field.mtx"
[ "$(wc -l <field.states.csv)" = "$(($(jq .states field.json) + 1))" ] || fail "lines of field.states.csv"
"$gatewalk" export p.nc --set field.max_gates=0 -o again.npz --quiet >/dev/null && cmp -s field.npz again.npz || fail "the same chain, other bytes"

# The counts of one gate come back bit for bit from every format, and the chain gives the same answer.
"$gatewalk" predict p.nc --json ours.json --quiet
start=$(jq .start_state.input ours.json)
for form in mtx csv npz; do
  "$gatewalk" export p.nc --gate --counts -o g.$form --force --quiet >/dev/null || fail "export --gate $form"
  expect 0 '87 rows, 88 columns' "$gatewalk" import g.$form --states g.states.csv --start "$start" -o $form.nc
  "$gatewalk" export $form.nc --gate --counts -o back.$form --force --quiet >/dev/null
  cmp -s <(grep -av '^%' g.$form) <(grep -av '^%' back.$form) || fail "$form comes back otherwise"
  "$gatewalk" predict $form.nc --json back.json --quiet
  [ "$(jq -cS '[.endings, .endings_95, .final_gates]' back.json)" = "$(jq -cS '[.endings, .endings_95, .final_gates]' ours.json)" ] ||
    fail "$form: the imported chain answers otherwise"
done
# Probabilities have no error bars, with a message.
"$gatewalk" export p.nc --gate -o q.csv --quiet >/dev/null
expect 0 'have no error bars' "$gatewalk" import q.csv --states g.states.csv --start "$start" -o q.nc
expect 0 'the matrix holds probabilities, not counts' "$gatewalk" predict q.nc --json q.json
jq -s '[.[0].endings[], .[1].endings[]] as $e | [range(5) | ($e[.] - $e[. + 5]) | fabs] | max < 1e-14' q.json ours.json | grep -q true ||
  fail "probabilities: another answer"
holds '.matrix_sampling.replicates == 0' q.json
expect 0 '^  probabilities  *given in the place of counts$' "$gatewalk" show q.nc

# A chain of the user's own: by names of states; and by trajectories, in which each step is a count.
cat >s.csv <<'END'
state,name,move_x,move_y
0,up,0,1
1,aside,1,0
2,up_again,0,1
END
printf 'from,to,count\nup,up,5\nup,aside,3\nup,trapped,2\naside,up_again,4\nup_again,1,1\n' >own.csv
expect 0 '15 counted steps' "$gatewalk" import own.csv --states s.csv --start 0 --set field.rows=2 --set field.columns=3 -o own.nc
printf '0 0 0 0 0 0 1 2 1\n0 1 2\n0 1 2\n1 2\n0 3\n0 3\n' >own.dtrajs
expect 0 '15 counted steps' "$gatewalk" import own.dtrajs --states s.csv --start 0 --set field.rows=2 --set field.columns=3 -o steps.nc
for command in predict analyze "walk --walks 1000" "show --rows"; do
  # shellcheck disable=SC2086
  for matrix in own steps; do "$gatewalk" ${command%% *} $matrix.nc $(printf '%s' "${command#"${command%% *}"}") --json $matrix.json --quiet 2>/dev/null || fail "$command $matrix.nc"; done
  [ "$(jq -cS 'del(.made_by, .text, .seconds, .file, .matrix)' own.json)" = "$(jq -cS 'del(.made_by, .text, .seconds, .file, .matrix)' steps.json)" ] || fail "$command: steps are not their counts"
done
# An imported chain has no trials, so it cannot be validated or planned.
expect 2 '^gatewalk: own.nc: holds an imported chain, without trials or bodies to test it with. Make .* gatewalk build runs.csv' "$gatewalk" validate own.nc
expect 2 '^gatewalk: own.nc: is a chain that was made elsewhere: its error bars are of its counts, not of trials' "$gatewalk" power own.nc
for command in walk predict; do ! "$gatewalk" $command own.nc 2>&1 | grep 'gatewalk validate' || fail "$command: sends to what refuses the chain"; done
# A start is a state, by its name or number, and gives the same answer as the start that import was given.
for start in 0 1 2; do
  "$gatewalk" import own.csv --states s.csv --start $start --set field.rows=2 --set field.columns=3 -o from.nc --force --quiet >/dev/null 2>&1
  "$gatewalk" predict from.nc --json from.json --quiet
  for text in $start "$(sed -n "s/^$start,\([a-z_]*\),.*/\1/p" s.csv)"; do
    "$gatewalk" predict own.nc --start "$text" --json start.json --quiet
    [ "$(jq -c .starts[0].endings start.json)" = "$(jq -c .endings from.json)" ] || fail "--start $text: another answer"
  done
done
expect 2 'has no state of that name or number' "$gatewalk" predict own.nc --start 3
"$gatewalk" export own.nc --gate --counts -o named.csv --quiet >/dev/null
[ "$(cat named.csv)" = "$(sed 's/^up_again,1,/up_again,aside,/' own.csv)" ] || fail "names or order of states are lost: $(cat named.csv)"
# States have the order of their table everywhere, although the file keeps states of one face together.
[ "$(cut -d, -f1-5 named.states.csv)" = "$(printf 'state,name,face,move_x,move_y\n0,up,ahead,0,1\n1,aside,right,1,0\n2,up_again,ahead,0,1')" ] || fail "order: $(cat named.states.csv)"
for form in mtx csv npz; do
  "$gatewalk" export own.nc --gate --counts -o once.$form --force --quiet >/dev/null
  "$gatewalk" import once.$form --states once.states.csv --start 0 --set field.rows=2 --set field.columns=3 -o once.nc --force --quiet >/dev/null
  "$gatewalk" export once.nc --gate --counts -o twice.$form --force --quiet >/dev/null
  cmp -s <(grep -av '^%' once.$form) <(grep -av '^%' twice.$form) && cmp -s once.states.csv twice.states.csv || fail "$form: another order when it comes back"
done
"$gatewalk" show own.nc --json show.json --quiet >/dev/null
holds '[.rows[] | [.input, .name]] == [[0, "up"], [1, "aside"], [2, "up_again"]] and .rows[1].outputs == [{"output": 2, "count": 4}]' show.json
expect 0 '^ *2 *4 *up_again$' "$gatewalk" show own.nc --row 1
expect 0 '^States: 3, of an imported chain. --start takes the name of a state, or its number from 0.$' "$gatewalk" show own.nc --details
grep -q '^  counted steps  *15$' out.txt || fail "show: the counts are not named"
"$gatewalk" predict own.nc --start aside --json start.json --quiet
holds '.starts[0].start_state | .input == 1 and .bin == "aside"' start.json
# Names with commas and quotes are quoted as in RFC 4180, in all CSV.
printf 'state,name,move_x,move_y\n0,"fast, ahead",0,1\n1,"the ""right""",1,0\n' >quoted.csv
printf '0 1 0 0 2\n' >quoted.dtrajs
"$gatewalk" import quoted.dtrajs --states quoted.csv --start 0 --set field.rows=1 --set field.columns=1 --set field.max_gates=0 -o quoted.nc --quiet >/dev/null
"$gatewalk" export quoted.nc -o whole.mtx --quiet >/dev/null
[ "$(sed -n 2p whole.states.csv)" = '0,"x0_y0_fast, ahead_n0",0,0,"fast, ahead",0,' ] || fail "quotes: $(cat whole.states.csv)"
"$gatewalk" export quoted.nc --gate --counts -o q.csv --force --quiet >/dev/null
[ "$(sed -n 5p q.csv)" = '"the ""right""","fast, ahead",1' ] || fail "quotes: $(cat q.csv)"
expect 0 '4 counted steps' "$gatewalk" import q.csv --states q.states.csv --start 'fast, ahead' -o requoted.nc

expect 2 'has no \[start\]' bash -c "'$gatewalk' import own.csv --states s.csv -o nowhere.nc && '$gatewalk' predict nowhere.nc"
# What show proposes gives this chain a start, and runs.
expect 0 '^      gatewalk predict nowhere.nc --start 0  # ' "$gatewalk" show nowhere.nc
expect 0 '^crossed ' "$gatewalk" predict nowhere.nc --start 0

# Trials as trajectories: each ends as its trial ended, and the counts are those of the runs.
"$gatewalk" export tree.nc -o t.dtrajs --json t.json --quiet
[ "$(wc -l <t.dtrajs)" = "$(jq .trajectories t.json)" ] || fail "trajectories"
[ "$(tr ' ' '\n' <t.dtrajs | grep -c .)" = "$(($(ncdump -h tree.nc | sed -n 's/^\trun = \([0-9]*\) ;/\1/p') + $(wc -l <t.dtrajs)))" ] || fail "steps of the trajectories"
# The trajectories come with the table of states that import needs; the counts of steps are those of the lines.
awk '{ for (k = 2; k <= NF; ++k) print $(k - 1) + 1, $k + 1 }' t.dtrajs | sort | uniq -c | awk '{ print $2, $3, $1 }' | sort -n -k1,1 -k2,2 >steps.txt
"$gatewalk" import t.dtrajs --states t.states.csv --start 0 -o t.nc --quiet >/dev/null || fail "import of t.dtrajs"
"$gatewalk" export t.nc --gate --counts -o steps.mtx --quiet >/dev/null
grep -v '^%' steps.mtx | sed 1d | cmp -s - steps.txt || fail "steps of t.dtrajs"
[ "$(cut -d, -f1-5 steps.states.csv)" = "$(cut -d, -f1-5 t.states.csv)" ] || fail "states of t.dtrajs"
"$gatewalk" export tree.nc -o u.dtrajs.npz --quiet >/dev/null && cmp -s t.states.csv u.states.csv || fail "export .dtrajs.npz"
"$gatewalk" import u.dtrajs.npz --states u.states.csv --start 0 -o u.nc --quiet >/dev/null
"$gatewalk" export u.nc --gate --counts -o u.mtx --force --quiet >/dev/null
cmp -s <(grep -v '^%' u.mtx) <(grep -v '^%' steps.mtx) || fail "steps of u.dtrajs.npz"
expect 2 'import keeps the counts of their steps' "$gatewalk" export t.nc -o no.dtrajs
expect 2 'is written beside -o' "$gatewalk" export tree.nc -o z.dtrajs --json z.states.csv
expect 2 'keeps no trials' "$gatewalk" export p.nc -o p.dtrajs

# Files as other programs write them. By hand: counts 5 2 1 1 / 3 0 0 1 / 3 0 0 1 of states up, aside, up_again,
# trapped.
taken() { # TEXT FILE CONTENT
  printf '%b' "$3" >"$2"
  expect 0 "$1" "$gatewalk" import "$2" --states s.csv --start 0 --set field.rows=2 --set field.columns=3 -o taken.nc --force --json taken.json
  # shellcheck disable=SC2046
  "$gatewalk" export taken.nc --gate $(jq -r 'if .state_space.probabilities then "" else "--counts" end' taken.json) -o taken.csv --force --quiet >/dev/null
}
is() { [ "$(sed 1d taken.csv | tr '\n' ' ')" = "$1 " ] || fail "$2: $(cat taken.csv)"; }
counts='up,up,5 up,aside,2 up,up_again,1 up,trapped,1 aside,up,3 aside,trapped,1 up_again,up,3 up_again,trapped,1'
head='%%MatrixMarket matrix coordinate'
rest='1 2 2\n1 3 1\n1 4 1\n2 1 3\n2 4 1\n3 1 3\n3 4 1\n'
taken '17 counted steps' a.mtx "$head unsigned-integer general\n%%\n3 4 8\n1 1 5\n$rest" && is "$counts" unsigned-integer
taken 'whole numbers, written as reals: counts' a.mtx "$head real general\n3 4 8\n1 1 5.000000000000000e+00\n$rest" && is "$counts" 'whole reals'
holds '.understood == ["whole numbers, written as reals: counts"] and .text.understood == .understood[0]' taken.json
taken 'are added to it, as scipy does: 1' a.mtx "$head integer general\n3 4 9\n1 1 2\n${rest}1 1 3\n" && is "$counts" duplicates
taken '17 counted steps' a.mtx '%%MatrixMarket matrix array integer general\n3 4\n5\n3\n3\n2\n0\n0\n1\n0\n0\n1\n1\n1\n' && is "$counts" array
taken 'the last state, which is never left, is trapped' a.mtx "$head integer general\n4 4 9\n1 1 5\n${rest}4 4 1\n" && is "$counts" 'with a row of trapped'
taken 'symmetric: ' a.mtx "$head integer symmetric\n3 3 3\n1 1 4\n2 1 2\n3 1 1\n" && is 'up,up,4 up,aside,2 up,up_again,1 aside,up,2 up_again,up,1' symmetric
taken 'symmetric: ' a.mtx '%%MatrixMarket matrix array integer symmetric\n3 3\n4\n2\n1\n0\n0\n0\n' && is 'up,up,4 up,aside,2 up,up_again,1 aside,up,2 up_again,up,1' 'symmetric array'
taken '17 counted steps' A.CSV 'from,to,count\nup,up,5.0\nup,aside,+2\nup,up_again,1e0\nup,trapped,1\naside,up,3\naside,trapped,1\nup_again,up,3\nup_again,trapped,1\n' && is "$counts" 'numbers of a spreadsheet'
taken 'probabilities' a.mtx "$head real general\n3 4 4\n1 1 +0.5\n1 4 +5.0E-01\n2 1 1\n3 1 1\n" && is 'up,up,0.5 up,trapped,0.5 aside,up,1 up_again,up,1' plus
# A third with six digits counts as a third, also with a float's digits. A number that is no rounding of it is refused
# (below).
thirds='up,up,0.3333333333333333 up,aside,0.3333333333333333 up,trapped,0.3333333333333333'
for third in 0.333333 3.33333e-01 0.333 0.33333334 0.3333333432674408; do
  taken 'rows sum to 1 but for the rounding of their numbers (row 0 (counted from 0) to ' a.csv "from,to,probability\nup,up,$third\nup,aside,$third\nup,trapped,$third\n"
  sed -E '1d; s/(0.333333333333333)[0-9]*/\13/' taken.csv | tr '\n' ' ' | grep -qx "$thirds " || fail "$third: $(cat taken.csv)"
done
# If each row is a single 1, the type of the numbers decides between counts and probabilities.
taken 'each row is a single 1, a real: probabilities' a.mtx "$head real general\n3 4 3\n1 2 1.0\n2 3 1\n3 1 1\n"
holds '.state_space.probabilities' taken.json
taken '3 counted steps' a.mtx "$head integer general\n3 4 3\n1 2 1\n2 3 1\n3 1 1\n"
holds '.understood == []' taken.json
# -1 is a gap: 0 0 1 | 1 0 | and 2 0 trapped.
taken '^-1 is a gap: 1 of 2 trajectories are cut there, into 3$' a.dtrajs '0,0,1,-1,1,0,-1,-1,0\n2 0 3\n' && is 'up,up,1 up,aside,1 up,trapped,1 aside,up,1 up_again,up,1' gaps
printf '3 3\n0 1 1\n1 0 0.25\n1 2 0.75\n' >one.tra
sed -e '1cfrom,to,probability' -e 's/ /,/g' one.tra >tra.csv
expect 0 probabilities "$gatewalk" import tra.csv --states s.csv -o tra.nc

# An error names what is wrong, and where.
wrong() { # TEXT FILE CONTENT
  printf '%b' "$3" >"$2"
  expect 2 "$1" "$gatewalk" import "$2" --states s.csv -o no.nc
  [ ! -e no.nc ] || fail "$2: something is written"
}
wrong 'w.csv: row 0 (counted from 0) sums to 0.9: probabilities' w.csv 'from,to,probability\n0,0,.5\n0,1,.4\n'
wrong 'w.csv:2: there is no state "sideways"' w.csv 'from,to,count\nsideways,up,1\n'
wrong 'w.csv:3: has the same row and column as line 2' w.csv 'from,to,count\n0,1,1\nup,aside,2\n'
wrong 'w.csv: row 0, column 1 (counted from 0): -1 is no count' w.csv 'from,to,count\n0,1,-1\n'
wrong 'w.csv:1: must name the columns from,to,count or from,to,probability; there are a, b, c' w.csv 'a,b,c\n'
wrong 'w.csv:1: must name the columns from,to,count or from,to,probability' w.csv 'from,to,count,probability\n0,1,10,1\n'
wrong 'w.csv:2: has 4 fields, the line of the columns (line 1) has 3' w.csv 'from,to,count\n0,1,1,500\n'
wrong 'w.mtx:1: must be "%%MatrixMarket' w.mtx '%%MatrixMarket vector coordinate real general\n'
wrong 'w.mtx:1: "pattern" are no counts or probabilities: the numbers are left out' w.mtx '%%MatrixMarket matrix coordinate pattern general\n3 3 1\n1 1\n'
wrong 'w.mtx:1: "complex" are no counts' w.mtx '%%MatrixMarket matrix array complex general\n1 1\n1 0\n'
wrong 'w.mtx:1: "skew-symmetric" are no counts or probabilities: write general or symmetric' w.mtx '%%MatrixMarket matrix coordinate integer skew-symmetric\n3 3 1\n2 1 4\n'
wrong 'w.mtx:3: lies above the diagonal' w.mtx '%%MatrixMarket matrix coordinate integer symmetric\n3 3 1\n1 2 4\n'
wrong 'w.mtx:2: a symmetric matrix has as many rows as columns' w.mtx '%%MatrixMarket matrix coordinate integer symmetric\n3 4 1\n1 1 4\n'
wrong 'has 11 entries, not 12 as it says' w.mtx '%%MatrixMarket matrix array integer general\n3 4\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n'
wrong 'w.mtx:3: row and column must lie in 1 to 3' w.mtx '%%MatrixMarket matrix coordinate integer general\n3 3 1\n4 1 2\n'
wrong 'has 1 entries, not 2 as it says' w.mtx '%%MatrixMarket matrix coordinate integer general\n3 3 2\n1 1 2\n'
wrong 'of 3 states it must be 3 x 4, the last column trapped, or 3 x 3' w.mtx '%%MatrixMarket matrix coordinate integer general\n2 3 1\n1 1 2\n'
wrong 'trajectory 1, step 0 (counted from 0): there is no state 3' w.dtrajs '0 1\n3 0\n'
wrong 'w.dtrajs:1: "x" is no whole number' w.dtrajs '0 x\n'
wrong 'trajectory 0, step 1 (counted from 0): there is no state -2' w.dtrajs '0 -2 1\n'
wrong 'no trajectory has a second state: one column?' w.dtrajs '0\n1\n0\n2\n'
wrong 'no trajectory has a second state: one column?' w.dtrajs '0 -1 1\n'
wrong 'row 0, column 0 (counted from 0): 4.5 is no count: counts are whole numbers of runs; round effective counts' w.csv 'from,to,count\n0,0,4.5\n0,trapped,2.5\n'
wrong 'row 0 (counted from 0) sums to 7: probabilities of a row sum to 1, counts are whole numbers (integer, count); round effective counts' w.mtx '%%MatrixMarket matrix coordinate real general\n3 4 2\n1 1 4.5\n1 4 2.5\n'
wrong 'row 0 (counted from 0) sums to 0.996' w.csv 'from,to,probability\n0,0,.333\n0,1,.333\n0,2,.33\n'
wrong 'row 0 (counted from 0) sums to 0.999997' w.csv 'from,to,probability\n0,0,0.333333\n0,1,0.333333\n0,2,0.333331\n'
wrong 'row 0 (counted from 0) sums to 10' w.csv 'from,to,probability\n0,0,5\n0,1,5\n'
wrong 'chain is one of a whole field, import takes that of one cell' w.tra '3 3\n0 1 1\n1 2 1\n2 0 1\n'
wrong 'w.npz' w.npz 'no archive\n'
wrong 'must end in .mtx, .csv, .npz or .dtrajs' w.txt '0 1\n'
head -c 3000 g.npz >cut.npz
expect 2 'cut.npz' "$gatewalk" import cut.npz --states g.states.csv -o no.nc
printf 'state,move_x,move_y\n0,0,1\n2,0,1\n' >s2.csv
expect 2 's2.csv:3: state must be 1' "$gatewalk" import own.csv --states s2.csv -o no.nc
printf 'state,move_x,move_y\n0,0,0\n' >s2.csv
expect 2 's2.csv:2: the move must lead to another cell' "$gatewalk" import own.csv --states s2.csv -o no.nc
printf 'state,move_x,move_y,name\n0,0,1,1\n1,0,1,0\n' >s2.csv
printf 'from,to,count\n0,1,3\n' >n.csv
expect 2 'is the name of state 0 and the number of another' "$gatewalk" import n.csv --states s2.csv -o no.nc
printf 'state,move_x,move_y,face\n0,0,1,a b\n' >s2.csv
expect 2 's2.csv:2: face "a b" must be a name' "$gatewalk" import own.csv --states s2.csv -o no.nc
{ echo state,move_x,move_y; for k in $(seq 0 64); do echo "$k,$((k + 1)),1"; done; } >s2.csv
expect 2 's2.csv:66: there are more than 64 faces' "$gatewalk" import own.csv --states s2.csv -o no.nc
expect 2 'was made of probabilities, and has no counts' "$gatewalk" export q.nc --gate --counts -o no.csv
expect 2 'for trajectories' "$gatewalk" export tree.nc -o no.dtrajs --set field.rows=2
expect 2 'is written beside -o' "$gatewalk" export p.nc --gate -o z.mtx --csv z.states.csv
expect 2 'missing --states' "$gatewalk" import own.csv -o no.nc
expect 2 'are the same file' "$gatewalk" import own.csv --states s.csv -o s.csv
expect 2 'cannot be written' "$gatewalk" export p.nc -o /nowhere/at/all.mtx
expect 2 'is for .mtx, .csv and .npz' "$gatewalk" export p.nc --gate -o g.umb
finish
