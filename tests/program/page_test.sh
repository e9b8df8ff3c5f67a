#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests --page, the interactive page of an answer: what is refused, and what is written.   page_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
small=(--set run.method=moreau --set field.columns=3 --set field.rows=3)

# Refused before any work, without leaving a file.
expect 2 'fields of up to 441 gates, this one has 101 x 9' "$gatewalk" predict "$scenes/field.toml" --page p.html --set field.columns=101
expect 2 'cannot go to standard output' "$gatewalk" predict "$scenes/field.toml" --page -
expect 2 'are the same file' "$gatewalk" predict "$scenes/field.toml" --page p.html --json p.html
expect 2 'are the same file' "$gatewalk" predict "$scenes/field.toml" --page "$scenes/field.toml"
expect 2 'there is no option --shard' "$gatewalk" predict "$scenes/field.toml" --page p.html --shard 1/2
paper_matrix m.nc
expect 2 'row has no meaning beside --page' "$gatewalk" predict m.nc --row 1=m.nc --page p.html
[ ! -e p.html ] || fail "a page is left by a command that was refused"

# Beside JSON; the recorded command is the same with and without a page; an old page is kept.
run() { "$gatewalk" "$1" "$scenes/field.toml" "${small[@]}" --accuracy 0.2 "${@:2}" --json "$1.json" --quiet; }
run predict --page p.html || fail "predict --page"
grep -q '<script type="application/json" id="data">{' p.html || fail "no data in the page"
grep -qE '(src|href)="?(https?:)?//' p.html && fail "the page asks for something"
holds '.made_by.command | contains("--page") | not' predict.json
cp p.html first.html
run predict --page p.html --force || fail "predict --page again"
cmp -s p.html first.html || fail "the same command, another page"
run predict --page p.html --threads 1 --force || fail "predict --page, one thread"
cmp -s p.html first.html || fail "another number of threads, another page"
echo old >p.html
expect 0 'kept as p.html.~1~' "$gatewalk" analyze "$scenes/field.toml" "${small[@]}" --accuracy 0.2 --runs 0 --page p.html
grep -q 'id="data"' p.html || fail "analyze --page"

# Cells of another program; without a limit of cells; too few bodies for error bars.
expect 0 'bodies' "$gatewalk" build "$scenes/tracks/runs.csv" --cell "$scenes/tracks/cell.toml" -o few.nc
expect 0 'no error bars' "$gatewalk" predict few.nc --page few.html
grep -q '"can_run":false' few.html || fail "recorded runs: the page promises others"
expect 0 '' "$gatewalk" predict "$scenes/field.toml" "${small[@]}" --set field.max_gates=0 --accuracy 0.2 --page endless.html
finish
