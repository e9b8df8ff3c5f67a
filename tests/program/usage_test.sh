#!/usr/bin/env bash
# Help, wrong use, and the command that was meant.   usage_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# Help and wrong use.
expect 0 'usage: gatewalk' "$gatewalk" --help
expect 0 '^gatewalk [0-9]' "$gatewalk" --version
expect 2 'usage: gatewalk' "$gatewalk"
expect 2 "no command 'fly'" "$gatewalk" fly
for command in $("$gatewalk" --help | awk '/^usage/ { list = 1; next } list && /^  [a-z]/ { print $1 }'); do
  expect 0 'Example:' "$gatewalk" $command --help
  expect 2 'unrecognised option' "$gatewalk" $command --no-such-option
done
expect 2 'missing SCENE' "$gatewalk" gate
expect 2 'missing -o' "$gatewalk" build "$scenes/field.toml"
expect 2 'unrecognised option' "$gatewalk" gate "$scenes/field.toml" --tri 5       # nothing is guessed
expect 2 'at least 1' "$gatewalk" gate "$scenes/field.toml" --trials 0
expect 2 "'1.5' is not a whole number" "$gatewalk" gate "$scenes/field.toml" --trials 1.5
expect 2 "'-1' is not a seed" "$gatewalk" gate "$scenes/field.toml" --seed -1
expect 2 'json needs' "$gatewalk" gate "$scenes/field.toml" --json ''
expect 2 'must lie in' "$gatewalk" gate "$scenes/field.toml" --set forces.random_N=-1
expect 2 'nosuch.toml' "$gatewalk" gate nosuch.toml
expect 2 'three numbers' "$gatewalk" validate "$scenes/field.toml" --start 1,2

# Help of a command, and the command that was meant.
"$gatewalk" build --help >help.txt
"$gatewalk" help build | cmp -s - help.txt || fail "help build is not build --help"
expect 0 'usage: gatewalk' "$gatewalk" help
expect 0 'exit status: 0 fine, 1 failure (with --strict' "$gatewalk" --help
expect 2 'did you mean build?' "$gatewalk" biuld
expect 2 'did you mean predict?' "$gatewalk" help predictt
expect 2 'did you mean chart-field?' "$gatewalk" chart_field
"$gatewalk" fly 2>&1 | grep -q 'did you mean' && fail "fly is no misspelled command"

finish
