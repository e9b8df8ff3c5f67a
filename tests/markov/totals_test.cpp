// SPDX-License-Identifier: MIT
#include "markov/totals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numeric>

#include "markov/committor.h"
#include "markov/paths.h"
#include "markov/quasi_stationary.h"
#include "tests/markov/chains.h"
#include "tests/support/propagation.h"
#include "tests/support/threads.h"

namespace gatewalk::markov {
namespace {

using test::propagate;

using namespace test;

/// A random time for each nonzero, with some spread.
Rewards some_rewards(const FieldChain& chain, std::uint64_t seed) {
  Words words(seed);
  Rewards rewards;
  for (const Chain& c : chain.chains()) {
    Reward r;
    for (Eigen::Index i = 0; i < c.matrix().nonZeros(); ++i) {
      const double mean = 0.5 + 0.01 * words.below(300), sd = 0.002 * words.below(300) * mean;
      r.mean.push_back(mean);
      r.square.push_back(mean * mean + sd * sd);
    }
    rewards.push_back({r});
  }
  return rewards;
}

constexpr std::size_t at(Ending e) { return static_cast<std::size_t>(e); }

// One cell; state 0 is trapped after 2 s with 1/4, else goes up and out after 1 or 3 s.
TEST(WalkTotals, AreThoseDoneByHand) {
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, 0.75}, {0, 1, 0.25}}), {{0, 0, 1}, {}});
  const Rewards rewards = {{{{2.0, 2.0}, {5.0, 4.0}}}};
  const WalkTotals two = walk_totals(chain, {1, 2}, {}, 0, rewards);
  EXPECT_DOUBLE_EQ(two.endings[at(Ending::far_edge)], 0.5625);
  EXPECT_DOUBLE_EQ(two.endings[at(Ending::trapped)], 0.25 + 0.75 * 0.25);
  const Moments crossed = two.totals[0][at(Ending::far_edge)],
                trapped = two.totals[0][at(Ending::trapped)];
  EXPECT_DOUBLE_EQ(crossed.mean(), 4.0);
  EXPECT_DOUBLE_EQ(crossed.sd(), std::sqrt(2.0));  // twice 1 or 3 s
  // 2 s in 4 of 7 cases, else 2 s after 1 or 3 s.
  EXPECT_NEAR(trapped.mean(), (4 * 2.0 + 3 * 4.0) / 7.0, 1e-15);
  EXPECT_NEAR(trapped.square / trapped.share, (4 * 4.0 + 1.5 * 9.0 + 1.5 * 25.0) / 7.0, 1e-14);
  EXPECT_DOUBLE_EQ(two.draws[at(Ending::far_edge)].mean(), 2.0);
  EXPECT_DOUBLE_EQ(two.visits(0, 0), 1.0);
  EXPECT_DOUBLE_EQ(two.visits(1, 0), 0.75);
}

TEST(WalkTotals, EndAsPropagationSays) {
  Counts counts = lattice_counts(3);
  empty_row(counts, 30);
  const Chain chain = Chain::from_counts(counts, never_down());
  for (const int limit : {1, 13, 0}) {
    const FinalDistribution d =
        propagate(chain, kNineByNine, kBottomCentre, {.max_cells = limit, .tolerance = 1e-13});
    const WalkTotals t = walk_totals(chain, kNineByNine, kBottomCentre, limit);
    for (std::size_t e = 0; e < kEndings; ++e) EXPECT_NEAR(t.endings[e], d.endings[e], 2e-12);
    EXPECT_NEAR(t.visits.sum(), d.mean_steps, 1e-9);
    EXPECT_NEAR(WalkTotals::all(t.draws).mean(), d.mean_steps, 1e-9);
  }
}

