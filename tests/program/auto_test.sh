#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests run.method = "auto": the result names the chosen method and its evidence, the same on any number of threads.
#   auto_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

auto="$scenes/field.toml --set run.method=auto --set run.time_limit_s=2"
# shellcheck disable=SC2086
{
expect 0 '^Time stepping: method [a-z]*, run\..*, chosen with 4000 pilot trials.$' "$gatewalk" gate $auto --details --trials 50 --json auto.json
"$gatewalk" gate $auto --trials 50 --json - --threads 1 --quiet | cmp -s - auto.json || fail "auto: another number of threads gave another file"
holds '.method | .asked == "auto" and .met and .tolerance == 0.005 and .pilot_starts == 1 and .reference.verdict == "ok"' auto.json
holds '.method.tried[-1] as $last | $last.verdict == "ok" and $last.outcome_total_variation + $last.uncertainty <= 0.005' auto.json
holds '.method.tried[-1] as $last | .method | $last.method == .method and ([.step_s, .event_tolerance_m] | index($last.value)) != null' auto.json
value .made_by.scene auto.json | grep -q "^method = \"$(value .method.method auto.json)\"$" || fail "auto: the scene of the result names another method"
grep -q '^It changes their outcomes by a total variation of' out.txt || fail "auto: not by how much the method is off"
expect 0 '^Time stepping: method [a-z]*, run\.' "$gatewalk" build $auto --details --trials 5 -o auto.nc --json auto-build.json
holds '.method.met and .method.pilot_starts == 9' auto-build.json
"$gatewalk" show auto.nc --json auto-show.json --quiet
jq -s '(.[0].text.method | fromjson) == .[1].method' auto-show.json auto-build.json | grep -q true || fail "auto: the matrix does not record the choice"
expect 0 '^trapped' "$gatewalk" predict auto.nc $auto
expect 0 '^trapped' "$gatewalk" predict auto.nc
"$gatewalk" validate $auto --matrix auto.nc --trials 20 --start 0,0,15 --json auto-validate.json --quiet
jq -s '.[0].method == .[1].method' auto-validate.json auto-build.json | grep -q true || fail "auto: validate took another method than the matrix"
"$gatewalk" lattice $auto --trials 20 --json auto-lattice.json --quiet
jq -s '.[0].method == .[1].method' auto-lattice.json auto-build.json | grep -q true || fail "auto: lattice and build chose differently"
# Chains of trees.
for command in predict "analyze --runs 0" "rare --row 2 --gate-runs 4000" power "validate --trials 50" "plan --set field.rows=2 --set actions.a.forces.propulsion_N=9 --set actions.b={}" "design --set field.rows=2 --set terrain.types.s.forces.propulsion_N=9 --set terrain.random.s=0.5"; do
  # shellcheck disable=SC2086
  set -- $command
  expect 0 '' "$gatewalk" $1 $auto --accuracy 0.2 "${@:2}" --json auto-tree.json
  holds '(.method // .actions[0].method) | .asked == "auto" and .pilot_starts == 9' auto-tree.json
done
expect 0 '' "$gatewalk" power $auto --accuracy 0.2 --versus forces.propulsion_N=9
# "auto" does not read a matrix made with a named method, or with another tolerance.
"$gatewalk" build "$scenes/field.toml" --set run.time_limit_s=2 --trials 1 -o named.nc --quiet >/dev/null
expect 2 'run.method: auto here, stable by name there' "$gatewalk" predict named.nc $auto
expect 2 'run.tolerance: 0.01 here, 0.005 there' "$gatewalk" predict auto.nc $auto --set run.tolerance=0.01
for tolerance in 0.99e-4 1.01 nan -1; do
  expect 2 "run.tolerance = .* must lie in \[1e-04, 1\]" "$gatewalk" gate $auto --set run.tolerance=$tolerance
done
# No exact method takes such beams; and a method that does shows faults at this speed: refused with a message.
expect 2 'run.method = "auto" is not permitted for this scene: no method is exact' "$gatewalk" gate $auto --set beams.mass_kg=1e-6 --set beams.stiffness_left_Nm_per_rad=1e12
too_fast="--set beams.stiffness_right_Nm_per_rad=1e12 --set run.time_limit_s=0.02 --set start.vy_m_per_s=1e10"
expect 0 'even the most accurate setting shows faults' "$gatewalk" gate $auto $too_fast --trials 5 --quiet --json auto-faulty.json
holds '.method | .met == false and .method == .reference.method and .step_s == .reference.value' auto-faulty.json
expect 0 'run.step_s has no effect: run.method = "auto" chooses it' "$gatewalk" gate $auto --trials 5 --set run.step_s=0.01 --quiet --json out.json
}

finish
