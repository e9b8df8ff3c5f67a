// SPDX-License-Identifier: MIT
#include "dynamics/disc/disc_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "dynamics/cells/quantile_bins.h"
#include "dynamics/cells/tree_space.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;

constexpr double kInf = std::numeric_limits<double>::infinity();
using Edges = std::vector<double>;

const Section kPaper = disc_section(GateParams{});
StateSpace paper() { return table3_space(GateParams{}); }

// ---- Sections ----

/// Points of unit speed in squares: two coordinates, not those of a disc.
Section squares() {
  return {.faces = {{"S", 0, 1, 0, 0b11, "from below", {{{-1, 1}, {-2, 2}}}},
                    {"W", 1, 0, 2, 0b00, "from the left", {{{-1, 1}, {-2, 2}}}},
                    {"E", -1, 0, 1, 0b00, "from the right", {{{-1, 1}, {-2, 2}}}}},
          .coordinates = {{"s", "s_m", "m", "place", 0.5}, {"v", "v", "1", "velocity", 2.0}},
          .costs = {{"time_s", "s", "duration"}}};
}

TEST(Section, RefusesWhatIsNone) {
  EXPECT_NO_THROW(squares().validate());
  EXPECT_NO_THROW(disc_section().validate());
  const auto expect_refused = [](auto change) {
    Section section = squares();
    change(section);
    EXPECT_THROW(section.validate(), std::invalid_argument);
    EXPECT_THROW((void)StateSpace(section, std::vector<Tree>(section.faces.size())),
                 std::invalid_argument);
  };
  expect_refused([](Section& s) { s.faces.clear(); });
  expect_refused([](Section& s) {
    while (s.faces.size() <= kMostFaces) {
      s.faces.push_back(s.faces[0]);
      s.faces.back().name += std::to_string(s.faces.size());
      s.faces.back().mirror = static_cast<int>(s.faces.size()) - 1;
    }
  });
  expect_refused([](Section& s) { s.coordinates.clear(); });
  const auto grown = [](auto& all, auto name, std::size_t most) {
    while (all.size() <= most) {
      all.push_back(all[0]);
      all.back().*name += std::to_string(all.size());
    }
  };
  expect_refused([&](Section& s) { grown(s.coordinates, &Coordinate::name, kMostCoordinates); });
  expect_refused([&](Section& s) { grown(s.costs, &CostInfo::key, kMostCosts); });
  expect_refused([](Section& s) { s.coordinates[1].name = "s"; });
  expect_refused([](Section& s) { s.coordinates[1].name.clear(); });
  expect_refused([](Section& s) { s.costs[0].key.clear(); });
  expect_refused([](Section& s) { s.costs.push_back(s.costs[0]); });
  expect_refused([](Section& s) { s.faces[0].odd = 0b100; });
  expect_refused([](Section& s) { s.coordinates[1].scale = 0.0; });
  expect_refused([](Section& s) { s.coordinates[0].scale = kInf; });
  expect_refused([](Section& s) { s.faces[2].name = "W"; });
  expect_refused([](Section& s) { s.faces[0].name.clear(); });
  expect_refused([](Section& s) { s.faces[0].di_y = 0; });
  expect_refused([](Section& s) { s.faces[1].mirror = 3; });
  expect_refused([](Section& s) { s.faces[1].mirror = 0; });
  expect_refused([](Section& s) { s.faces[1].odd = 0b10; });
  expect_refused([](Section& s) { s.faces[1].di_x = 2; });
}

TEST(Section, OfADiscKnowsItsMirrorImages) {
  const auto image = [](Entry entry) { return mirrored(disc_section(), entry); };
  EXPECT_EQ(image({enter, {3, 4, 15}}), (Entry{enter, {-3, -4, 15}}));
  EXPECT_EQ(image({right_deflect, {3, -4, 15}}), (Entry{left_deflect, {3, 4, 15}}));
  EXPECT_EQ(image({left_deflect, {3, 4, 15}}), (Entry{right_deflect, {3, -4, 15}}));
  EXPECT_EQ(image({right_traverse, {3, -4, 15}}), (Entry{left_traverse, {3, 4, 15}}));
  EXPECT_EQ(image({left_traverse, {3, 4, 15}}), (Entry{right_traverse, {3, -4, 15}}));
  EXPECT_EQ(image({enter, {0, 0, 15}}), (Entry{enter, {0, 0, 15}}));  // -0 == 0
  const StateRange range{enter, {{{1, 2}, {-3, 4}, {5, 6}}}};
  EXPECT_EQ(mirrored(disc_section(), range), (StateRange{enter, {{{-2, -1}, {-4, 3}, {5, 6}}}}));
}

