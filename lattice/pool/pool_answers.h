// SPDX-License-Identifier: MIT
#pragma once
/// Predictions of a pool's chains: the chain of all trials, and the chains of eight groups of the
/// trials, from which error bars come.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/pool/kernel.h"
#include "lattice/statistics/group_spread.h"
#include "markov/solvers.h"

namespace gatewalk::lattice {

/// Predictions of a kernel from several starts, whose first draws are `first_rows` (starts x n+1):
/// exact, or by Monte Carlo walks where exact ones would take long (large fields, very many runs).
struct KernelAnswers {
  std::vector<markov::FinalDistribution> final;  // (starts)
  std::int64_t walks = 0;                        // Monte Carlo walks per start; 0: exact
};
[[nodiscard]] KernelAnswers answers_of(const Kernel& kernel, const dynamics::CellMap& map,
                                       const markov::Counts& first_rows, const FieldParams& field,
                                       std::uint64_t seed);

/// Predictions for each start by all trials, and by each group of the trials.
struct PoolAnswers {
  KernelAnswers whole;
  std::vector<std::vector<markov::FinalDistribution>> groups;  // (starts x kTrialGroups)
  /// (starts x kTrialGroups) Predictions of each group's kernel with the first runs of all trials:
  /// their spread shows the kernel's part of the error. Empty if answers come from Monte Carlo
  /// walks.
  std::vector<std::vector<markov::FinalDistribution>> kernels;
  std::vector<double> unseen;  // (starts) missing_mass()
  int states = 0;
  std::int64_t nonzeros = 0;
};

/// The chains of a pool that grows. Kernels are kept while only first runs are added.
class PoolChains {
 public:
  /// `starts`: number of starts at first. For many starts answers come by the adjoint, and leaves
  /// are twice as large, which costs less.
  PoolChains(const dynamics::CellMap& map, const FieldParams& field, int per_leaf,
             std::size_t starts, std::uint64_t seed);

  /// True if answers for this number of starts come by the adjoint: further starts then cost
  /// nothing.
  [[nodiscard]] bool by_adjoint(const RunPool& pool, std::size_t starts) const;

  [[nodiscard]] PoolAnswers ask(const RunPool& pool, const std::vector<FirstRow>& starts);

 private:
  struct GroupChain {
    Kernel kernel;
    std::optional<markov::AdjointPredictor> adjoint{};
  };
  void renew(const RunPool& pool);
  [[nodiscard]] KernelAnswers answers(const GroupChain& chain, int group,
                                      const markov::Counts& rows) const;

  dynamics::CellMap map_;
  const FieldParams& field_;
  int per_leaf_;
  std::uint64_t seed_;
  std::int64_t runs_ = -1;  // number of runs behind the kernels
  bool by_walks_ = false;
  std::vector<GroupChain> chains_{};  // of all trials, then one of each group
};

}  // namespace gatewalk::lattice
