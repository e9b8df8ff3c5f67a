// SPDX-License-Identifier: MIT
#include "dynamics/cells/quantile_bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/disc/disc_section.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;

const Section kPaper = disc_section(GateParams{});

/// Entries at every boundary, half of them at EN; unequal left and right.
std::vector<Entry> made_up(int n, std::uint64_t seed) {
  Draw draw(seed);
  std::vector<Entry> entries;
  for (int i = 0; i < n; ++i) {
    const int face = i % 2 == 0 ? 0 : 1 + static_cast<int>(draw.below(4));
    const double u = draw.uniform(0, 1);
    const double d = face == Boundary::enter ? draw.uniform(-25, 25) : draw.uniform(10, 30);
    const double vx = 20 * u * u * draw.sign();
    entries.push_back({face, {d, vx, draw.uniform(5, 25)}});
  }
  return entries;
}

std::vector<Entry> scaled(std::vector<Entry> entries, double length, double speed) {
  for (Entry& c : entries) c = {c.face, {c.at[0] * length, c.at[1] * speed, c.at[2] * speed}};
  return entries;
}

// Four bins of eight values: edges midway between the second and third, and so on.
TEST(QuantileSpace, HasItsEdgesMidwayBetweenTheEntries) {
  std::vector<Entry> seen;
  for (int copy = 0; copy < 10; ++copy)
    for (const double v : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0})
      seen.push_back({Boundary::enter, {-v, v, 2 * v}});
  const StateSpace s = quantile_space(kPaper, seen, 8, {});  // 2 x 2 x 2
  const Bins& enter = s.bins()[0];
  EXPECT_EQ(enter.edges[0], (std::vector<double>{-128, -12, -1}));
  EXPECT_EQ(enter.edges[1], (std::vector<double>{1, 12, 128}));
  EXPECT_EQ(enter.edges[2], (std::vector<double>{2, 24, 256}));
  EXPECT_TRUE(s.open());
  EXPECT_EQ(s.size(), 8 + 4);  // one bin for each boundary without entries
}

