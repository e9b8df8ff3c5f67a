// SPDX-License-Identifier: MIT
#pragma once
/// What a posterior is made from: how trials of an experiment ended, or recorded passages, and how
/// to make the like of them.

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

/// How trials end: gates where gates were counted (row * columns + column), endings where endings
/// were, and for lines of trials with both, each ending's gates: ending * gates + gate. Passages:
/// from entries that are alike to a face, or trapped, begin * (faces + 1) + face. Where times were
/// measured each of these has parts, by when a body left: way * parts + part.
struct FittedOutcomes {
  std::size_t gates = 0;  // 0: endings alone
  bool endings = false;
  std::vector<double> times{};  // s, rising: between the parts; none: one part
  /// In words, of passages: how they begin, as leaves of a tree for each type of cell; and faces.
  std::vector<std::string> begins{}, faces{};

  [[nodiscard]] bool is_of_passages() const { return !begins.empty(); }
  [[nodiscard]] std::size_t parts() const { return times.size() + 1; }
  [[nodiscard]] std::size_t size() const;
  /// So many, one behind the other, are of the same ending, or of passages that begin alike.
  [[nodiscard]] std::size_t together() const;
};

struct FitData {
  FittedOutcomes outcomes;
  std::vector<std::int64_t> seen;  // (outcomes.size())
  std::vector<std::size_t> order;  // of outcomes, in which neighbours are alike
  /// Runs these trials, or passages, in a field: the outcome of each; -1 where a run broke.
  using Run =
      std::function<dynamics::Health(const Problem& problem, std::uint64_t seed,
                                     dynamics::TrialRange range, std::span<std::int32_t> ended)>;
  Run run;
  /// Passages that begin well inside an obstacle: places are wrong, or obstacles.
  std::int64_t inside = 0;
};

/// Of a model of degree 2: so many are fitted in a second.
inline constexpr double kMostParameters = 600.0;
/// The share of all trials that a group of outcomes has at least: a hundredth; more where there are
/// many numbers; and so much that by chance in the model of all groups the likelihood of what was
/// observed seems to tell a fourth of what the range does, or less.
[[nodiscard]] double least_share(int numbers, double trials, double observed);

/// Trials from the problem's start. Throws std::invalid_argument for counts of another field, of
/// both gates and endings without saying which belong together, and of none.
[[nodiscard]] FitData trials_to_fit(const Observed& observed, const Problem& problem);

/// Passages through the types of cells of these problems, each from where it was seen to begin, by
/// bodies that remember nothing; those that broke are left out. They are told apart by where and
/// how they begin as finely as so many trials of a fit permit, mirror images not where all cells
/// are symmetric. Throws std::invalid_argument where none is left, and for costs of a passage that
/// left that are not finite.
[[nodiscard]] FitData passages_to_fit(const std::vector<EnteredPassage>& seen, int numbers,
                                      const ProblemAt& problem_at, std::int64_t trials);

}  // namespace gatewalk::lattice
