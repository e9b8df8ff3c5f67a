#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests fit: the numbers of a scene that explain an experiment.   fit_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# An experiment with a known propulsion.
# Steps of 0.01 s take half the time of the usual ones. The truth comes from the same scene.
field=("$scenes/field.toml" --set run.method=moreau --set field.rows=4)
small=("${field[@]}" --set run.step_s=0.01)
"$gatewalk" lattice "${small[@]}" --set forces.propulsion_N=7.2 --trials 300 --seed 11 --quiet --json truth.json
jq -r '"ending,count", (.endings | to_entries[] | select(.key != "broken") | "\(.key),\(.value)")' truth.json >endings.csv
free=(--free forces.propulsion_N=5:9)
expect 0 '^forces.propulsion_N  *5 to 9  *[0-9.]*  *[0-9.]*  *\[[0-9.]*, [0-9.]*\]$' "$gatewalk" fit "${small[@]}" endings.csv "${free[@]}" --trials 16384 --json fit.json --figure fit.svg --draws draws.csv --inference-data fit.nc -o best.toml --scenes 2
holds '.numbers[0] | .key == "forces.propulsion_N" and .median_95[0] < 7.2 and 7.2 < .median_95[1] and .told and .sd < 0.6 and .low == 5' fit.json
holds '.observed == 300 and ([.outcomes[].observed] | add) == 300 and .p > 0.001 and .correlation == [[1]] and .trials <= 16384 and .trials > 15000' fit.json
grep -q 'posterior after 300 trials' fit.svg || fail "no picture"
[ "$(wc -l <draws.csv)" = "$(($(jq .draws fit.json) + 1))" ] && [ "$(head -n 1 draws.csv)" = forces.propulsion_N,log_likelihood ] || fail "draws"
ncdump -h fit.nc | grep -q 'double forces.propulsion_N(chain, draw)' && ncdump -v count fit.nc | grep -q 'group: observed_data' || fail "no InferenceData"
# The mean of the draws is that of the answer; scenes are written as they are drawn.
awk -F, 'NR > 1 { sum += $1 } END { print sum / (NR - 1) }' draws.csv >mean.txt
jq --argjson m "$(cat mean.txt)" -e '.numbers[0].mean - $m | . < 1e-4 and . > -1e-4' fit.json >/dev/null || fail "draws of another mean"
for f in best.toml best-1.toml best-2.toml; do "$gatewalk" scene $f --quiet --json scene.json || fail "$f is no scene"; done
! cmp -s best-1.toml best-2.toml || fail "scenes are alike"
# Recordings of one experiment are added: two files with half of the counts each give the same as the whole.
awk -F, 'NR == 1 { print; next } { print $1 "," int($2 / 2) }' endings.csv >half.csv
awk -F, 'NR == 1 { print; next } { print $1 "," $2 - int($2 / 2) }' endings.csv >rest.csv
"$gatewalk" fit "${small[@]}" half.csv rest.csv "${free[@]}" --trials 16384 --quiet --json parts.json
jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' fit.json parts.json | grep -q true || fail "fit: two files are not their sum"
expect 2 'half.csv: is given twice' "$gatewalk" fit "${small[@]}" half.csv half.csv "${free[@]}"
# Final gates in one file and endings in another, without their connection: the result is that of the gates alone.
jq -r '"gate_x,gate_y,count", (.final_gates | to_entries[] | .key as $y | .value | ((length - 1) / 2) as $middle | to_entries[] | "\(.key - $middle),\($y),\(.value)")' truth.json >gates.csv
"$gatewalk" fit "${small[@]}" gates.csv "${free[@]}" --trials 16384 --quiet --json gates.json
expect 0 'the endings are left out: nothing says which of them belong' "$gatewalk" fit "${small[@]}" gates.csv endings.csv "${free[@]}" --trials 16384 --quiet --json pair.json
jq -s '.[0].numbers == .[1].numbers' gates.json pair.json | grep -q true || fail "fit: gates and endings are not the gates"
# Lines of trials; two numbers of which one cannot be determined; the same on one thread and after a resume.
printf 'trial,ending,gate_x,gate_y\na,crossed,0,3\nb,trapped,0,1\nc,trapped,0,2\nd,crossed,1,3\ne,left side,-4,2\nf,crossed,0,3\n' >lines.csv
both=("${free[@]}" --free contact.impulse_threshold_Ns=0.04:0.041 --trials 24576)
expect 0 '^Beware: these data cannot tell contact.impulse_threshold_Ns: ' "$gatewalk" fit "${field[@]}" lines.csv "${both[@]}" --json two.json --figure two.svg
same() { jq -s '(.[0] | del(.made_by, .seconds)) == (.[1] | del(.made_by, .seconds))' "$1" "$2" | grep -q true || fail "$3"; }
expect 75 'kept in kept' "$gatewalk" fit "${field[@]}" lines.csv "${both[@]}" --threads 1 --checkpoint kept --max-time 0.3s --json one.json
first=$(stat -c %s kept)
for _ in 1 2 3 4 5 6; do  # a --resume that began anew would keep no more than the first call
  "$gatewalk" fit "${field[@]}" lines.csv "${both[@]}" --threads 1 --checkpoint kept --resume --max-time 0.3s --quiet --json one.json && break
