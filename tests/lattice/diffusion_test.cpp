// SPDX-License-Identifier: MIT
#include "results/lorentz/diffusion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/markov/chains.h"

namespace gatewalk::markov {
namespace {

using namespace lorentz;
using test::matrix;

// Rounding of sums over states, and the tolerance 1e-12 of the solve.
constexpr double kExact = 1e-10;

/// The Green-Kubo sum as written, with dense matrices: the sum over P^k is the fundamental matrix
/// (I - P + 1 pi)^-1 (Kemeny and Snell, Finite Markov Chains, 1960, section 4.3).
Diffusion diffusion_plainly(const Chain& chain, const Eigen::Matrix2d& lattice,
                            const Reward& time) {
  const int n = chain.inputs();
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, n);
  const auto each = [&](auto use) {
    std::size_t k = 0;
    for (int i = 0; i < n; ++i)
      for (Probabilities::InnerIterator it(chain.matrix(), i); it; ++it, ++k) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        use(i, exit.next_input, it.value(), lattice * Eigen::Vector2d(exit.di_x, exit.di_y),
            time.mean.empty() ? 1.0 : time.mean[k], time.mean.empty() ? 1.0 : time.square[k]);
      }
  };
  each([&](int i, int j, double q, const Eigen::Vector2d&, double, double) { p(i, j) += q; });
  // pi (I - P) = 0 and pi 1 = 1
  Eigen::MatrixXd equations(n + 1, n);
  equations << (Eigen::MatrixXd::Identity(n, n) - p).transpose(), Eigen::RowVectorXd::Ones(n);
  const Eigen::VectorXd pi =
      Eigen::FullPivLU<Eigen::MatrixXd>(equations).solve(Eigen::VectorXd::Unit(n + 1, n));
  const Eigen::MatrixXd fundamental =
      (Eigen::MatrixXd::Identity(n, n) - p + Eigen::VectorXd::Ones(n) * pi.transpose()).inverse();
  Diffusion out{.states = {pi.data(), pi.data() + n}, .mean_time = 0.0};
  Eigen::Vector2d move = Eigen::Vector2d::Zero();
  each([&](int i, int, double q, const Eigen::Vector2d& l, double t, double) {
    move += pi[i] * q * l;
    out.mean_time += pi[i] * q * t;
  });
  out.drift = move / out.mean_time;
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(n, 2);  // expectation in each state
  each([&](int i, int, double q, const Eigen::Vector2d& l, double t, double) {
    f.row(i) += q * (l - out.drift * t).transpose();
  });
  const Eigen::MatrixXd later = fundamental * f;
  each([&](int i, int j, double q, const Eigen::Vector2d& l, double t, double t2) {
    const Eigen::Vector2d flow = l - out.drift * t;
    const Eigen::Matrix2d with_later = flow * later.row(j);
    out.tensor += pi[i] * q *
                  (flow * flow.transpose() + (t2 - t * t) * out.drift * out.drift.transpose() +
                   with_later + with_later.transpose());
  });
  out.tensor /= 2.0 * out.mean_time;
  return out;
}

void expect_same(const Diffusion& a, const Diffusion& b, double bound = kExact) {
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) EXPECT_NEAR(a.states[i], b.states[i], bound);
  EXPECT_NEAR(a.mean_time, b.mean_time, bound);
  EXPECT_LE((a.drift - b.drift).norm(), bound);
  EXPECT_LE((a.tensor - b.tensor).norm(), bound);
}

/// A walk that draws each of these moves with equal probability.
Chain moves_alike(const std::vector<std::array<int, 2>>& moves) {
  std::vector<Exit> exits;
  std::vector<test::Entry> entries;
  for (const auto& [x, y] : moves) {
    entries.push_back({0, static_cast<int>(exits.size()), 1.0 / static_cast<double>(moves.size())});
    exits.push_back({0, x, y});
  }
  return Chain::from_probabilities(matrix(1, static_cast<int>(moves.size()), entries), exits);
}

/// Hops between the sites of a honeycomb, of unit length in unit time: straight back with
/// probability `back`, else to either of the other neighbours.
Chain honeycomb(double back) {
  // Moves from sites of one kind: e0, e1, -e0 - e1; from sites of the other kind the reverse. A
  // state is the last move.
  constexpr int kMoves[3][2] = {{1, 0}, {0, 1}, {-1, -1}};
  std::vector<Exit> exits;
  std::vector<test::Entry> entries;
  for (int state = 0; state < 6; ++state) {
    const int sign = state < 3 ? 1 : -1, *const move = kMoves[state % 3];
    exits.push_back({state, sign * move[0], sign * move[1]});
    const int other_kind = state < 3 ? 3 : 0;
    for (int k = 0; k < 3; ++k)
      entries.push_back({state, other_kind + k, k == state % 3 ? back : (1.0 - back) / 2.0});
  }
  return Chain::from_probabilities(matrix(6, 6, entries), exits);
}
Eigen::Matrix2d honeycomb_lattice() {
  Eigen::Matrix2d lattice;
  lattice << 0.0, -std::sqrt(3.0) / 2.0, 1.0, -0.5;
  return lattice;
}

