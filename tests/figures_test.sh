#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The figures of --figure: each command that has one draws it in every format, and tests/web/figures_test.mjs reads it.
#   tests/figures_test.sh GATEWALK SOURCES FOLDER KEPT      KEPT: where tests/program keeps the figures of studies
set -euo pipefail
gatewalk=$1 scenes=$2/scenes out=$3 kept=$4
rm -rf "$out"
mkdir -p "$out/work"
cd "$out/work"
few=(--quiet --seed 1)
run() { "$gatewalk" "$@" "${few[@]}" >/dev/null; }
field=$scenes/field.toml
"$gatewalk" build "$field" --bins paper --trials 20 -o paper.nc --quiet >/dev/null
"$gatewalk" build "$field" --accuracy 0.1 -o tree.nc --quiet >/dev/null
run gate "$scenes/soft_left.toml" --trials 500 --figure ../gate.svg
run gate "$scenes/single_gate.toml" --set forces.propulsion_N=4 --set forces.random_N=0 --trials 200 --figure ../gate_trapped.svg
grep -q '100.00 \[' ../gate_trapped.svg || { echo "gate_trapped.svg: no number beside a bar of 100 %"; exit 1; }
run sweep "$scenes/single_gate.toml" --trials 50 --vary forces.propulsion_N=7 --figure ../sweep_single.svg
run sweep "$scenes/single_gate.toml" --trials 200 --vary forces.propulsion_N=4:1:9 --figure ../sweep_one.svg
run sweep "$scenes/single_gate.toml" --trials 100 --vary run.method=stable,moreau,paper --figure ../sweep_words.svg
run sweep "$scenes/single_gate.toml" --trials 50 --vary beams.stiffness_right_Nm_per_rad=400,500 --vary forces.propulsion_N=7,8 --figure ../sweep_low.svg
run sweep "$scenes/single_gate.toml" --trials 100 --vary forces.propulsion_N=4:1:9 --vary forces.random_N=0:10:60 --figure ../sweep_two.svg
run predict "$field" --accuracy 0.1 --figure ../predict.svg
run predict tree.nc --accuracy 0.1 --start 4,5,10 --start=-17,13,12 --figure ../predict_starts.svg
run predict paper.nc --figure ../predict_bins.svg
run predict paper.nc --set field.columns=401 --set field.rows=300 --set field.max_gates=200 --figure ../predict_large.svg
run predict paper.nc --set field.columns=3 --set field.rows=30 --set field.max_gates=40 --figure ../predict_tall.svg
for size in 1,1 3,1 1,3 401,1; do
  run predict paper.nc --set field.columns=${size%,*} --set field.rows=${size#*,} --set field.max_gates=5 --figure ../predict_$size.svg
done
run walk paper.nc --walks 1000 --figure ../walk.svg
run lattice "$field" --trials 1000 --figure ../lattice.svg
run lattice "$scenes/robot.toml" --trials 1000 --figure ../lattice_robot.svg
"$gatewalk" show paper.nc --figure ../show_paper.svg >/dev/null
"$gatewalk" show tree.nc --figure ../show_tree.svg >/dev/null
run validate "$field" --bins paper --matrix-trials 20 --trials 200 --figure ../validate.svg
"$gatewalk" sample observed -o observed.csv --quiet
printf 'gate_x,gate_y,count\n0,0,20\n-1,1,25\n4,2,15\n' >gates.csv
run validate "$field" --observed observed.csv --bins paper --matrix-trials 20 --null-draws 99 --figure ../validate_observed.svg
run validate "$field" --observed gates.csv --bins paper --matrix-trials 20 --null-draws 99 --figure ../validate_gates.svg
run analyze "$field" --set run.method=moreau --accuracy 0.05 --runs 300 --trials 2000 --target left_side --figure ../analyze.svg
run analyze "$field" --set run.method=moreau --set field.columns=61 --set field.rows=40 --set field.max_gates=30 --accuracy 0.1 --runs 0 --figure ../analyze_large.svg
# Which gate is of which type.
mixed=("$scenes/mixed.toml" --set run.method=moreau)
run predict "${mixed[@]}" --accuracy 0.1 --figure ../mixed_predict.svg
run predict "${mixed[@]}" --accuracy 0.1 --set field.columns=41 --set field.rows=40 --set field.max_gates=45 --figure ../mixed_small.svg
run lattice "${mixed[@]}" --trials 500 --figure ../mixed_lattice.svg
run validate "${mixed[@]}" --bins paper --matrix-trials 20 --trials 300 --start 0,0,15 --figure ../mixed_validate.svg
run analyze "${mixed[@]}" --accuracy 0.1 --runs 0 --figure ../mixed_analyze.svg
"$gatewalk" build "${mixed[@]}" --bins paper --trials 5 -o mixed.nc --quiet >/dev/null
run walk mixed.nc --walks 1000 --figure ../mixed_walk.svg
for name in predict lattice validate analyze walk; do
  grep -q 'unmarked: \.<' ../mixed_$name.svg || { echo "mixed_$name.svg does not name the types of gates"; exit 1; }
done
grep -q 'too small to be marked' ../mixed_small.svg || { echo "mixed_small.svg does not say why it marks no types"; exit 1; }
run plan "$field" --set run.method=moreau --set field.rows=3 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --accuracy 0.2 --figure ../plan.svg
run design "${mixed[@]}" --set field.rows=3 --changes 2 --types s,. --accuracy 0.2 --figure ../design.svg
printf 'ending,count\ncrossed,9\nleft side,3\nright side,2\ntrapped,40\ncut off,0\n' >counts.csv
free=(--free forces.propulsion_N=5:9)
for more in forces.random_N=20:60 beams.stiffness_left_Nm_per_rad=300:500 beams.stiffness_right_Nm_per_rad=300:500; do
  run fit "$field" counts.csv --set run.method=moreau --set field.rows=2 "${free[@]}" --trials $((6144 * ${#free[@]})) --figure ../fit_${#free[@]}.svg
  free+=(--free $more)
done
run fit "$field" counts.csv --set run.method=moreau --set field.rows=2 "${free[@]}" --trials 50000 --figure ../fit_${#free[@]}.svg
run rare "$field" --set run.method=moreau --row 8 --accuracy 0.2 --gate-runs 40000 --trials 2000 --figure ../rare.svg
run trace "$scenes/soft_left.toml" --trials 5 --figure ../trace.svg
run trace "$field" --field --trials 4 --figure ../trace_field.svg
# Studies draw into their folders; --figure draws the same again.
run landscape "$scenes/soft_left.toml" -o landscape --figure ../landscape.svg
run landscape "$scenes/robot.toml" -o landscape --figure ../landscape_robot.svg
# Numbers at the very ends of both maps; numbers as long as 0.35 beside them.
for radius in 0.08 0.05; do
  printf 'body.radius_m = %s\nbody.mass_kg = 0.25\nforces.propulsion_N = 0.8\n' $radius >three_keys.toml
  run landscape three_keys.toml -o landscape --figure ../landscape_radius_$radius.svg
done
run chart field "$field" --trials 20 -o fidelity --figure ../chart_field.svg
cp "$kept/passages/tracks.svg" ../passages.svg
for study in chart_methods chart_chain chart_limits; do
  for figure in "$kept/$study"/*.svg; do cp "$figure" "../${study}_$(basename "$figure")"; done
done
# The other formats, with what they say of themselves.
for end in pdf png; do run gate "$scenes/single_gate.toml" --trials 100 --figure ../gate.$end; done
nine=(); for d in 1 2 3 4 5 6 7 8 9; do nine+=(--start "$d,0,15"); done
"$gatewalk" predict paper.nc "${nine[@]}" --figure nine.svg 2>nine.txt && { echo "nine starts in a figure"; exit 1; }
grep -q 'at most 8 starts' nine.txt
"$gatewalk" gate "$scenes/single_gate.toml" --trials 10 --figure gate.jpg 2>jpg.txt && { echo "a figure .jpg"; exit 1; }
grep -q 'must end in .svg, .pdf or .png' jpg.txt
for end in svg pdf png; do
  grep -qa 'gatewalk gate .*scenes/.*\.toml --trials' ../gate.$end || { echo "gate.$end does not say what made it"; exit 1; }
done
# And the figures that stand in the repository, but how.svg and gate.svg, drawings of the width of a page.
results=$(find "$2/results" -name '*.svg' ! -name how.svg ! -name gate.svg ! -path '*/paper/*')
node "$2/tests/web/figures_test.mjs" "$out" $results
