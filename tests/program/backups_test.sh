#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# An existing output of any kind is kept before it is replaced, and one line says where; --force keeps nothing.
#   backups_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

seed() { "$gatewalk" gate "$scenes/single_gate.toml" --trials 20 --seed "$@"; }
echo 'not to be lost' >notes.txt
expect 0 '^gatewalk: what was there is kept as notes.txt.~1~$' "$gatewalk" build "$scenes/single_gate.toml" --trials 1 -o notes.txt
[ "$(cat notes.txt.~1~)" = 'not to be lost' ] || fail "build lost a file"
expect 0 'gate runs  *87' "$gatewalk" show notes.txt
seed 1 --json a.json >/dev/null 2>err.txt
[ -s err.txt ] && fail "a new file: $(cat err.txt)"
seed 1 --json a.json >/dev/null 2>err.txt
[ -s err.txt ] && fail "the same file again: $(cat err.txt)"
[ -e a.json.~1~ ] && fail "a backup of what stays as it was"
cp a.json first
seed 2 --json a.json --quiet 2>err.txt
[ -s err.txt ] && fail "--quiet: $(cat err.txt)"
cmp -s first a.json.~1~ || fail "the result before is lost"
seed 3 --json a.json --figure a.svg >/dev/null 2>err.txt
[ "$(cat err.txt)" = 'gatewalk: what was there is kept as a.json.~2~' ] || fail "said $(cat err.txt)"
seed 4 --json a.json --figure a.svg >/dev/null 2>err.txt
[ "$(cat err.txt)" = 'gatewalk: what was there is kept as a.json.~3~, a.svg.~1~' ] || fail "said $(cat err.txt)"
seed 5 --json a.json --figure a.svg --force >/dev/null 2>err.txt
[ -s err.txt ] && fail "--force: $(cat err.txt)"
[ "$(ls a.* | xargs)" = 'a.json a.json.~1~ a.json.~2~ a.json.~3~ a.svg a.svg.~1~' ] || fail "--force kept $(ls a.*)"
seed 5 --json - --quiet | cmp -s - a.json || fail "--force shows in the result"
: >empty.json
seed 1 --json empty.json --quiet
[ -e empty.json.~1~ ] && fail "a backup of an empty file"
for i in $(seq 4 99); do : >a.json.~$i~; done
expect 2 'json: a.json: is there, and so are 99 backups of it' seed 6 --json a.json
seed 5 --json - --quiet | cmp -s - a.json || fail "a refused command wrote"
# Each file of a study's folder is kept, figures too.
few() { "$gatewalk" sweep "$scenes/single_gate.toml" --trials 5 --vary forces.random_N=0,20 --seed "$@"; }
few 1 --csv s.csv --json s.json --quiet
few 2 --csv s.csv --json s.json >/dev/null 2>err.txt
[ "$(cat err.txt)" = 'gatewalk: what was there is kept as s.csv.~1~, s.json.~1~' ] || fail "sweep said $(cat err.txt)"
runs() { "$gatewalk" trace "$scenes/soft_left.toml" --trial "$1" --csv t.csv --netcdf t.nc --replay t.html --json t.json --quiet; }
runs 0; runs 1
[ "$(ls t.* | xargs)" = 't.csv t.csv.~1~ t.html t.html.~1~ t.json t.json.~1~ t.nc t.nc.~1~' ] || fail "trace kept $(ls t.*)"
"$gatewalk" landscape "$scenes/single_gate.toml" -o study --quiet >/dev/null
cat study/* | cksum >before.txt
"$gatewalk" landscape "$scenes/soft_left.toml" -o study >/dev/null 2>err.txt
grep -q 'kept as study/landscape.csv.~1~, study/landscape.json.~1~, study/landscape.svg.~1~$' err.txt || fail "landscape said $(cat err.txt)"
cat study/*.~1~ | cksum | cmp -s - before.txt || fail "landscape lost a file"
"$gatewalk" landscape "$scenes/single_gate.toml" -o study --force --quiet >/dev/null
[ "$(ls study | wc -l)" = 6 ] || fail "landscape --force kept $(ls study)"

finish