/// Every state leads to every other one, at random. The outputs are as in markov::test's chains,
/// but none traps.
Chain some_chain(int states, std::uint64_t seed) {
  test::Words words(seed);
  Counts counts(states, 2 * states);
  std::vector<Exit> exits;
  for (int output = 0; output < 2 * states; ++output)
    exits.push_back({output % states, words.below(5) - 2, words.below(4) - 1});
  for (int row = 0; row < states; ++row)
    for (int output = 0; output < 2 * states; ++output)
      if (words.below(3) > 0) counts.insert(row, output) = 1 + words.below(9);
  return Chain::from_counts(counts, exits);
}
Reward some_times(const Chain& chain, std::uint64_t seed) {
  test::Words words(seed);
  Reward time;
  for (Eigen::Index k = 0; k < chain.matrix().nonZeros(); ++k) {
    time.mean.push_back(0.1 * (1 + words.below(30)));
    time.square.push_back(time.mean.back() * time.mean.back() * (1.0 + 0.1 * words.below(10)));
  }
  return time;
}

TEST(Diffusion, OfSimpleRandomWalks) {
  const Diffusion square = diffusion(moves_alike({{1, 0}, {-1, 0}, {0, 1}, {0, -1}}));
  EXPECT_NEAR(square.coefficient(), 0.25, kExact);
  EXPECT_NEAR(square.tensor(0, 1), 0.0, kExact);
  EXPECT_EQ(square.mean_time, 1.0);
  // Only up and down: D is 1/2 along y, 0 along x.
  const Diffusion line = diffusion(moves_alike({{0, 1}, {0, -1}}));
  EXPECT_NEAR(line.tensor(1, 1), 0.5, kExact);
  EXPECT_EQ(line.tensor(0, 0), 0.0);
  // All six neighbours on a triangular lattice with sides of length 2.
  Eigen::Matrix2d triangles;
  triangles << 2.0, 1.0, 0.0, std::sqrt(3.0);
  const Diffusion six =
      diffusion(moves_alike({{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}), triangles);
  EXPECT_LE((six.tensor - Eigen::Matrix2d::Identity()).norm(), kExact);
}

// One step of memory on a honeycomb: D = 3 (1 - p) / (1 + 3 p) / 4 (Machta and Zwanzig's model with
// correlated hops, as in Klages and Dellago, J Stat Phys 101:145).
TEST(Diffusion, OfPersistentWalks) {
  for (const double back : {0.0, 0.2, 1.0 / 3.0, 0.3821, 0.7, 0.999}) {
    const Diffusion d = diffusion(honeycomb(back), honeycomb_lattice());
    EXPECT_LE(
        (d.tensor - 0.25 * 3.0 * (1.0 - back) / (1.0 + 3.0 * back) * Eigen::Matrix2d::Identity())
            .norm(),
        kExact)
        << back;
    for (const double share : d.states) EXPECT_NEAR(share, 1.0 / 6.0, kExact);
  }
  EXPECT_THROW((void)diffusion(honeycomb(1.0)), std::invalid_argument) << "goes to and fro";
}

// One state with moves up by 1 or down by 2, which take different times: a renewal process with D =
// var(l - v T) / (2 <T>), v = <l> / <T>.
TEST(Diffusion, TimesAndDriftOfARenewalProcess) {
  const Chain chain = Chain::from_probabilities(matrix(1, 2, {{0, 0, 0.75}, {0, 1, 0.25}}),
                                                {{0, 0, 1}, {0, 0, -2}});
  // Up takes 2 or 4, each half of the time, down always 1.
  const Diffusion d = diffusion(chain, Eigen::Matrix2d::Identity(), {{3.0, 1.0}, {10.0, 1.0}});
  const double v = (0.75 - 0.5) / (0.75 * 3.0 + 0.25);
  EXPECT_NEAR(d.mean_time, 2.5, kExact);
  EXPECT_NEAR(d.drift[1], v, kExact);
  const double variance = 0.375 * std::pow(1.0 - 2.0 * v, 2) + 0.375 * std::pow(1.0 - 4.0 * v, 2) +
                          0.25 * std::pow(-2.0 - v, 2);
  EXPECT_NEAR(d.tensor(1, 1), variance / 5.0, kExact);
}

TEST(Diffusion, IsThePlainGreenKuboSum) {
  Eigen::Matrix2d lattice;
  lattice << 1.5, -0.25, 0.5, 2.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const int states : {1, 2, 7, 60}) {
      const Chain chain = some_chain(states, seed);
      const Reward times = some_times(chain, seed);
      expect_same(diffusion(chain, lattice, times), diffusion_plainly(chain, lattice, times));
      expect_same(diffusion(chain, lattice), diffusion_plainly(chain, lattice, {}));
    }
}