// Scales and usual ranges depend on the gate; the contents of files do not.
TEST(Section, OfADiscIsOneForAllGates) {
  GateParams p;
  p.body.radius = 5.0;
  const Section section = disc_section(p);
  EXPECT_EQ(section, disc_section());
  EXPECT_EQ(section.coordinates[kEntryD].scale, scale_of(p).length);
  EXPECT_EQ(section.coordinates[kEntryVy].scale, scale_of(p).speed());
  EXPECT_EQ(section.faces[right_deflect].usual[kEntryD], (std::array{5.0, 30.0}));
  EXPECT_EQ(names_of(section.faces), "EN, RD, LD, RT, LT");
  EXPECT_EQ(numbers_of(section.coordinates), "0 d, 1 vx, 2 vy");
  EXPECT_NE(squares(), disc_section());
}

TEST(Section, OfEightCoordinatesMakesSpaces) {
  Section section = squares();
  section.coordinates.resize(2);
  while (section.coordinates.size() < 8) {
    section.coordinates.push_back(section.coordinates[1]);
    section.coordinates.back().name = "c" + std::to_string(section.coordinates.size());
  }
  section.faces[0].odd = 0b1000'0001;  // the first and the last
  section.validate();
  EXPECT_EQ(mirrored(section, Entry{0, {1, 2, 3, 4, 5, 6, 7, 8}}),
            (Entry{0, {-1, 2, 3, 4, 5, 6, 7, -8}}));
  // Two bins along each coordinate except the last, which has three and runs fastest.
  Bins bins;
  for (std::size_t axis = 0; axis < 8; ++axis) bins.edges[axis] = {-1, 0, 1};
  bins.edges[7] = {-1, 0, 1, 2};
  const StateSpace binned(section, {bins, bins, bins});
  EXPECT_EQ(binned.size(), 3 * 128 * 3);
  EXPECT_EQ(binned.index_of({1, {1, -1, -1, -1, -1, -1, 1, 2}}).state, 384 + (64 + 1) * 3 + 2);
  Random random(Purpose::row, {1, 2, 3});
  for (int state = 0; state < binned.size(); ++state)
    ASSERT_EQ(binned.index_of(binned.sample(state, random)).state, state);
  Tree cut{.nodes = {{7, 0.5}, {0, 0.0}, {}, {}, {}}, .seen = {}};
  for (auto& seen : cut.seen) seen = {-1, 1};
  const StateSpace trees(section, {cut, cut, cut}, {{2, {0, 0, 0, 0, 0, 0, 0, 0.25}}});
  EXPECT_EQ(trees.size(), 3 * 3 + 1);
  EXPECT_EQ(trees.index_of({1, {0, 0, 0, 0, 0, 0, 0, 0.75}}).state, 5);
  EXPECT_EQ(trees.index_of({1, {0.5, 0, 0, 0, 0, 0, 0, 0.5}}).state, 4);
  EXPECT_EQ(trees.index_of({2, {0, 0, 0, 0, 0, 0, 0, 0.25}}).state, 9);
  EXPECT_EQ(trees.range(4).at[7], (std::array<double, 2>{-1, 0.5}));
  EXPECT_EQ(trees.range(4).at[6], (std::array<double, 2>{-1, 1}));
  cut.nodes[0].axis = 8;
  EXPECT_THROW((void)StateSpace(section, {cut, cut, cut}), std::invalid_argument);
}

