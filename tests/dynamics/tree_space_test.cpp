// SPDX-License-Identifier: MIT
#include "dynamics/cells/tree_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

#include "dynamics/disc/disc_section.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;

const Section kPaper = disc_section(GateParams{});

/// Entries at every boundary but RT and LT, densest at the middle.
std::vector<Entry> made_up(int n, std::uint64_t seed) {
  Draw draw(seed);
  std::vector<Entry> entries;
  for (int i = 0; i < n; ++i) {
    const double narrow = draw.uniform(0.0, 1.0);
    const int face = i % 4 == 0 ? 1 : i % 4 == 1 ? 2 : 0;
    const double d = draw.uniform(-20, 20) * narrow, vx = draw.uniform(-15, 15);
    entries.push_back({face, {d, vx, draw.uniform(5, 25)}});
  }
  return entries;
}

// By hand: eight entries in a row along vx, two per leaf, are cut in the middle.
TEST(TreeSpace, HalvesAtTheMedianOfTheWidestAxis) {
  std::vector<Entry> entries;
  for (const double vx : {8.0, 1.0, 7.0, 2.0, 6.0, 3.0, 5.0, 4.0})
    entries.push_back({Boundary::enter, {0.1 * vx, vx, 15.0}});
  std::vector<int> states;
  const StateSpace space = tree_space(kPaper, {kPaper, entries}, 2, {}, &states);
  const Tree& tree = space.trees()[0];
  ASSERT_EQ(tree.nodes.size(), 7u);
  EXPECT_EQ(tree.nodes[0], (Tree::Node{1, 4.5}));
  EXPECT_EQ(tree.nodes[1], (Tree::Node{1, 2.5}));
  EXPECT_EQ(tree.nodes[2], Tree::Node{});
  EXPECT_EQ(tree.nodes[4], (Tree::Node{1, 6.5}));
  EXPECT_EQ(space.size(), 4 + 4);  // and one state for each boundary without entries
  EXPECT_EQ(states, (std::vector<int>{3, 0, 3, 0, 2, 1, 2, 1}));
  EXPECT_EQ(space.range(1).at[kEntryVx], (std::array<double, 2>{2.5, 4.5}));
  EXPECT_EQ(space.range(1).at[kEntryD], (std::array<double, 2>{0.1 * 1.0, 0.1 * 8.0}));
  EXPECT_EQ(space.index_of({Boundary::enter, {0.5, -100.0, 15.0}}).state, 0);
  EXPECT_TRUE(space.index_of({Boundary::enter, {0.5, -100.0, 15.0}}).beyond);
  EXPECT_FALSE(space.index_of({Boundary::enter, {0.5, -100.0, 15.0}}).clamped);
  EXPECT_EQ(space.face(4), Boundary::right_deflect);
}

TEST(TreeSpace, LeavesHoldFromOnceToTwiceTheEntriesAskedFor) {
  const auto entries = made_up(5000, 3);
  std::vector<int> states;
  const StateSpace space = tree_space(kPaper, {kPaper, entries}, 7, {}, &states);
  std::map<int, int> held;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(space.index_of(entries[i]).state, states[i]);
    EXPECT_FALSE(space.index_of(entries[i]).beyond);
    ++held[states[i]];
  }
  for (const auto& [state, n] : held) {
    EXPECT_GE(n, 7);
    EXPECT_LT(n, 14);
  }
  EXPECT_EQ(static_cast<int>(held.size()) + 2, space.size());  // RT and LT were never seen
}

// ---- A plain grower, which sorts instead of partitioning.