// Row by row and step by step give the same. A limit that no walk reaches is computed by steps.
TEST(WalkTotals, ByRowsAreThoseByStepsUpToALimitThatNobodyReaches) {
  Counts gaps = lattice_counts(4);
  empty_row(gaps, 30);
  std::vector<Exit> leaps = never_down();  // of two columns, of two rows, and aslant
  for (std::size_t j = 0; j + 1 < leaps.size(); j += 7)
    leaps[j].di_x *= 2, leaps[j].di_y *= 2, leaps[j].di_x += leaps[j].di_y;
  const std::vector<Chain> chains = {Chain::from_counts(lattice_counts(3), leaps),
                                     Chain::from_counts(gaps, never_down())};
  std::vector<int> types(81);
  for (std::size_t i = 0; i < types.size(); ++i) types[i] = i % 3 == 0;
  for (const FieldChain& field :
       {FieldChain(chains[0]), FieldChain(chains[1]), FieldChain::by_cell(chains, 9, types)}) {
    const Rewards rewards = some_rewards(field, 8);
    std::vector<double> shares[2];
    const auto totals = [&](int limit) {
      auto& by_state = shares[limit == 0 ? 0 : 1];
      by_state.resize(std::size_t{81} * 87);
      return walk_totals(field, kNineByNine, kBottomCentre, limit, rewards,
                         [&](int, std::int64_t cell, int input, double share) {
                           by_state[static_cast<std::size_t>(cell * 87 + input)] += share;
                         });
    };
    const WalkTotals rows = totals(0), steps = totals(5000);
    EXPECT_LT(rows.remainder, 1e-12);
    EXPECT_LT((rows.visits - steps.visits).abs().maxCoeff(), 1e-11);
    for (std::size_t i = 0; i < shares[0].size(); ++i)
      EXPECT_NEAR(shares[0][i], shares[1][i], 1e-11);
    const auto expect_same = [](const Moments& a, const Moments& b) {
      EXPECT_NEAR(a.share, b.share, 1e-11);
      EXPECT_NEAR(a.sum, b.sum, 1e-10);
      EXPECT_NEAR(a.square, b.square, 1e-8);
    };
    for (std::size_t e = 0; e < kEndings; ++e) {
      expect_same(rows.draws[e], steps.draws[e]);
      expect_same(rows.totals[0][e], steps.totals[0][e]);
    }
  }
}

// Rare walks are followed if they are the target.
TEST(WalkTotals, FollowTheFewThatEndAsAskedFor) {
  const double up = 1e-4;
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, up}, {0, 1, 1.0 - up}}), {{0, 0, 1}, {}});
  const Field field{1, 20};
  const EndingChance chance(chain, field, Ending::far_edge, 0);
  const WalkTotals all = walk_totals(chain, field, {}, 0),
                   few = walk_totals(chain, field, {}, 0, {}, {}, {.chance = &chance});
  EXPECT_EQ(all.endings[at(Ending::far_edge)], 0.0);
  EXPECT_LT(all.remainder, 1e-12);
  EXPECT_NEAR(few.endings[at(Ending::far_edge)] / std::pow(up, 20), 1.0, 1e-12);
  EXPECT_NEAR(few.draws[at(Ending::far_edge)].mean(), 20.0, 1e-12);
}

