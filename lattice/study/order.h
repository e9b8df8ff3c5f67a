// SPDX-License-Identifier: MIT
#pragma once
/// What must a chain remember? The least number of letters (turns, faces or states of the cells
/// before; dynamics/cells/words.h) with which a chain predicts bodies as well as with more.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/tree_space.h"
#include "dynamics/cells/words.h"
#include "lattice/field/problem.h"
#include "lattice/pool/run_pool.h"
#include "lattice/study/cross_validation.h"
#include "lattice/study/remembering.h"

namespace gatewalk::lattice {

struct OrderOptions {
  dynamics::LettersOf of = dynamics::LettersOf::turns;
  int least = 0, most = 4;  // orders to compare
  std::uint64_t seed = 1;   // of the parts of the bodies, and of the draws
  int per_leaf = dynamics::kEntriesPerLeaf;
  bool with_halves = true;  // whether to predict one half of the bodies from the other
};

/// A chain that remembers this number of letters.
struct OrderAnswer {
  int order = 0;
  std::int64_t words = 0;     // of the chain of all bodies
  std::int64_t left_out = 0;  // words that such a chain has no room for (Words::kMostLabels)
  /// The geometric mean of the probabilities that the chain of other bodies gave to the next face
  /// (or to being trapped) of each passage: that of order 0, times what each further letter adds.
  double likelihood = 0.0;
  /// By how much that of the best order is larger, as a share of it, with simultaneous 95 %
  /// intervals.
  double gain_to_best = 0.0;
  std::array<double, 2> interval{};
  /// One half of the bodies predicted by the chain of the other; empty if not asked for.
  CrossValidation halves{};

  /// Whether the best order is not known to be better.
  [[nodiscard]] bool is_enough() const { return interval[0] <= 0.0; }
};

/// What a chain would gain that knew the numbers that bodies remember (Cell::remembered), above one
/// of the chosen order.
struct RememberedAnswer {
  std::vector<std::string> keys;  // of the numbers
  /// Passages whose numbers could tell something. 0: the numbers do not vary, or too few passages
  /// are alike; then nothing else is known.
  std::int64_t passages = 0;
  /// By how much the likelihood of such a passage was larger, as a share of it, with a 95 %
  /// interval. A chain of more bodies can gain more.
  double gain = 0.0;
  std::array<double, 2> interval{};
  /// Whether the chain is known to forget something that matters.
  [[nodiscard]] bool matters() const { return interval[0] > 0.0; }
};

struct OrderStudy {
  dynamics::LettersOf of = dynamics::LettersOf::turns;
  std::vector<OrderAnswer> orders;
  std::size_t best = 0;                   // index of the order with the largest likelihood
  std::size_t chosen = 0;                 // index of the least order that is enough
  std::int64_t bodies = 0, passages = 0;  // passages with a known outcome
  /// The halves are compared after this number of cells: that of the field (0: at the end of every
  /// trial); if the field has no limit and not all trials were seen to their ends, the number that
  /// nine of ten trials pass.
  int max_gates = 0;
  std::optional<RememberedAnswer> remembered{};  // empty: bodies remember no numbers

  [[nodiscard]] const OrderAnswer& answer() const { return orders[chosen]; }
  /// Whether the largest order that was tried may be too small.
  [[nodiscard]] bool may_need_more() const { return chosen + 1 == orders.size() && chosen > 0; }
};

/// Compares the orders by ten-fold cross-validation over bodies. The probability of an outcome in
/// the leaf of an order is smoothed with that of the order before (Chances::learn). What a letter
/// adds is the gain over letters that are shuffled among passages alike but for it: even without
/// memory, a second tree of the same entries predicts better than one. The intervals of the
/// differences to the best order are simultaneous, by draws of bodies with replacement and the
/// spread between seven shuffles. Chosen is the least order whose interval contains 0. Throws
/// std::invalid_argument for fewer than 2 kLeastBodies bodies, and as cross_validate.
///
/// `remembering`: the same bodies with what they remember. What they gain by it is found as for a
/// letter: against numbers of other passages that say as much of the entry, as far as that is
/// linear in a leaf.
[[nodiscard]] OrderStudy study_order(const Problem& problem, const RunPool& pool,
                                     const OrderOptions& options, const dynamics::Work& work = {},
                                     const Remembering* remembering = nullptr);

}  // namespace gatewalk::lattice