/// Appends the tree of the entries with numbers `these`, and writes their leaves into `states`.
void grow_plainly(const Section& section, const std::vector<Entry>& entries,
                  const std::vector<std::size_t>& these, std::size_t per_leaf,
                  std::vector<Tree::Node>& nodes, std::vector<int>& states, int& leaves) {
  const std::size_t n = these.size(), coordinates = section.coordinates.size();
  const auto value = [&](std::size_t i, std::size_t axis) { return entries[i].at[axis]; };
  const auto spread = [&](std::size_t axis) {
    double mean = 0.0, squares = 0.0;
    for (const std::size_t i : these) mean += value(i, axis) / static_cast<double>(n);
    for (const std::size_t i : these) squares += std::pow(value(i, axis) - mean, 2);
    return squares / std::pow(section.coordinates[axis].scale, 2);
  };
  std::vector<std::size_t> axes(coordinates);
  std::iota(axes.begin(), axes.end(), std::size_t{0});
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::size_t a, std::size_t b) { return spread(a) > spread(b); });
  for (const std::size_t axis : axes) {
    std::vector<std::size_t> sorted = these;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::size_t a, std::size_t b) { return value(a, axis) < value(b, axis); });
    // Cut below or above the entries that equal the median: at the place nearer to the middle that
    // fits.
    const double median = value(sorted[n / 2], axis);
    std::size_t low = 0, high = 0;
    for (const std::size_t i : sorted) {
      low += value(i, axis) < median;
      high += value(i, axis) <= median;
    }
    const auto fits = [&](std::size_t k) { return k >= per_leaf && n - k >= per_leaf; };
    std::size_t below = 0;
    if (fits(low) && (n / 2 - low <= high - n / 2 || !fits(high)))
      below = low;
    else if (fits(high))
      below = high;
    if (below == 0) continue;
    const double cut = 0.5 * value(sorted[below - 1], axis) + 0.5 * value(sorted[below], axis);
    nodes.push_back({static_cast<int>(axis), cut});
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(below);
    grow_plainly(section, entries, {sorted.begin(), middle}, per_leaf, nodes, states, leaves);
    grow_plainly(section, entries, {middle, sorted.end()}, per_leaf, nodes, states, leaves);
    return;
  }
  for (const std::size_t i : these) states[i] = leaves;
  ++leaves;
  nodes.push_back({});
}

/// Faces that lead one row on, with coordinates of different scales.
Section section_of(std::size_t coordinates, int faces) {
  Section section{.faces = {}, .coordinates = {}, .costs = {{"time_s", "s", "duration"}}};
  for (int f = 0; f < faces; ++f)
    section.faces.push_back({"F" + std::to_string(f), 0, f + 1, f, 0, "", {}});
  for (std::size_t c = 0; c < coordinates; ++c) {
    const std::string name = "c" + std::to_string(c);
    section.coordinates.push_back({name, name, "1", name, std::pow(2.0, static_cast<double>(c))});
  }
  return section;
}

// Numbers are multiples of 1/8, many of them equal.
TEST(TreeSpace, IsThatOfAPlainGrowerForAnyNumberOfCoordinates) {
  for (std::size_t coordinates = 1; coordinates <= kMostCoordinates; ++coordinates) {
    const Section section = section_of(coordinates, 2);
    Draw draw(coordinates);
    std::vector<Entry> entries;
    std::vector<std::vector<std::size_t>> at(2);
    for (std::size_t i = 0; i < 1500; ++i) {
      Entry entry{draw.uniform(0, 1) < 0.3 ? 1 : 0};
      for (std::size_t c = 0; c < coordinates; ++c)
        entry.at[c] = section.coordinates[c].scale * std::round(draw.uniform(-40, 40)) *
                      (c % 3 == 2 ? std::round(draw.uniform(0, 3)) : 1.0) / 8.0;
      at[static_cast<std::size_t>(entry.face)].push_back(i);
      entries.push_back(entry);
    }
    std::vector<int> states, plain_states(entries.size());
    const StateSpace space = tree_space(section, {section, entries}, 6, {}, &states);
    int leaves = 0;
    for (std::size_t face = 0; face < at.size(); ++face) {
      std::vector<Tree::Node> nodes;
      grow_plainly(section, entries, at[face], 6, nodes, plain_states, leaves);
      EXPECT_EQ(space.trees()[face].nodes, nodes) << coordinates << ' ' << face;
      std::set<int> axes;
      for (const Tree::Node& node : nodes)
        if (node.axis != Tree::kLeaf) axes.insert(node.axis);
      if (face == 0) {
        EXPECT_EQ(axes.size(), coordinates);
      }
    }
    EXPECT_EQ(space.size(), leaves);
    EXPECT_EQ(states, plain_states) << coordinates;
    for (std::size_t i = 0; i < entries.size(); ++i)
      ASSERT_EQ(space.index_of(entries[i]).state, states[i]);
  }
}