TEST(Section, OfTwoCoordinatesMakesSpaces) {
  const Bins two_by_three{{Edges{-1, 0, 1}, Edges{-2, -1, 1, 2}}};
  const StateSpace bins(squares(), {two_by_three, two_by_three, two_by_three});
  EXPECT_EQ(bins.size(), 18);
  Random random(Purpose::row, {1, 2, 3});
  for (int state = 0; state < bins.size(); ++state)
    EXPECT_EQ(bins.index_of(bins.sample(state, random)).state, state);
  EXPECT_EQ(text_of(bins.section(), bins.range(7)), "W s [-1, 0] m, v [-1, 1]");
  EXPECT_EQ(refined(bins, 2.0).size(), 3 * 4 * 6);
  const Tree cut{.nodes = {{1, 0.0}, {}, {}}, .seen = {{{-1, 1}, {-2, 2}}}};
  const StateSpace trees(squares(), {cut, Tree{}, cut}, {{1, {0.5, 0.5}}});
  EXPECT_EQ(trees.size(), 6);
  EXPECT_EQ(trees.index_of({2, {0.0, 1.0}}).state, 4);
  EXPECT_EQ(trees.index_of({1, {0.5, 0.5}}).state, 5);
  EXPECT_EQ(trees.range(3).at[1], (std::array<double, 2>{-2, 0}));
  const Tree third{.nodes = {{2, 0.0}, {}, {}}, .seen = {{{-1, 1}, {-2, 2}, {-1, 1}}}};
  EXPECT_THROW((void)StateSpace(squares(), {third, cut, cut}), std::invalid_argument);
  EXPECT_THROW((void)StateSpace(squares(), std::vector<Tree>{cut, cut}), std::invalid_argument);
  for (const int face : {-1, 3})
    EXPECT_THROW((void)StateSpace(squares(), {cut, cut, cut}, {{face, {0.5, 0.5}}}),
                 std::invalid_argument);
}

TEST(Section, OfTwoCoordinatesGrowsTreesAndBins) {
  std::vector<Entry> seen;  // numbers beyond the last coordinate are ignored
  for (int i = 0; i < 400; ++i)
    seen.push_back({i % 2, {-1.0 + 0.005 * i, std::sin(i), static_cast<double>(i)}});
  const StateSpace trees = tree_space(squares(), {squares(), seen}, 10);
  EXPECT_GT(trees.size(), 30);
  for (const Tree& tree : trees.trees())
    for (const Tree::Node& node : tree.nodes) EXPECT_LT(node.axis, 2);
  EXPECT_EQ(trees.trees()[2].seen[1], (std::array<double, 2>{-2, 2}));  // the usual range
  const StateSpace bins = quantile_space(squares(), seen, 8, {});
  // 2 x 2 for either half of the entries, and one at the face without entries.
  EXPECT_EQ(bins.size(), 9);
  Section lacking = squares();
  lacking.faces[2].usual = {};
  EXPECT_THROW((void)tree_space(lacking, {lacking, seen}, 10), std::invalid_argument);
  EXPECT_THROW((void)quantile_space(lacking, seen, 8, {}), std::invalid_argument);
}

// ---- Table III ----

TEST(StateSpace, HasTheStatesOfTableIII) {
  const StateSpace s = paper();
  EXPECT_EQ(s.size(), 87);
  EXPECT_EQ(s.trapped(), 87);  // O_88, counted from 0
  const int states[] = {25, 30, 30, 1, 1};
  int first = 0;
  for (int b = 0; b < kBoundaries; ++b) {
    EXPECT_EQ(s.first(b), first) << disc_section().faces[b].name;
    for (int i = 0; i < states[b]; ++i) EXPECT_EQ(s.face(first + i), b);
    first += states[b];
  }
}

TEST(StateSpace, HasTheEdgesOfTableIII) {
  const StateSpace space = paper();
  const auto& bins = space.bins();
  const auto of = [&](Boundary b) { return bins[b].edges; };
  using AllEdges = decltype(Bins::edges);
  const Edges fives{-25, -15, -5, 5, 15, 25}, sideways{-20, -10, 0, 10, 20, 30};
  EXPECT_EQ(of(Boundary::enter), (AllEdges{fives, fives, Edges{10, 20}}));
  EXPECT_EQ(of(Boundary::right_deflect), (AllEdges{{{10, 20, 30}, {-30, -20, -10, 0}, sideways}}));
  EXPECT_EQ(of(Boundary::left_deflect), (AllEdges{{{10, 20, 30}, {0, 10, 20, 30}, sideways}}));
  // One state each; the bin is that of cli/site/explain/model.md: y in [40, 60].
  EXPECT_EQ(of(Boundary::right_traverse), (AllEdges{{{10, 30}, {-30, 0}, {-20, 30}}}));
  EXPECT_EQ(of(Boundary::left_traverse), (AllEdges{{{10, 30}, {0, 30}, {-20, 30}}}));
}

