// SPDX-License-Identifier: MIT
#pragma once
/// What a matrix file records about its states: what its trees were made for, and how accurate they
/// are.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"

namespace gatewalk::lattice {

/// How the trees of a file were made.
struct TreeInfo {
  int entries_per_leaf = dynamics::kEntriesPerLeaf;
  std::int64_t gate_runs = 0;
  std::optional<double> accuracy{};               // accuracy asked for; none for recorded runs
  std::optional<std::vector<double>> error_95{};  // by start
  std::optional<PooledRange> range{};  // the range of starts that the trees were made for
  double states_bias = 0.0;
  /// Outer nullopt: the file does not say, as files of version 1.0.0.
  std::optional<std::optional<HausmanCheck>> hausman_check{};
  std::vector<AssumptionCheck> assumptions{};  // empty also in files of version 2.0.0 and older

  /// The accuracy that one start can expect: for trees of a range, half of what was asked for.
  [[nodiscard]] double accuracy_of_one() const;
  /// Number of these starts that lie outside the range and are not states of their own.
  [[nodiscard]] std::int64_t outside(const dynamics::StateSpace& space,
                                     const std::vector<dynamics::Entry>& starts) const;
};
[[nodiscard]] TreeInfo tree_info(const TreeChain& chain, double accuracy);

/// How the states of a file came about.
struct StatesInfo {
  std::string kind = "imported";   // "paper", "auto", "scene" (bins); "tree"; "imported"
  bool are_probabilities = false;  // imported probabilities, without counts
  std::optional<TreeInfo> trees{};

  [[nodiscard]] bool is_imported() const { return kind == "imported"; }
};
/// Reads the record that a file keeps, in JSON. Throws std::invalid_argument if it is damaged.
[[nodiscard]] StatesInfo states_info(std::string_view record, const dynamics::Section& section);
/// Reads the record of a file; nullopt if the file has none. Throws markov::BadFile naming `path`
/// if the record is damaged.
[[nodiscard]] std::optional<StatesInfo> states_info(const MatrixFile& file,
                                                    const std::string& path);
/// The record of a file of trees; the defaults for any other file.
[[nodiscard]] TreeInfo tree_info(const MatrixFile& file, const std::string& path);
/// The key of the record in a matrix file's text.
inline constexpr const char* kStatesText = "state_space";

}  // namespace gatewalk::lattice
