#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# README and the guides' index: the commands in their tables run as printed, and README is not too long.
#   readme_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# Values for the words in capitals.
for sample in field mixed cell tracks observed; do
  "$gatewalk" sample $sample -o $sample.toml --quiet || fail "sample $sample"
done
mv tracks.toml tracks.csv
mv observed.toml observed.csv
cp "$scenes/programs/pillars.toml" .
cp "$scenes/programs/pillars.py" program && chmod +x program
paper_matrix M.nc
named() {
  sed -E 's|CELL.toml|pillars.toml|; s|COMMAND|./program|; s|KEY=FROM:STEP:TO|forces.random_N=1:1:2|; s|KEY=A:B|forces.random_N=1:20|
    s|D,VX,VY|0,0,15|; s|FILE\.csv|observed.csv|; s|counts\.csv|observed.csv|; s|FILE\.html|page.html|; s|\bDIR\b|folder|; s|\bNAME\b|field|; s|\bTARGET\b|crossed|; s|--row I\b|--row 1|
    s|^design SCENE|design mixed.toml|; s|\bSCENE\b|field.toml|g'
}
commands=$("$gatewalk" --help | awk '/^usage/ { list = 1; next } list && /^  [a-z]/ { print $1 }')

# runs WORDS...: the command succeeds, or is still at work after a while; wrong use would fail at once. A while is 1 s of
# CPU time, however busy the machine is, or 3 s on the clock, which also end a cell program.
runs() {
  local limit=1
  [[ " $* " != *" --cell-program "* ]] || limit=unlimited
  (
    ulimit -c 0 -S -t $limit
    timeout --foreground 3 "$gatewalk" "$@" --quiet --force
    exit $?
  ) >out.txt 2>&1 </dev/null
  local status=$?
  [ $status = 0 ] || [ $status = 124 ] || [ $status = 130 ] || [ $status = 152 ] || fail "$page: status $status: gatewalk $* ($(head -n 3 out.txt))"
}
# rows PAGE AT_LEAST: its table "I want" names at least so many commands, and each works.
rows() {
  local page=$1 seen=0 words name with without
  while read -r words; do
    words=${words#gatewalk }
    name=${words%% *}
    grep -qx -e "$name" <<<"$commands" || continue  # an option
    seen=$((seen + 1))
    # shellcheck disable=SC2046
    expect 0 Example: "$gatewalk" help $(sed -E 's/^(chart [a-z]+|[a-z-]+).*/\1/' <<<"$words")
    [ "$words" != "$name" ] || continue  # a name alone
    with=$(sed -E 's/\[[^],]*, [^]]*\]//g; s/[][]//g' <<<"$words" | named)
    without=$(sed -E 's/ *\[[^]]*\]//g' <<<"$words" | named)
    # shellcheck disable=SC2086
    runs $without
    # shellcheck disable=SC2086
    [ "$with" = "$without" ] || runs $with
  done < <(awk -F'|' '/^\| I want /{ on = 1 } on && !/^\|/ { exit } on { print $3 }' "$scenes/../$page" | grep -o '`[^`]*`' | tr -d '`')
  [ $seen -ge "$2" ] || fail "$page: the table has $seen commands"
}
rows README.md 8
rows cli/site/guides/index.md 30
[ "$(wc -w <"$scenes/../README.md")" -le 900 ] || fail "README.md has $(wc -w <"$scenes/../README.md") words"

# The check finds a wrong row.
failures_before=$failures
page=none
runs passages tracks.csv --cell cell.toml -o runs.csv >/dev/null
[ $failures -gt "$failures_before" ] || fail "a row that is refused is taken for right"
failures=$failures_before

finish
