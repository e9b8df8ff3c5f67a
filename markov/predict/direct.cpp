// SPDX-License-Identifier: MIT
#include <klu.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "markov/predict/ends.h"
#include "markov/predict/transient.h"

namespace gatewalk::markov {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

/// States in blocks in which walks can return: no walk that leaves a block comes back to it.
struct Blocks {
  std::vector<std::int64_t> order;  // states, those of a block together, in an order of little fill
  std::vector<std::int64_t> begin{};  // of each block, in `order`; blocks after those they lead to
};

/// By KLU's analysis: block triangular form, and within a block minimum degree (AMD). Every column
/// begins with its diagonal entry, which KLU then takes for the pivot, as nothing stands against
/// it.
Blocks blocks_of(Transient& t) {
  klu_l_common common{};
  klu_l_defaults(&common);
  const auto n = static_cast<SuiteSparse_long>(t.states.size());
  klu_l_symbolic* symbolic = klu_l_analyze(n, t.begin.data(), t.index.data(), &common);
  if (symbolic == nullptr) return {};
  Blocks blocks{{symbolic->Q, symbolic->Q + n}, {symbolic->R, symbolic->R + symbolic->nblocks + 1}};
  klu_l_free_symbolic(&symbolic, &common);
  return blocks;
}

/// Expected visits of the states of a block by what enters it. State after state is eliminated, in
/// order: what it passes on goes to those behind it, and out of the block. What leaves a state, its
/// pivot, is the sum of these, never 1 less what stays.
class BlockElimination {
 public:
  explicit BlockElimination(std::size_t states)
      : place_(states, -1), in_hand_(states, 0.0), is_in_hand_(states, 0) {}

  struct Part {
    std::int64_t to;
    double share;
  };

  /// visits[s] of the states [first, last) of `order` is replaced: what enters, by how often they
  /// are visited. Returns false where `left` operations do not suffice, or nothing leaves.
  bool solve(const Transient& t, const std::int64_t* first, const std::int64_t* last,
             std::vector<double>& visits, double& left) {
    const std::int64_t n = last - first;
    for (std::int64_t i = 0; i < n; ++i) place_[static_cast<std::size_t>(first[i])] = i;
    to_later_.assign(static_cast<std::size_t>(n), {});
    to_earlier_.assign(static_cast<std::size_t>(n), {});
    pivots_.assign(static_cast<std::size_t>(n), 0.0);
    leaving_.assign(static_cast<std::size_t>(n), 0.0);
    bool fine = true;
    for (std::int64_t i = 0; i < n && fine; ++i) fine = eliminate(t, first[i], i, left);
    if (fine) substitute(first, visits);
    for (std::int64_t i = 0; i < n; ++i) place_[static_cast<std::size_t>(first[i])] = -1;
    return fine;
  }

