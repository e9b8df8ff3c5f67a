#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests gate: counts, methods, warnings, and a better method beside the scene's.   gate_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# Counts add up; --json - prints JSON and nothing else.
expect 0 '"trials": 200' "$gatewalk" gate "$scenes/single_gate.toml" --trials 2e2 --seed 3 --json - --quiet
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json gate.json --threads 2 >/dev/null 2>&1
holds '.traversed + .exited_left + .exited_right + .trapped == .trials' gate.json
holds '.traversed == .traversed_left + .traversed_right + .traversed_even' gate.json
holds '.status.clean' gate.json
holds '.trapped_95[0] < .trapped and .trapped < .trapped_95[1]' gate.json
# The Jeffreys interval for none of 200 reaches up to 0.012466 (beta quantile 0.975 of 0.5, 200.5).
holds '.traversed == 0 and .trials == 200 and .traversed_95[0] == 0 and (.traversed_95[1] / .trials - 0.012466 | fabs) < 1e-6' gate.json
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 3 --json - --threads 1 2>/dev/null | cmp -s - gate.json ||
  fail "gate: another number of threads gave another file"
"$gatewalk" gate "$scenes/single_gate.toml" --trials 200 --seed 4 --json other.json --quiet
[ "$(value .trapped gate.json)$(value .exited_left gate.json)" != "$(value .trapped other.json)$(value .exited_left other.json)" ] ||
  fail "another seed gave the same outcomes"
expect 0 'sank into a beam' "$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200
"$gatewalk" gate "$scenes/single_gate.toml" --set run.method=paper --trials 200 --json paper.json --quiet
holds '.status.clean == false' paper.json

# A step outside a method's region is refused, or a warning stands in text and JSON.
expect 0 'longer than the method.s stability bound' "$gatewalk" gate "$scenes/undamped.toml" --set run.method=paper --trials 20 --json beyond.json --quiet
holds '.status | .clean == false and .runs_beyond_the_stability_bound == 20' beyond.json
# Euler's bound is d/k = 10/500 s: at the bound and below it there is no warning.
loose="$scenes/single_gate.toml --set run.method=paper --set beams.damping_Nms_per_rad=10 --trials 20 --quiet"
for step in 0.02 0.01; do
  # shellcheck disable=SC2086
  "$gatewalk" gate $loose --set run.step_s=$step --set beams.stiffness_left_Nm_per_rad=500 --json within.json 2>/dev/null
  holds '.status.runs_beyond_the_stability_bound == 0' within.json
done
# shellcheck disable=SC2086
"$gatewalk" gate $loose --set run.step_s=0.02 --set beams.stiffness_left_Nm_per_rad=501 --json beyond.json 2>/dev/null
holds '.status.runs_beyond_the_stability_bound == 20' beyond.json
expect 2 'run.step_s = 0.004 is not permitted.*method penalty permits at most' "$gatewalk" gate "$scenes/field.toml" --set run.method=penalty --set beams.stiffness_left_Nm_per_rad=1e9
# moreau has no bound on the step; the effect of long steps is measured.
expect 0 'sank into a beam' "$gatewalk" gate "$scenes/stiff.toml" --set run.method=moreau --set run.step_s=0.02 --trials 50 --json sunk.json --quiet
holds '.status | .clean == false and .runs_penetrating_over_1_percent > 0 and .runs_beyond_the_stability_bound == 0' sunk.json

expect 0 'hits may have been missed' "$gatewalk" gate "$scenes/field.toml" --set body.radius_m=0.01 --set start.x_m=-12 --trials 1 --quiet --set run.method=moreau
expect 0 'run.event_tolerance_m has no effect' "$gatewalk" gate "$scenes/field.toml" --trials 5 --set run.event_tolerance_m=1e-6 --quiet --json out.json

# A method that is wrong without a sign: a better method checks it. (Elastic, one beam without a spring.)
cat >elastic.toml <<'TOML'
body = { mass_kg = 100, radius_m = 14 }
beams = { length_m = 25, mass_kg = 1, stiffness_left_Nm_per_rad = 400, stiffness_right_Nm_per_rad = 0, damping_Nms_per_rad = 500, joint_x_m = 25, joint_y_m = 30 }
forces = { propulsion_N = 0, random_N = 10, random_rate_Hz = 5, drag_Ns_per_m = 1 }
contact = { restitution = 1, tip_restitution = 1 }
run = { method = "moreau", step_s = 0.004, time_limit_s = 12, traverse_y_m = 60 }
start = { x_m = 0, y_m = 0, vx_m_per_s = -10, vy_m_per_s = 15 }
TOML
expect 1 'a better method gives other outcomes for at least' "$gatewalk" gate elastic.toml --trials 200 --strict --json elastic.json --quiet
holds '.status.clean == false and .status.outcome_error_seen > 0.3 and .exited_right < 150' elastic.json
"$gatewalk" gate elastic.toml --set run.method=stable --set run.step_s=0.02 --trials 200 --strict --json elastic.json --quiet
holds '.exited_right == 200 and .status.clean' elastic.json
expect 1 'a better method gives other outcomes for at least' "$gatewalk" sweep elastic.toml --vary run.method=moreau,stable --set run.step_s=0.004 --trials 100 --strict --json elastic.json --quiet
holds '.points | map(.status.clean) == [false, true]' elastic.json
expect 1 'a better method gives other outcomes for at least' "$gatewalk" trace elastic.toml --strict --json elastic.json --quiet
expect 1 'a better method gives other outcomes for at least' "$gatewalk" landscape elastic.toml --trials 100 -o passes --strict --quiet

finish
