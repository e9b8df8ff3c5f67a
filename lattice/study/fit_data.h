// SPDX-License-Identifier: MIT
#pragma once
/// The data of a fit: how trials of an experiment ended, or recorded passages, and how to simulate
/// such data.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/field/passage_table.h"
#include "lattice/field/problem.h"
#include "lattice/study/observed.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::lattice {

/// The kinds of outcomes, numbered. Trials: gates (row * columns + column), or endings, or for
/// lines of trials with both: ending * gates + gate. Passages: from beginnings that are alike to a
/// face, or trapped: begin * (faces + 1) + face. With measured times each of these has parts, by
/// the time at which a body left: way * parts + part.
struct FittedOutcomes {
  std::size_t gates = 0;  // 0: endings only
  bool endings = false;
  std::vector<double> times{};  // s, ascending: limits between the parts; empty: a single part
  /// Names for passages: beginnings (leaves of a tree for each type of cell), and faces.
  std::vector<std::string> begins{}, faces{};

  [[nodiscard]] bool is_of_passages() const { return !begins.empty(); }
  [[nodiscard]] std::size_t parts() const { return times.size() + 1; }
  [[nodiscard]] std::size_t size() const;
  /// Number of consecutive outcomes that belong to one ending, or to passages that begin alike.
  [[nodiscard]] std::size_t together() const;
};

/// Observed counts of outcomes, and a simulation of them.
struct FitData {
  FittedOutcomes outcomes;
  std::vector<std::int64_t> seen;  // (outcomes.size())
  std::vector<std::size_t> order;  // of outcomes, so that neighbours are alike
  /// Runs these trials, or passages, in a field, and writes the outcome of each; -1 if a run broke.
  using Run =
      std::function<dynamics::Health(const Problem& problem, std::uint64_t seed,
                                     dynamics::TrialRange range, std::span<std::int32_t> ended)>;
  Run run;
  /// Passages that begin well inside an obstacle, which shows that places or obstacles are wrong.
  std::int64_t inside = 0;
};

/// Most parameters of a model of degree 2, which is fitted in a second.
inline constexpr double kMostParameters = 600.0;
/// The least share of all trials in a group of outcomes: a hundredth, and more for many numbers. It
/// is also large enough that sampling error in the model of all groups changes the likelihood of
/// the observations by at most a fourth of what the range does.
[[nodiscard]] double least_share(int numbers, double trials, double observed);

/// Fits trials from the problem's start. Throws std::invalid_argument for counts of another field,
/// gates and endings without knowing which belong together, and no counts.
[[nodiscard]] FitData trials_to_fit(const Observed& observed, const Problem& problem);

/// Fits passages through the types of cells of these problems, each from where it was seen to
/// begin, by bodies without memory; broken passages are left out. Beginnings are distinguished as
/// finely as the number of trials of a fit permits, mirror images only if some cell is not
/// symmetric. Throws std::invalid_argument if no passage is left, and if the cost of a passage that
/// left is not finite.
[[nodiscard]] FitData passages_to_fit(const std::vector<EnteredPassage>& seen, int numbers,
                                      const ProblemAt& problem_at, std::int64_t trials);

}  // namespace gatewalk::lattice