// Distances follow the gate and velocities the scene's own unit, so bins are the same in other
// units.
TEST(StateSpace, TableIIIIsInTheScenesOwnUnits) {
  const StateSpace space = paper();
  for (const int power : {-10, -1, 3, 10}) {
    const double length = std::ldexp(1.0, 2 * power), time = std::ldexp(1.0, 4 - 2 * power),
                 mass = std::ldexp(1.0, 6), speed = length / time;
    GateParams p;
    for (double* x :
         {&p.body.radius, &p.beams.length, &p.beams.joint_x, &p.beams.joint_y, &p.run.traverse_y})
      *x *= length;
    p.body.mass *= mass;
    p.forces.random_rate /= time;
    for (double* f : {&p.forces.propulsion, &p.forces.random}) *f *= mass * length / (time * time);
    const StateSpace twin = table3_space(p);
    for (std::size_t b = 0; b < kBoundaries; ++b) {
      const auto times = [](Edges edges, double factor) {
        for (double& e : edges) e *= factor;
        return edges;
      };
      const auto &own = space.bins()[b].edges, &others = twin.bins()[b].edges;
      EXPECT_EQ(others[kEntryD], times(own[kEntryD], length));
      EXPECT_EQ(others[kEntryVx], times(own[kEntryVx], speed));
      EXPECT_EQ(others[kEntryVy], times(own[kEntryVy], speed));
    }
  }
}

// Open: the outermost bins include everything and report what lies beyond their edges.
TEST(StateSpace, OpenBinsClampNothing) {
  const StateSpace closed = paper(), open(closed.section(), closed.bins(), true);
  EXPECT_FALSE(closed == open);
  EXPECT_TRUE(refined(open, 2.0).open());
  const Entry outside{Boundary::enter, {0.0, 60.0, 15.0}},
      inside{Boundary::enter, {0.0, 20.0, 15.0}};
  EXPECT_TRUE(closed.index_of(outside).clamped && closed.index_of(outside).beyond);
  EXPECT_FALSE(open.index_of(outside).clamped);
  EXPECT_TRUE(open.index_of(outside).beyond);
  EXPECT_FALSE(open.index_of(inside).beyond);
  EXPECT_EQ(open.index_of(outside).state, closed.index_of(outside).state);
}

TEST(StateSpace, SingleEntriesAreStatesOfTheirOwn) {
  const Entry a{Boundary::enter, {0.0, 0.0, 15.0}}, b{Boundary::enter, {4.0, 5.0, 10.0}};
  const StateSpace space(kPaper, paper().bins(), false, {a, b});
  EXPECT_EQ(space.size(), 89);
  EXPECT_EQ(space.trapped(), 89);
  EXPECT_EQ(space.index_of(a).state, 87);
  EXPECT_EQ(space.index_of(b).state, 88);
  EXPECT_EQ(space.index_of({Boundary::enter, {0.0, 0.0, 15.5}}).state, 12);
  EXPECT_EQ(space.index_of({Boundary::enter, {-0.0, 0.0, 15.0}}).state, 87);
  EXPECT_EQ(space.face(88), Boundary::enter);
  EXPECT_EQ(space.range(88).at[kEntryVx], (std::array<double, 2>{5, 5}));
  Random random(Purpose::row, {1, 2, 3});
  EXPECT_EQ(space.sample(88, random), b);
  EXPECT_EQ(refined(space, 2.0).size(), 698);
  EXPECT_THROW((void)StateSpace(kPaper, paper().bins(), false, {a, a}), std::invalid_argument);
  EXPECT_THROW((void)StateSpace(kPaper, paper().bins(), false, {{Boundary::enter, {kInf, 0, 0}}}),
               std::invalid_argument);
}

// Our order, which the paper leaves open: d slowest, then vx, then vy.
TEST(StateSpace, CountsDThenVxThenVy) {
  const StateSpace s = paper();
  const StateRange enter{Boundary::enter, {{{-15, -5}, {-5, 5}, {10, 20}}}};
  EXPECT_EQ(s.range(7), enter);  // second d, third vx
  const StateRange side{Boundary::left_deflect, {{{20, 30}, {20, 30}, {20, 30}}}};
  EXPECT_EQ(s.range(55 + 15 + 2 * 5 + 4), side);  // LD: second d, third vx, fifth vy
}

