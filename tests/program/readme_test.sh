#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# README and the help pages: the commands in README's table and the examples of all commands run as printed, and README
# is not too long.
#   readme_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# The files that the commands name.
ln -s "$scenes" scenes
"$gatewalk" sample observed -o counts.csv --quiet || fail "sample observed"
paper_matrix matrix.nc
for part in 1 2 3; do
  "$gatewalk" lattice scenes/field.toml --trials 8 --shard $part/3 --part part$part --quiet || fail "part $part"
done

# runs WORDS...: the command succeeds, or is still at work after a while; wrong use would fail at once. A while is 1 s of
# CPU time, however busy the machine is, or 3 s on the clock.
runs() {
  (
    ulimit -c 0 -S -t 1
    timeout --foreground 3 "$gatewalk" "$@" --quiet --force
    exit $?
  ) >out.txt 2>&1 </dev/null
  local status=$?
  [ $status = 0 ] || [ $status = 124 ] || [ $status = 130 ] || [ $status = 152 ] || fail "$page: status $status: gatewalk $* ($(head -n 3 out.txt))"
}

page=README.md seen=0
while read -r words; do
  seen=$((seen + 1))
  [[ $words == *" "* ]] || continue  # a name alone
  # shellcheck disable=SC2046
  runs $(sed -E 's|KEY=FROM:STEP:TO|forces.random_N=1:1:2|; s|\bSCENE\b|scenes/field.toml|' <<<"$words")
done < <(awk -F'|' '/^\| I want /{ on = 1 } on && !/^\|/ { exit } on { print $3 }' "$scenes/../$page" | grep -o '`[^`]*`' | tr -d '`' | sed -n 's|^gatewalk ||p')
[ $seen -ge 8 ] || fail "$page: the table has $seen commands"
[ "$(wc -w <"$scenes/../README.md")" -le 900 ] || fail "README.md has $(wc -w <"$scenes/../README.md") words"

seen=0
while read -r name; do
  seen=$((seen + 1))
  page="gatewalk help $name"
  # shellcheck disable=SC2086
  example=$("$gatewalk" help $name | awk '/^Example:/ { on = 1; next } on && !/^  / { exit } on { if (sub(/ \\$/, "")) printf "%s", $0; else print }')
  [ -n "$example" ] || fail "$page: no example"
  while read -r _ words; do eval "runs $words"; done <<<"$example"
done < <("$gatewalk" --help | sed -nE 's/^  ([a-z-]+( [a-z]+)?)  +[a-z].*/\1/p')
[ $seen -ge 28 ] || fail "gatewalk help lists $seen commands"

# The check finds a wrong row.
failures_before=$failures
page=none
runs passages tracks.csv --cell cell.toml -o runs.csv >/dev/null
[ $failures -gt "$failures_before" ] || fail "a row that is refused is taken for right"
failures=$failures_before

finish
