// SPDX-License-Identifier: MIT
#include "markov/predict/block_elimination.h"

#include <klu.h>

#include <algorithm>
#include <new>
#include <utility>

namespace gatewalk::markov {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

Blocks blocks_of(PassedOn& t) {
  klu_l_common common{};
  klu_l_defaults(&common);
  const auto n = static_cast<SuiteSparse_long>(t.states());
  klu_l_symbolic* symbolic = klu_l_analyze(n, t.begin.data(), t.index.data(), &common);
  if (symbolic == nullptr) throw std::bad_alloc();
  Blocks blocks{{symbolic->Q, symbolic->Q + n}, {symbolic->R, symbolic->R + symbolic->nblocks + 1}};
  klu_l_free_symbolic(&symbolic, &common);
  return blocks;
}

std::vector<char> can_end(const PassedOn& t) {
  const std::size_t n = t.states();
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

bool BlockElimination::eliminate(const PassedOn& t, const std::int64_t* first,
                                 const std::int64_t* last, double& left) {
  const std::int64_t n = last - first;
  for (std::int64_t i = 0; i < n; ++i) place_[static_cast<std::size_t>(first[i])] = i;
  to_later_.assign(static_cast<std::size_t>(n), {});
  to_earlier_.assign(static_cast<std::size_t>(n), {});
  pivots_.assign(static_cast<std::size_t>(n), 0.0);
  leaving_.assign(static_cast<std::size_t>(n), 0.0);
  bool fine = true;
  for (std::int64_t i = 0; i < n && fine; ++i) fine = eliminate_row(t, first[i], i, left);
  for (std::int64_t i = 0; i < n; ++i) place_[static_cast<std::size_t>(first[i])] = -1;
  return fine;
}

bool BlockElimination::eliminate_row(const PassedOn& t, std::int64_t state, std::int64_t i,
                                     double& left) {
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

void BlockElimination::take(std::int64_t i, std::int64_t to, double share) {
  if (to == i) return;  // a return to the same state
  const auto at = static_cast<std::size_t>(to);
  in_hand_[at] += share;
  if (std::exchange(is_in_hand_[at], 1)) return;
  if (to < i)
    earlier_.push(to);
  else
    later_.push_back(to);
}

/// Forward pass: visits in the order of elimination. Backward pass: visits that return from later
/// states.
void BlockElimination::visits(const std::int64_t* first, std::vector<double>& x) const {
  const auto at = [&](std::int64_t i) -> double& { return x[static_cast<std::size_t>(first[i])]; };
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

void BlockElimination::values(const std::int64_t* first, std::vector<double>& x) const {
  const auto at = [&](std::int64_t i) -> double& { return x[static_cast<std::size_t>(first[i])]; };
  const std::int64_t n = std::ssize(pivots_);
  for (std::int64_t i = 0; i < n; ++i)
    for (const Part& part : to_earlier_[static_cast<std::size_t>(i)])
      at(i) += part.share * at(part.to);
  for (std::int64_t i = n - 1; i >= 0; --i) {
    for (const Part& part : to_later_[static_cast<std::size_t>(i)])
      at(i) += part.share * at(part.to);
    at(i) /= pivots_[static_cast<std::size_t>(i)];
  }
}

}  // namespace gatewalk::markov