// The bins of a boundary tile their box: volumes add up, and no two states share a bin.
TEST(StateSpace, RangesTileTheBoundary) {
  const StateSpace s = paper();
  std::array<double, kBoundaries> volume{};
  std::set<std::array<double, 4>> corners;
  for (int state = 0; state < s.size(); ++state) {
    const auto [face, at] = s.range(state);
    double here = 1.0;
    for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
      const auto [from, to] = at[axis];
      EXPECT_LT(from, to);
      here *= to - from;
    }
    volume[face] += here;
    EXPECT_TRUE(corners.insert({static_cast<double>(face), at[0][0], at[1][0], at[2][0]}).second);
  }
  EXPECT_EQ(volume, (std::array<double, kBoundaries>{25000, 30000, 30000, 30000, 30000}));
}

TEST(StateSpace, ScalesDistancesWithTheGate) {
  GateParams p;
  p.beams.joint_x = 50;
  p.beams.joint_y = 40;
  p.body.radius = 20;
  p.run.traverse_y = 100;
  const auto bins = table3_space(p).bins();
  EXPECT_EQ(bins[0].edges[kEntryD], (Edges{-50, -30, -10, 10, 30, 50}));
  EXPECT_EQ(bins[1].edges[kEntryD], (Edges{20, 30, 40}));
  EXPECT_EQ(bins[3].edges[kEntryD], (Edges{20, 60}));
  EXPECT_EQ(bins[0].edges[kEntryVx],
            (Edges{-50, -30, -10, 10, 30, 50}));  // a radius of 20 m: 2 m/s for 1 m/s
}

// RT and LT begin at joint + R = 40 m; a gate that ends there has no room for them.
TEST(StateSpace, RefusesAGateThatEndsInTheBeams) {
  GateParams p;
  p.run.traverse_y = 40.0;
  try {
    (void)table3_space(p);
    ADD_FAILURE() << "accepted";
  } catch (const InvalidParameter& e) {
    EXPECT_EQ(e.key(), "run.traverse_y_m");
  }
  p.run.traverse_y = 40.001;
  EXPECT_EQ(table3_space(p).size(), 87);
}

// ---- Finer and coarser ----

TEST(Refined, FactorOneIsTheSameSpaceBitForBit) {
  GateParams odd;  // edges that are no equal division in floating point
  odd.beams.joint_x = 31.7;
  odd.body.radius = 7.3;
  for (const GateParams& p : {GateParams{}, odd}) {
    const StateSpace s = table3_space(p), same = refined(s, 1.0);
    for (int b = 0; b < kBoundaries; ++b)
      for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
        const Edges &before = s.bins()[b].edges[axis], &after = same.bins()[b].edges[axis];
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t i = 0; i < after.size(); ++i)
          EXPECT_TRUE(test::same_bits(after[i], before[i]))
              << disc_section().faces[b].name << " " << i;
      }
    EXPECT_EQ(same.size(), 87);
  }
}

TEST(Refined, CountsBinsPerAxis) {
  // n bins become max(1, round(n f)): EN 5 x 5 x 1, RD and LD 2 x 3 x 5, RT and LT 1 x 1 x 1.
  struct Case {
    double factor;
    int enter, deflect, traverse;
  };
  for (const Case& c :
       {Case{0.25, 1, 1, 1}, Case{0.5, 3 * 3 * 1, 1 * 2 * 3, 1}, Case{1, 25, 30, 1},
        Case{1.5, 8 * 8 * 2, 3 * 5 * 8, 2 * 2 * 2}, Case{2, 10 * 10 * 2, 4 * 6 * 10, 8},
        Case{4, 20 * 20 * 4, 8 * 12 * 20, 64}}) {
    const StateSpace s = refined(paper(), c.factor);
    EXPECT_EQ(s.first(Boundary::right_deflect), c.enter) << c.factor;
    EXPECT_EQ(s.first(Boundary::left_deflect), c.enter + c.deflect) << c.factor;
    EXPECT_EQ(s.first(Boundary::right_traverse), c.enter + 2 * c.deflect) << c.factor;
    EXPECT_EQ(s.size(), c.enter + 2 * c.deflect + 2 * c.traverse) << c.factor;
    EXPECT_EQ(s.trapped(), s.size());
  }
}

