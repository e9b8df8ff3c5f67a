// SPDX-License-Identifier: MIT
#include "cli/render/tested_shares.h"

#include <algorithm>
#include <cmath>

#include "cli/render/final_gates.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::cli {

std::optional<std::size_t> named_share(const std::vector<TestedShare>& shares, double p_of_gates,
                                       double level) {
  const bool any = std::ranges::any_of(shares, [&](const TestedShare& s) { return s.p <= level; });
  if (!any && p_of_gates <= level) return {};
  constexpr double kRounding = 1e-12;  // of shares that differ alike, the first is named
  std::optional<std::size_t> most;
  for (std::size_t k = 0; k < shares.size(); ++k)
    if ((!any || shares[k].p <= level) &&
        (!most || shares[k].difference > shares[*most].difference + kRounding))
      most = k;
  return most;
}

double p_of_gates(const lattice::JointTest& j) {
  double least = std::nan("");
  for (const double p :
       {j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted})
    least = std::fmin(least, p);
  return least;
}

std::string name_of(markov::Ending ending) {
  return ending == markov::Ending::unsampled ? "never sampled" : ending_name(ending).name;
}

}  // namespace gatewalk::cli
