// SPDX-License-Identifier: MIT
#pragma once
/// Neumaier's compensated sum.

#include <cmath>

namespace gatewalk::markov {

/// The error stays at a few eps of the sum of magnitudes, however many terms there are.
class CompensatedSum {
 public:
  CompensatedSum& operator+=(double term) {
    const double sum = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
    return *this;
  }
  [[nodiscard]] double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0.0;
  double lost_ = 0.0;
};

}  // namespace gatewalk::markov