// Walks that go round and round, which no iteration settles.
TEST(Diffusion, OfWalksInCircles) {
  constexpr int kStates = 401;
  std::vector<test::Entry> entries, hesitant;
  std::vector<Exit> exits;
  for (int i = 0; i < kStates; ++i) {
    entries.push_back({i, (i + 1) % kStates, 1.0});
    hesitant.push_back({i, (i + 1) % kStates, 1.0 - 1e-3});
    hesitant.push_back({i, (i + 2) % kStates, 1e-3});
    exits.push_back({i, i == 0 ? 1 : 0, i % 2});
  }
  const Chain circle = Chain::from_probabilities(matrix(kStates, kStates, entries), exits);
  const Diffusion d = diffusion(circle);
  EXPECT_NEAR(d.drift[0], 1.0 / kStates, kExact);
  EXPECT_NEAR(d.drift[1], 200.0 / kStates, kExact);
  EXPECT_LE(d.tensor.norm(), kExact) << "nothing is random";
  const Chain jumps = Chain::from_probabilities(matrix(kStates, kStates, hesitant), exits);
  // Walks forget within a million draws: rounding errors grow by that factor.
  expect_same(diffusion(jumps), diffusion_plainly(jumps, Eigen::Matrix2d::Identity(), {}), 1e-8);
}

// Many copies of each state, between which walks choose at random, give the same walk.
TEST(Diffusion, OfManyStates) {
  constexpr int kCopies = 3000, kOfARow = 6;
  const Chain base = some_chain(6, 3);
  const int n = base.inputs(), outputs = base.outputs();
  test::Words words(8);
  std::vector<Exit> exits;
  for (int output = 0; output < outputs; ++output)
    for (int copy = 0; copy < kCopies; ++copy) {
      Exit exit = base.exits()[static_cast<std::size_t>(output)];
      exit.next_input = exit.next_input * kCopies + copy;
      exits.push_back(exit);
    }
  Probabilities p(n * kCopies, outputs * kCopies);
  p.reserve(Eigen::VectorXi::Constant(n * kCopies, kOfARow * outputs));
  for (int row = 0; row < n * kCopies; ++row)
    for (Probabilities::InnerIterator it(base.matrix(), row / kCopies); it; ++it)
      for (int k = 0; k < kOfARow; ++k)
        p.coeffRef(row, static_cast<int>(it.col()) * kCopies + words.below(kCopies)) +=
            it.value() / kOfARow;
  const Diffusion many = diffusion(Chain::from_probabilities(p, exits)), one = diffusion(base);
  EXPECT_LE((many.tensor - one.tensor).norm(), 1e-9);
  EXPECT_LE((many.drift - one.drift).norm(), 1e-9);
}

TEST(Diffusion, StatesThatWalksLeaveForGoodMakeNoDifference) {
  const Chain chain = Chain::from_probabilities(
      matrix(3, 4,
             {{0, 1, 0.5}, {0, 3, 0.5}, {1, 1, 0.5}, {1, 2, 0.5}, {2, 1, 0.25}, {2, 2, 0.75}}),
      {{0, 5, 5}, {1, 1, 0}, {2, -1, 0}, {0, 0, 7}});
  const Chain without = Chain::from_probabilities(
      matrix(2, 2, {{0, 0, 0.5}, {0, 1, 0.5}, {1, 0, 0.25}, {1, 1, 0.75}}),
      {{0, 1, 0}, {1, -1, 0}});
  const Diffusion all = diffusion(chain), some = diffusion(without);
  EXPECT_NEAR(all.states[0], 0.0, kExact);
  EXPECT_LE((all.tensor - some.tensor).norm(), kExact);
  EXPECT_LE((all.drift - some.drift).norm(), kExact);
}

TEST(Diffusion, IsRefusedWhereThereIsNone) {
  const auto refused = [](const Chain& chain, const Reward& time = {}) {
    EXPECT_THROW((void)diffusion(chain, Eigen::Matrix2d::Identity(), time), std::invalid_argument);
  };
  refused(test::nearly_closed(0.1));  // bodies are trapped
  refused(Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}}), {{0, 1, 0}, {1, 1, 0}}));
  refused(Chain::from_probabilities(matrix(2, 2, {{0, 0, 1.0}, {1, 1, 1.0}}),
                                    {{0, 1, 0}, {1, -1, 0}}));  // walks left or right for ever
  const Chain walk = moves_alike({{1, 0}, {-1, 0}});
  refused(walk, {{1.0}, {1.0}});
  refused(walk, {{1.0, 1.0}, {1.0}});
  refused(walk, {{0.0, 0.0}, {0.0, 0.0}});
  refused(walk, {{1.0, std::nan("")}, {1.0, 1.0}});
}

}  // namespace
}  // namespace gatewalk::markov
