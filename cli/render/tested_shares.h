// SPDX-License-Identifier: MIT
#pragma once
/// Of the shares that were tested together: the one that a screen names.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lattice/statistics/ending_shares.h"

namespace gatewalk::lattice {
struct JointTest;
}

namespace gatewalk::cli {

/// How much two shares of an ending differ, and the p-value, adjusted for all that is tested.
struct TestedShare {
  markov::Ending ending;
  double difference, p;
};
/// Adds the shares of all endings in the order of tables, then those of states never sampled.
template <class Tests>
void add_tested(std::vector<TestedShare>& shares, const Tests& endings) {
  const auto add = [&](markov::Ending ending) {
    const auto& test = endings[static_cast<std::size_t>(ending)];
    shares.push_back({ending, test.seen, test.p_adjusted});
  };
  for (const lattice::EndingName& e : lattice::kAllEndingNames) add(e.ending);
  add(markov::Ending::unsampled);
}

/// The index of the share to name: of the shares with p at most `level`, the one that differs most.
/// If there are none: nullopt if the final gates differ (`p_of_gates` at most `level`), else the
/// share that differs most of all.
[[nodiscard]] std::optional<std::size_t> named_share(const std::vector<TestedShare>& shares,
                                                     double p_of_gates, double level);
/// The sentence of a screen that names no share.
inline constexpr const char* kOnlyGatesDiffer =
    "No ending differs by more than chance; the final gates do.\n";

/// The smallest adjusted p-value of the final gates; NaN if they were not counted.
[[nodiscard]] double p_of_gates(const lattice::JointTest& j);

/// The name of an ending in tables; of Ending::unsampled: "never sampled".
[[nodiscard]] std::string name_of(markov::Ending ending);

}  // namespace gatewalk::cli
