#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Bins other than the paper's are recorded in the matrix file, and every command reads them.
#   bins_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
expect 0 '696 rows, 697 columns' "$gatewalk" build "$scenes/field.toml" --trials 1 --bins 2 --seed 1 -o fine.nc
expect 0 '23 rows, 24 columns' "$gatewalk" build "$scenes/field.toml" --trials 5 --bins 0.5 --seed 1 -o coarse.nc
expect 0 'bins  *2.0' "$gatewalk" show fine.nc --row 695 --details
"$gatewalk" show coarse.nc --json coarse.json --quiet
holds '.text.bins == "0.5" and .inputs == 23 and (.rows | length) == 23' coarse.json
for bins in fine coarse; do
  "$gatewalk" walk $bins.nc --walks 1000 --json walk-$bins.json --quiet >/dev/null 2>&1
  holds '([.final_gates[][]] | add) == 1000' walk-$bins.json
  "$gatewalk" predict $bins.nc "$scenes/field.toml" --json predict-$bins.json --quiet >/dev/null 2>&1
  holds '(([.final_gates[][]] | add) - 1 | fabs) < 1e-12' predict-$bins.json
done
"$gatewalk" build "$scenes/field.toml" --trials 20 --bins 1 --seed 1 -o m1.nc --quiet >/dev/null
"$gatewalk" show m1.nc --json m1.json --quiet
"$gatewalk" show m.nc --json m.json --quiet
jq -s '.[0].rows == .[1].rows' m.json m1.json | grep -q true || fail "--bins 1 is not the paper's matrix"
for bins in 0 -1 nan 1e9; do expect 2 'bins' "$gatewalk" build "$scenes/field.toml" --bins $bins -o x.nc; done

# Bins from a pilot are the default of any other field. Twins, in other units, have the same matrix.
cat >cm.toml <<'END'
[body]
mass_kg = 0.25
radius_m = 0.08
[beams]
length_m = 0.17
mass_kg = 0.01
stiffness_left_Nm_per_rad = 0.15
stiffness_right_Nm_per_rad = 0.15
damping_Nms_per_rad = 0.005
joint_x_m = 0.23
joint_y_m = 0.20
[forces]
propulsion_N = 0.8
random_N = 1.0
random_rate_Hz = 10
drag_Ns_per_m = 1.0
[contact]
impulse_threshold_Ns = 1e-4
[run]
traverse_y_m = 0.40
[start]
vy_m_per_s = 0.4
END
expect 0 'bins from a pilot' "$gatewalk" build cm.toml --trials 2 --seed 3 -o auto.nc --json auto.json --threads 1 --details
holds '.bins == "auto" and .clamped_share == 0 and .state_space.outermost_bins == "open" and .state_space.row_starts == "visited"' auto.json
holds '.state_space | .states > 100 and .pilot.trials == 2000 and .pilot.entries > 1000 and .resolution.poor == false and .starts_of_their_own == [{"d_m": 0, "vx_m_per_s": 0, "vy_m_per_s": 0.4}]' auto.json
holds '.state_space.resolution.unresolved_variance | [.d, .vx, .vy] | all(. > 0 and . < 0.5)' auto.json
"$gatewalk" build cm.toml --trials 2 --seed 3 -o auto2.nc --quiet --threads 2 >/dev/null
cmp -s auto.nc auto2.nc || fail "build: bins from a pilot depend on the threads"
expect 0 '^States: .* pilot trials' "$gatewalk" show auto.nc --details
"$gatewalk" show auto.nc --json auto-show.json --quiet
# A symmetric scene has symmetric bins: EN's states in the order of d, then vx, are mirrored.
holds '[.rows[] | select(.boundary == "EN") | .vx_m_per_s] | flatten | unique | map(. + 0) | . == (map(-.) | sort)' <(jq '.rows |= .[:-1]' auto-show.json)
expect 0 '^State of the chain at the start: EN d 0 m, vx 0 m/s, vy 0.4 m/s' "$gatewalk" predict auto.nc --details
expect 0 'beyond every entry that the bins were made from' "$gatewalk" predict auto.nc --start 0,0,9 --quiet
# If the bins do not resolve how bodies move, a warning says so, and what to do.
expect 0 'the bins are too coarse.*--bins auto' "$gatewalk" build cm.toml --set "bins.EN_vx_m_per_s=[-90, 90]" --set "bins.RD_vx_m_per_s=[-90, 0]" --set "bins.LD_vx_m_per_s=[0, 90]" --trials 1 -o own.nc --quiet
expect 2 'has a table \[bins\]' "$gatewalk" build cm.toml --set "bins.EN_vx_m_per_s=[-1, 1]" --bins auto -o x.nc
expect 2 'no meaning beside --matrix' "$gatewalk" validate cm.toml --matrix auto.nc --bins auto
expect 2 'must be paper, tree, auto' "$gatewalk" build cm.toml --bins many -o x.nc
# validate without --start takes the scene's own start; in the paper's field with the paper's start, Table IV's starts.
"$gatewalk" validate cm.toml --trials 100 --matrix-trials 2 --json own.json --quiet
holds '(.starts | map(.start.vy_m_per_s)) == [0.4] and .state_space.bins == "auto"' own.json
"$gatewalk" validate "$scenes/field.toml" --set start.x_m=3 --matrix m.nc --trials 20 --json own.json --quiet
holds '(.starts | map(.start.d_m)) == [3]' own.json
# A scene's own edges are stored with the matrix; another scene's edges count as a difference.
{ cat "$scenes/field.toml"; printf '[bins]\nEN_d_m = [-25, -5, 5, 25]\nEN_vx_m_per_s = [-20, 0, 20]\n'; } >bins.toml
expect 0 'transition matrix of 68 states (68 rows, 69 columns' "$gatewalk" build bins.toml --trials 2 -o bins.nc --json bins.json
holds '.bins == "scene" and .state_space.outermost_bins == "closed"' bins.json
expect 0 '^trapped' "$gatewalk" predict bins.nc bins.toml
expect 2 '\[bins\]: none here, edges of its own there' "$gatewalk" predict bins.nc "$scenes/field.toml"
printf '[bins]\nEN_d_m = [5, -5]\n' >bad-bins.toml
expect 2 'bad-bins.toml:2: bins.EN_d_m' "$gatewalk" build bad-bins.toml -o x.nc

