// SPDX-License-Identifier: MIT
#pragma once
/// What a matrix file records of how its states came about: what trees were made for, and how well
/// they serve that.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"

namespace gatewalk::lattice {

/// Of states that are leaves of trees.
struct TreeInfo {
  int entries_per_leaf = dynamics::kEntriesPerLeaf;
  std::int64_t gate_runs = 0;
  std::optional<double> accuracy{};               // that was asked for; none of recorded runs
  std::optional<std::vector<double>> error_95{};  // by start
  std::optional<PooledRange> range{};             // of starts that the trees were made for
  double states_bias = 0.0;
  /// None: the file does not say, as those of version 1.0.0.
  std::optional<std::optional<HausmanCheck>> hausman_check{};

  /// That one start can expect: of trees for a range half of what was asked for.
  [[nodiscard]] double accuracy_of_one() const;
  /// How many of these starts lie outside the range, and are no states of their own.
  [[nodiscard]] std::int64_t outside(const dynamics::StateSpace& space,
                                     const std::vector<dynamics::Entry>& starts) const;
};
[[nodiscard]] TreeInfo tree_info(const TreeChain& chain, double accuracy);

struct StatesInfo {
  std::string kind = "imported";   // "paper", "auto", "scene"; "tree"; "imported": from elsewhere
  bool are_probabilities = false;  // of a chain from elsewhere: without counts
  std::optional<TreeInfo> trees{};

  [[nodiscard]] bool is_imported() const { return kind == "imported"; }
};
/// Of the record as the file keeps it, in JSON. Throws std::invalid_argument for one that is
/// damaged.
[[nodiscard]] StatesInfo states_info(std::string_view record, const dynamics::Section& section);
/// Of a file; none where it has no record. Throws markov::BadFile naming `path` for one that is
/// damaged.
[[nodiscard]] std::optional<StatesInfo> states_info(const MatrixFile& file,
                                                    const std::string& path);
/// Of a file of trees; of others what it would be by default.
[[nodiscard]] TreeInfo tree_info(const MatrixFile& file, const std::string& path);
/// The key of a matrix file's text that has the record.
inline constexpr const char* kStatesText = "state_space";

}  // namespace gatewalk::lattice
