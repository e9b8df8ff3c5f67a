// SPDX-License-Identifier: MIT
#pragma once
/// Exact answers of a small absorbing chain over any kind of number: double, long double, exact
/// fractions (boost::multiprecision::cpp_rational), bounds (enclosure.h).
///
/// States are eliminated one by one, as in Grassmann, Taksar and Heyman (Operations Research 33,
/// 1985). Nothing is subtracted: the probability 1 - q_kk of leaving a state is the sum of its
/// moves. Every answer is therefore exact to about n roundings of its own size, however unlikely an
/// ending is.

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::markov {

/// A dense table, row by row. (Eigen 3.4 does not compile with Boost 1.74's fractions.)
template <class Number>
class Dense {
 public:
  using Index = std::ptrdiff_t;
  Dense() = default;
  Dense(Index rows, Index columns)  // all 0
      : rows_(rows), columns_(columns), values_(static_cast<std::size_t>(rows * columns)) {}

  [[nodiscard]] Index rows() const { return rows_; }
  [[nodiscard]] Index cols() const { return columns_; }
  [[nodiscard]] Number* row(Index i) { return values_.data() + i * columns_; }
  [[nodiscard]] const Number* row(Index i) const { return values_.data() + i * columns_; }
  [[nodiscard]] Number& operator()(Index i, Index j) { return row(i)[j]; }
  [[nodiscard]] const Number& operator()(Index i, Index j) const { return row(i)[j]; }

  /// The part of `rows` x `columns` numbers from column `first` on.
  [[nodiscard]] Dense part(Index rows, Index first, Index columns) const {
    Dense some(rows, columns);
    for (Index i = 0; i < rows; ++i) std::copy_n(row(i) + first, columns, some.row(i));
    return some;
  }

 private:
  Index rows_ = 0, columns_ = 0;
  std::vector<Number> values_;
};

/// An absorbing chain of n states and m ends. The rows of both tables together sum to 1. The
/// diagonal (what a state keeps) only counts in that sum: it is 1 minus the state's other moves.
template <class Number>
struct AbsorbingChain {
  Dense<Number> moves;  // (n x n) from state to state
  Dense<Number> ends;   // (n x m) from state to end

  AbsorbingChain(std::ptrdiff_t n_states, std::ptrdiff_t n_ends)  // all 0
      : moves(n_states, n_states), ends(n_states, n_ends) {}
};

template <class Number>
struct Absorption {
  Dense<Number> ends;  // (n x m) probability of each end, from each state
  /// (n x n) expected visits of each state, from each; the start counts as one
  Dense<Number> visits;
  std::vector<Number> steps;  // (n) expected draws until the end
};

/// Throws std::invalid_argument naming the state (counted from 0) unless all probabilities are >=
/// 0, each row sums to 1 within 1e-12, and every state can reach an end.
template <class Number>
void validate(const AbsorbingChain<Number>& chain) {
  const std::ptrdiff_t n = chain.moves.rows(), m = chain.ends.cols();
  if (n < 1 || m < 1 || chain.moves.cols() != n || chain.ends.rows() != n)
    throw std::invalid_argument("absorbing chain: n x n moves and n x m ends are needed, not " +
                                std::to_string(n) + " x " + std::to_string(chain.moves.cols()) +
                                " and " + std::to_string(chain.ends.rows()) + " x " +
                                std::to_string(m));
  const auto refuse = [](std::ptrdiff_t state, const char* why) {
    throw std::invalid_argument("absorbing chain: state " + std::to_string(state) +
                                " (counted from 0) " + why);
  };
  const Number none(0), least(1.0 - 1e-12), most(1.0 + 1e-12);
  std::vector<char> can_end(static_cast<std::size_t>(n));
  std::vector<std::ptrdiff_t> found;  // states that can end, in the order of discovery
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    Number sum(0);
    const auto add = [&](const Number& p) {
      if (!(p >= none)) refuse(k, "has a negative chance");
      sum += p;
    };
    for (std::ptrdiff_t j = 0; j < n; ++j) add(chain.moves(k, j));
    for (std::ptrdiff_t j = 0; j < m; ++j) {
      add(chain.ends(k, j));
      if (chain.ends(k, j) == none || can_end[static_cast<std::size_t>(k)]) continue;
      can_end[static_cast<std::size_t>(k)] = 1;
      found.push_back(k);
    }
    if (!(sum >= least && sum <= most)) refuse(k, "has chances that do not sum to 1");
  }
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      if (can_end[static_cast<std::size_t>(k)] || chain.moves(k, found[i]) == none) continue;
      can_end[static_cast<std::size_t>(k)] = 1;
      found.push_back(k);
    }
  for (std::ptrdiff_t k = 0; k < n; ++k)
    if (!can_end[static_cast<std::size_t>(k)]) refuse(k, "never ends");
}