// In large fields visits and endings are as exact as in small ones, and times come from drawn
// walks.
TEST(WalkTotals, OfLargeFieldsAreTheSameButForChanceInTheMoments) {
  Counts gaps = lattice_counts(4);
  empty_row(gaps, 30);
  const std::vector<Chain> chains = {Chain::from_counts(lattice_counts(3), never_down()),
                                     Chain::from_counts(gaps, never_down())};
  std::vector<int> rows_of_types(81);
  for (std::size_t i = 0; i < rows_of_types.size(); ++i) rows_of_types[i] = i / 9 % 2;
  for (const FieldChain& field :
       {FieldChain(chains[0]), FieldChain::by_cell(chains, 9, rows_of_types)}) {
    const Rewards rewards = some_rewards(field, 8);
    const EndingChance chance(field, kNineByNine, Ending::far_edge, 0);
    const auto totals = [&](double large, std::vector<double>& by_state) {
      by_state.assign(std::size_t{81} * 87, 0.0);
      return walk_totals(
          field, kNineByNine, kBottomCentre, 0, rewards,
          [&](int, std::int64_t cell, int input, double share) {
            by_state[static_cast<std::size_t>(cell * 87 + input)] += share;
          },
          {.chance = &chance, .large = large}, 7);
    };
    std::vector<double> shares, exact_shares;
    const WalkTotals exact = totals(1e9, exact_shares), large = totals(0.0, shares);
    EXPECT_EQ(exact.drawn_walks, 0);
    ASSERT_EQ(large.drawn_walks, 1 << 16);
    EXPECT_LT((large.visits - exact.visits).abs().maxCoeff(), 1e-11);
    for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(shares[i], exact_shares[i], 1e-11);
    for (const Ending e : {Ending::trapped, Ending::left_edge, Ending::far_edge}) {
      EXPECT_NEAR(large.endings[at(e)], exact.endings[at(e)], 1e-11);
      const double n = 65536.0 * exact.endings[at(e)];
      const auto expect_close = [&](const Moments& drawn, const Moments& wanted) {
        EXPECT_NEAR(drawn.share, wanted.share, 1e-11);
        EXPECT_NEAR(drawn.mean(), wanted.mean(), 4.5 * wanted.sd() / std::sqrt(n));
        EXPECT_NEAR(drawn.sd() / wanted.sd(), 1.0, 8.0 / std::sqrt(n));
      };
      expect_close(large.draws[at(e)], exact.draws[at(e)]);
      expect_close(large.totals[0][at(e)], exact.totals[0][at(e)]);
    }
    // The means over all walks need no drawn walks.
    EXPECT_NEAR(WalkTotals::all(large.draws).mean(), WalkTotals::all(exact.draws).mean(), 1e-9);
    for (std::size_t q = 0; q < exact.totals.size(); ++q)
      EXPECT_NEAR(WalkTotals::all(large.totals[q]).mean() / WalkTotals::all(exact.totals[q]).mean(),
                  1.0, 1e-9);
    const auto one = gatewalk::test::on_threads(1, [&] { return totals(0.0, shares); });
    EXPECT_EQ(one.totals[0][at(Ending::trapped)].sum, large.totals[0][at(Ending::trapped)].sum);
  }
}

// A row that one walk in 10^80 reaches: such walks are drawn as well.
TEST(WalkTotals, OfLargeFieldsKnowTheFewThatEndAsAskedFor) {
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, 1e-4}, {0, 1, 1.0 - 1e-4}}), {{0, 0, 1}, {}});
  const Field field{1, 20};
  const EndingChance chance(chain, field, Ending::far_edge, 0);
  const Rewards rewards{{Reward{{3.0, 1.0}, {9.0, 1.0}}}};  // of going on, of being trapped
  const WalkTotals few =
      walk_totals(chain, field, {}, 0, rewards, {}, {.chance = &chance, .large = 0.0}, 3);
  EXPECT_NEAR(few.endings[at(Ending::far_edge)] / 1e-80, 1.0, 1e-12);
  EXPECT_NEAR(few.draws[at(Ending::far_edge)].mean(), 20.0, 1e-12);
  EXPECT_NEAR(few.totals[0][at(Ending::far_edge)].mean(), 60.0, 1e-12);
  EXPECT_NEAR(WalkTotals::all(few.totals[0]).mean(), 3.0 * 1e-4 / (1.0 - 1e-4) + 1.0, 1e-12);
  const WalkTotals without =
      walk_totals(chain, field, {}, 0, {}, {}, {.chance = &chance, .large = 0.0}, 3);
  EXPECT_EQ(without.drawn_walks, 0);  // no rewards are asked for
}

