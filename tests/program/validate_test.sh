#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests validate: the chain beside the full dynamics, with one verdict that no p-value contradicts.
#   validate_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 300 --walks 500 --start 4.3,5.1,10.2 --start 0,0,15 --details --json ends-validate.json >ends-validate.txt 2>/dev/null
head -1 ends-validate.txt | grep -q '^The chain .* the full dynamics from ' || fail "validate: the verdict does not come first"
grep -q '^   d   vx    vy  *p  *differs most  *trials, %  chain, %  final gates: TV  by chance$' ends-validate.txt || fail "validate: no header of the starts"
[ "$(grep -c '^ 4\.3  5\.1  10\.2  ' ends-validate.txt)" -ge 5 ] || fail "validate: labels of starts are rounded"
[ "$(grep -c '^trapped  *[0-9.]* \[.*\]  *[0-9.]* \[.*\]  *[0-9.<]*\( \*\)\{0,1\}$' ends-validate.txt)" = 2 ] || fail "validate: no endings by start"
holds '[.starts[] | (.endings.dynamics | add) == 300 and (.endings.walks | add) + .never_sampled == 500 and ((.endings.exact | add) + .never_sampled - 1 | fabs) < 1e-12] | all' ends-validate.json
holds '[.starts[] | .endings.dynamics as $seen | .endings.exact as $exact | .exits | to_entries | all(((.value | map(.dynamics) | add) - $seen[.key] / 300 | fabs) < 1e-12 and ((.value | map(.exact) | add) - $exact[.key] | fabs) < 1e-12)] | all' ends-validate.json
grep -q '^ 4\.3  5\.1  10\.2  *[0-9]* of 27$' ends-validate.txt || fail "validate: no places along the sides"
holds '[.starts[].trials_and_matrix | ([.p_adjusted | .. | numbers] | min) as $least | .p == $least and .differs == (.p <= .level) and .null_draws >= 999 and .resampled_matrices == 999] | all' ends-validate.json
holds '[.starts[] | (.verdict | test("differs")) == .trials_and_matrix.differs] | all' ends-validate.json
# Is it Markov? Every question has its p and its sentence; the held force only if asked for.
holds '.markov | .walks == 600 and (.verdict | test("chain forgets")) and ([.gates_ahead, .gate_before, .visit, .row | .p > 0 and .p <= .p_adjusted and (.sentence | length > 20)] | all) and (.gates_ahead.steps | length == 7)' ends-validate.json
holds '[.starts[] | has("force_memory")] | any | not' ends-validate.json
grep -q '^Is it Markov? Four tests' ends-validate.txt && grep -q '^  The gate before (p [=<] ' ends-validate.txt || fail "validate: does not say whether it is Markov"
expect 0 'drawn anew at every crossing' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 30 --start 0,0,15 --memory --null-draws 99 --details
# A force that holds for a second is a memory; what it does to the final gates is the check's own number.
expect 0 '^Is it Markov? No' "$gatewalk" validate "$scenes/field.toml" --set forces.random_rate_Hz=1 --set forces.random_N=8 \
  --trials 1000 --accuracy 0.05 --json held.json
said=$(sed -n 's/^With the face before in the state the final gates differ by a total variation of \([0-9.]*\); chance makes up$/\1/p' out.txt)
holds "(.state_space.assumptions.face_before.total_variation - ${said:-9} | fabs) <= 0.0005" held.json
# A tree's gate runs are those that were simulated, without the mirror images in its rows.
"$gatewalk" build "$scenes/field.toml" --accuracy 0.1 -o tree.nc --quiet >/dev/null
"$gatewalk" show tree.nc --json tree.json --quiet
"$gatewalk" validate "$scenes/field.toml" --matrix tree.nc --trials 30 --start 0,0,15 --null-draws 99 --json runs.json --quiet
jq -s '.[0].gate_runs == .[1].matrix.gate_runs' tree.json runs.json | grep -q true || fail "validate: other gate runs than show's"
# Values beyond what is sensible are refused by name, with the range, before any work.
for value in 0 1e15; do expect 2 "null-draws.*at least 1 and at most 100000" "$gatewalk" validate "$scenes/field.toml" --null-draws $value --matrix-trials 1e12; done
expect 2 'walks 0: must be at least 1' "$gatewalk" validate "$scenes/field.toml" --walks 0 --matrix-trials 1e12
expect 2 'trials.*at most 1e15' "$gatewalk" validate "$scenes/field.toml" --trials 2000000000000000 --matrix-trials 1e12
expect 2 'inside the gate' "$gatewalk" validate "$scenes/field.toml" --start 25,0,15 --matrix-trials 1e12
# Walks need no memory each: a million and twenty million take the same.
peak() {
  python3 -c 'import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$@"
}
few=$(peak "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,15 --walks 1e5 --null-draws 9 --threads 2 --quiet)
many=$(peak "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,15 --walks 2e7 --null-draws 9 --threads 2 --quiet)
[ $((many - few)) -lt 20000 ] || fail "validate: twenty million walks take $((many - few)) KiB more"

# A start that Table IV lacks.
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 200 --start 4,5,10 --json validate.json --figure gates.svg --quiet
# The figure has the numbers of the screen, whose chance includes the matrix.
said=$(jq -r '.starts[0].trials_and_matrix.total_variation_by_chance.mean' validate.json)
grep -q "(chance: $(printf %.3f "$said"))" gates.svg || fail "validate: the figure has another chance than $said"
holds '.starts | length == 1' validate.json
holds '.starts[0].exact | .p_values.chi_squared > 0 and .rmse_per_100_floor > 0 and .total_variation >= 0' validate.json

expect 2 'no meaning' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --matrix-trials 5
expect 2 'start   0    0  -15 lies outside the chain' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --start 0,0,-15 --start 0,0,15
expect 2 'start   0    0  -15 lies outside the chain' "$gatewalk" validate "$scenes/field.toml" --bins paper --trials 20 --start 0,0,-15
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --quiet --json out.json
holds '[.starts[].start.clamped] == [false, false, false, false]' out.json
holds '[.starts[].verdict | test("^the chain (agrees with|differs from) the dynamics .*p [=<] ")] | all' out.json
# The paper's numbers are shown for its own body and beams only.
expect 0 'fewer than 4' "$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 20 --details
expect 0 '^   0    0   15  *-  ' "$gatewalk" validate "$scenes/field.toml" --trials 20 --matrix-trials 2 --set body.mass_kg=2 --details
grep -q 'fewer than 4' out.txt && fail "validate: the paper's numbers beside another body"
# A start and a seed determine the noise, the same in every command.
"$gatewalk" lattice "$scenes/field.toml" --trials 200 --seed 5 --json start.json --quiet
"$gatewalk" validate "$scenes/field.toml" --matrix m.nc --trials 200 --seed 5 --start 4,5,10 --start 0,0,15 --json starts.json --quiet
jq -s '.[0].final_gates == .[1].starts[1].final_gates.dynamics' start.json starts.json | grep -q true ||
  fail "validate and lattice ran other trials for the same start"

finish
