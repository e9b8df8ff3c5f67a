#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Chains and matrix files in other programs: scipy, R (markovchain, ncdf4), Octave. Each absorbs the field's chain
# itself and must find the endings that gatewalk predicts; each reads the matrix file as it is.
#   readers_test.sh GATEWALK ROOT scipy|r|octave
here=$(realpath "$(dirname "$0")")
. "$here/../program/preamble.sh"
tool=$3
keep=
case $tool in
  scipy) /usr/bin/python3 -c 'import scipy, xarray, h5py, netCDF4' 2>/dev/null || { echo "python3-scipy, python3-xarray, python3-h5py or python3-netcdf4 is not installed"; exit 77; } ;;
  r) Rscript -e 'library(markovchain); library(ncdf4)' >/dev/null 2>&1 || { echo "r-cran-markovchain or r-cran-ncdf4 is not installed"; exit 77; } ;;
  octave) octave --no-gui --eval 'pkg load netcdf' >/dev/null 2>&1 || { echo "octave or octave-netcdf is not installed"; exit 77; } ;;
  *) echo "no tool '$tool'"; exit 2 ;;
esac
small=(--set field.columns=3 --set field.rows=2 --set field.max_gates=0)
paper_matrix p.nc
"$gatewalk" build "$scenes/field.toml" --gate-runs 500 -o tree.nc --quiet >/dev/null 2>&1
"$gatewalk" predict p.nc "${small[@]}" --json predicted.json --quiet
for form in csv mtx npz; do "$gatewalk" export p.nc "${small[@]}" -o field.$form --force --quiet >/dev/null || fail "export .$form"; done
"$gatewalk" export p.nc --gate --counts -o gate.csv --quiet >/dev/null
"$gatewalk" export tree.nc -o trials.dtrajs.npz --quiet >/dev/null
jq -r '.endings | to_entries[] | "\(.key) \(.value)"' predicted.json >expected.txt

case $tool in
  scipy) /usr/bin/python3 "$here/readers.py" >answer.txt || fail "readers.py" ;;
  r) Rscript "$here/readers.R" >answer.txt || fail "readers.R" ;;
  octave) octave --no-gui --quiet "$here/readers.m" >answer.txt 2>err.txt || fail "readers.m: $(cat err.txt)" ;;
esac
# answer.txt: "absorbed NAME SHARE" for each ending, "counts N" of the file's matrix, "name STATE" of its third state.
while read -r ending share; do
  found=$(awk -v e="$ending" '$1 == "absorbed" && $2 == e { print $3 }' answer.txt)
  awk -v a="$share" -v b="${found:-nan}" 'BEGIN { d = a - b; exit !(d < 1e-12 && d > -1e-12) }' || fail "$ending: $share here, '$found' there"
done <expected.txt
[ "$(awk '$1 == "counts" { print $2 }' answer.txt)" = "$(awk -F, 'NR > 1 { n += $3 } END { print n }' gate.csv)" ] || fail "counts: $(cat answer.txt)"
[ "$(awk '$1 == "name" { print $2 }' answer.txt)" = EN_2 ] || fail "the third state's name: $(cat answer.txt)"
finish