// The times of walks have the given moments, and the walks have the endings of the prediction.
TEST(WalkTotals, AreThoseOfTimedWalks) {
  std::vector<Chain> chains = {Chain::from_counts(lattice_counts(3), never_down()),
                               Chain::from_counts(lattice_counts(4), never_down())};
  std::vector<int> types(81);
  for (std::size_t i = 0; i < types.size(); ++i) types[i] = i % 3 == 0;
  const FieldChain field = FieldChain::by_cell(chains, 9, types);
  const Rewards rewards = some_rewards(field, 8);
  const WalkTotals exact = walk_totals(field, kNineByNine, kBottomCentre, 13, rewards);
  constexpr std::int64_t kWalks = 200'000;
  const auto walks = gatewalk::test::on_threads(
      2, [&] { return timed_walks(field, kNineByNine, kBottomCentre, 13, rewards, kWalks, 5); });
  for (const Ending e : {Ending::trapped, Ending::left_edge, Ending::far_edge}) {
    Moments seen;
    for (const TimedWalk& w : walks)
      if (w.ending == e) {
        seen.share += 1.0 / kWalks;
        seen.sum += w.total / kWalks;
        seen.square += w.total * w.total / kWalks;
      }
    const Moments& wanted = exact.totals[0][at(e)];
    const double n = kWalks * wanted.share;
    EXPECT_NEAR(seen.share, wanted.share, 4.0 * std::sqrt(wanted.share / kWalks));
    EXPECT_NEAR(seen.mean(), wanted.mean(), 4.0 * wanted.sd() / std::sqrt(n));
    EXPECT_NEAR(seen.sd() / wanted.sd(), 1.0, 6.0 / std::sqrt(n));
  }
  const auto one = gatewalk::test::on_threads(
      1, [&] { return timed_walks(field, kNineByNine, kBottomCentre, 13, rewards, 500, 5); });
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].total, walks[i].total);
    EXPECT_EQ(one[i].ending, walks[i].ending);
  }
}

TEST(WalkTotals, RefuseRewardsOfAnotherChain) {
  const Chain chain = Chain::from_counts(lattice_counts(3), never_down());
  Rewards rewards = some_rewards(chain, 1);
  rewards[0][0].mean.pop_back();
  EXPECT_THROW((void)walk_totals(chain, kNineByNine, kBottomCentre, 13, rewards),
               std::invalid_argument);
  EXPECT_THROW((void)timed_walks(chain, kNineByNine, kBottomCentre, 13, {}, 1, 1),
               std::invalid_argument);
}

// From left (state 0) to right (1) and back, and up once in a million: G draws on the left, G
// geometric, and G - 1 on the right. Sums stop long before.
TEST(WalkTotals, AreExactWhereWalksCircleForLong) {
  const double out = 1e-6;
  for (const int back : {1, -1}) {  // with an unreachable state that may lead back
    const Chain chain = Chain::from_probabilities(
        matrix(3, 4, {{0, 1, 1.0 - out}, {0, 2, out}, {1, 0, 1.0}, {2, 3, 1.0}}),
        {{0, -1, 0}, {1, 1, 0}, {2, 0, 1}, {2, 0, back}});
    const Rewards rewards{{Reward{{2.0, 2.0, 3.0, 1.0}, {4.0, 4.0, 9.0, 1.0}}}};
    const Field field{2, 1};
    const EndingChance chance(chain, field, Ending::far_edge, 0);
    double told = 0.0;
    const WalkTotals t = walk_totals(chain, field, {}, 0, rewards,
                                     [&](int, std::int64_t, int, double share) { told += share; },
                                     {.chance = &chance});
    const double g = 1.0 / out, gg = (2.0 - out) / (out * out);      // E G, E G^2
    const auto expect = [&](const Moments& m, double a, double b) {  // of a G - b
      EXPECT_NEAR(m.mean() / (a * g - b), 1.0, 1e-9);
      EXPECT_NEAR(m.square / (a * a * gg - 2 * a * b * g + b * b), 1.0, 1e-9);
    };
    EXPECT_NEAR(t.endings[at(Ending::far_edge)], 1.0, 1e-9);
    EXPECT_EQ(t.remainder, 0.0);
    EXPECT_NEAR(t.visits(0, 0) * out, 1.0, 1e-9);
    EXPECT_NEAR(told / (2.0 * g - 1.0), 1.0, 1e-9);
    expect(t.draws[at(Ending::far_edge)], 2.0, 1.0);
    expect(t.totals[0][at(Ending::far_edge)], 5.0, 3.0);
  }
}

// ---- The probability of an ending ----