TEST(QuantileSpace, HasAboutAsManyStatesAsAskedFor) {
  const auto seen = made_up(20'000, 1);
  EXPECT_EQ(quantile_space(kPaper, seen, 1, {}).size(), kBoundaries);
  for (const int states : {87, 348, 1000}) {
    const StateSpace s = quantile_space(kPaper, seen, states, {});
    EXPECT_GE(s.size(), states / 2) << states;
    EXPECT_LE(s.size(), 2 * states + kBoundaries) << states;
  }
  // At most one state for ten entries: 300 entries, 30 states.
  EXPECT_LE(quantile_space(kPaper, made_up(300, 2), 1000, {}).size(), 60);
  EXPECT_THROW((void)quantile_space(kPaper, seen, 0, {}), std::invalid_argument);
  EXPECT_THROW((void)quantile_space(kPaper, seen, kMostStates + 1, {}), std::invalid_argument);
}

TEST(QuantileSpace, DealsTheEntriesOutEvenlyAlongEveryAxis) {
  const auto seen = made_up(20'000, 3);
  const StateSpace s = quantile_space(kPaper, seen, 348, {});
  const std::vector<double>& vx = s.bins()[0].edges[kEntryVx];
  const auto bins = static_cast<int>(vx.size()) - 1;
  ASSERT_GE(bins, 4);
  for (int i = 0; i < bins; ++i) {
    int n = 0;
    for (const Entry& c : seen)
      n += c.face == Boundary::enter && c.at[kEntryVx] >= vx[i] &&
           (c.at[kEntryVx] < vx[i + 1] || i + 1 == bins);
    EXPECT_NEAR(n, 10'000.0 / bins, 1.0) << i;
  }
}

TEST(QuantileSpace, ClampsNothing) {
  const auto seen = made_up(5000, 4);
  const StateSpace s = quantile_space(kPaper, seen, 87, {});
  for (const Entry& c : seen) {
    const auto index = s.index_of(c);
    EXPECT_FALSE(index.clamped || index.beyond);
  }
  const auto far = s.index_of({Boundary::enter, {0.0, 1e6, -1e6}});
  EXPECT_FALSE(far.clamped);
  EXPECT_TRUE(far.beyond);
}

TEST(QuantileSpace, IsSymmetricWhereTheEntriesAre) {
  for (const int n : {37, 400, 5001}) {
    auto seen = made_up(n, 5);
    for (Entry& c : seen) c.at[kEntryVx] = std::round(c.at[kEntryVx]);  // many are equal
    add_mirror_images(kPaper, seen);
    ASSERT_EQ(seen.size(), 2u * static_cast<std::size_t>(n));
    for (const int states : {8, 87, 348}) {
      const auto bins = quantile_space(kPaper, seen, states, {}).bins();
      const auto negated = [](std::vector<double> edges) {
        std::reverse(edges.begin(), edges.end());
        for (double& e : edges) e = -e;
        return edges;
      };
      EXPECT_EQ(bins[0].edges[kEntryD], negated(bins[0].edges[kEntryD]));
      EXPECT_EQ(bins[0].edges[kEntryVx], negated(bins[0].edges[kEntryVx]));
      for (const int face : {1, 3}) {
        const auto &right = bins[face].edges, &left = bins[face + 1].edges;
        EXPECT_EQ(right[kEntryD], left[kEntryD]);
        EXPECT_EQ(right[kEntryVx], negated(left[kEntryVx]));
        EXPECT_EQ(right[kEntryVy], left[kEntryVy]);
      }
    }
  }
}

TEST(QuantileSpace, TwinsHaveTheSameBins) {
  GateParams p;
  const auto seen = made_up(3000, 6);
  const Entry start{Boundary::enter, {3.0, 1.0, 15.0}};
  const StateSpace s = quantile_space(disc_section(p), seen, 87, {start});
  for (const int power : {-10, -3, 7, 10}) {
    const double length = std::ldexp(1.0, 2 * power), time = std::ldexp(1.0, 2 - 2 * power);
    const double speed = length / time;
    const auto twin = quantile_space(disc_section(p), scaled(seen, length, speed), 87,
                                     scaled({start}, length, speed));
    EXPECT_EQ(twin.size(), s.size());
    for (std::size_t b = 0; b < kBoundaries; ++b) {
      const auto times = [](std::vector<double> edges, double factor) {
        for (double& e : edges) e *= factor;
        return edges;
      };
      const auto &own = s.bins()[b].edges, &others = twin.bins()[b].edges;
      EXPECT_EQ(others[kEntryD], times(own[kEntryD], length));
      EXPECT_EQ(others[kEntryVx], times(own[kEntryVx], speed));
      EXPECT_EQ(others[kEntryVy], times(own[kEntryVy], speed));
    }
    const Resolution a = resolution_of(s, seen),
                     b = resolution_of(twin, scaled(seen, length, speed));
    EXPECT_EQ(a.unresolved, b.unresolved);
    EXPECT_EQ(a.states_of_90, b.states_of_90);
  }
}

// Entries that are all equal, or none: the bins still have a range.
TEST(QuantileSpace, TakesEntriesThatAreAllAlike) {
  const Entry c{Boundary::enter, {0.0, 0.0, 40.0}};
  const StateSpace s = quantile_space(kPaper, std::vector<Entry>(1000, c), 87, {c});
  EXPECT_EQ(s.size(), kBoundaries + 1);
  EXPECT_EQ(s.bins()[0].edges[kEntryVy],
            (std::vector<double>{10, 40}));  // Table III's, up to the entry
  EXPECT_EQ(quantile_space(kPaper, {}, 87, {}).size(), kBoundaries);
}

TEST(Resolution, IsTheVarianceWithinTheStates) {
  const Bins enter{{{{-1, 0, 1}, {-1, 1}, {0, 10}}}}, side{{{{0, 1}, {-1, 1}, {0, 10}}}};
  const std::vector<Bins> bins{enter, side, side, side, side};
  // d: values -.75, -.25, .25, .75: variance 5/16 in all, 1/16 within a bin.
  std::vector<Entry> seen;
  for (const double d : {-0.75, -0.25, 0.25, 0.75})
    for (const double vy : {2.0, 6.0}) seen.push_back({Boundary::enter, {d, 0.0, vy}});
  seen.push_back({Boundary::right_deflect, {0.5, 0.0, 4.0}});
  seen.push_back({Boundary::right_deflect, {0.5, 0.0, 40.0}});  // outside
  const StateSpace space(kPaper, bins);
  const Resolution r = resolution_of(space, seen);
  EXPECT_EQ(r.entries, 10);
  EXPECT_EQ(r.clamped, 1);
  EXPECT_EQ(r.states_entered, 3);
  EXPECT_EQ(r.states_of_90, 3);
  EXPECT_NEAR(r.unresolved[0], 0.2, 1e-15);
  EXPECT_EQ(r.unresolved[1], 0.0);
  EXPECT_NEAR(r.unresolved[2], 1.0, 1e-15);
  EXPECT_TRUE(r.poor());  // nothing of vy
  EXPECT_FALSE(resolution_of(space, {}).poor());
}

// Bins on another scale: nothing is clamped, and everything is in one bin of its boundary.
TEST(Resolution, TellsBinsThatAreFarTooWide) {
  auto seen = made_up(5000, 7);
  for (Entry& c : seen) c.at = {c.at[0], 0.01 * c.at[1], 15 + 0.01 * c.at[2]};
  const Resolution r = resolution_of(table3_space({}), seen);
  EXPECT_LT(r.clamped, r.entries / 2);
  EXPECT_TRUE(r.poor());
  EXPECT_FALSE(resolution_of(quantile_space(kPaper, seen, 87, {}), seen).poor());
}

}  // namespace
}  // namespace gatewalk::dynamics
