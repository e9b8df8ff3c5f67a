#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A reader that closes its pipe (| head -1) is no failure.   pipe_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# unread COMMAND...: runs the command with a pipe without a reader as standard output; SIGPIPE ends processes as usual,
# or is ignored, as in some services. The command must be quiet and have the status of a process that SIGPIPE ended.
unread() {
  local handler status
  for handler in - ''; do
    mkfifo unread
    sleep 60 <unread &
    local reader=$!
    exec 5>unread
    kill $reader
    wait $reader 2>/dev/null
    rm unread
    (trap "$handler" PIPE; exec "$@") >&5 2>err.txt
    status=$?
    exec 5>&-
    [ $status = 141 ] || fail "status $status instead of 141 without a reader: $*"
    [ -s err.txt ] && fail "a reader that went away is said: $* ($(head -n 3 err.txt))"
  done
}

paper_matrix m.nc
unread "$gatewalk" --help
unread "$gatewalk" help
unread "$gatewalk" --version --verbose
unread "$gatewalk" help gate
unread "$gatewalk" sample
unread "$gatewalk" sample field
unread "$gatewalk" scene "$scenes/field.toml"
unread "$gatewalk" gate "$scenes/field.toml" --trials 20
unread "$gatewalk" gate "$scenes/field.toml" --trials 20 --json -
unread "$gatewalk" gate "$scenes/field.toml" --trials 20 --csv -
unread "$gatewalk" gate "$scenes/field.toml" --trials 20 --json /dev/stdout
unread "$gatewalk" trace "$scenes/field.toml" --csv -
unread "$gatewalk" sweep "$scenes/field.toml" --vary forces.random_N=1,2 --trials 20
unread "$gatewalk" lattice "$scenes/field.toml" --trials 20
unread "$gatewalk" predict m.nc
unread "$gatewalk" show m.nc --rows
unread "$gatewalk" walk m.nc
unread "$gatewalk" build "$scenes/field.toml" --trials 2 --bins paper -o b.nc --force
[ -s b.nc ] || fail "no matrix without a reader of the table"

# Other outputs are written all the same.
unread "$gatewalk" gate "$scenes/field.toml" --trials 20 --json other.json --force
"$gatewalk" gate "$scenes/field.toml" --trials 20 --json read.json >/dev/null
cmp -s other.json read.json || fail "no other files without a reader"
# So is an output beside a named pipe that nobody reads to its end.
mkfifo named
head -c 1 named >/dev/null &
timeout 20 "$gatewalk" trace "$scenes/field.toml" --field --trials 20 --csv named --quiet 2>err.txt
[ $? = 141 ] || fail "a named pipe without a reader"
[ -s err.txt ] && fail "a named pipe: $(cat err.txt)"
# An endless standard input is not read for an argument that cannot mean it.
mkfifo open
sleep 60 >open &
waiting() { expect "$@" <open; }
waiting 2 '' timeout 20 "$gatewalk" predict "$scenes/field.toml" -
waiting 2 '' timeout 20 "$gatewalk" walk -
waiting 2 '' timeout 20 "$gatewalk" export - -o z.csv
waiting 2 '' timeout 20 "$gatewalk" power "$scenes/field.toml" --versus -
waiting 2 '' timeout 20 "$gatewalk" predict m.nc --row 0=-
kill %%
# A failure keeps its status.
(exec "$gatewalk" gate none.toml 2>/dev/null) | true
[ "${PIPESTATUS[0]}" = 2 ] || fail "a failure beside a reader that went away"
# A full device is still a failure.
expect 1 'No space left on device' bash -c '"$1" gate "$2" --trials 20 >/dev/full' _ "$gatewalk" "$scenes/field.toml"

finish