/// Solves x = moves x + b for the first `wanted` states. b: the ends, and with visits also the unit
/// matrix (wanted x m, or m + n). Throws as validate(), and std::runtime_error if the probability
/// of leaving a state is too small for the kind of number (a double: below 1e-308).
template <class Number>
[[nodiscard]] Dense<Number> eliminate(const AbsorbingChain<Number>& chain, std::ptrdiff_t wanted,
                                      bool with_visits) {
  validate(chain);
  const Number none(0);
  const std::ptrdiff_t n = chain.moves.rows(), m = chain.ends.cols();
  const std::ptrdiff_t right = m + (with_visits ? n : 0), width = right + n;
  Dense<Number> all(n, width);  // b, then the moves
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    for (std::ptrdiff_t j = 0; j < m; ++j) all(k, j) = chain.ends(k, j);
    for (std::ptrdiff_t j = 0; j < n; ++j) all(k, right + j) = chain.moves(k, j);
    if (with_visits) all(k, m + k) = Number(1);
  }
  // Adds the moves of k to those of i, in proportion to the move from i to k.
  const auto pass_on = [&](std::ptrdiff_t k, std::ptrdiff_t i) {
    const Number* const from = all.row(k);
    Number* const to = all.row(i);
    const Number times = to[right + k];
    if (times == none) return;
    for (std::ptrdiff_t j = 0; j < right + k; ++j) to[j] += times * from[j];
  };
  const auto leave = [&](std::ptrdiff_t k) {
    Number* const from = all.row(k);
    Number leaves(0);  // 1 - q_kk of the chain on the states up to k
    for (std::ptrdiff_t j = 0; j < m; ++j) leaves += from[j];
    for (std::ptrdiff_t j = right; j < right + k; ++j) leaves += from[j];
    if (!(leaves > none))
      throw std::runtime_error("absorbing chain: what leaves state " + std::to_string(k) +
                               " (counted from 0) is too little for this kind of number");
    for (std::ptrdiff_t j = 0; j < right + k; ++j) from[j] /= leaves;
  };
  // From the last state to the first, several rows at a time, which share reading the rows after
  // them.
  constexpr std::ptrdiff_t kTogether = 16;
  for (std::ptrdiff_t end = n, begin; end > 0; end = begin) {
    begin = end > kTogether ? end - kTogether : 0;
    for (std::ptrdiff_t k = n - 1; k >= end; --k)
      for (std::ptrdiff_t i = begin; i < end; ++i) pass_on(k, i);
    for (std::ptrdiff_t k = end - 1; k >= begin; --k) {
      leave(k);
      for (std::ptrdiff_t i = begin; i < k; ++i) pass_on(k, i);
    }
  }
  for (std::ptrdiff_t k = 1; k < wanted; ++k)
    for (std::ptrdiff_t i = 0; i < k; ++i) {
      Number* const to = all.row(k);
      const Number* const from = all.row(i);
      const Number times = to[right + i];
      if (times == none) continue;
      for (std::ptrdiff_t j = 0; j < right; ++j) to[j] += times * from[j];
    }
  return all.part(wanted, 0, right);
}

/// All answers. Throws as validate().
template <class Number>
[[nodiscard]] Absorption<Number> absorption(const AbsorbingChain<Number>& chain) {
  const std::ptrdiff_t n = chain.moves.rows(), m = chain.ends.cols();
  const Dense<Number> x = eliminate(chain, n, true);
  Absorption<Number> a{x.part(n, 0, m), x.part(n, m, n), {}};
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    Number steps(0);
    for (std::ptrdiff_t j = 0; j < n; ++j) steps += a.visits(k, j);
    a.steps.push_back(steps);
  }
  return a;
}

/// The probabilities of the ends from the first `wanted` states only (wanted x m), in less time.
template <class Number>
[[nodiscard]] Dense<Number> end_chances(const AbsorbingChain<Number>& chain,
                                        std::ptrdiff_t wanted) {
  return eliminate(chain, wanted, false);
}

}  // namespace gatewalk::markov
