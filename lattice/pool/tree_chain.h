// SPDX-License-Identifier: MIT
#pragma once
/// A chain whose states are leaves of trees: how it is made, what its file keeps, and how it serves
/// a start that is not a state of its own.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"

namespace gatewalk::lattice {

/// What a chain of trees is made for.
struct TreeOptions {
  AccuracyOptions accuracy{};
  std::vector<dynamics::Entry> starts{};  // starts that become states of their own
  std::optional<StartRange> range{};      // range of starts that the chain must serve
  std::optional<int> most_states{};       // without the starts
};

/// A chain of trees with the runs behind it.
struct TreeChain {
  RunPool pool;
  Kernel kernel;
  /// By gate type; the first one has the health of all runs.
  std::vector<dynamics::Transitions> transitions;
  int per_leaf = dynamics::kEntriesPerLeaf;
  /// For the starts, before the number of states was limited.
  std::optional<PooledPrediction> prediction;
  std::optional<PooledRange> range;
  /// Total variation of the final gates caused by the limit of states; 0 without one.
  double states_bias = 0.0;
  /// All full trials of the pool against this chain; nullopt if answers come from Monte Carlo
  /// walks.
  std::optional<HausmanCheck> hausman_check{};
  std::vector<AssumptionCheck> assumptions{};  // of this chain, for the same trials
};

/// Makes a chain whose error bar is at most the accuracy for each of the starts, and half of that
/// for any start of the range. The other half is for the start's own first runs, and for the worst
/// of many starts. Throws as predict_pooled and pool_range; std::invalid_argument for neither
/// starts nor range, and for fewer states than faces.
[[nodiscard]] TreeChain make_tree_chain(const Problem& problem, const TreeOptions& options,
                                        const dynamics::Work& work = {});

/// The part of a range's accuracy that the error bar of a single start must keep.
inline constexpr double kPartForOne = 0.5;

/// Converts a pool's runs to arrays of a matrix file, and back. Endings of a start's full trials
/// are known only if these ran in the scene's field. Throws markov::BadFile naming `path` if the
/// arrays are inconsistent.
[[nodiscard]] std::vector<markov::NamedArray> arrays_of(const RunPool& pool,
                                                        const dynamics::Section& section);
/// The array with the type of gate of each run, by number; only if there are several types.
inline constexpr const char* kRunTypes = "run_type";
[[nodiscard]] bool has_runs(const MatrixFile& file);
[[nodiscard]] RunPool pool_of(const MatrixFile& file, const Problem& problem,
                              const std::string& path);

/// The matrices of a pool, by cell type, with these starts as states of their own. Each start needs
/// runs of its own.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(
    const Problem& problem, const RunPool& pool, const std::vector<dynamics::Entry>& starts,
    int per_leaf);

}  // namespace gatewalk::lattice
