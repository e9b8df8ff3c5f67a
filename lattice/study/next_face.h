// SPDX-License-Identifier: MIT
#pragma once
/// The chances of what a passage leads to, the next face or being trapped, as learned from the
/// passages of other bodies.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/cells/words.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// A passage with a known outcome: a face, or the number of faces for being trapped.
struct Step {
  std::int32_t body = 0;
  int type = 0;
  dynamics::Entry entry{};
  int outcome = 0;
  std::vector<int> letters{};  // of the passages before, the latest at the end
  std::size_t number = 0;      // of the passage; that of its mirror image too
  bool is_image = false;       // whether it is a mirror image
  bool is_first = false;       // whether it begins a trial
};

/// The passages of all bodies, and the mirror images of those through symmetric cells.
struct Steps {
  std::vector<Step> seen, images;
};
/// `most`: the largest number of letters of a step.
[[nodiscard]] Steps steps_of(const dynamics::CellMap& map, const RunPool& pool,
                             const dynamics::Letters& letters, int most);

/// Where a step stands at one order: type, face, then the last letters. A body that has fewer
/// letters stands nowhere.
using Standing = std::vector<int>;
using StandingOf = std::function<std::optional<Standing>(const Step&)>;
[[nodiscard]] std::optional<Standing> standing(const Step& step, int order);
/// The same with another letter as the earliest of them.
[[nodiscard]] std::optional<Standing> standing(const Step& step, int order, int earliest);

/// Numbers that go with steps, and where a step stands; steps that stand alike are grouped by them.
struct Shown {
  dynamics::Section section;  // one face, and the numbers as its coordinates
  std::function<dynamics::Entry(const Step&)> of;
  StandingOf at;
};

/// The group of each step: the leaf of a tree of the numbers of the steps that stand alike, with
/// `per_leaf` of them or more. -1 for a step that stands nowhere.
[[nodiscard]] std::vector<int> groups_of(const std::vector<const Step*>& steps, const Shown& shown,
                                         int per_leaf);

/// The chances of the outcomes of a body's own steps, learned from the steps of others; and those
/// of each of the others, learned from the rest of them.
class Chances {
 public:
  /// Before anything is learned, all outcomes are as likely.
  Chances(std::vector<const Step*> own, std::vector<const Step*> others, int outcomes);

  /// Learns from how often each outcome was seen in a step's group, smoothed with what was known
  /// before (a hierarchical Dirichlet model; MacKay and Peto, Nat. Lang. Eng. 1, 1995). The weight
  /// of what was known is the one that predicts the others best. `per_leaf` 0: groups are all steps
  /// that stand alike.
  void learn(const Shown& shown, int per_leaf);
  /// Learns by which factor each outcome is seen more often in a step's group than the chances so
  /// far expect. So numbers that change the chances everywhere alike count in large groups, with no
  /// loss of what is known of the single step. Returns the number of own steps for which the
  /// numbers could tell something: where they stand, there are several groups.
  std::int64_t learn_factors(const Shown& shown, int per_leaf);

  /// Adds the log likelihood of each of the own steps to its body's score.
  void add_to(std::vector<double>& scores) const;

 private:
  std::vector<const Step*> own_, others_;
  std::size_t outcomes_;
  std::vector<double> of_own_, of_others_;  // (steps x outcomes)
};

}  // namespace gatewalk::lattice
