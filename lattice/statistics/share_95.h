// SPDX-License-Identifier: MIT
#pragma once
/// What a predicted share may be: one rule for endings, gates and chances, also of those that none
/// or all of the trials show.

#include <array>
#include <vector>

namespace gatewalk::lattice {

/// Shares, and differences of shares, below this are rounding.
inline constexpr double kShareRounding = 1e-12;

/// What a share was predicted from: independent trials, and all their gate runs.
struct Evidence {
  double trials = 0.0, gate_runs = 0.0;
  /// The largest share of all walks that one row of a matrix may send elsewhere, as all its runs
  /// had one outcome and were too few to exclude another.
  double hidden = 0.0;
};

/// 95 % interval of a share that is predicted from all trials, `whole`, and from each of
/// kTrialGroups groups of them: Jeffreys' of as many independent trials as would make the relative
/// error that the groups show, so that it leans to the side where few were seen. It is no narrower
/// than if each gate run were a trial. Where none or all of the trials end so, it is theirs.
/// `besides`: half of the interval that an error makes which the groups have in common.
[[nodiscard]] std::array<double, 2> share_95(double whole, const std::vector<double>& groups,
                                             const Evidence& from, double besides = 0.0);

/// 95 % interval of a share that a matrix predicts, `own`, from what resampled ones predict (one at
/// least; MatrixNoise): their middle 95 %. Where `own` does not lie within these, as their
/// distribution is skewed, it is Jeffreys' interval of as many independent trials as would vary
/// like them. Where they show no spread, it is what the trials `from` the row that all walks begin
/// in leave open. Resampled rows hold nothing that no run showed. So the interval is no narrower
/// than if each gate run were a trial (gate_runs 0: may be narrower), nor than what a row of one
/// outcome hides.
[[nodiscard]] std::array<double, 2> resampled_95(std::vector<double> drawn, double own,
                                                 const Evidence& from);

/// Walks that were not followed to their end, `unfinished` of all, may add to a share, and
/// `rounding` takes from it or adds: the interval with both. Without an interval (NaN): what the
/// share may be. As it is where both are less than any digit that is shown.
[[nodiscard]] std::array<double, 2> with_unfinished(const std::array<double, 2>& interval,
                                                    double share, double unfinished,
                                                    double rounding);

}  // namespace gatewalk::lattice
