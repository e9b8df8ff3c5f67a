#include "markov/predict/row_sum.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "markov/staying.h"

namespace gatewalk::markov {

RowSum::RowSum(const std::vector<Move>& moves, Sums sums, int columns, int inputs)
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
  ends_.assign(states + 1, 0);
  for (const Move& m : sorted) {
    const int di_x = sums == Sums::brought ? -m.di_x : m.di_x;
    terms_.push_back({m.p, di_x * stride_ + place[source(m)] * kLanes});
    ++ends_[static_cast<std::size_t>(place[target(m)]) + 1];
  }
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());

  buffer_.reset((2 * length_ + 2 * widest_) * inputs + length_ + 1, kLanes);
  (void)buffer_.take(1);  // before the first number
  mask_ = buffer_.take(length_);
  b_ = buffer_.take(std::ptrdiff_t{length_} * inputs);
  x_ = buffer_.take(std::ptrdiff_t{length_ + 2 * widest_} * inputs);
  for (std::ptrdiff_t column = 0; column < columns; ++column)
    mask_.data()[column % length_ * kLanes + column / length_] = 1.0;
}

bool RowSum::suits() const {
  constexpr double kStayLong = 0.95;
  return stays_ <= kStayLong && widest_ < columns_;
}

template <class Use>
void RowSum::each(Use use) const {
  for (std::ptrdiff_t k = 0; k < length_; ++k)
    for (std::ptrdiff_t place = 0; place < inputs_; ++place)
      for (std::ptrdiff_t column = k, at = k * stride_ + place * kLanes; column < columns_;
           column += length_, ++at)
        use(at, column * inputs_ + states_[static_cast<std::size_t>(place)]);
}

void RowSum::tell_neighbours() {
  double* const x = x_.data() + widest_ * stride_;
  shift_lanes(x + (length_ - widest_) * stride_, x - widest_ * stride_, widest_ * stride_, -1);
  shift_lanes(x, x + length_ * stride_, widest_ * stride_, 1);
}

void RowSum::solve(double* values, Of of, double tolerance) {
  double* const x = x_.data() + widest_ * stride_;
  each([&](std::ptrdiff_t at, std::ptrdiff_t cell) { x[at] = values[cell]; });
  std::copy_n(x, b_.size(), b_.data());
  const StripPass pass{terms_.data(), ends_.data(), mask_.data(),
                       length_,       stride_,      tolerance * (1.0 - stays_)};
  for (bool settled = right_ == last_; !settled;) {
    StripChange change;
    tell_neighbours();
    sweep_strips(pass, right_, left_, right_first_up_, b_.data(), x, change);
    tell_neighbours();
    sweep_strips(pass, left_, last_, !right_first_up_, b_.data(), x, change);
    settled = of == Of::each ? change.excess <= 0.0
                             : change.largest <= pass.tolerance * change.largest_number;
  }
  tell_neighbours();
  StripChange change;
  sweep_strips(pass, last_, inputs_, true, b_.data(), x, change);
  each([&](std::ptrdiff_t at, std::ptrdiff_t cell) { values[cell] = x[at]; });
}

}  // namespace gatewalk::markov
