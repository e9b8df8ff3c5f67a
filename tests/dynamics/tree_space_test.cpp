#include "dynamics/cells/tree_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
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

// By hand: eight entries in a row along vx, two in a leaf, make cuts at the middles.
TEST(TreeSpace, HalvesAtTheMedianOfTheWidestAxis) {
  std::vector<Entry> entries;
  for (const double vx : {8.0, 1.0, 7.0, 2.0, 6.0, 3.0, 5.0, 4.0})
    entries.push_back({Boundary::enter, {0.1 * vx, vx, 15.0}});
  std::vector<int> states;
  const StateSpace space = tree_space(kPaper, entries, 2, {}, &states);
  const Tree& tree = space.trees()[0];
  ASSERT_EQ(tree.nodes.size(), 7u);
  EXPECT_EQ(tree.nodes[0], (Tree::Node{1, 4.5}));
  EXPECT_EQ(tree.nodes[1], (Tree::Node{1, 2.5}));
  EXPECT_EQ(tree.nodes[2], Tree::Node{});
  EXPECT_EQ(tree.nodes[4], (Tree::Node{1, 6.5}));
  EXPECT_EQ(space.size(), 4 + 4);  // and one state for each boundary where nothing was seen
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
  const StateSpace space = tree_space(kPaper, entries, 7, {}, &states);
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

TEST(TreeSpace, EqualEntriesStayTogether) {
  std::vector<Entry> entries(100, {Boundary::enter, {1.0, 2.0, 3.0}});
  EXPECT_EQ(tree_space(kPaper, entries, 5).trees()[0].nodes.size(), 1u);
  for (int i = 0; i < 20; ++i) entries.push_back({Boundary::enter, {2.0 + i, 2.0, 3.0}});
  std::vector<int> states;
  (void)tree_space(kPaper, entries, 5, {}, &states);
  EXPECT_TRUE(std::all_of(states.begin(), states.begin() + 100, [](int s) { return s == 0; }));
  EXPECT_GT(states.back(), 0);
}

TEST(TreeSpace, PointsAreStatesBehindTheLeaves) {
  const Entry start{Boundary::enter, {0.0, 0.0, 15.0}};
  const StateSpace space = tree_space(kPaper, made_up(200, 1), 10, {start});
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
  const StateSpace here = tree_space(kPaper, entries, 7, {}, &states),
                   there = tree_space(disc_section(small), scaled, 7, {}, &scaled_states);
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
  EXPECT_THROW((void)tree_space(kPaper, {}, 0), std::invalid_argument);
  EXPECT_THROW((void)refined(tree_space(kPaper, made_up(50, 1)), 2.0), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::dynamics