done
[ -f one.json ] || [ "$(stat -c %s kept)" -gt $((2 * first)) ] || fail "fit --resume: keeps $(stat -c %s kept) bytes after $first"
[ -f one.json ] || "$gatewalk" fit "${field[@]}" lines.csv "${both[@]}" --threads 1 --checkpoint kept --resume --quiet --json one.json
same two.json one.json "fit: other results on one thread, or after a resume"
# The times at which bodies left determine the drag, which endings hardly do.
fast=("${small[@]}" --set forces.propulsion_N=14)
"$gatewalk" trace "${fast[@]}" --set forces.drag_Ns_per_m=0.12 --field --trials 90 --seed 11 --quiet --json traced.json
jq -r '"trial,ending,time_s", (.runs[] | [.trial, .ending, if .ending == "trapped" or .ending == "cut off" then "" else .t[-1] end] | map(tostring) | join(","))' traced.json >timed.csv
cut -d, -f1,2 timed.csv >untimed.csv
drag=(--free forces.drag_Ns_per_m=0.02:0.3 --trials 16384)
"$gatewalk" fit "${fast[@]}" timed.csv "${drag[@]}" --quiet --json timed.json --force
"$gatewalk" fit "${fast[@]}" untimed.csv "${drag[@]}" --quiet --json untimed.json --force
holds '.numbers[0] | .median_95[0] < 0.12 and 0.12 < .median_95[1]' timed.json
holds '[.outcomes[].outcomes] | any(test("crossed .*(within|from) [0-9.]+ s"))' timed.json
jq -s '.[0].numbers[0].sd < 0.2 * .[1].numbers[0].sd' timed.json untimed.json | grep -q true || fail "times tell nothing: $(jq -c .numbers timed.json untimed.json)"
expect 0 '^gatewalk: --observed: validate does not test the times; gatewalk fit uses them$' "$gatewalk" validate "${fast[@]}" --observed timed.csv --trials 200 --accuracy 0.1
printf 'trial,ending,time_s\na,trapped,\nb,crossed,\n' >none.csv
expect 2 'none.csv:3: column time_s: nothing is not permitted' "$gatewalk" fit "${fast[@]}" none.csv "${drag[@]}"
# No number in the range explains the counts; the likeliest lies beyond the range's end.
printf 'gate_x,gate_y,count\n-4,0,50\n4,3,50\n' >odd.csv
expect 1 'no numbers in these ranges explain the counts' "$gatewalk" fit "${field[@]}" odd.csv "${free[@]}" --trials 12288 --strict
expect 2 'free forces.propulsion_N=-1:1: ' "$gatewalk" fit "${small[@]}" odd.csv --free forces.propulsion_N=-1:1
expect 0 'likely to lie beyond 6.5, where its range ends' "$gatewalk" fit "${small[@]}" endings.csv --free forces.propulsion_N=4:6.5 --trials 16384
# All crossed: the posterior falls from the range's end as the 300th power of the probability to cross. Of 8000 trials
# 38 cross at 5 N and 121 at 6 N, so its sd is about 1 / (300 ln(121 / 38)) = 0.0029 N.
printf 'ending,count\ncrossed,300\n' >all.csv
"$gatewalk" fit "${small[@]}" all.csv --free forces.propulsion_N=4:6 --trials 16384 --quiet --json all.json
holds '.p < 0.001 and (.numbers[0].sd | . > 0.0015 and . < 0.004) and .numbers[0].goes_on_above and .outside <= 0.01' all.json
# An ending that hardly ever happens gives no certainty.
"$gatewalk" fit "${small[@]}" all.csv --free forces.propulsion_N=3:4 --trials 16384 --quiet --json all.json --force
holds '.p < 0.001 and .numbers[0].sd > 0.02' all.json

