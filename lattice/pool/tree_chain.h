// SPDX-License-Identifier: MIT
#pragma once
/// A chain whose states are trees: how it is made, what its file keeps, and how it serves a start
/// that it does not know.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"

namespace gatewalk::lattice {

struct TreeOptions {
  AccuracyOptions accuracy{};
  std::vector<dynamics::Entry> starts{};  // that are states of their own
  std::optional<StartRange> range{};      // of starts that it is to be good for
  std::optional<int> most_states{};       // not counting the starts
};

struct TreeChain {
  RunPool pool;
  Kernel kernel;
  /// By types; the first one has the health of all.
  std::vector<dynamics::Transitions> transitions;
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::optional<PooledPrediction> prediction;  // of the starts, before states were limited
  std::optional<PooledRange> range;
  /// Total variation of the final gates that the limit of states makes; 0 without one.
  double states_bias = 0.0;
  /// All full trials of the pool against this chain; none where answers come by walks.
  std::optional<HausmanCheck> hausman_check{};
};

/// A chain that gives the starts an error bar of the accuracy, and any start of the range half of
/// it: the other half is for its own first runs, and for the worst of many. Throws as
/// predict_pooled and pool_range; std::invalid_argument for neither start nor range, and for fewer
/// states than boundaries.
[[nodiscard]] TreeChain make_tree_chain(const Problem& problem, const TreeOptions& options,
                                        const dynamics::Work& work = {});

/// Part of the accuracy asked for a range that error bars of a single start are to keep.
inline constexpr double kPartForOne = 0.5;

/// The runs of a pool of entries in this section as tables of a matrix file, and back. How full
/// trials of a start end is known where they were run in the scene's field. Throws markov::BadFile
/// naming `path` when they do not add up.
[[nodiscard]] std::vector<markov::NamedArray> arrays_of(const RunPool& pool,
                                                        const dynamics::Section& section);
[[nodiscard]] bool has_runs(const MatrixFile& file);
[[nodiscard]] RunPool pool_of(const MatrixFile& file, const Problem& problem,
                              const std::string& path);

/// The matrices of a pool, by types, with these starts as states of their own.
/// Each start needs runs of its own.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(
    const Problem& problem, const RunPool& pool, const std::vector<dynamics::Entry>& starts,
    int per_leaf);

}  // namespace gatewalk::lattice
