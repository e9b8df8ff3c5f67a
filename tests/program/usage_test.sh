#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests help, wrong use, and suggestions of the command that was meant.   usage_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

expect 0 'usage: gatewalk' "$gatewalk" --help
expect 0 '^gatewalk [0-9]' "$gatewalk" --version
expect 0 '^gatewalk [0-9]' "$gatewalk" -V
expect 2 'usage: gatewalk' "$gatewalk"
expect 2 "no command 'fly'" "$gatewalk" fly
expect 2 'cli/site/glossary.md explains words' "$gatewalk" help lost
expect 2 "^gatewalk: no command '$scenes/field.toml', but a file: the command comes first, gatewalk COMMAND $scenes/field.toml\$" "$gatewalk" "$scenes/field.toml" predict
"$gatewalk" --help | sed -n '/^usage/,$ s/^  \([a-z]*\( [a-z][a-z]*\)\{0,1\}\)  .*/\1/p' >commands.txt
[ "$(grep -c -x -e 'chart [a-z]*' -e gate -e merge commands.txt)" -ge 5 ] || fail "commands: $(cat commands.txt)"
while read -r command; do
  # shellcheck disable=SC2086
  expect 0 'Example:' "$gatewalk" $command --help
  # Its page begins with at most five options, and no line but the example is wider than a screen.
  first=$(awk '/^Options that most people need/ { on = 1; next } on && /^$/ { exit } on && /^  -/ { n++ } END { print n + 0 }' out.txt)
  [ "$first" -le 5 ] && { [ "$first" -ge 1 ] || [ "$command" = sample ]; } || fail "$command --help: $first options come first"
  grep -v '^  gatewalk ' out.txt | grep -q '.\{101\}' && fail "$command --help: a line is too wide"
  # shellcheck disable=SC2086
  expect 2 'there is no option' "$gatewalk" $command --no-such-option
done <commands.txt
expect 2 'missing SCENE' "$gatewalk" gate
expect 2 'missing -o' "$gatewalk" build "$scenes/field.toml"
expect 2 'there is no option' "$gatewalk" gate "$scenes/field.toml" --tri 5       # abbreviations are refused
expect 2 '^gatewalk: there is no option --trails (did you mean --trials?); see gatewalk gate --help$' "$gatewalk" gate "$scenes/field.toml" --trails 5
expect 2 '^gatewalk: --trials needs a value; see' "$gatewalk" gate "$scenes/field.toml" --trials
expect 2 '^gatewalk: --quiet takes no value; see' "$gatewalk" gate "$scenes/field.toml" --quiet=3
expect 2 '^gatewalk: there are more arguments than the command takes; see' "$gatewalk" gate "$scenes/field.toml" a b
expect 2 "^gatewalk: --threads: 'x' is not a whole number" "$gatewalk" gate "$scenes/field.toml" --threads x
expect 2 '^gatewalk: --threads 1025: must be at least 0 and at most 1024' "$gatewalk" gate "$scenes/field.toml" --threads 1025
for number in abc nan inf 0,1; do
  expect 2 "^gatewalk: --accuracy: '$number' is not a number" "$gatewalk" predict "$scenes/field.toml" --accuracy $number
done
# With a blank in place of =, the value becomes an argument.
for command in gate predict; do
  expect 2 '^gatewalk: --set body.mass_g: must be KEY=VALUE, for example' "$gatewalk" $command "$scenes/field.toml" --set body.mass_g 5