# Passages determine more than endings: each is simulated from where it began. Costs other than the time may be missing.
"$gatewalk" lattice "${small[@]}" --set forces.propulsion_N=7.2 --trials 300 --seed 11 --quiet --passages runs.csv --cell-file cell.toml --json again.json --force
expect 0 '^From [0-9]* observed passages and ' "$gatewalk" fit "${small[@]}" runs.csv "${free[@]}" --trials 100000 --json passages.json
holds '.of == "passages" and (.numbers[0] | .median_95[0] < 7.2 and 7.2 < .median_95[1] and .median_95[1] - .median_95[0] < 0.3) and .settled and .p > 0.01' passages.json
holds '.observed == ([.outcomes[].observed] | add) and ([.outcomes[].outcomes] | any(test("^EN d .* m/s( or mirrored)?: to [ELR][DNT] (within|from|after) ")) and any(test("trapped$")))' passages.json
cut -d, -f1-11 runs.csv >bare.csv
sed '2s/^.*$/1,1,EN,0,0,15,lost,,,,0.1/;3,$d' bare.csv >lost.csv
expect 2 'no passage was seen to its end' "$gatewalk" fit "${small[@]}" lost.csv "${free[@]}"
expect 2 'bare.csv:[0-9]*: column time_s: .* must be at most cell.trapped_after_s = 3' "$gatewalk" fit "${small[@]}" --set run.time_limit_s=3 bare.csv "${free[@]}"
cut -d, -f1-10 bare.csv >timeless.csv
expect 2 'column time_s is missing: the columns must be body,trial,in,d,vx,vy,out,out_d,out_vx,out_vy,time_s; there are' "$gatewalk" fit "${small[@]}" timeless.csv "${free[@]}"
expect 2 'says nothing of passages' "$gatewalk" fit "${small[@]}" bare.csv --free start.vy_m_per_s=10:20
expect 2 'observed ones need [0-9]* trials or more' "$gatewalk" fit "${small[@]}" bare.csv "${free[@]}" --trials 16384
# The order of lines, missing costs, and a lost passage beside the others do not change the numbers.
{ sed 's/^1,1,/lost,1,/' lost.csv; sed -n '2,$p' bare.csv | awk -F, '{ print ($1 * 7919) % 1009 "," NR "," $0 }' | sort -t, -k1,1n -k2,2n | cut -d, -f3-; } >other.csv
expect 0 '^gatewalk: 1 of [0-9]* passages were lost' "$gatewalk" fit "${small[@]}" other.csv "${free[@]}" --trials 100000 --json other.json
jq -s '.[0].numbers == .[1].numbers' passages.json other.json | grep -q true || fail "fit: order, costs or a lost passage matter"
expect 2 'bare.csv: has passages, of which fit takes one file' "$gatewalk" fit "${small[@]}" bare.csv other.csv "${free[@]}"
expect 2 'start has no meaning for passages' "$gatewalk" fit "${small[@]}" bare.csv "${free[@]}" --start 0,0,15
# A program's numbers, by endings and by passages, which say where bodies entered.
hopper=("$scenes/programs/hopper.toml" --cell-program "$hopper_program")
"$gatewalk" lattice "${hopper[@]}" --set parameters.push_J=1.4 --trials 120 --seed 3 --quiet --passages hops.csv --cell-file hops.toml --json hops.json --force
push=(--free parameters.push_J=1:3 --trials 12288 --quiet)
"$gatewalk" fit "${hopper[@]}" hops.csv "${push[@]}" --json hopped.json
holds '.of == "passages" and (.numbers[0] | .key == "parameters.push_J" and .told and .median_95[0] < 1.4 and 1.4 < .median_95[1] and .median_95[1] < 2)' hopped.json
jq -r '"ending,count", (.endings | to_entries[] | select(.key != "broken") | "\(.key),\(.value)")' hops.json >ends.csv
"$gatewalk" fit "${hopper[@]}" ends.csv "${push[@]}" --json ended.json
holds '.of == "trials" and (.numbers[0] | .median_95[0] < 1.4 and 1.4 < .median_95[1])' ended.json
# The Sobol index of a single number: all of the variance is its own.
"$gatewalk" analyze "${hopper[@]}" --over parameters.push_J=1:3 --over-trials 4000 --runs 0 --quiet --json over.json
holds '.variance_shares.numbers[0] | .key == "parameters.push_J" and .total_95[1] > 0.9' over.json
expect 2 'unknown column "d"' "$gatewalk" fit "${hopper[@]}" bare.csv --free parameters.push_J=1:3
expect 2 'free push_J=1:3: numbers of a program are parameters.KEY' "$gatewalk" fit "${hopper[@]}" hops.csv --free push_J=1:3
expect 2 "parameter 'push_J' must be" "$gatewalk" fit "${hopper[@]}" hops.csv --free parameters.push_J=1:4
expect 2 "has no parameter 'pull_J', but push_J" "$gatewalk" fit "${hopper[@]}" hops.csv --free parameters.pull_J=1:3
expect 2 'push_J is varied already' "$gatewalk" fit "${hopper[@]}" hops.csv --free parameters.push_J=1:2 --free parameters.push_J=1:3
expect 2 'has no effect: parameters.push_J is varied' "$gatewalk" fit "${hopper[@]}" hops.csv --set parameters.push_J=2 --free parameters.push_J=1:3
expect 2 'writes scenes of gates' "$gatewalk" fit "${hopper[@]}" hops.csv --free parameters.push_J=1:3 -o best.toml --force

expect 2 'free KEY=LOW:HIGH says which numbers' "$gatewalk" fit "${small[@]}" endings.csv
expect 2 'free forces.push=4:8: ' "$gatewalk" fit "${small[@]}" endings.csv --free forces.push=4:8
expect 2 'scenes: needs -o' "$gatewalk" fit "${small[@]}" endings.csv "${free[@]}" --scenes 3
expect 2 'trials 100: must be at least' "$gatewalk" fit "${small[@]}" endings.csv "${free[@]}" --trials 100
expect 2 'counts are of one start\|for one start' "$gatewalk" fit "${small[@]}" endings.csv "${free[@]}" --start 0,0,15 --start 4,0,15
expect 2 'nothing.csv: cannot be read\|cannot be read' "$gatewalk" fit "${small[@]}" nothing.csv "${free[@]}"
finish
