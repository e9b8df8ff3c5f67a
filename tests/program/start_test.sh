#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Bodies start in any cell of the field and by any face: all methods then tell the same law.
#   start_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

field=$scenes/field.toml
to_shares() { jq '(.trials // .walks // 1) as $n | (.starts[0] // .) | .endings as $e | .endings_95 as $i |
  [$e | keys[] | {key: ., value: [$e[.] / $n, (($i[.] // [0, 0]) | (.[1] - .[0]) / 2 / $n)]}] | from_entries' "$1"; }
# agree A B: every ending of two results agrees within one and a half times the half widths of both 95 % intervals.
agree() {
  to_shares "$1" >a.shares && to_shares "$2" >b.shares &&
    [ "$(jq -n --slurpfile a a.shares --slurpfile b b.shares '[$a[0] | to_entries[] | .value as [$x, $u] |
      ($b[0][.key] // [0, 0]) as [$y, $v] | ($x - $y | fabs) <= 1.5 * ($u + $v) + 1e-9] | all')" = true ] ||
    fail "$1 and $2 differ: $(jq -c . a.shares) $(jq -c . b.shares)"
}

# The middle of the near row by name is the start without these keys; the scene's text leaves both out.
by_name=(--set field.start_row=0 --set field.start_column=4)
"$gatewalk" lattice "$field" --trials 500 --quiet --json usual.json
"$gatewalk" lattice "$field" --trials 500 --quiet --json named.json "${by_name[@]}"
holds '.made_by.scene | contains("max_gates = 13\nfidelity")' usual.json
[ "$(jq -c 'del(.made_by, .seconds)' usual.json)" = "$(jq -c 'del(.made_by, .seconds)' named.json)" ] || fail "lattice: other results from the usual gate by name"

# Two rows behind the start that no disc enters change nothing: the same bits, two rows further.
few=(--set field.rows=3 --set field.columns=5 --set field.start_column=1)
more=(--set field.rows=5 --set field.columns=5 --set field.start_column=1 --set field.start_row=2)
ends='[.endings, .endings_95]'
for command in "lattice --trials 500" "predict --accuracy 0.1" "rare --split-trials 500"; do
  read -ra words <<<"$command"
  "$gatewalk" "${words[0]}" "$field" "${words[@]:1}" "${few[@]}" --quiet --json few.json
  "$gatewalk" "${words[0]}" "$field" "${words[@]:1}" "${more[@]}" --quiet --json more.json
  case $command in
    rare*) ends='[.probability, [.rows[].probability], [.rows[].chain]]' ;;
    predict*) ends='[.starts[0] // . | .endings, .endings_95]' ;;
  esac
  [ "$(jq -c "$ends" few.json)" = "$(jq -c "$ends" more.json)" ] || fail "$command: other results two rows further: $(jq -c "$ends" few.json more.json)"
done
[ "$(jq -c '[.row, [.rows[].row]]' more.json)" = '[5,[3,4,5]]' ] || fail "rare: other rows: $(jq -c '[.rows[].row]' more.json)"
[ "$(jq -c '(.starts[0] // .).final_gates | [.[0], .[1]] | add | add' <("$gatewalk" predict "$field" "${more[@]}" --accuracy 0.1 --quiet --json -))" = 0 ] ||
  fail "predict: bodies end behind the start"
expect 2 'the row to enter must be 3 or more: bodies start in field.start_row = 2' "$gatewalk" rare "$field" "${more[@]}" --row 2

# A disc that enters row 2 off the middle by the left side: trials, trees, bins and walks; --start names the same start.
side=(--set field.start_column=1 --set field.start_row=2 --set start.x_m=-25 --set start.y_m=12 --set start.vx_m_per_s=8
  --set start.vy_m_per_s=10 --set forces.propulsion_N=9)
"$gatewalk" lattice "$field" "${side[@]}" --trials 20000 --quiet --json trials.json
"$gatewalk" predict "$field" "${side[@]}" --accuracy 0.05 --quiet --json trees.json
"$gatewalk" predict "$field" "${side[@]:0:4}" --set forces.propulsion_N=9 --start LD:18,8,10 --accuracy 0.05 --quiet --json named.json
"$gatewalk" build "$field" "${side[@]}" --bins 3 --trials 300 -o bins.nc --quiet >/dev/null
expect 0 '  i_x      -1      0      1' "$gatewalk" predict bins.nc --details --json bins.json  # from the start's column
"$gatewalk" walk bins.nc --walks 20000 --quiet --json walks.json
agree trials.json trees.json
agree trials.json bins.json
agree bins.json walks.json
[ "$(jq -c '(.starts[0] // .).endings' named.json)" = "$(jq -c '(.starts[0] // .).endings' trees.json)" ] || fail "--start LD: another answer than by [start]"
# The mirrored start has the mirrored law: the field is symmetric, the start is not.
"$gatewalk" lattice "$field" --set field.start_column=7 --set field.start_row=2 --set start.x_m=25 --set start.y_m=12 \
  --set start.vx_m_per_s=-8 --set start.vy_m_per_s=10 --set forces.propulsion_N=9 --trials 20000 --quiet --json right.json
jq '(.endings, .endings_95) |= (.left_side as $l | .left_side = .right_side | .right_side = $l)' right.json >mirrored.json
agree trials.json mirrored.json
holds '.endings.left_side > 2 * .endings.right_side' trials.json

# A matrix keeps the start; --set gives another.
holds '.made_by.scene | contains("max_gates = 13\nstart_column = 1\nstart_row = 2\nfidelity")' bins.json
"$gatewalk" build "$field" "${side[@]}" --bins 2 --trials 20 -o few.nc --quiet >/dev/null
"$gatewalk" predict few.nc --quiet --json left.json
"$gatewalk" predict few.nc --set field.start_column=4 --quiet --json middle.json
jq -s '.[1].endings.left_side < 0.2 * .[0].endings.left_side' left.json middle.json | grep -q true || fail "predict: --set gives no other start"
expect 2 'bins.nc (its scene):.*: field.start_row = 2 is not permitted: must lie in \[0, 1\]' "$gatewalk" predict bins.nc --set field.rows=2

# A policy is for every start.
printf '[actions.slow]\n[actions.fast]\nforces.propulsion_N = 12\n' | cat "$field" - >actions.toml
"$gatewalk" plan actions.toml --set field.start_row=2 --accuracy 0.2 --policy policy.json --quiet >/dev/null 2>&1
expect 0 '^crossed' "$gatewalk" lattice actions.toml --set field.start_row=3 --set field.start_column=1 --policy policy.json --trials 100

# Kept work of another start is refused, as for other keys of the field.
expect 75 'with --resume goes on' "$gatewalk" lattice "$field" --trials 4000000 --max-time 0.3s --checkpoint kept
for key in start_row=1 start_column=3; do
  expect 2 'is of another run, the scene is another one' "$gatewalk" lattice "$field" --trials 4000000 --max-time 0.3s --checkpoint kept --resume --set field.$key
done

# Off the middle, left is no mirror image of right: from the left column bodies that go left leave there, and the mean
# over the starts that were told is the whole chance. A start by a side has its ranges too.
"$gatewalk" analyze "$field" --set field.start_column=0 --set field.start_row=2 --set field.columns=5 --set field.rows=4 \
  --set forces.propulsion_N=9 --accuracy 0.05 --runs 0 --target left_side --json ranges.json --quiet
holds '[.starts[] | {p: .probability, vx: (.vx_m_per_s | add / 2)}] | ([.[] | select(.vx < -20) | .p] | add / length) > 0.7
  and ([.[] | select(.vx > 20) | .p] | add / length) < 0.35' ranges.json
"$gatewalk" analyze "$field" --set field.columns=5 --set field.rows=4 --set forces.propulsion_N=9 --set start.x_m=-25 \
  --set start.y_m=12 --set start.vx_m_per_s=8 --set start.vy_m_per_s=10 --accuracy 0.05 --runs 0 --json ranges.json --force --quiet
holds '.starts_in_all > 0' ranges.json

# Refusals name the key and what is allowed.
for wrong in 9 -1; do
  expect 2 "field.start_column = $wrong is not permitted: must lie in \[0, 8\]" "$gatewalk" scene "$field" --set field.start_column=$wrong
  expect 2 "field.start_row = $wrong is not permitted: must lie in \[0, 8\]" "$gatewalk" scene "$field" --set field.start_row=$wrong
done
expect 2 'field.start_row = 1.5 is not permitted: must be a whole number in \[0, 8\]' "$gatewalk" scene "$field" --set field.start_row=1.5
expect 2 'field.start_row = "x" is not permitted: must be a whole number' "$gatewalk" scene "$field" --set 'field.start_row="x"'
expect 2 'start.vx_m_per_s = 0 is not permitted: start.x_m = 25 is a side of the gate, .* start.vx_m_per_s < 0' "$gatewalk" scene "$field" --set start.x_m=25
expect 2 'start.y_m = -1 is not permitted: start.x_m = 25 is a side' "$gatewalk" scene "$field" --set start.x_m=25 --set start.y_m=-1
expect 2 'the disc .* would overlap a beam' "$gatewalk" scene "$field" --set start.x_m=25 --set start.vx_m_per_s=-1 --set start.y_m=25
expect 2 'by face LD, d = 5.0 m must lie in \[10.0, 30.0\]' "$gatewalk" predict "$field" --start LD:5,8,6
expect 2 'by face RT, vx = 8.0 m/s must be < 0' "$gatewalk" predict "$field" --start RT:15,8,6
expect 2 'start.y_m must be 0, or start.x_m a side of the gate, -25.0 or 25.0' "$gatewalk" predict "$field" --set start.y_m=5
expect 2 'give ranges of start.vx_m_per_s and start.vy_m_per_s alone' "$gatewalk" plan "$field" --start LD:18,8,10
expect 2 'starts are entries from below' "$gatewalk" chart chain "$field" --start LD:18,8,10 -o chart

# A cell program and its recorded runs, from row 1 by a side: direct trials, trees, and the chain of the recorded runs.
program=(--cell-program "python3 $scenes/programs/pillars.py")
pillars=(--set field.start_column=1 --set field.start_row=1 --set start.face=W)
"$gatewalk" lattice "$scenes/programs/pillars.toml" "${program[@]}" "${pillars[@]}" --trials 4000 --passages runs.csv --cell-file cell.toml --quiet --json direct.json
"$gatewalk" predict "$scenes/programs/pillars.toml" "${program[@]}" "${pillars[@]}" --accuracy 0.05 --quiet --json chain.json
"$gatewalk" build runs.csv --cell cell.toml -o recorded.nc --quiet >/dev/null
"$gatewalk" predict recorded.nc --quiet --json recorded.json
agree direct.json chain.json
agree direct.json recorded.json
"$gatewalk" lattice "$scenes/programs/pillars.toml" "${program[@]}" "${pillars[@]:0:2}" --set start.face=W --trials 4000 --quiet --json other.json
[ "$(jq -c .endings other.json)" != "$(jq -c .endings direct.json)" ] || fail "lattice: field.start_row changes nothing"
grep -q '^start_row = 1$' cell.toml || fail "--cell-file: leaves out field.start_row"
expect 2 'cell.toml:.*: field.start_row = 3 is not permitted: must lie in \[0, 2\]' bash -c "sed -i 's/^start_row = 1/start_row = 3/' cell.toml; '$gatewalk' build runs.csv --cell cell.toml -o no.nc"

# By hand: each cell is left ahead 1 time of 2, to the right 1 of 4, and traps 1 of 4. From row 1 of 3 and column 3 of 5,
# R cells to its right: crossed = 3/8, right side = 1/8, trapped = 1/2.
printf 'from,to,count\n0,0,2\n0,1,1\n0,2,1\n1,0,2\n1,1,1\n1,2,1\n' >counts.csv
printf 'state,name,move_x,move_y\n0,ahead,0,1\n1,aside,1,0\n' >states.csv
"$gatewalk" import counts.csv --states states.csv --start 0 --set field.rows=3 --set field.columns=5 --set field.start_column=3 \
  --set field.start_row=1 --set field.max_gates=0 -o hand.nc --quiet >/dev/null || fail "import of counts.csv"
"$gatewalk" predict hand.nc --quiet --json hand.json
holds '.endings | (.crossed - 3 / 8 | fabs) < 1e-12 and (.right_side - 1 / 8 | fabs) < 1e-12 and (.trapped - 1 / 2 | fabs) < 1e-12' hand.json
finish