TEST(Refined, HasEqualBinsOverTheSameRange) {
  const StateSpace finer = refined(paper(), 2.0), coarser = refined(paper(), 0.5);
  const auto& fine = finer.bins()[Boundary::enter].edges;
  EXPECT_EQ(fine[kEntryD], (Edges{-25, -20, -15, -10, -5, 0, 5, 10, 15, 20, 25}));
  EXPECT_EQ(fine[kEntryVy], (Edges{10, 15, 20}));
  const Bins side{{{{10, 20, 30}, {-30, -15, 0}, {-20, 5, 30}}}};
  EXPECT_EQ(finer.bins()[Boundary::right_traverse], side);
  const auto& coarse = coarser.bins()[Boundary::left_deflect].edges;
  EXPECT_EQ(coarse[kEntryD], (Edges{10, 30}));
  EXPECT_EQ(coarse[kEntryVx], (Edges{0, 15, 30}));
  for (const double factor : {0.1, 0.3, 0.7, 1.9, 3.0, 7.7}) {
    const StateSpace before = paper(), s = refined(before, factor);
    for (int b = 0; b < kBoundaries; ++b)
      for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
        const Edges &now = s.bins()[b].edges[axis], &was = before.bins()[b].edges[axis];
        EXPECT_EQ(now.front(), was.front());  // exactly the clamped entries stay clamped
        EXPECT_EQ(now.back(), was.back());
        const double width = (was.back() - was.front()) / static_cast<double>(now.size() - 1);
        for (std::size_t i = 1; i < now.size(); ++i)  // edges of at most 60, differences of two
          EXPECT_NEAR(now[i] - now[i - 1], width, 4 * 60 * test::kEps);
      }
  }
}

TEST(Refined, SamplesComeBackToTheirState) {
  for (const double factor : {0.5, 1.3, 2.0, 4.0}) {
    const StateSpace s = refined(paper(), factor);
    for (int state = 0; state < s.size(); ++state) {
      Random random(Purpose::row, {1, static_cast<std::uint64_t>(state), 0});
      for (int i = 0; i < 20; ++i) {
        const auto index = s.index_of(s.sample(state, random));
        ASSERT_EQ(index.state, state) << factor;
        ASSERT_FALSE(index.clamped);
      }
    }
  }
}

// With twice as many bins, every bin lies within one of the paper's bins.
TEST(Refined, FinerBinsAreNested) {
  const StateSpace coarse = paper(), fine = refined(coarse, 2.0);
  const auto inside = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return b[0] <= a[0] && a[1] <= b[1];
  };
  for (int state = 0; state < fine.size(); ++state) {
    const StateRange range = fine.range(state);
    Entry corner{range.face};
    for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis)
      corner.at[axis] = range.at[axis][0];
    const StateRange around = coarse.range(coarse.index_of(corner).state);
    for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis)
      EXPECT_TRUE(inside(range.at[axis], around.at[axis])) << state << ' ' << axis;
  }
}

TEST(Refined, RefusesFactorsThatMakeNoSpace) {
  for (const double bad : {0.0, -1.0, std::nan(""), kInf, -kInf, 23.0, 1e9, 1e300})
    EXPECT_THROW((void)refined(paper(), bad), std::invalid_argument) << bad;
  EXPECT_EQ(refined(paper(), 1e-300).size(), 5);  // one state per boundary
  EXPECT_EQ(refined(paper(), 22.0).size(), 87 * 22 * 22 * 22);
}

// ---- Indices ----

TEST(StateSpace, SampleLiesInItsState) {
  const StateSpace s = paper();
  for (int state = 0; state < s.size(); ++state) {
    Random random(Purpose::row, {1, static_cast<std::uint64_t>(state), 0});
    const auto [from, to] = s.range(state).at[kEntryD];
    double d_sum = 0.0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i) {
      const Entry c = s.sample(state, random);
      const auto index = s.index_of(c);
      ASSERT_EQ(index.state, state);
      ASSERT_FALSE(index.clamped);
      d_sum += (c.at[kEntryD] - from) / (to - from);
    }
    // Uniform: mean 1/2 with a standard error of 1 / sqrt(12 n); 87 states, so five of them.
    EXPECT_NEAR(d_sum / n, 0.5, 5 / std::sqrt(12.0 * n));
  }
}

TEST(StateSpace, MiddleAndLowerCornerBelongToTheRange) {
  const StateSpace s = paper();
  for (int state = 0; state < s.size(); ++state) {
    const StateRange range = s.range(state);
    EXPECT_EQ(s.index_of(range.middle()).state, state);
    Entry low{range.face};
    for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis)
      low.at[axis] = range.at[axis][0];
    const auto corner = s.index_of(low);
    EXPECT_EQ(corner.state, state);
    EXPECT_FALSE(corner.clamped);
  }
}

