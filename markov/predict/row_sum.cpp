#include "markov/predict/row_sum.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "markov/staying.h"

namespace gatewalk::markov {

RowSum::RowSum(const std::vector<Term>& terms, int columns, int inputs)
    : columns_(columns), inputs_(inputs) {
  std::vector<bool> depends(static_cast<std::size_t>(inputs)), is_used(depends);
  for (const Term& t : terms) {
    depends[static_cast<std::size_t>(t.target)] = is_used[static_cast<std::size_t>(t.source)] =
        true;
    widest_ = std::max(widest_, std::abs(t.di_x));
  }
  std::vector<int> place(depends.size(), -1);  // in the circle
  for (int input = 0; input < inputs; ++input) {
    const auto i = static_cast<std::size_t>(input);
    if (!depends[i] || !is_used[i]) continue;
    place[i] = static_cast<int>(circle_.size());
    circle_.push_back(input);
  }
  std::vector<Term> round;
  for (const Term& t : terms) {
    const int target = place[static_cast<std::size_t>(t.target)],
              source = place[static_cast<std::size_t>(t.source)];
    if (target < 0)
      last_.push_back(t);
    else if (source < 0)
      first_.push_back(t);
    else
      round.push_back({target, source, t.di_x, t.p});
  }
  std::stable_sort(round.begin(), round.end(),
                   [](const Term& a, const Term& b) { return a.target < b.target; });
  ends_.assign(circle_.size() + 1, 0);
  for (const Term& t : round) {
    const auto known = std::find_if(shifts_.begin(), shifts_.end(),
                                    [&](const Shift& s) { return s.offset == t.di_x; });
    terms_.push_back({t.p, t.source, static_cast<int>(known - shifts_.begin())});
    if (known == shifts_.end()) shifts_.push_back({t.di_x, nullptr});
    ++ends_[static_cast<std::size_t>(t.target) + 1];
  }
  for (std::size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
  stays_ =
      circle_.empty() ? 0.0 : staying_per_move(static_cast<int>(circle_.size()), [&](auto use) {
        for (const Term& t : round) use(t.target, t.source, t.p);
      });
  if (!suits()) return;
  origin_ = lanes_up(widest_);
  range_ = {{origin_, lanes_up(origin_ + columns)}};
  stride_ = lanes_up(range_.front().last + widest_);
  const std::ptrdiff_t planes = std::ssize(circle_);
  buffer_.reset(3 * planes + 1, stride_);
  mask_ = buffer_.take(1);
  std::fill_n(mask_.data() + origin_, columns, 1.0);
  sum_ = buffer_.take(planes), now_ = buffer_.take(planes), next_ = buffer_.take(planes);
}

bool RowSum::suits() const {
  constexpr double kStayLong = 0.95;
  return stays_ <= kStayLong && widest_ < columns_;
}

void RowSum::add(const std::vector<Term>& terms, double* values) const {
  for (int column = 0; column < columns_; ++column)
    for (const Term& t : terms)
      if (const int from = column + t.di_x; from >= 0 && from < columns_)
        values[std::ptrdiff_t{column} * inputs_ + t.target] +=
            t.p * values[std::ptrdiff_t{from} * inputs_ + t.source];
}

template <class Use>
void RowSum::each(Use use) const {
  for (std::ptrdiff_t column = 0; column < columns_; ++column)
    for (std::ptrdiff_t k = 0; k < std::ssize(circle_); ++k)
      use(k * stride_ + origin_ + column, column * inputs_ + circle_[static_cast<std::size_t>(k)]);
}

void RowSum::solve(double* values, Of of) {
  constexpr double kTolerance = 1e-12;
  constexpr int kAtOnce = 8;  // to look at all numbers takes as long as to sum some
  add(first_, values);
  each([&](std::ptrdiff_t plane, std::ptrdiff_t cell) {
    sum_.data()[plane] = now_.data()[plane] = values[cell];
  });
  const auto planes = static_cast<int>(circle_.size());
  const double tolerance = kTolerance * (1.0 - stays_);
  const auto largest_of = [](Planes p) { return *std::max_element(p.data(), p.data() + p.size()); };
  // Of each: with the last two terms, as moves of one column lead to every other column only; a
  // number that was reached just now is all of its sum.
  const auto is_settled = [&] {
    if (of == Of::largest) return largest_of(now_) <= tolerance * largest_of(sum_);
    for (std::ptrdiff_t i = 0; i < sum_.size(); ++i)
      if (now_.data()[i] + next_.data()[i] > tolerance * sum_.data()[i]) return false;
    return true;
  };
  do {
    for (int k = 0; k < kAtOnce && planes > 0; ++k) {
      gather(
          {terms_.data(), ends_.data(), planes, shifts_.data(), stride_, mask_.data(), nullptr, 0},
          range_, {}, now_.data(), next_.data());
      accumulate(next_.data(), sum_.data(), planes, stride_, range_.front().first,
                 range_.front().last);
      std::swap(now_, next_);
    }
  } while (planes > 0 && !is_settled());
  each([&](std::ptrdiff_t plane, std::ptrdiff_t cell) { values[cell] = sum_.data()[plane]; });
  add(last_, values);
}

}  // namespace gatewalk::markov
