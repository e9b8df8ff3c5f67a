// SPDX-License-Identifier: MIT
#pragma once
/// Neumaier's compensated summation.

#include <cmath>

namespace gatewalk::markov {

/// A compensated sum. Its error is a few eps of the sum of magnitudes, for any number of terms.
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