// Beyond an outer edge a crossing goes into the nearest bin and is flagged; on the edge it is not.
TEST(StateSpace, ClampsToTheNearestBinAndSaysSo) {
  const StateSpace s = paper();
  const Entry middle{Boundary::enter, {0.0, 0.0, 15.0}};
  const int centre = 2 * 5 + 2;
  ASSERT_EQ(s.index_of(middle).state, centre);
  struct Case {
    std::size_t axis;
    double inside, outside;
    int state;
  };
  for (const Case& c :
       {Case{kEntryD, -25.0, std::nextafter(-25.0, -kInf), 2},
        Case{kEntryD, 25.0, std::nextafter(25.0, kInf), 4 * 5 + 2},
        Case{kEntryVx, -25.0, -26.0, 2 * 5}, Case{kEntryVx, 25.0, 1e300, 2 * 5 + 4},
        Case{kEntryVy, 10.0, -3.0, centre}, Case{kEntryVy, 20.0, 20.000001, centre}}) {
    Entry at = middle;
    at.at[c.axis] = c.inside;
    EXPECT_EQ(s.index_of(at).state, c.state);
    EXPECT_FALSE(s.index_of(at).clamped);
    at.at[c.axis] = c.outside;
    EXPECT_EQ(s.index_of(at).state, c.state);
    EXPECT_TRUE(s.index_of(at).clamped);
  }
}

TEST(StateSpace, EveryBoundaryClampsEverySide) {
  const StateSpace s = paper();
  for (int b = 0; b < kBoundaries; ++b) {
    Entry low{b}, high{b};
    int states = 1;
    for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
      const Edges& edges = s.bins()[b].edges[axis];
      low.at[axis] = edges.front();
      high.at[axis] = edges.back();
      states *= static_cast<int>(edges.size()) - 1;
    }
    const int first = s.first(b), last = first + states - 1;
    for (const auto& [corner, state, away] : {std::tuple{low, first, -1.0}, {high, last, 1.0}}) {
      EXPECT_EQ(s.index_of(corner).state, state);
      EXPECT_FALSE(s.index_of(corner).clamped);
      for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
        Entry beyond = corner;
        beyond.at[axis] += away;
        EXPECT_EQ(s.index_of(beyond).state, state);
        EXPECT_TRUE(s.index_of(beyond).clamped);
      }
    }
  }
}

TEST(StateSpace, RefusesEdgesThatMakeNoBins) {
  const auto good = paper().bins();
  EXPECT_EQ(StateSpace(kPaper, good), paper());
  for (const Edges& bad :
       {Edges{}, Edges{1}, Edges{1, 1}, Edges{2, 1}, Edges{0, 1, 1, 2},
        Edges{0, std::numeric_limits<double>::quiet_NaN(), 2}, Edges{0, kInf}, Edges{-kInf, 0}}) {
    for (int b = 0; b < kBoundaries; ++b) {
      for (std::size_t axis = 0; axis < kPaper.coordinates.size(); ++axis) {
        auto bins = good;
        bins[b].edges[axis] = bad;
        try {
          (void)StateSpace(kPaper, bins);
          ADD_FAILURE() << "accepted for " << disc_section().faces[b].name;
        } catch (const std::invalid_argument& e) {
          EXPECT_NE(std::string(e.what()).find(disc_section().faces[b].name), std::string::npos)
              << e.what();
        }
      }
    }
  }
}

// ---- Crossings ----

// Top -> EN of the gate above; left below y = 30 -> RD of the left neighbour, above -> RT; right
// likewise -> LD, LT.
TEST(Crossing, OfEachExit) {
  const GateParams p;
  struct Case {
    Outcome outcome;
    BodyState exit;
    Boundary boundary;
    double d;
    int di_x, di_y;
  };
  using enum Outcome;
  using enum Boundary;
  const Case cases[] = {{traversed_right, {7, 60.05, 1, 15}, enter, 7, 0, 1},
                        {exited_left, {-25.1, 12, -5, 3}, right_deflect, 18, -1, 0},
                        {exited_left, {-25.1, 47, -5, 3}, right_traverse, 17, -1, 0},
                        {exited_right, {25.1, 12, 5, 3}, left_deflect, 18, 1, 0},
                        {exited_right, {25.1, 47, 5, 3}, left_traverse, 17, 1, 0},
                        {exited_left, {-25.1, -4, -5, 3}, right_deflect, 34, -1, 0}};
  for (const Case& c : cases) {
    const Entry crossing = crossing_of(p, c.outcome, c.exit);
    EXPECT_EQ(crossing.face, c.boundary);
    EXPECT_EQ(crossing.at[kEntryD], c.d);
    EXPECT_EQ(crossing.at[kEntryVx], c.exit.vx);
    EXPECT_EQ(crossing.at[kEntryVy], c.exit.vy);
    const Face& move = disc_section().faces[crossing.face];
    EXPECT_EQ(move.di_x, c.di_x);
    EXPECT_EQ(move.di_y, c.di_y);
  }
}

