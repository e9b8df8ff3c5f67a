// SPDX-License-Identifier: MIT
#include "lattice/statistics/sobol.h"

#include <bit>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace gatewalk::lattice {
namespace {

/// Sums over the rows of one scramble.
struct Sums {
  double answers = 0.0;          // over A and B
  double squares = 0.0;          // products of the deviations from the mean of one and of the other
  double noise = 0.0;            // squares of one minus the other, over all points
  std::vector<double> own, all;  // by number: numerators of first-order and total index
};

Sums sums_of(const IndexDesign& design, int group, double mean, const std::vector<double>& one,
             const std::vector<double>& other) {
  const auto numbers = static_cast<std::size_t>(design.numbers());
  Sums s{.own = std::vector<double>(numbers), .all = std::vector<double>(numbers)};
  for (std::int64_t row = group; row < std::ssize(one) / design.points_of_row();
       row += kTrialGroups) {
    const auto at = static_cast<std::size_t>(row * design.points_of_row());
    const double *x = &one[at], *y = &other[at];
    s.answers += 0.5 * (x[0] + y[0] + x[1] + y[1]);
    for (int point : {0, 1}) s.squares += (x[point] - mean) * (y[point] - mean);
    for (std::size_t k = 0; k < numbers; ++k) {
      s.own[k] += (x[1] - mean) * (y[2 + k] - y[0]) + (y[1] - mean) * (x[2 + k] - x[0]);
      s.all[k] += (x[0] - x[2 + k]) * (y[0] - y[2 + k]);
    }
    for (std::size_t k = 0; k < numbers + 2; ++k) s.noise += (x[k] - y[k]) * (x[k] - y[k]);
  }
  return s;
}

/// Jackknife interval of a number computed from sums over all rows: its changes when each scramble
/// is left out (Wolter, Introduction to Variance Estimation, 2007, ch. 4).
Mean95 jackknife(const std::vector<Sums>& scrambles,
                 const std::function<double(const std::vector<const Sums*>&)>& number) {
  std::vector<const Sums*> all;
  for (const Sums& s : scrambles) all.push_back(&s);
  const double whole = number(all), n = kTrialGroups;
  std::vector<double> pseudo;
  for (std::size_t left_out = 0; left_out < all.size(); ++left_out) {
    std::vector<const Sums*> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    pseudo.push_back(n * whole - (n - 1.0) * number(others));
  }
  const double half = half_width_95(pseudo);
  if (half > 0.0) return {whole, {whole - half, whole + half}};
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return {whole, {kUnknown, kUnknown}};
}

double total(const std::vector<const Sums*>& of, const std::function<double(const Sums&)>& part) {
  double sum = 0.0;
  for (const Sums* s : of) sum += part(*s);
  return sum;
}

}  // namespace

IndexDesign::IndexDesign(int numbers, std::uint64_t seed) : numbers_(numbers) {
  if (numbers < 1 || numbers > kMostVaried)
    throw std::invalid_argument("one to " + std::to_string(kMostVaried) + " numbers can vary");
  for (int group = 0; group < kTrialGroups; ++group) {
    dynamics::Random random(dynamics::Purpose::indices, {seed, static_cast<std::uint64_t>(group)});
    scrambles_.emplace_back(random);
  }
}

std::vector<double> IndexDesign::point(std::int64_t i) const {
  const std::int64_t row = i / points_of_row(), kind = i % points_of_row();
  const dynamics::Point of_row = scrambles_[static_cast<std::size_t>(row % kTrialGroups)](
      static_cast<std::uint32_t>(row / kTrialGroups));
  const auto numbers = static_cast<std::size_t>(numbers_);
  std::vector<double> out(numbers);
  for (std::size_t k = 0; k < numbers; ++k) {
    const bool of_b = kind == 1 || kind == static_cast<std::int64_t>(k) + 2;
    out[k] = of_row[of_b ? numbers + k : k];
  }
  return out;
}

SobolIndices sobol_indices(const IndexDesign& design, const std::vector<double>& one,
                           const std::vector<double>& other) {
  const std::int64_t points = std::ssize(one), of_row = design.points_of_row(),
                     all_rows = points / of_row;
  if (std::ssize(other) != points || points % (of_row * kTrialGroups) != 0 ||
      !std::has_single_bit(static_cast<std::uint64_t>(all_rows)))
    throw std::invalid_argument("indices need two answers for each point of 8, 16, 32 ... rows");
  double mean = 0.0;
  for (std::size_t at = 0; at < one.size(); at += static_cast<std::size_t>(of_row))
    mean += 0.25 * (one[at] + other[at] + one[at + 1] + other[at + 1]);
  mean /= static_cast<double>(all_rows);
  const double rows = static_cast<double>(all_rows) / kTrialGroups;
  std::vector<Sums> scrambles;
  for (int group = 0; group < kTrialGroups; ++group)
    scrambles.push_back(sums_of(design, group, mean, one, other));

  using Some = std::vector<const Sums*>;
  const auto per_row = [&](const Some& of, double sum) {
    return sum / (rows * static_cast<double>(of.size()));
  };
  const auto squares = [](const Sums& s) { return s.squares; };
  SobolIndices out;
  out.mean = jackknife(scrambles, [&](const Some& of) {
    return per_row(of, total(of, [](const Sums& s) { return s.answers; })) / 2.0;
  });
  out.variance =
      jackknife(scrambles, [&](const Some& of) { return per_row(of, total(of, squares)) / 2.0; });
  for (const Sums& s : scrambles) out.noise += s.noise / (2.0 * static_cast<double>(points));
  const bool varies = out.variance.interval[0] > 0.0;
  const auto index = [&](const auto& part) -> Mean95 {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!varies) return {kNone, {kNone, kNone}};
    return jackknife(scrambles,
                     [&](const Some& of) { return total(of, part) / total(of, squares); });
  };
  for (std::size_t k = 0; k < static_cast<std::size_t>(design.numbers()); ++k) {
    out.first.push_back(index([k](const Sums& s) { return s.own[k]; }));
    out.total.push_back(index([k](const Sums& s) { return s.all[k]; }));
  }
  return out;
}

}  // namespace gatewalk::lattice
