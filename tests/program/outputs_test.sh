#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# An output that cannot be written is refused before the work; files keep their modes; pipes work.
#   outputs_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json gate.json --quiet
# An output that cannot be written, or a value out of range, is refused before the work, naming the option.
long=$(printf 'n%.0s' $(seq 256))
quick() { expect 2 "$1" timeout 20 "$gatewalk" "${@:2}"; }
quick 'json: .*File name too long' gate "$scenes/field.toml" --trials 1e9 --json "$long"
quick 'csv: .*No such file or directory' trace "$scenes/field.toml" --field --trials 1000 --csv none/x.csv
quick 'o: .*cannot be made' landscape "$scenes/field.toml" --trials 1e9 -o "new/$long"
quick 'o: .*is no folder' chart methods "$scenes/field.toml" -o m.nc/charts
quick 'csv needs a file name' sweep "$scenes/fig8.toml" --trials 1e9 --csv ''
quick 'matrix needs a file name' validate "$scenes/field.toml" --trials 1e9 --matrix ''
quick 'o needs a file name' build "$scenes/field.toml" --trials 1e9 -o ''
quick 'o needs the name of a folder' chart limits "$scenes/field.toml" -o ''
quick 'o --: looks like an option, so the value of -o is missing' build "$scenes/field.toml" --trials 1e9 -o --
quick 'json --output: looks like an option' gate "$scenes/field.toml" --trials 1e9 --json --output
quick 'json -x: looks like an option' gate "$scenes/field.toml" --trials 1e9 --json -x
quick "trials: '1e18' is out of range: at most 1e15" gate "$scenes/field.toml" --trials 1e18
quick "trials: '1000000000000000001' is out of range: at most 1e15" gate "$scenes/field.toml" --trials 1000000000000000001
quick "walks: '1e999' is out of range" walk m.nc --walks 1e999
quick "trials: 'nan' is not a whole number" gate "$scenes/field.toml" --trials nan
quick "seed: '1e3' is not a seed" gate "$scenes/field.toml" --seed 1e3
quick 'at most 10000000' chart methods "$scenes/field.toml" -o charts --trials 1e9
quick 'visited 1000000000: .* at most 1000000' chart chain "$scenes/field.toml" -o charts --visited 1e9
quick 'trial 0 alone has more than .* a longer run.step_s or a shorter run.time_limit_s' trace "$scenes/field.toml" --set run.step_s=1e-7 --csv x.csv
quick 'more than 100000 values' sweep "$scenes/field.toml" --vary forces.random_N=0:1e-6:10
quick 'must lie in' landscape "$scenes/field.toml" -o land --set beams.joint_x_m=900 --spacing 0.1
for set in 'forces.random_N=1' ' forces.random_N = 1' 'forces . random_N=1' 'forces."random_N"=1' '"forces".random_N=1'; do
  quick 'has no effect: forces.random_N is varied' sweep "$scenes/field.toml" --vary forces.random_N=1,2 --set "$set"
done

# Files keep their modes; a new file follows the umask. Pipes and devices are written into.
(umask 027; "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json mode.json --quiet; "$gatewalk" build "$scenes/single_gate.toml" --trials 1 -o mode.nc --quiet >/dev/null)
[ "$(stat -c %a mode.json mode.nc | xargs)" = '640 640' ] || fail "modes of new files: $(stat -c %a mode.json mode.nc | xargs)"
chmod 600 mode.json mode.nc
"$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json mode.json --quiet
"$gatewalk" build "$scenes/single_gate.toml" --trials 1 -o mode.nc --quiet >/dev/null
[ "$(stat -c %a mode.json mode.nc | xargs)" = '600 600' ] || fail "modes of replaced files: $(stat -c %a mode.json mode.nc | xargs)"
mkfifo pipe
timeout 20 cat pipe >piped.json &
reader=$!
timeout 20 "$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json pipe --quiet || fail "a named pipe"
wait $reader
cmp -s piped.json gate.json || fail "another result through a named pipe"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --quiet --json >(cat >substituted.json) || fail "a process substitution"
for _ in 1 2 3 4 5 6 7 8 9 10; do cmp -s substituted.json gate.json && break; sleep 0.1; done
cmp -s substituted.json gate.json || fail "another result through a process substitution"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json /dev/stdout | cmp -s - gate.json || fail "/dev/stdout is not standard output"
expect 0 'trapped' "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json /dev/null
expect 2 'cannot go to standard output' "$gatewalk" build "$scenes/single_gate.toml" -o /dev/stdout
expect 1 'No space left on device' "$gatewalk" gate "$scenes/single_gate.toml" --trials 5 --json /dev/full

expect 2 'nosuch.nc' "$gatewalk" walk nosuch.nc
expect 2 'json: no/such/dir/x.json: cannot be written' "$gatewalk" gate "$scenes/single_gate.toml" --trials 10 --json no/such/dir/x.json
expect 2 'no-dir/m.nc: cannot be written' "$gatewalk" build "$scenes/field.toml" --trials 1 -o no-dir/m.nc
ls | grep -q tmp && fail "temporary files stayed behind: $(ls)"
expect 2 'are the same file' "$gatewalk" build "$scenes/field.toml" -o x.nc --json ./x.nc
expect 2 'are the same file' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --json m.nc
expect 2 'a file of its own' "$gatewalk" build "$scenes/field.toml" -o -
expect 2 'field.toml.*run.step_s' "$gatewalk" gate "$scenes/field.toml" --set beams.damping_Nms_per_rad=1e12

# A large file of another kind is refused at once and in little memory.
truncate -s 3G zeros.nc
(printf '\211HDF\r\n\032\n'; head -c 100 /dev/zero) >large.nc && truncate -s 3G large.nc
expect 2 'field.toml: not a NetCDF-4 file, but a scene .* gatewalk build' "$gatewalk" walk "$scenes/field.toml"
most=${SANITIZED:+unlimited}
expect 2 'zeros.nc: not a NetCDF-4 file' bash -c "ulimit -v ${most:=2000000}; $gatewalk show zeros.nc"
expect 2 'large.nc: has 3221225472 bytes, more than' bash -c "ulimit -v $most; $gatewalk show large.nc"
rm zeros.nc large.nc

# Names that are not UTF-8 stop no command.
odd=$(printf 'odd\377')
cp "$scenes/field.toml" "$odd.toml"
expect 0 'traversed' "$gatewalk" gate "$odd.toml" --trials 5 --json odd.json
expect 0 '' "$gatewalk" trace "$odd.toml" --json odd.json --replay odd.html --netcdf odd.nc --csv odd.csv
expect 0 '' "$gatewalk" landscape "$odd.toml" -o "$odd" --trials 5
expect 0 '' "$gatewalk" build "$odd.toml" --trials 1 -o "$odd.nc" --json odd.json
expect 0 '' "$gatewalk" show "$odd.nc" --json odd.json
expect 0 '' "$gatewalk" predict "$odd.nc" --row "0=$odd.nc" --json odd.json
expect 0 '' "$gatewalk" chart methods "$odd.toml" -o odd-chart --trials 5 --repeats 1 --methods stable --quiet
jq -e . odd.json odd-chart/chart.json "$odd/landscape.json" >/dev/null || fail "a name that is no UTF-8 breaks the JSON"

finish
