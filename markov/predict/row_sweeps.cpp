// SPDX-License-Identifier: MIT
#include "markov/predict/row_sweeps.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>

#include "markov/staying.h"

namespace gatewalk::markov {

RowSweeps::RowSweeps(const std::vector<Move>& moves, Sums sums, int columns, int inputs)
    : columns_(columns), inputs_(inputs) {
  const auto target = [&](const Move& m) {
    return static_cast<std::size_t>(sums == Sums::brought ? m.to : m.from);
  };
  const auto source = [&](const Move& m) {
    return static_cast<std::size_t>(sums == Sums::brought ? m.from : m.to);
  };
  const auto states = static_cast<std::size_t>(inputs);
  std::vector<char> depends(states), is_used(states);
  std::vector<double> heading(states);
  for (const Move& m : moves) {
    depends[target(m)] = is_used[source(m)] = 1;
    heading[static_cast<std::size_t>(m.to)] += m.p * m.di_x;
    widest_ = std::max(widest_, std::abs(m.di_x));
  }
  const auto kind = [&](int input) {
    const auto i = static_cast<std::size_t>(input);
    if (!depends[i]) return 0;
    if (!is_used[i]) return 3;
    return heading[i] >= 0.0 ? 1 : 2;
  };
  states_.resize(states);
  std::iota(states_.begin(), states_.end(), 0);
  std::stable_sort(states_.begin(), states_.end(), [&](int a, int b) { return kind(a) < kind(b); });
  const auto begin_of = [&](int k) {
    return static_cast<int>(
        std::find_if(states_.begin(), states_.end(), [&](int s) { return kind(s) >= k; }) -
        states_.begin());
  };
  right_ = begin_of(1), left_ = begin_of(2), last_ = begin_of(3);
  right_first_up_ = sums == Sums::brought;
  std::vector<int> place(states);
  for (std::size_t i = 0; i < states; ++i) place[static_cast<std::size_t>(states_[i])] = int(i);

  stays_ = right_ == last_ ? 0.0 : staying_per_move(inputs, [&](auto use) {
    for (const Move& m : moves)
      if (is_used[target(m)] && depends[source(m)])
        use(static_cast<int>(target(m)), static_cast<int>(source(m)), m.p);
  });
  length_ = std::max((columns + static_cast<int>(kLanes) - 1) / static_cast<int>(kLanes), widest_);
  if (!suits()) return;
  stride_ = std::ptrdiff_t{inputs} * kLanes;

  std::vector<Move> sorted = moves;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Move& a, const Move& b) {
    return place[target(a)] < place[target(b)];
  });
  for (Terms* terms : {&first_, &further_}) terms->ends.assign(states + 1, 0);
  std::map<double, int> numbers;
  for (const Move& m : sorted) {
    const int di_x = sums == Sums::brought ? -m.di_x : m.di_x, at = place[target(m)];
    const bool is_first = at < last_ && !depends[source(m)];
    Terms& terms = is_first ? first_ : further_;
    const auto [number, is_new] = numbers.try_emplace(m.p, std::ssize(shares_));
    if (is_new) shares_.push_back(m.p);
    terms.terms.push_back(
        {number->second, static_cast<std::int32_t>(di_x * stride_ + place[source(m)] * kLanes)});
    ++terms.ends[static_cast<std::size_t>(at) + 1];
  }
  for (Terms* terms : {&first_, &further_}) {
    std::partial_sum(terms->ends.begin(), terms->ends.end(), terms->ends.begin());
    terms->terms.resize(terms->terms.size() + kTermsAhead);
  }

  buffer_.reset((2 * length_ + 2 * widest_) * inputs + length_ + 1, kLanes);
  (void)buffer_.take(1);  // padding before the first number
  mask_ = buffer_.take(length_);
  b_ = buffer_.take(std::ptrdiff_t{length_} * inputs);
  x_ = buffer_.take(std::ptrdiff_t{length_ + 2 * widest_} * inputs);
  for (std::ptrdiff_t column = 0; column < columns; ++column)
    mask_.data()[column % length_ * kLanes + column / length_] = 1.0;
}

bool RowSweeps::suits() const {
  constexpr double kStayLong = 0.95;
  const double farthest = static_cast<double>(widest_ + 1) * inputs_ * static_cast<double>(kLanes);
  return stays_ <= kStayLong && widest_ < columns_ &&
         farthest < std::numeric_limits<std::int32_t>::max();
}

template <class Use>
void RowSweeps::each(Use use) const {
  for (std::ptrdiff_t k = 0; k < length_; ++k)
    for (std::ptrdiff_t place = 0; place < inputs_; ++place)
      for (std::ptrdiff_t column = k, at = k * stride_ + place * kLanes; column < columns_;
           column += length_, ++at)
        use(at, column * inputs_ + states_[static_cast<std::size_t>(place)]);
}

void RowSweeps::tell_neighbours(int first, int last) {
  double* const x = x_.data() + widest_ * stride_;
  const std::ptrdiff_t behind = length_ * stride_, count = std::ptrdiff_t{last - first} * kLanes;
  for (std::ptrdiff_t at = first * kLanes; at < widest_ * stride_; at += stride_) {
    shift_lanes(x + behind - widest_ * stride_ + at, x - widest_ * stride_ + at, count, -1);
    shift_lanes(x + at, x + behind + at, count, 1);
  }
}

int RowSweeps::solve(double* values, Of of, double tolerance) {
  double* const x = x_.data() + widest_ * stride_;
  const auto sweep = [&](const Terms& terms, int first, int last, bool upwards, const double* b,
                         StripChange& change) {
    sweep_strips({shares_.data(), terms.terms.data(), terms.ends.data(), mask_.data(), length_,
                  stride_, tolerance * (1.0 - stays_)},
                 first, last, upwards, b, x, change);
  };
  StripChange unasked;
  each([&](std::ptrdiff_t at, std::ptrdiff_t cell) { x[at] = values[cell]; });
  tell_neighbours(0, right_);
  sweep(first_, right_, last_, true, x, unasked);
  std::copy_n(x, b_.size(), b_.data());
  int sweeps = 0;
  for (bool settled = right_ == last_; !settled; ++sweeps) {
    StripChange change;
    tell_neighbours(right_, last_);
    sweep(further_, right_, left_, right_first_up_, b_.data(), change);
    tell_neighbours(right_, last_);
    sweep(further_, left_, last_, !right_first_up_, b_.data(), change);
    settled = of == Of::each
                  ? !(change.excess > 0.0)
                  : !(change.largest > tolerance * (1.0 - stays_) * change.largest_number);
  }
  tell_neighbours(0, last_);
  sweep(further_, last_, inputs_, true, x, unasked);
  each([&](std::ptrdiff_t at, std::ptrdiff_t cell) { values[cell] = x[at]; });
  return sweeps;
}

}  // namespace gatewalk::markov