done
expect 2 '^gatewalk: --set --quiet: looks like an option' "$gatewalk" gate "$scenes/field.toml" --set --quiet
expect 2 'at least 1' "$gatewalk" gate "$scenes/field.toml" --trials 0
expect 2 "'1.5' is not a whole number" "$gatewalk" gate "$scenes/field.toml" --trials 1.5
expect 2 "'-1' is not a seed" "$gatewalk" gate "$scenes/field.toml" --seed -1
expect 2 'json needs' "$gatewalk" gate "$scenes/field.toml" --json ''
expect 2 'must lie in' "$gatewalk" gate "$scenes/field.toml" --set forces.random_N=-1
expect 2 'nosuch.toml' "$gatewalk" gate nosuch.toml
expect 2 '3 numbers d,vx,vy (m, m/s, m/s)' "$gatewalk" validate "$scenes/field.toml" --start 1,2

# Help of a command, and the command that was meant.
"$gatewalk" build --help >help.txt
"$gatewalk" help build | cmp -s - help.txt || fail "help build is not build --help"
expect 0 'usage: gatewalk' "$gatewalk" help
expect 0 'exit status: 0 fine, 1 failure (with --strict' "$gatewalk" --help
expect 2 'did you mean build?' "$gatewalk" biuld
expect 2 'did you mean predict?' "$gatewalk" help predictt
expect 2 'did you mean chart field?' "$gatewalk" chart_field
# Names from before 2.0 are answered with the new command.
for old in 'chart-chain=chart chain' 'chart-field=chart field' 'stability=chart limits SCENE' 'chart=chart methods'; do
  expect 2 "^gatewalk: ${old%=*} is now: gatewalk ${old#*=} a.toml 'b c.toml' -o DIR --seed=2\$" "$gatewalk" ${old%=*} a.toml 'b c.toml' -o DIR --seed=2
  [ "$(wc -l <out.txt)" = 1 ] || fail "${old%=*}: $(cat out.txt)"
done
expect 2 '^gatewalk: chart needs to know what:$' "$gatewalk" chart
expect 2 "^gatewalk: no chart 'feild'; did you mean chart field?\$" "$gatewalk" chart feild a.toml
for words in 'chart --help' 'help chart' 'chart -h'; do
  # shellcheck disable=SC2086
  expect 0 '^  gatewalk chart field ' "$gatewalk" $words
done
"$gatewalk" help chart field | cmp -s - <("$gatewalk" chart field --help) || fail "help chart field is not chart field --help"
expect 0 '^The result of gatewalk chart field, as --json writes it' "$gatewalk" help chart field --result
expect 2 "^gatewalk: help chart field takes --result, and nothing else: not 'extra'$" "$gatewalk" help chart field extra
"$gatewalk" fly 2>&1 | grep -q 'did you mean' && fail "fly is no misspelled command"

# simulate is another name of lattice; the result records one name.
for name in lattice simulate; do "$gatewalk" $name "$scenes/field.toml" --trials 20 --json $name.json --quiet || fail "$name"; done
cmp lattice.json simulate.json || fail "simulate is not lattice"
holds '.made_by.command | startswith("gatewalk lattice ")' simulate.json
"$gatewalk" help simulate | cmp -s - <("$gatewalk" help lattice) || fail "help simulate is not help lattice"
"$gatewalk" help --write share
jq -e '.properties.chain.unit == "1" and (.properties.chain.description | length > 0)' share/gatewalk/schemas/rare.schema.json >/dev/null || fail "the schema of rare is not written"
grep -q '^| `rows\[\].direct_entered` \* | count | 1 |' share/doc/gatewalk/results.md || fail "the keys of rare are not written"
"$gatewalk" help rare --result | grep -q '^  chain_seconds (number, s): ' || fail "help rare --result does not say what its keys mean"
"$gatewalk" help merge --result 2>err.txt && fail "merge has a result of its own"
grep -q '^gatewalk: merge has no result of its own' err.txt || fail "help merge --result: $(cat err.txt)"
grep -q "'simulate:another name of lattice'" share/zsh/vendor-completions/_gatewalk || fail "zsh does not complete simulate"
grep -q "^    simulate) options='.*--passages" share/bash-completion/completions/gatewalk || fail "bash does not complete simulate"