TEST(EndingChance, IsThatOfPropagationFromEverywhere) {
  Counts counts = lattice_counts(7);
  empty_row(counts, 30);
  const Chain chain = Chain::from_counts(counts, never_down());
  for (const int limit : {7, 0})
    for (const Ending e : {Ending::far_edge, Ending::left_edge, Ending::right_edge, Ending::trapped,
                           Ending::cut_off, Ending::unsampled}) {
      if (limit == 0 && e == Ending::cut_off) continue;
      const EndingChance chance(chain, {5, 6}, e, limit);
      for (const Start& start : {Start{2, 0, 12}, Start{0, 5, 40}, Start{4, 3, 86}}) {
        const FinalDistribution d =
            propagate(chain, {5, 6}, start, {.max_cells = limit, .tolerance = 1e-14});
        EXPECT_NEAR(chance(1, start.row * 5 + start.column, start.input), d.endings[at(e)], 1e-11)
            << "ending " << at(e) << ", limit " << limit;
      }
    }
}

TEST(EndingChance, FewerDrawsAreLeftLater) {
  const Chain chain = Chain::from_counts(lattice_counts(7), never_down());
  const EndingChance seven(chain, {5, 6}, Ending::trapped, 7),
      five(chain, {5, 6}, Ending::trapped, 5);
  for (const int input : {0, 40, 86}) EXPECT_EQ(seven(3, 12, input), five(1, 12, input));
  EXPECT_EQ(seven(8, 12, 0), 0.0);
  EXPECT_EQ(EndingChance(chain, {5, 6}, Ending::cut_off, 7)(8, 12, 0), 1.0);
}

// In cells that walks from a start can reach, the bits are those from everywhere; elsewhere the
// result is NaN.
TEST(EndingChance, FromAStartIsTheSameWhereItLeads) {
  Counts counts = lattice_counts(7);
  empty_row(counts, 30);
  const FieldChain chain(Chain::from_counts(counts, lattice_exits()));
  const Field field{5, 6};
  const Start start{2, 1, 12};
  for (const Ending e : {Ending::far_edge, Ending::trapped, Ending::unsampled}) {
    const EndingChance all(chain, field, e, 6), from(chain, field, e, 6, kRowTolerance, start);
    std::size_t known = 0;
    for (int draw = 1; draw <= 7; ++draw)
      for (std::int64_t cell = 0; cell < 30; ++cell) {
        const std::int64_t way = std::abs(cell % 5 - 2) + std::abs(cell / 5 - 1);
        if (draw <= 6 && (way >= draw || (way - draw) % 2 == 0)) {
          EXPECT_TRUE(std::isnan(from(draw, cell, 40))) << draw << " " << cell;
          continue;
        }
        ++known;
        for (int input = 0; input < 87; ++input)
          EXPECT_EQ(from(draw, cell, input), all(draw, cell, input)) << draw << " " << cell;
      }
    EXPECT_GT(known, 40U);
  }
}

// ---- Paths ----

TEST(Paths, AreTheMostFrequentOfAll) {
  const Chain chain = Chain::from_counts(lattice_counts(7), never_down());
  const Field field{3, 3};
  const Start start{1, 0, 12};
  constexpr int kLimit = 6;
  // All paths of walks by brute force.
  std::map<std::vector<std::int64_t>, double> all;
  const Eigen::MatrixXd p = chain.matrix();
  const std::function<void(std::vector<std::int64_t>, const Eigen::VectorXd&)> follow =
      [&](std::vector<std::int64_t> cells, const Eigen::VectorXd& states) {
        const Eigen::VectorXd out = p.transpose() * states;
        std::map<std::int64_t, Eigen::VectorXd> next;
        for (int j = 0; j < 87; ++j) {
          const Exit& exit = chain.exits()[static_cast<std::size_t>(j)];
          const std::int64_t column = cells.back() % 3 + exit.di_x,
                             row = cells.back() / 3 + exit.di_y;
          if (row >= 3) all[cells] += out(j);
          if (column < 0 || column >= 3 || row >= 3) continue;
          next.try_emplace(row * 3 + column, Eigen::VectorXd::Zero(87)).first->second(j) += out(j);
        }
        if (static_cast<int>(cells.size()) == kLimit) return;
        for (const auto& [to, there] : next) {
          cells.push_back(to);
          follow(cells, there);
          cells.pop_back();
        }
      };
  Eigen::VectorXd first = Eigen::VectorXd::Zero(87);
  first(start.input) = 1.0;
  follow({1}, first);

  const EndingChance chance(chain, field, Ending::far_edge, kLimit);
  const auto found = most_frequent_paths(chain, field, start, kLimit, chance, all.size() + 5);
  EXPECT_FALSE(found.gave_up);
  const auto& paths = found.paths;
  EXPECT_TRUE(most_frequent_paths(chain, field, start, kLimit, chance, 3, 1).gave_up);
  std::vector<double> shares;
  for (const auto& [cells, share] : all)
    if (share > 0.0) shares.push_back(share);
  std::sort(shares.begin(), shares.end(), std::greater<>());
  ASSERT_EQ(paths.size(), shares.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    EXPECT_NEAR(paths[i].share, shares[i], 1e-15);
    EXPECT_NEAR(all.at(paths[i].cells), paths[i].share, 1e-15);
  }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  EXPECT_NEAR(sum, chance(1, 1, start.input), 1e-14);
}

