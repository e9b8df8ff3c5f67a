// SPDX-License-Identifier: MIT
#pragma once
/// Sparse block elimination for walks without a limit of cells, without subtraction (Grassmann,
/// Taksar and Heyman 1985): expected visits from the inflow, and values from the states' own
/// rewards.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace gatewalk::markov {

/// I - Q, transposed, in compressed columns: column s begins with its diagonal entry, followed by
/// what state s passes on.
struct PassedOn {
  std::vector<std::int64_t> begin{0};
  std::vector<std::int64_t> index;
  std::vector<double> value;
  std::vector<double> ends;  // probability that a draw in s ends the walk

  [[nodiscard]] std::size_t states() const { return ends.size(); }
};

/// The states in strongly connected blocks: a walk that leaves a block never returns to it.
struct Blocks {
  std::vector<std::int64_t> order;  // states by block, within a block in an order of little fill-in
  /// The first index of each block in `order`. A block follows the blocks that it leads to.
  std::vector<std::int64_t> begin{};
};

/// Finds the blocks by KLU's analysis: block triangular form, and minimum degree (AMD) within a
/// block. Every column begins with its diagonal entry, which KLU takes as the pivot for lack of a
/// competitor. Throws std::bad_alloc.
[[nodiscard]] Blocks blocks_of(PassedOn& t);

/// Whether walks from each state can end.
[[nodiscard]] std::vector<char> can_end(const PassedOn& t);

/// Eliminates state after state in order: a state's outflow is redistributed to later states and
/// out of the block. The pivot, the total outflow of a state, is the sum of these parts, never 1
/// minus the rest.
class BlockElimination {
 public:
  explicit BlockElimination(std::size_t states)
      : place_(states, -1), in_hand_(states, 0.0), is_in_hand_(states, 0) {}

  /// Eliminates the states [first, last) of `order`, for visits() and values(). Returns false if
  /// more than `left` operations are needed, or if nothing leaves a state.
  bool eliminate(const PassedOn& t, const std::int64_t* first, const std::int64_t* last,
                 double& left);
  /// Replaces the inflow x of these states by their expected visits.
  void visits(const std::int64_t* first, std::vector<double>& x) const;
  /// Replaces the reward x of a visit to these states by the expected total reward of a walk from
  /// there.
  void values(const std::int64_t* first, std::vector<double>& x) const;

 private:
  struct Part {
    std::int64_t to;
    double share;
  };
  /// Eliminates row i of the block: moves to earlier states are replaced by their continuations.
  bool eliminate_row(const PassedOn& t, std::int64_t state, std::int64_t i, double& left);
  void take(std::int64_t i, std::int64_t to, double share);

  std::vector<std::int64_t> place_;  // place in the block; -1: outside
  std::vector<double> in_hand_;      // the row being eliminated
  std::vector<char> is_in_hand_;
  std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>> earlier_;
  std::vector<std::int64_t> later_;
  // For each state of the block: moves to later states after elimination of earlier ones; visits of
  // earlier states per visit of this one; the total outflow, and its part that leaves the block.
  std::vector<std::vector<Part>> to_later_, to_earlier_;
  std::vector<double> pivots_, leaving_;
};

}  // namespace gatewalk::markov
