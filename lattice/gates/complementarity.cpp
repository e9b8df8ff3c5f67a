// SPDX-License-Identifier: MIT
#include "lattice/gates/complementarity.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "dynamics/disc/contact.h"

namespace gatewalk::lattice {
namespace {

constexpr double kOpen = 1e-12;  // relative to max|b|: a contact that closes more slowly is at rest
constexpr double kDependent = 1e-13;  // relative to its diagonal: a smaller pivot is round-off

/// Solves W z = -b over the contacts `in`, by Cholesky's method. Returns false if a pivot falls to
/// `least` of its diagonal: that contact depends on those before it.
bool solve(const Eigen::MatrixXd& w, const Eigen::VectorXd& b, const std::vector<int>& in,
           double least, std::vector<double>& z) {
  const auto n = static_cast<int>(in.size());
  Eigen::MatrixXd lower(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double rest = w(in[i], in[j]);
      for (int k = 0; k < j; ++k) rest -= lower(i, k) * lower(j, k);
      if (j < i) {
        lower(i, j) = rest / lower(j, j);
      } else {
        if (!(rest > least * w(in[i], in[i]))) return false;
        lower(i, i) = std::sqrt(rest);
      }
    }
  }
  z.resize(n);
  for (int i = 0; i < n; ++i) {
    double rest = -b[in[i]];
    for (int k = 0; k < i; ++k) rest -= lower(i, k) * z[k];
    z[i] = rest / lower(i, i);
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) z[i] -= lower(k, i) * z[k];
    z[i] /= lower(i, i);
  }
  return true;
}

}  // namespace

Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& w, const Eigen::VectorXd& b) {
  const auto n = static_cast<int>(b.size());
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
  if (n == 0) return z;
  if (n <= 2) {
    const bool two = n == 2;
    const auto pair = dynamics::unilateral_impulses(
        {w(0, 0), two ? w(1, 1) : 1.0, two ? w(0, 1) : 0.0}, {b[0], two ? b[1] : 0.0}, {true, two});
    z[0] = pair[0];
    if (two) z[1] = pair[1];
    return z;
  }

  const double open = kOpen * b.cwiseAbs().maxCoeff();
  std::vector<int> in;                  // contacts that have joined, in the order of joining
  std::vector<bool> useless(n, false);  // contacts that depend on those in `in`
  std::vector<double> tried;
  const int most_rounds =
      100 * n;  // far more than ever needed; only round-off could make the method cycle
  for (int round = 0; round < most_rounds; ++round) {
    const Eigen::VectorXd rate = w * z + b;
    int next = -1;
    for (int i = 0; i < n; ++i) {
      const bool joined = std::find(in.begin(), in.end(), i) != in.end();
      if (joined || useless[i] || rate[i] >= -open) continue;
      if (next < 0 || rate[i] < rate[next]) next = i;
    }
    if (next < 0) return z;
    in.push_back(next);
    if (!solve(w, b, in, kDependent, tried) || tried.back() <= 0.0) {
      in.pop_back();
      useless[next] = true;
      continue;
    }
    std::fill(useless.begin(), useless.end(), false);
    while (std::any_of(tried.begin(), tried.end(), [](double x) { return x <= 0.0; })) {
      // Moves towards `tried` until the first contact would pull, which then leaves. All contacts
      // in `in` have z > 0, except the new one, which has tried > 0: the quotient is never 0/0.
      const auto part = [&](std::size_t i) { return z[in[i]] / (z[in[i]] - tried[i]); };
      double share = 1.0;
      for (std::size_t i = 0; i < in.size(); ++i)
        if (tried[i] <= 0.0) share = std::min(share, part(i));
      std::vector<int> stay;
      for (std::size_t i = 0; i < in.size(); ++i) {
        const bool leaves = tried[i] <= 0.0 && part(i) <= share;
        z[in[i]] = leaves ? 0.0 : z[in[i]] + share * (tried[i] - z[in[i]]);
        if (!leaves && z[in[i]] > 0.0) stay.push_back(in[i]);
      }
      in = stay;
      // Fewer contacts have larger pivots; half the bound leaves room for round-off.
      if (!solve(w, b, in, 0.5 * kDependent, tried))
        throw std::logic_error("solve_lcp: contacts became dependent");
    }
    for (std::size_t i = 0; i < in.size(); ++i) z[in[i]] = tried[i];
  }
  throw std::logic_error("solve_lcp: no end");
}

}  // namespace gatewalk::lattice
