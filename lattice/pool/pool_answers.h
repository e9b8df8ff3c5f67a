// SPDX-License-Identifier: MIT
#pragma once
/// What the chains of a pool say of starts: that of all its trials, and those of eight groups of
/// them, behind the error bars.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/pool/kernel.h"
#include "lattice/statistics/group_spread.h"
#include "markov/solvers.h"

namespace gatewalk::lattice {

/// Predictions of a kernel from starts, of which `first_rows` (starts x n+1) are the first draws:
/// exact, or by walks where that would take long (large fields, very many runs).
struct KernelAnswers {
  std::vector<markov::FinalDistribution> final;  // (starts)
  std::int64_t walks = 0;                        // behind each; 0: they are exact
};
[[nodiscard]] KernelAnswers answers_of(const Kernel& kernel, const dynamics::CellMap& map,
                                       const markov::Counts& first_rows, const FieldParams& field,
                                       std::uint64_t seed);

struct PoolAnswers {
  KernelAnswers whole;
  std::vector<std::vector<markov::FinalDistribution>> groups;  // (starts x kTrialGroups)
  /// The same with the first runs of all trials in every group: what the kernel alone makes. Empty
  /// where answers come by walks.
  std::vector<std::vector<markov::FinalDistribution>> kernels;
  std::vector<double> unseen;  // (starts) missing_mass()
  int states = 0;
  std::int64_t nonzeros = 0;
};

/// Asks a pool that grows. Kernels stay while only first runs are added.
class PoolChains {
 public:
  /// For so many starts at first. Where these are many, their answers come by the adjoint, and
  /// leaves are twice as large, so that this takes less.
  PoolChains(const dynamics::CellMap& map, const FieldParams& field, int per_leaf,
             std::size_t starts, std::uint64_t seed);

  /// Whether answers for so many starts come by the adjoint: further ones then cost nothing.
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
  std::int64_t runs_ = -1;  // behind the kernels
  bool by_walks_ = false;
  std::vector<GroupChain> chains_{};  // of all trials, then of each group
};

}  // namespace gatewalk::lattice