TEST(TreeSpace, EqualEntriesStayTogether) {
  std::vector<Entry> entries(100, {Boundary::enter, {1.0, 2.0, 3.0}});
  EXPECT_EQ(tree_space(kPaper, {kPaper, entries}, 5).trees()[0].nodes.size(), 1u);
  EXPECT_EQ(coordinates_cut(tree_space(kPaper, {kPaper, entries}, 5)), 0);
  for (int i = 0; i < 20; ++i) entries.push_back({Boundary::enter, {2.0 + i, 2.0, 3.0}});
  std::vector<int> states;
  EXPECT_EQ(coordinates_cut(tree_space(kPaper, {kPaper, entries}, 5, {}, &states)), 1);
  EXPECT_TRUE(std::all_of(states.begin(), states.begin() + 100, [](int s) { return s == 0; }));
  EXPECT_GT(states.back(), 0);
}

TEST(TreeSpace, PointsAreStatesBehindTheLeaves) {
  const Entry start{Boundary::enter, {0.0, 0.0, 15.0}};
  const StateSpace space = tree_space(kPaper, {kPaper, made_up(200, 1)}, 10, {start});
  EXPECT_EQ(space.index_of(start).state, space.size() - 1);
  EXPECT_EQ(space.range(space.size() - 1).at[kEntryVy], (std::array<double, 2>{15.0, 15.0}));
}

TEST(TreeSpace, AScaledSceneHasTheSameTreeToTheLastBit) {
  constexpr double kLength = 0.0625, kSpeed = 0.25;  // powers of 4, and their quotient
  GateParams small;
  const double kTime = kLength / kSpeed;
  small.body.radius *= kLength;
  small.beams.length *= kLength;
  small.beams.joint_x *= kLength;
  small.beams.joint_y *= kLength;
  small.run.traverse_y *= kLength;
  small.forces.random_rate /= kTime;
  small.forces.propulsion *= kLength / (kTime * kTime);
  small.forces.random *= kLength / (kTime * kTime);
  auto entries = made_up(1000, 5), scaled = entries;
  for (Entry& c : scaled) c.at = {c.at[0] * kLength, c.at[1] * kSpeed, c.at[2] * kSpeed};
  std::vector<int> states, scaled_states;
  const StateSpace here = tree_space(kPaper, {kPaper, entries}, 7, {}, &states),
                   there = tree_space(disc_section(small), {kPaper, scaled}, 7, {}, &scaled_states);
  EXPECT_EQ(states, scaled_states);
  for (std::size_t i = 0; i < here.trees()[0].nodes.size(); ++i) {
    const Tree::Node &a = here.trees()[0].nodes[i], &b = there.trees()[0].nodes[i];
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.cut * (a.axis == 0 ? kLength : kSpeed), b.cut);
  }
}

TEST(TreeSpace, RefusesTreesThatAreNone) {
  const auto space_of = [](std::vector<Tree::Node> nodes) {
    Tree tree{.nodes = std::move(nodes), .seen = {{{-1, 1}, {-1, 1}, {-1, 1}}}};
    return StateSpace(kPaper, {tree, Tree{}, Tree{}, Tree{}, Tree{}});
  };
  EXPECT_NO_THROW((void)space_of({{0, 0.0}, {}, {}}));
  EXPECT_THROW((void)space_of({{0, 0.0}, {}}), std::invalid_argument);
  EXPECT_THROW((void)space_of({{0, 0.0}, {}, {}, {}}), std::invalid_argument);
  EXPECT_THROW((void)space_of({{3, 0.0}, {}, {}}), std::invalid_argument);
  EXPECT_THROW((void)space_of({{0, 2.0}, {}, {}}), std::invalid_argument);
  EXPECT_THROW((void)space_of({{0, std::nan("")}, {}, {}}), std::invalid_argument);
  EXPECT_THROW((void)space_of({}), std::invalid_argument);
  EXPECT_THROW((void)tree_space(kPaper, {kPaper}, 0), std::invalid_argument);
  EXPECT_THROW((void)refined(tree_space(kPaper, {kPaper, made_up(50, 1)}), 2.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::dynamics
