#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which propulsion and random force did the paper use in its field? It does not say.
# For F_prop 5..9 N x Rm 10..60 N: the four corrcoef and RMSE of Table IV, exact chain (100 runs per
# row) against 100 trials of the full dynamics, mean and sd over many repeats (15 blocks of 100 trials
# for each of 3 seeds, every seed with a matrix of its own).
#   results/field_scan/run.sh [GATEWALK]      about 8 minutes on two cores
# misfit: sum over the starts of the squared distance of the printed (corrcoef, RMSE) from ours in its
# 2 x 2 covariance, 8 on average if the scene were the paper's; deviance: -2 log likelihood, up to a
# constant. Writes scan.csv (a line per scene), starts.csv (a line per scene and start), scan.svg, manifest.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
gatewalk=${1:-$root/build/gatewalk}
. "$root/results/manifest.sh"
seeds="1 2 3"
trials=1500
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for f in 5 6 7 8 9; do
  for rm in 10 20 30 40 50 60; do
    for seed in $seeds; do
      "$gatewalk" validate "$root/scenes/field.toml" --trials $trials --seed "$seed" --null-draws 1 --quiet \
        --set forces.propulsion_N=$f --set forces.random_N=$rm --json "$work/$f-$rm-$seed.json"
    done
    jq -s --argjson f $f --argjson rm $rm '
      def mean: add / length;
      # Mean of one 100-trial experiment and its sd: within a matrix, and from matrix to matrix.
      def pooled(name): map(.at_100_trials[name].mean) as $m | ($m | mean) as $mu
        | {mean: $mu, sd: ((map(.at_100_trials[name].sd | . * .) | mean)
                           + ($m | map((. - $mu) * (. - $mu)) | add / (length - 1)) | sqrt)};
      . as $runs
      | [range(0; 4) as $i
         | [$runs[].starts[$i]]
         | {start: .[0].start, paper: .[0].paper,
            corr: pooled("exact_corrcoef"), rmse: pooled("exact_rmse_per_100"),
            r: (map(.at_100_trials.exact_corrcoef_rmse_correlation) | mean),
            walks_corr: pooled("walks_corrcoef"), walks_rmse: pooled("walks_rmse_per_100"),
            trapped: (map(.fates.dynamics.trapped) | mean),
            tv: (map(.exact.total_variation) | mean)}
         | .a = (.paper.corrcoef - .corr.mean) / .corr.sd
         | .b = (.paper.rmse_per_100 - .rmse.mean) / .rmse.sd
         # Squared distance of the printed pair from our mean, in its own 2 x 2 covariance.
         | .misfit = (.a * .a - 2 * .r * .a * .b + .b * .b) / (1 - .r * .r)
         | .deviance = .misfit + 2 * ((.corr.sd * .rmse.sd | log) + 0.5 * (1 - .r * .r | log))]
      | {f: $f, rm: $rm, starts: ., misfit: (map(.misfit) | add), deviance: (map(.deviance) | add),
         clamped: ($runs | map(.crossings.clamped_share) | mean),
         sides: ($runs | map(.crossings.RT_and_LT_share) | mean)}' \
      "$work/$f-$rm"-*.json >"$work/scene-$f-$rm.json"
    echo "F_prop $f N, Rm $rm N: misfit $(jq '.misfit * 10 | round / 10' "$work/scene-$f-$rm.json")" >&2
  done
done

jq -rs '["propulsion_N","random_N","misfit","deviance","corrcoef_mean","rmse_mean","clamped_share","RT_LT_share","trapped_share","total_variation"],
  (sort_by(.f, .rm)[] | [.f, .rm, .misfit, .deviance, (.starts | map(.corr.mean) | add / 4), (.starts | map(.rmse.mean) | add / 4),
   .clamped, .sides, (.starts | map(.trapped) | add / 4), (.starts | map(.tv) | add / 4)]
   | map(if . == null then "" else (. * 10000 | round / 10000) end)) | @csv' "$work"/scene-*.json | tr -d '"' >"$here/scan.csv"
jq -rs '["propulsion_N","random_N","d_m","vx_m_per_s","vy_m_per_s","paper_corrcoef","corrcoef_mean","corrcoef_sd","paper_rmse","rmse_mean","rmse_sd","walks_corrcoef_mean","walks_rmse_mean"],
  (sort_by(.f, .rm)[] | . as $s | .starts[] | [$s.f, $s.rm, .start.d_m, .start.vx_m_per_s, .start.vy_m_per_s,
   .paper.corrcoef, .corr.mean, .corr.sd, .paper.rmse_per_100, .rmse.mean, .rmse.sd, .walks_corr.mean, .walks_rmse.mean]
   | map(if . == null then "" else (. * 10000 | round / 10000) end)) | @csv' "$work"/scene-*.json | tr -d '"' >"$here/starts.csv"

{
  manifest "results/field_scan/run.sh"
  echo "trials: $trials per start and seed, seeds $seeds, matrices of 100 runs per row"
} >"$here/manifest.txt"

gnuplot -c "$here/plot.gp" "$here/scan.csv" "$here/scan.svg"
light_or_dark "$here/scan.svg"
