#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests landscape: the grid and its passes, in any units.   landscape_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

# The paper's grid, the pass of its equal beams, three files.
"$gatewalk" landscape "$scenes/single_gate.toml" -o land --trials 20 --quiet --set beams.stiffness_left_Nm_per_rad=500 \
  --set beams.stiffness_right_Nm_per_rad=500 >land.txt || fail "landscape"
holds '.passes[0].from_start.barrier_J | . > 32 and . < 32.1' land/landscape.json
holds '.passes[1].above_start_J | . > 18.15 and . < 20' land/landscape.json
[ "$(wc -l <land/landscape.csv)" = $((101 * 131 + 1)) ] || fail "landscape.csv has $(wc -l <land/landscape.csv) lines"
grep -q 'simulated runs traverse the gate' land.txt && [ -s land/landscape.svg ] || fail "landscape: $(cat land.txt)"
expect 0 'there is no basin' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --set beams.stiffness_left_Nm_per_rad=100
expect 0 '' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --beam right
expect 2 'must be both' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --beam top
expect 2 'must lie in' "$gatewalk" landscape "$scenes/single_gate.toml" -o land --spacing 0
expect 2 'missing -o' "$gatewalk" landscape "$scenes/single_gate.toml"
# In other units (lengths / 4^5, masses * 4^2) the grid and the passes are the same; videos keep the scene's own pace.
twin="--set body.radius_m=0.009765625 --set body.mass_kg=16 --set beams.length_m=0.0244140625 --set beams.mass_kg=1.6 --set beams.damping_Nms_per_rad=0.000762939453125
  --set beams.joint_x_m=0.0244140625 --set beams.joint_y_m=0.029296875 --set run.traverse_y_m=0.0634765625
  --set beams.stiffness_left_Nm_per_rad=0.00762939453125 --set beams.stiffness_right_Nm_per_rad=0.00762939453125
  --set forces.propulsion_N=0.109375 --set forces.random_N=0.15625"
# shellcheck disable=SC2086
{
"$gatewalk" landscape "$scenes/single_gate.toml" -o land --quiet --set beams.stiffness_left_Nm_per_rad=500 --set beams.stiffness_right_Nm_per_rad=500 >/dev/null
"$gatewalk" landscape "$scenes/single_gate.toml" -o land-twin --quiet $twin >land-twin.txt || fail "landscape in other units"
jq '.spacing_m, (.passes[].from_start.energy_J, .passes[].from_basin.barrier_J), .passes[].from_basin.y_m' land/landscape.json >land.list
jq '.spacing_m * 1024, (.passes[].from_start.energy_J, .passes[].from_basin.barrier_J) * 65536, .passes[].from_basin.y_m * 1024' land-twin/landscape.json >land-twin.list
cmp -s land.list land-twin.list && [ "$(wc -l <land.list)" = 7 ] || fail "landscape in other units: $(paste land.list land-twin.list)"
[ "$(wc -l <land-twin/landscape.csv)" = "$(wc -l <land/landscape.csv)" ] || fail "landscape in other units: another grid"
expect 2 'video-speed: must lie in \[0.01, 100\]' "$gatewalk" trace "$scenes/field.toml" --video v.mp4 --video-speed 101
expect 2 'video-speed: must lie in \[2.56, 25600\]' "$gatewalk" trace "$scenes/field.toml" --video v.mp4 --video-speed 2 --set forces.random_rate_Hz=0.1953125 \
  --set forces.propulsion_N=0.0001 --set forces.random_N=0.0001
}

finish
