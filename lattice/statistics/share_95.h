// SPDX-License-Identifier: MIT
#pragma once
/// 95 % intervals of predicted shares: one rule for endings, gates and probabilities, also for
/// shares that none or all of the trials show.

#include <array>
#include <vector>

namespace gatewalk::lattice {

/// Shares, and differences of shares, below this are rounding errors.
inline constexpr double kShareRounding = 1e-12;

/// The part of the groups' offset from the whole prediction that counts as the whole's own bias,
/// with up to three coordinates (bias_left()).
inline constexpr double kBiasLeft = 0.75;

/// The evidence behind a predicted share: independent trials, and all their gate runs.
struct Evidence {
  double trials = 0.0, gate_runs = 0.0;
  /// The largest share of all walks that one row of a matrix may send elsewhere, because all runs
  /// of the row had one outcome and were too few to exclude another.
  double hidden = 0.0;
  double bias_left = kBiasLeft;
};

/// 95 % interval of a share predicted from all trials, `whole`, and from each of kTrialGroups
/// groups: the Jeffreys interval for an effective number of independent trials. That number comes
/// from the spread between the groups, and never exceeds the number of gate runs. If none or all of
/// the trials end so, it is the number of trials. `besides`: half-width of an error that the groups
/// have in common.
[[nodiscard]] std::array<double, 2> share_95(double whole, const std::vector<double>& groups,
                                             const Evidence& from, double besides = 0.0);

/// 95 % interval of a share that a matrix predicts, `own`, from the predictions of resampled
/// matrices (at least one; MatrixNoise): their middle 95 %. If `own` lies outside, because their
/// distribution is skewed: the Jeffreys interval for an effective number of trials with the same
/// variance. If they do not vary: the Jeffreys interval for the trials of the start's row.
/// Resampled rows contain no new outcomes, so the interval is never narrower than with each gate
/// run as one trial (gate_runs 0: no such bound), nor than what rows with a single outcome hide.
[[nodiscard]] std::array<double, 2> resampled_95(std::vector<double> drawn, double own,
                                                 const Evidence& from);

/// Widens an interval by walks that were not followed to their end (a share `unfinished` of all,
/// which may only add to the share) and by `rounding` (in both directions). An interval of NaN
/// starts from the share itself. Returns it unchanged if both are smaller than any digit shown.
[[nodiscard]] std::array<double, 2> with_unfinished(const std::array<double, 2>& interval,
                                                    double share, double unfinished,
                                                    double rounding);

}  // namespace gatewalk::lattice
