// SPDX-License-Identifier: MIT
#pragma once
/// Sparse elimination of walks without limit of cells, block by block, with nothing subtracted
/// (Grassmann, Taksar and Heyman 1985): expected visits by what enters, and values by what states
/// themselves are worth.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace gatewalk::markov {

/// I - Q, transposed, in compressed columns: column s holds what state s passes on, after itself.
struct PassedOn {
  std::vector<std::int64_t> begin{0};
  std::vector<std::int64_t> index;
  std::vector<double> value;
  std::vector<double> ends;  // chance that a draw of s ends the walk

  [[nodiscard]] std::size_t states() const { return ends.size(); }
};

/// States in blocks in which walks can return: no walk that leaves a block comes back to it.
struct Blocks {
  std::vector<std::int64_t> order;  // states, those of a block together, in an order of little fill
  std::vector<std::int64_t> begin{};  // of each block, in `order`; blocks after those they lead to
};

/// By KLU's analysis: block triangular form, and within a block minimum degree (AMD). Every column
/// begins with its diagonal entry, which KLU then takes for the pivot, as nothing stands against
/// it. Throws std::bad_alloc.
[[nodiscard]] Blocks blocks_of(PassedOn& t);

/// Whether walks end sooner or later, by state.
[[nodiscard]] std::vector<char> can_end(const PassedOn& t);

/// State after state is eliminated, in order: what it passes on goes to those behind it, and out of
/// the block. What leaves a state, its pivot, is the sum of these, never 1 less what stays.
class BlockElimination {
 public:
  explicit BlockElimination(std::size_t states)
      : place_(states, -1), in_hand_(states, 0.0), is_in_hand_(states, 0) {}

  /// The states [first, last) of `order`, for visits() and values(). Returns false where `left`
  /// operations do not suffice, or nothing leaves.
  bool eliminate(const PassedOn& t, const std::int64_t* first, const std::int64_t* last,
                 double& left);
  /// x of these states: what enters is replaced by how often they are visited.
  void visits(const std::int64_t* first, std::vector<double>& x) const;
  /// x of these states: what a visit is worth by itself is replaced by what a walk from there is.
  void values(const std::int64_t* first, std::vector<double>& x) const;

 private:
  struct Part {
    std::int64_t to;
    double share;
  };
  /// Row i of the block: moves to earlier states are replaced by what follows them.
  bool eliminate_row(const PassedOn& t, std::int64_t state, std::int64_t i, double& left);
  void take(std::int64_t i, std::int64_t to, double share);

  std::vector<std::int64_t> place_;  // in the block; -1: not in it
  std::vector<double> in_hand_;      // the row in work
  std::vector<char> is_in_hand_;
  std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>> earlier_;
  std::vector<std::int64_t> later_;
  // Of the block's states: moves to later ones once earlier ones are eliminated; visits of earlier
  // ones for each of its own; what leaves it, and what of that leaves the block.
  std::vector<std::vector<Part>> to_later_, to_earlier_;
  std::vector<double> pivots_, leaving_;
};

}  // namespace gatewalk::markov