// From left to right and back, and up once in 10^4: k rounds have the probability (1 - out)^k out.
// The first of these paths are proved to be the most frequent only after some 10^5 rounds.
TEST(Paths, ShareTheirBeginningsWhereWalksCircleForLong) {
  const double out = 1e-4;
  const Chain chain =
      Chain::from_probabilities(matrix(2, 3, {{0, 1, 1.0 - out}, {0, 2, out}, {1, 0, 1.0}}),
                                {{0, -1, 0}, {1, 1, 0}, {0, 0, 1}});
  const Field field{2, 1};
  const EndingChance chance(chain, field, Ending::far_edge, 0);
  const auto found = most_frequent_paths(chain, field, {}, 0, chance, 3);
  EXPECT_FALSE(found.gave_up);
  ASSERT_EQ(found.paths.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(found.paths[k].cells.size(), 2 * k + 1);
    EXPECT_NEAR(found.paths[k].share, out * std::pow(1.0 - out, static_cast<double>(k)), 1e-15);
  }
}

// ---- Quasi-stationary distribution ----

TEST(QuasiStationary, IsTheFirstEigenvectorOfTheMatrix) {
  const Chain chain = Chain::from_counts(lattice_counts(7), never_down());
  const QuasiStationary q = quasi_stationary(chain, {1.0});
  const Eigen::MatrixXd kernel = Eigen::MatrixXd(chain.matrix()).leftCols(87).transpose();
  std::vector<double> moduli;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(kernel, false);
  for (const auto& value : solver.eigenvalues()) moduli.push_back(std::abs(value));
  std::sort(moduli.begin(), moduli.end(), std::greater<>());
  EXPECT_NEAR(q.survival, moduli[0], 1e-12);
  EXPECT_NEAR(q.second, moduli[1], 1e-8);
  ASSERT_EQ(std::ssize(q.moduli), kToldEigenvalues);
  for (std::size_t k = 0; k < q.moduli.size(); ++k) EXPECT_NEAR(q.moduli[k], moduli[k], 1e-13);
  const Eigen::Map<const Eigen::VectorXd> states(q.states.data(), 87);
  EXPECT_NEAR(states.sum(), 1.0, 1e-12);
  EXPECT_LT((kernel * states - q.survival * states).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(QuasiStationary, IsKnownForTwoStates) {
  // Half of the walks survive in each state: state 0 goes to 0 and 1 alike, state 1 only to 0.
  const Chain chain = Chain::from_probabilities(
      matrix(2, 3, {{0, 0, 0.25}, {0, 1, 0.25}, {0, 2, 0.5}, {1, 0, 0.5}, {1, 2, 0.5}}),
      {{0, 0, 1}, {1, 1, 0}, {}});
  const QuasiStationary q = quasi_stationary(chain, {1.0});
  EXPECT_NEAR(q.survival, 0.5, 1e-12);
  EXPECT_NEAR(q.second, 0.25, 1e-6);
  EXPECT_NEAR(q.states[0], 2.0 / 3.0, 1e-10);
  EXPECT_NEAR(q.rows_per_cell, 2.0 / 3.0, 1e-10);  // moves to state 0 lead up
}

/// States in a ring: with `on` to the next one, with `back` to the one before, else stays; a tenth
/// is trapped.
Chain ring(int states, double on, double back) {
  std::vector<Entry> entries;
  std::vector<Exit> exits;
  for (int i = 0; i < states; ++i) {
    exits.push_back({i, 0, 1});
    entries.push_back({i, i, 0.9 * (1.0 - on - back)});
    entries.push_back({i, (i + 1) % states, 0.9 * on});
    entries.push_back({i, (i + states - 1) % states, 0.9 * back});
    entries.push_back({i, states, 0.1});
  }
  exits.push_back({});
  return Chain::from_probabilities(matrix(states, states + 1, entries), exits);
}

// By hand: 0.9 (1 - 2 p + 2 p cos(2 pi k / n)) for steps to both sides; on a one-way circle all
// moduli are 0.9.
TEST(QuasiStationary, OfARingHasItsTimeScales) {
  const std::vector<double> both = quasi_stationary(ring(7, 0.2, 0.2), {1.0}).moduli;
  ASSERT_EQ(std::ssize(both), kToldEigenvalues);
  for (std::size_t k = 0; k < both.size(); ++k) {
    const double turn = 2.0 * M_PI * static_cast<double>((k + 1) / 2) / 7.0;
    EXPECT_NEAR(both[k], 0.9 * (0.6 + 0.4 * std::cos(turn)), 1e-14) << k;
  }
  EXPECT_NEAR(implied_time_scale(both[0]), -1.0 / std::log(0.9), 1e-12);
  const std::vector<double> circle = quasi_stationary(ring(5, 1.0, 0.0), {1.0}).moduli;
  ASSERT_EQ(circle.size(), 5u);
  for (const double modulus : circle) EXPECT_NEAR(modulus, 0.9, 1e-14);
  EXPECT_TRUE(std::isinf(implied_time_scale(1.0)));
  EXPECT_TRUE(std::isinf(implied_time_scale(std::nextafter(1.0, 0.0))));
  EXPECT_EQ(implied_time_scale(0.0), 0.0);
}

// More states than are solved densely: the reported eigenvalues are right, and more than two.
TEST(QuasiStationary, OfManyStatesTellsWhatSettles) {
  // 5 x 87 states, of which each draw changes both parts, so eigenvalues are products.
  const Probabilities slow = ring(5, 0.1, 0.02).matrix();
  const Chain fast = Chain::from_counts(lattice_counts(7), never_down());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(435, 435);
  std::vector<Entry> entries;
  std::vector<Exit> exits;
  for (int a = 0; a < 5; ++a)
    for (int i = 0; i < 87; ++i) {
      exits.push_back({87 * a + i, 0, 1});
      double ends = 1.0;
      for (int b = 0; b < 5; ++b)
        for (Probabilities::InnerIterator it(fast.matrix(), i); it; ++it) {
          const double p = slow.coeff(a, b) * it.value();
          if (it.col() == 87 || p == 0.0) continue;
          entries.push_back({87 * a + i, 87 * b + static_cast<int>(it.col()), p});
          dense(87 * a + i, 87 * b + it.col()) = p;
          ends -= p;
        }
      entries.push_back({87 * a + i, 435, ends});
    }
  exits.push_back({});
  const QuasiStationary q =
      quasi_stationary(Chain::from_probabilities(matrix(435, 436, entries), exits), {1.0});
  std::vector<double> moduli;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(dense, false);
  for (const auto& value : solver.eigenvalues()) moduli.push_back(std::abs(value));
  std::sort(moduli.begin(), moduli.end(), std::greater<>());
  ASSERT_GE(q.moduli.size(), 5u);
  for (std::size_t k = 0; k < q.moduli.size(); ++k) EXPECT_NEAR(q.moduli[k], moduli[k], 1e-8) << k;
}

TEST(QuasiStationary, SaysWhereNobodySurvives) {
  const Chain chain = Chain::from_probabilities(matrix(1, 2, {{0, 1, 1.0}}), {{0, 0, 1}, {}});
  EXPECT_THROW((void)quasi_stationary(chain, {1.0}), std::runtime_error);
  EXPECT_THROW((void)quasi_stationary(chain, {0.5, 0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
