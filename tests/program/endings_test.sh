#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Endings with their intervals stand in every result about a field, first in every table; counts and probabilities add
# up.
#   endings_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

paper_matrix m.nc
"$gatewalk" walk m.nc --walks 3000 --json ends-walk.json --quiet
"$gatewalk" predict m.nc --json ends-predict.json --quiet
"$gatewalk" lattice "$scenes/field.toml" --trials 150 --json ends-lattice.json --quiet
holds '(.endings | keys_unsorted) == ["crossed", "left_side", "right_side", "trapped", "cut_off"] and (.endings | add) + .never_sampled == 3000 and .endings.trapped == .trapped and .endings.cut_off == .cut_off and .endings.crossed + .endings.left_side + .endings.right_side == .departed' ends-walk.json
holds '(.endings | add) + .not_finite == 150 and .endings.crossed + .endings.left_side + .endings.right_side == .departed' ends-lattice.json
holds '((.endings | add) + .never_sampled - 1 | fabs) < 1e-12 and .endings.trapped == .trapped and ((.endings | .crossed + .left_side + .right_side) - .departed | fabs) < 1e-12' ends-predict.json
for file in walk predict lattice; do
  holds '(.walks // .trials // 1) as $all | .endings as $e | .endings_95 | to_entries | all(.value[0] <= $e[.key] and $e[.key] <= .value[1] and .value[0] >= 0 and .value[1] <= $all)' ends-$file.json
  holds '((.trapped_gates | flatten | add) - .trapped | fabs) < 1e-12 and ((.departed_gates | flatten | add) - .departed | fabs) < 1e-12' ends-$file.json
  # A body that left was last in the last row or an outer column.
  holds '[.departed_gates[:8][][1:8][]] | add == 0' ends-$file.json
done
# Where along each side: the same bodies, by place in metres; the same of the dynamics beside the chain.
"$gatewalk" predict "$scenes/field.toml" --accuracy 0.1 --details --json ends-trees.json 2>/dev/null >trees.txt
for file in predict lattice trees; do
  holds '(.exits | keys_unsorted) == ["crossed", "left_side", "right_side"] and [.exits[] | length] == [9, 9, 9]' ends-$file.json
  holds '(.endings | add) as $all | .endings as $e | .exits | to_entries | all(((.value | map(.share) | add) - $e[.key] / $all | fabs) < 1e-12)' ends-$file.json
  holds '[.exits[][] | .share_95[0] <= .share and .share <= .share_95[1] and .share_95[0] < .share_95[1]] | all' ends-$file.json
done
holds '.exits | .left_side[1].from_m == 60 and .left_side[8].to_m == 540 and .crossed[0].from_m == -225 and .crossed[4].to_m == 25' ends-predict.json
grep -q '^left side  y 60 to 120 m  *[0-9.]* \[' trees.txt || fail "predict: no place on the left side"
"$gatewalk" lattice "$scenes/field.toml" --trials 150 --quiet --details | grep -q '^left side  y 60 to 120 m' || fail "lattice: no place on the left side"
holds '.matrix_sampling | .replicates == 999 and 0 < .total_variation_mean and .total_variation_mean < .total_variation_q95 and .total_variation_q95 < 1' ends-predict.json
"$gatewalk" predict m.nc --threads 1 --json ends-again.json --quiet
jq -s '.[0].endings_95 == .[1].endings_95' ends-predict.json ends-again.json | grep -q true || fail "predict: intervals depend on the threads"
"$gatewalk" predict m.nc --seed 2 --json ends-again.json --quiet
jq -s '.[0].endings_95 != .[1].endings_95 and .[0].endings == .[1].endings' ends-predict.json ends-again.json | grep -q true || fail "predict: --seed is not that of the intervals"
for args in "walk m.nc" "predict m.nc" "lattice $scenes/field.toml"; do
  "$gatewalk" $args --quiet --details >first.txt 2>/dev/null
  [ "$(head -5 first.txt | cut -c1-11 | tr -d ' ' | tr '\n' ,)" = "crossed,leftside,rightside,trapped,cutoff," ] || fail "$args: the endings do not come first"
  head -5 first.txt | grep -vq '%  \[' && fail "$args: an ending without interval"
  grep -q '^Departed over any side: [0-9.]* %$' first.txt || fail "$args: does not say what departed"
  grep -i 'left the field' first.txt && fail "$args: a second word for departed"
done
"$gatewalk" predict m.nc --quiet --details | grep -q '^Rounding and unfinished walks change all shares' || fail "predict: no numerical bound"
# More runs per row give narrower intervals; a matrix of 10^6 runs per row is also resampled at once.
"$gatewalk" build "$scenes/field.toml" --trials 1 -o one.nc --quiet >/dev/null
"$gatewalk" predict one.nc --json ends-one.json --quiet
holds '.endings_95.trapped | .[1] - .[0] > 0.2' ends-one.json
# A field too large for many predictions has no intervals, and says so.
expect 0 'the field is too large' "$gatewalk" predict m.nc --set field.max_gates=1446 --set field.columns=301 --set field.rows=301 --quiet

"$gatewalk" lattice "$scenes/field.toml" --trials 100 --seed 1 --json lattice.json --quiet
holds '([.final_gates[][]] | add) == 100 and .trapped + .departed + .cut_off + .not_finite == 100' lattice.json
"$gatewalk" lattice "$scenes/field.toml" --set field.max_gates=1 --trials 50 --json one.json --quiet
holds '.final_gates[0][4] == 50' one.json
expect 2 'run.traverse_y_m' "$gatewalk" lattice "$scenes/field.toml" --set run.traverse_y_m=35

finish
