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
};

/// 95 % interval of a share that is predicted from all trials, `whole`, and from each of
/// kTrialGroups groups of them: Jeffreys' of as many independent trials as would make the relative
/// error that the groups show, so that it leans to the side where few were seen. It is no narrower
/// than if each gate run were a trial. Where none or all of the trials end so, it is theirs.
/// `besides`: half of the interval that an error makes which the groups have in common.
[[nodiscard]] std::array<double, 2> share_95(double whole, const std::vector<double>& groups,
                                             const Evidence& from, double besides = 0.0);

/// 95 % interval of a share that a matrix predicts, `own`, from the middle 95 % of what resampled
/// ones do (MatrixNoise). Where these show no spread, it is what the trials `from` the row that all
/// walks begin in leave open; of small rows, which hold nothing that no run showed, it is no
/// narrower than if each of their gate runs were a trial (0: rows are not small).
[[nodiscard]] std::array<double, 2> resampled_95(const std::array<double, 2>& middle, double own,
                                                 const Evidence& from);

/// Between what lie the middle 95 % of what was drawn (one at least), and `own`.
[[nodiscard]] std::array<double, 2> middle_95(std::vector<double> drawn, double own);

}  // namespace gatewalk::lattice