// A body exactly at the joint's height is not below the joint.
TEST(Crossing, AtTheJointCountsAsAbove) {
  const GateParams p;
  const Entry at = crossing_of(p, Outcome::exited_left, {-25.1, 30, -5, 0});
  EXPECT_EQ(at.face, Boundary::right_traverse);
  EXPECT_EQ(at.at[kEntryD], 0.0);
  const double just_below = std::nextafter(30.0, 0.0);
  const Entry below = crossing_of(p, Outcome::exited_left, {-25.1, just_below, -5, 0});
  EXPECT_EQ(below.face, Boundary::right_deflect);
  EXPECT_GT(below.at[kEntryD], 0.0);
}

TEST(Crossing, RunsThatStayedInsideHaveNone) {
  const GateParams p;
  EXPECT_THROW((void)crossing_of(p, Outcome::trapped, {}), std::logic_error);
  EXPECT_THROW((void)crossing_of(p, Outcome::broken, {}), std::logic_error);
}

// Round trip: the body that enters at a crossing is the body that has left the neighbour, moved
// onto its boundary. Shifted there and back, only the distance beyond the border differs.
TEST(Crossing, RoundTrips) {
  const GateParams p;
  Draw draw(1);
  for (int i = 0; i < 10'000; ++i) {
    const double beyond = draw.uniform(0, 0.1);
    Outcome outcome = Outcome::traversed_even;
    BodyState exit{draw.uniform(-25, 25), 60 + beyond, draw.uniform(-20, 20), draw.uniform(0, 20)};
    BodyState on_border = exit;
    on_border.y = 60;
    if (i % 3 != 0) {
      const double side = i % 3 == 1 ? -1.0 : 1.0;
      outcome = side < 0 ? Outcome::exited_left : Outcome::exited_right;
      exit = {side * (25 + beyond), draw.uniform(-5, 60), side * draw.uniform(0, 20),
              draw.uniform(-20, 20)};
      on_border = exit;
      on_border.x = side * 25;
    }
    const Entry crossing = crossing_of(p, outcome, exit);
    const Face& move = disc_section().faces[crossing.face];
    const BodyState entry = entry_state(p, crossing);
    EXPECT_NEAR(entry.x + 50 * move.di_x, on_border.x, 1e-13);
    EXPECT_NEAR(entry.y + 60 * move.di_y, on_border.y, 1e-13);
    EXPECT_EQ(entry.vx, exit.vx);
    EXPECT_EQ(entry.vy, exit.vy);
    EXPECT_FALSE(outside(p, entry));
    EXPECT_TRUE(on_boundary(p, entry));
    const Entry again = entry_of(p, entry);
    EXPECT_EQ(again.face, crossing.face);
    EXPECT_NEAR(again.at[kEntryD], crossing.at[kEntryD], 1e-13);

    const BodyState next = shifted_into_next(p, outcome, exit);
    EXPECT_NEAR(next.x + 50 * move.di_x, exit.x, 1e-13);
    EXPECT_NEAR(next.y + 60 * move.di_y, exit.y, 1e-13);
    EXPECT_EQ(next.vx, exit.vx);
    EXPECT_EQ(next.vy, exit.vy);
    EXPECT_NEAR(std::hypot(next.x - entry.x, next.y - entry.y), beyond, 1e-12);
  }
}

TEST(Crossing, RunsThatStayedInsideAreNotShifted) {
  const BodyState b = shifted_into_next(GateParams{}, Outcome::trapped, {1, 2, 3, 4});
  EXPECT_EQ(b.x, 1);
  EXPECT_EQ(b.y, 2);
}

}  // namespace
}  // namespace gatewalk::dynamics