# If an option is given twice, the last one counts, with a remark; options that may be repeated are lists.
"$gatewalk" gate "$scenes/field.toml" --trials 1 --seed 3 --trials 20 --seed 4 --set forces.random_N=3 --set forces.propulsion_N=4 --json twice.json >table.txt 2>err.txt
"$gatewalk" gate "$scenes/field.toml" --trials 20 --seed 4 --set forces.random_N=3 --set forces.propulsion_N=4 --json once.json >/dev/null 2>&1
jq -s '(.[0] | del(.made_by.command)) == (.[1] | del(.made_by.command))' twice.json once.json | grep -q true || fail "an option given twice: not the last one"
holds '.made_by.command | test("--seed 4") and (test("--seed 3") | not) and test("random_N=3") and test("propulsion_N=4")' twice.json
grep -q '^gatewalk: --trials is given 2 times: the last one counts, 20$' err.txt || fail "an option given twice is not said: $(cat err.txt)"
"$gatewalk" gate "$scenes/field.toml" --trials 1 --trials 20 --quiet >/dev/null 2>err.txt
[ -s err.txt ] && fail "--quiet: $(cat err.txt)"
# The same holds for the keys of --set, in any unit; different keys cause no remark.
sets=(--set forces.propulsion_N=8 --set forces.random_N=3)
expect 0 '^gatewalk: --set gives forces.propulsion_N 2 times: the last one counts, forces.propulsion_mN=9000$' \
  "$gatewalk" gate "$scenes/field.toml" --trials 20 "${sets[@]}" --set forces.propulsion_mN=9000 --json twice.json
holds '.made_by.scene | test("propulsion_N = 9.0\n")' twice.json
"$gatewalk" gate "$scenes/field.toml" --trials 20 "${sets[@]}" >/dev/null 2>err.txt
[ -s err.txt ] && fail "two keys of --set: $(cat err.txt)"
expect 2 'unknown key beams.stiffness_mNm_per_rad; the closest known keys are beams.stiffness_left_Nm_per_rad and beams.stiffness_right_Nm_per_rad$' \
  "$gatewalk" gate "$scenes/field.toml" --set beams.stiffness_mNm_per_rad=9

# A scene from standard input equals that of a file, for every command that reads one.
"$gatewalk" gate - --trials 20 --seed 4 --json dash.json --quiet <"$scenes/field.toml"
"$gatewalk" gate "$scenes/field.toml" --trials 20 --seed 4 --json file.json --quiet
jq -s '(.[0] | del(.made_by)) == (.[1] | del(.made_by)) and .[0].made_by.scene == .[1].made_by.scene' dash.json file.json | grep -q true || fail "a scene from standard input is another one"
for command in scene sweep landscape trace build predict analyze lattice rare plan design fit validate power 'chart methods' 'chart limits' 'chart field' 'chart chain'; do
  more=
  case $command in landscape | chart*) more='-o folder' ;; build) more='-o m.nc' ;; fit) more='/dev/null --free forces.random_N=1:2' ;; sweep) more='--vary forces.random_N=1,2' ;; esac
  # shellcheck disable=SC2086
  expect 2 '^gatewalk: .*standard input:2: body.mass_kg = -1.* is not permitted' "$gatewalk" $command - $more < <(printf '\nbody.mass_kg = -1\n')
done
# power reads its scene twice.
expect 2 'versus: field.columns and field.rows must stay' "$gatewalk" power - --versus field.rows=5 <"$scenes/field.toml"

# Out of memory: the message says which option would help; status 1.
[ -n "${SANITIZED-}" ] || expect 1 '^gatewalk: out of memory; .*larger --accuracy.*fewer --threads.*--set field.rows' \
  bash -c 'ulimit -v 170000; exec "$@"' _ "$gatewalk" predict "$scenes/field.toml" --threads 1 --accuracy 0.3 --set field.columns=2001 --set field.rows=2001 --set field.max_gates=0

finish