# A field in other units (lengths x 16, times x 4, masses / 16) has the same counts.
sed -e 's/^impulse_threshold_Ns.*/impulse_threshold_Ns = 0.01/' -e 's/^mass_kg = 1.0/mass_kg = 0.0625/' -e 's/^mass_kg = 0.1/mass_kg = 0.00625/' \
  -e 's/^radius_m.*/radius_m = 160/' -e 's/^length_m.*/length_m = 400/' -e 's/^joint_x_m.*/joint_x_m = 400/' -e 's/^joint_y_m.*/joint_y_m = 480/' \
  -e 's/^traverse_y_m.*/traverse_y_m = 960/' -e 's/^random_rate_Hz.*/random_rate_Hz = 12.5/' -e 's/^drag_Ns_per_m.*/drag_Ns_per_m = 0.0009375/' \
  -e 's/^propulsion_N.*/propulsion_N = 0.4375/' -e 's/^random_N.*/random_N = 3.125/' -e 's/^vy_m_per_s.*/vy_m_per_s = 60/' \
  -e 's/^\(stiffness_[a-z]*_Nm_per_rad\).*/\1 = 400/' -e 's/^damping_Nms_per_rad.*/damping_Nms_per_rad = 200/' \
  -e 's/^time_limit_s.*/time_limit_s = 48.0\nstep_s = 0.08\nevent_tolerance_m = 0.16/' "$scenes/field.toml" >twin.toml
for bins in paper auto; do
  "$gatewalk" build "$scenes/field.toml" --set run.method=moreau --set run.step_s=0.01 --bins $bins --trials 2 -o one.nc --quiet >/dev/null 2>&1
  "$gatewalk" build twin.toml --set run.method=moreau --set run.step_s=0.04 --bins $bins --trials 2 -o two.nc --quiet >/dev/null 2>&1
  "$gatewalk" show one.nc --json one.json --quiet
  "$gatewalk" show two.nc --json two.json --quiet
  jq -s '[.[].rows | map([.trials, .clamped, .outputs])] | .[0] == .[1]' one.json two.json | grep -q true || fail "build --bins $bins: a twin has other counts"
  jq -s '(.[0].rows | map(.vx_m_per_s | map(. * 4))) == (.[1].rows | map(.vx_m_per_s))' one.json two.json | grep -q true || fail "build --bins $bins: a twin has other bins"
done

finish