 private:
  /// Row i of the block: moves to earlier states are replaced by what follows them.
  bool eliminate(const Transient& t, std::int64_t state, std::int64_t i, double& left) {
    const auto s = static_cast<std::size_t>(state), at = static_cast<std::size_t>(i);
    double leaving = t.ends[s];
    later_.clear();
    for (auto k = static_cast<std::size_t>(t.begin[s]) + 1;
         k < static_cast<std::size_t>(t.begin[s + 1]); ++k) {
      const std::int64_t to = place_[static_cast<std::size_t>(t.index[k])];
      if (to < 0)
        leaving -= t.value[k];
      else
        take(i, to, -t.value[k]);
    }
    while (!earlier_.empty()) {
      const std::int64_t k = earlier_.top();
      earlier_.pop();
      const auto from = static_cast<std::size_t>(k);
      const double visits = std::exchange(in_hand_[from], 0.0) / pivots_[from];
      is_in_hand_[from] = 0;
      to_earlier_[at].push_back({k, visits});
      leaving += visits * leaving_[from];
      left -= static_cast<double>(to_later_[from].size()) + 1.0;
      for (const Part& part : to_later_[from]) take(i, part.to, visits * part.share);
    }
    double pivot = leaving;
    std::sort(later_.begin(), later_.end());
    for (const std::int64_t to : later_) {
      const auto later = static_cast<std::size_t>(to);
      to_later_[at].push_back({to, std::exchange(in_hand_[later], 0.0)});
      is_in_hand_[later] = 0;
      pivot += to_later_[at].back().share;
    }
    pivots_[at] = pivot;
    leaving_[at] = leaving;
    return left >= 0.0 && pivot > 0.0;
  }
  void take(std::int64_t i, std::int64_t to, double share) {
    if (to == i) return;  // back to itself
    const auto at = static_cast<std::size_t>(to);
    in_hand_[at] += share;
    if (std::exchange(is_in_hand_[at], 1)) return;
    if (to < i)
      earlier_.push(to);
    else
      later_.push_back(to);
  }
  /// First visits in the order of elimination, then those that come back from later states.
  void substitute(const std::int64_t* first, std::vector<double>& visits) const {
    const auto at = [&](std::int64_t i) -> double& {
      return visits[static_cast<std::size_t>(first[i])];
    };
    const std::int64_t n = std::ssize(pivots_);
    for (std::int64_t i = 0; i < n; ++i) {
      at(i) /= pivots_[static_cast<std::size_t>(i)];
      for (const Part& part : to_later_[static_cast<std::size_t>(i)])
        at(part.to) += at(i) * part.share;
    }
    for (std::int64_t i = n - 1; i >= 0; --i)
      for (const Part& part : to_earlier_[static_cast<std::size_t>(i)])
        at(part.to) += at(i) * part.share;
  }

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

/// Whether walks end sooner or later, by state.
std::vector<char> can_end(const Transient& t) {
  const std::size_t n = t.states.size();
  std::vector<std::vector<std::int64_t>> from(n);
  std::vector<std::int64_t> found;
  std::vector<char> ends(n, 0);
  for (std::size_t s = 0; s < n; ++s) {
    for (auto k = static_cast<std::size_t>(t.begin[s]) + 1;
         k < static_cast<std::size_t>(t.begin[s + 1]); ++k)
      from[static_cast<std::size_t>(t.index[k])].push_back(static_cast<std::int64_t>(s));
    if (t.ends[s] > 0.0) {
      ends[s] = 1;
      found.push_back(static_cast<std::int64_t>(s));
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const std::int64_t s : from[static_cast<std::size_t>(found[i])])
      if (!std::exchange(ends[static_cast<std::size_t>(s)], 1)) found.push_back(s);
  return ends;
}

}  // namespace

std::optional<FinalDistribution> solve_directly(const FieldChain& chain, const Field& field,
                                                const Start& start, double most_operations) {
  validate(chain, field, start, 0);
  constexpr std::int64_t kMostPairs = 20'000'000;
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  if (cells > kMostPairs / std::max(1, chain.inputs())) return {};
  if (!chain.at(start.column, start.row).is_sampled(start.input)) {
    Ends ends(field);
    ends.add(Ending::unsampled, std::int64_t{start.row} * field.columns + start.column, 1.0);
    return ends.result();
  }
  Transient t(chain, field, start);
  const std::vector<char> ends = can_end(t);
  const Blocks blocks = blocks_of(t);
  if (blocks.begin.empty()) return {};  // no memory
  std::vector<std::size_t> block_of(t.states.size());
  for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b)
    for (std::int64_t i = blocks.begin[b]; i < blocks.begin[b + 1]; ++i)
      block_of[static_cast<std::size_t>(blocks.order[static_cast<std::size_t>(i)])] = b;

  // First what enters a state from blocks before its own, then its visits.
  std::vector<double> draws(t.states.size(), 0.0);
  draws.front() = 1.0;
  BlockElimination elimination(t.states.size());
  CompensatedSum endless;
  double left = most_operations - static_cast<double>(t.index.size());
  for (std::size_t b = blocks.begin.size() - 1; b-- > 0;) {
    const std::int64_t* const first = blocks.order.data() + blocks.begin[b];
    const std::int64_t* const last = blocks.order.data() + blocks.begin[b + 1];
    if (!ends[static_cast<std::size_t>(*first)]) {  // nor does any other of its block
      for (const std::int64_t* s = first; s != last; ++s)
        endless += std::exchange(draws[static_cast<std::size_t>(*s)], 0.0);
      continue;
    }
    if (!elimination.solve(t, first, last, draws, left)) return {};
    for (const std::int64_t* s = first; s != last; ++s) {
      const auto from = static_cast<std::size_t>(*s);
      for (auto k = static_cast<std::size_t>(t.begin[from]) + 1;
           k < static_cast<std::size_t>(t.begin[from + 1]); ++k) {
        const auto to = static_cast<std::size_t>(t.index[k]);
        if (block_of[to] != b) draws[to] -= draws[from] * t.value[k];
      }
    }
  }
  FinalDistribution result = t.ended(draws, chain, field);
  result.endless = result.remainder = endless.value();
  // As in absorbing.h: each answer to some n roundings of its own size.
  result.rounding = 1e-15 * static_cast<double>(t.states.size());
  result.operations = most_operations - left;
  return result;
}

}  // namespace gatewalk::markov
