// SPDX-License-Identifier: MIT
#include "lattice/pool/assumptions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/statistics/multiple_tests.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// What bodies of a Square do that a chain does not know.
enum class Secret { none, remembers_face, differs_by_row, differs_by_side, differs_by_cell };

/// A square cell: bodies go on, turn left or right, or are trapped. Place and secret stand behind
/// the coordinate of the entry.
class Square : public Cell {
 public:
  explicit Square(Secret secret) : secret_(secret) {
    section_.faces = {{"S", 0, 1, 0, 0, "from below", {{{0.0, 1.0}}}},
                      {"R", -1, 0, 2, 0, "from the right", {{{0.0, 1.0}}}},
                      {"L", 1, 0, 1, 0, "from the left", {{{0.0, 1.0}}}}};
    section_.coordinates = {{"s", "s", "1", "place", 1.0}};
  }
  [[nodiscard]] const Section& section() const override { return section_; }
  void begin(Body& body) const override { body.carried.put<Place>({}); }
  [[nodiscard]] Passage pass(Body& body) const override {
    auto& place = body.carried.as<Place>();
    constexpr double kTurn = 0.2;
    double trapped = 0.1, turn = kTurn;
    if (secret_ == Secret::remembers_face && place.before > 0) turn = 2.0 * kTurn;
    if (secret_ == Secret::differs_by_row && place.row > 1) turn = 2.0 * kTurn;
    if (secret_ == Secret::differs_by_side && place.column < 0) trapped = 0.3;
    if (secret_ == Secret::differs_by_cell && place.row == 1 && place.column == 0) trapped = 0.4;
    place.before = body.entry.face;
    const double u = body.random.uniform();
    if (u < trapped) return {Fate::trapped, body.entry, {}};
    body.entry.face = u < trapped + turn ? 1 : u < trapped + 2.0 * turn ? 2 : 0;
    body.entry.at[0] = body.random.uniform();
    place.row += section_.faces[static_cast<std::size_t>(body.entry.face)].di_y;
    place.column += section_.faces[static_cast<std::size_t>(body.entry.face)].di_x;
    return {Fate::left, body.entry, {}};
  }

 private:
  struct Place {
    int before = 0, row = 0, column = 0;
  };
  Section section_;
  Secret secret_;
};

Problem squares(Secret secret) {
  Problem problem;
  problem.cells.cells = {std::make_shared<Square>(secret)};
  problem.cells.map = {problem.cells.cells.front()->section(), {{false}}, 0, {}};
  problem.start = {0, {0.5}};
  problem.width = problem.length = 1.0;
  problem.types = {"square"};
  return problem;
}

std::vector<AssumptionCheck> checks_of(const Problem& problem, std::uint64_t seed,
                                       double accuracy = 0.03) {
  RunPool pool;
  return predict_pooled(problem, pool, {problem.start}, {.accuracy = accuracy, .seed = seed})
      .assumptions;
}

const AssumptionCheck* find(const std::vector<AssumptionCheck>& checks, Assumption assumption) {
  const auto at = std::find_if(checks.begin(), checks.end(),
                               [&](const auto& check) { return check.assumption == assumption; });
  return at == checks.end() ? nullptr : &*at;
}

Problem gates(double stiffness_left) {
  Scene scene;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.gate.beams.stiffness_left = stiffness_left;
  return problem_of(scene);
}

TEST(Assumptions, OfRightChainsAreFine) {
  int wrong = 0, checked = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto checks = checks_of(squares(Secret::none), seed);
    checked += !checks.empty();
    wrong += wrong_assumption(checks) != nullptr;
  }
  EXPECT_GE(checked, 10);
  EXPECT_LE(wrong, 1);
}

TEST(Assumptions, ThatAreNotMadeAreNotChecked) {
  const auto square = checks_of(squares(Secret::none), 1);
  EXPECT_EQ(find(square, Assumption::mirror), nullptr);
  EXPECT_NE(find(square, Assumption::states), nullptr);
  EXPECT_NE(find(square, Assumption::face_before), nullptr);
  EXPECT_NE(find(square, Assumption::quarters), nullptr);
  EXPECT_NE(find(square, Assumption::cells), nullptr);
  Problem row = squares(Secret::none);
  row.field.rows = 1;
  row.field.own_start_column = 0;
  row.field.columns = 1;
  EXPECT_EQ(find(checks_of(row, 1), Assumption::quarters), nullptr);
  row.field.max_gates = 1;
  EXPECT_TRUE(checks_of(row, 1).empty());
}

TEST(Assumptions, NameWhatIsWrong) {
  const auto named = [](Secret secret, std::vector<Assumption> right) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto checks = checks_of(squares(secret), seed);
      const AssumptionCheck* const wrong = wrong_assumption(checks);
      ASSERT_NE(wrong, nullptr) << static_cast<int>(secret);
      EXPECT_EQ(std::count(right.begin(), right.end(), wrong->assumption), 1)
          << static_cast<int>(wrong->assumption);
      EXPECT_GT(wrong->total_variation, wrong->chance_95);
    }
  };
  named(Secret::remembers_face, {Assumption::face_before});
  named(Secret::differs_by_row, {Assumption::quarters, Assumption::cells});
  named(Secret::differs_by_cell, {Assumption::cells, Assumption::quarters});
}

TEST(Assumptions, QuartersDifferWhereSidesDo) {
  // The face before tells of the side too, so that it may be named instead.
  for (const std::uint64_t seed : {1, 2, 3})
    EXPECT_TRUE(
        find(checks_of(squares(Secret::differs_by_side), seed), Assumption::quarters)->is_wrong());
}

TEST(Assumptions, AMirrorThatIsNoneIsNamed) {
  Problem problem = gates(200.0);
  ASSERT_FALSE(problem.map().types[0].symmetric);
  EXPECT_EQ(wrong_assumption(checks_of(problem, 1)), nullptr);
  problem.cells.map.types[0].symmetric = true;
  const auto checks = checks_of(problem, 1);
  ASSERT_NE(wrong_assumption(checks), nullptr);
  EXPECT_EQ(wrong_assumption(checks)->assumption, Assumption::mirror);
}

TEST(Assumptions, StatesThatAreTooFewAreNamed) {
  const Problem problem = gates(200.0);
  TreeOptions options{.accuracy = {.trials = 4000}, .starts = {problem.start}};
  const auto right = make_tree_chain(problem, options);
  EXPECT_EQ(wrong_assumption(right.assumptions), nullptr);
  ASSERT_EQ(right.assumptions.size(), 4);
  options.most_states = 5;
  const auto few = make_tree_chain(problem, options).assumptions;
  ASSERT_NE(wrong_assumption(few), nullptr);
  EXPECT_EQ(wrong_assumption(few)->assumption, Assumption::states);
  options.starts.clear();
  options.range = usual_range(problem);
  const auto of_range = make_tree_chain(problem, options).assumptions;
  ASSERT_NE(wrong_assumption(of_range), nullptr);
  EXPECT_EQ(wrong_assumption(of_range)->assumption, Assumption::states);
}

// The bodies of one trial after the other are what recorded runs are.
TEST(Assumptions, OfRecordedRunsAreChecked) {
  Problem problem = squares(Secret::remembers_face);
  RunPool pool;
  FieldTrials& each = pool.scattered.each;
  (void)run_field(problem.cells, problem.field, problem.start, 3, {0, 4000}, &each);
  for (std::int32_t body = 0; body < 4000; ++body) {
    pool.scattered.starts.push_back(problem.start);
    each.bodies.push_back(body);
  }
  problem.cells.cells.clear();
  const auto checks = predict_recorded(problem, pool, {{}}, {}).assumptions;
  ASSERT_NE(wrong_assumption(checks), nullptr);
  EXPECT_EQ(wrong_assumption(checks)->assumption, Assumption::face_before);
}

/// A cell that bodies leave to any of its eight neighbours, each with the same chance.
class EightWays : public Cell {
 public:
  EightWays() {
    const std::array<std::array<int, 2>, 8> moves{
        {{0, 1}, {1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}};
    for (std::size_t i = 0; i < moves.size(); ++i)
      section_.faces.push_back({std::string(1, static_cast<char>('A' + i)),
                                moves[i][0],
                                moves[i][1],
                                static_cast<int>((8 - i) % 8),
                                0,
                                "before",
                                {{{0.0, 1.0}}}});
    section_.coordinates = {{"s", "s", "1", "place", 1.0}};
  }
  [[nodiscard]] const Section& section() const override { return section_; }
  [[nodiscard]] Passage pass(Body& body) const override {
    body.entry = {static_cast<int>(body.random.below(8)), {body.random.uniform()}};
    return {Fate::left, body.entry, {}};
  }

 private:
  Section section_;
};

// Pairs of faces: eight faces have labels for six faces before.
TEST(Assumptions, OfCellsWithManyFacesAreChecked) {
  Problem problem = squares(Secret::none);
  problem.cells.cells = {std::make_shared<EightWays>()};
  for (const bool symmetric : {false, true}) {
    problem.cells.map = {problem.cells.cells.front()->section(), {{symmetric}}, 0, {}};
    const auto checks = checks_of(problem, 1, 0.1);
    EXPECT_NE(find(checks, Assumption::states), nullptr);
    // Mirror images of the six faces are not all among them.
    EXPECT_EQ(find(checks, Assumption::face_before) == nullptr, symmetric);
    EXPECT_EQ(find(checks, Assumption::mirror) == nullptr, !symmetric);
    EXPECT_EQ(wrong_assumption(checks), nullptr);
  }
}

/// A prediction of four gates: 1/4 each, changed by `change`, with groups around it.
GroupedMaps around(const std::array<double, 4>& change, double noise, std::uint64_t seed) {
  GroupedMaps maps{CellProbabilities::Constant(1, 4, 0.25), {}, 0.0};
  for (Eigen::Index i = 0; i < 4; ++i) maps.whole(0, i) += change[static_cast<std::size_t>(i)];
  Random random(Purpose::comparison, {seed, 1, 0});
  CellProbabilities mean = CellProbabilities::Zero(1, 4);
  for (int g = 0; g < kTrialGroups; ++g) {
    CellProbabilities& group = maps.groups.emplace_back(CellProbabilities::Constant(1, 4, 0.25));
    for (Eigen::Index i = 0; i < 4; ++i) group(0, i) += noise * random.normal();
    group += 0.25 - group.mean();  // shares of all bodies
    mean += group / kTrialGroups;
  }
  maps.whole += mean - 0.25;
  return maps;
}

TEST(GroupDifference, OfChanceHasUniformP) {
  constexpr int kSeeds = 400;
  int below = 0, half = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const GroupedMaps first{CellProbabilities::Constant(1, 4, 0.25),
                            {kTrialGroups, CellProbabilities::Constant(1, 4, 0.25)},
                            0.0};
    const auto d = group_difference(first, around({}, 0.01, seed), 3, seed, 0);
    below += d.p <= 0.05;
    half += d.p <= 0.5;
  }
  EXPECT_NEAR(below, 0.05 * kSeeds, 13);
  EXPECT_NEAR(half, 0.5 * kSeeds, 35);
}

TEST(GroupDifference, CountsGatesThatOnlyOneChainReaches) {
  const auto map = [](double there) {
    CellProbabilities p(1, 2);
    p << 1.0 - there, there;
    return p;
  };
  // The first chain reaches the second gate, but for some of its groups; the second never does.
  GroupedMaps first{map(0.1), {}, 0.0}, second{map(0.0), {}, 0.0};
  for (int g = 0; g < kTrialGroups; ++g) {
    first.groups.push_back(map(g % 2 == 0 ? 0.2 : 0.0));
    second.groups.push_back(map(0.0));
  }
  EXPECT_DOUBLE_EQ(group_difference(first, second, 3, 1, 0).total_variation, 0.1);
}

TEST(GroupDifference, OfTwoPredictions) {
  const GroupedMaps first = around({}, 0.0, 1);
  EXPECT_EQ(group_difference(first, first, 3, 1, 0).p, 1.0);
  const auto moved = group_difference(first, around({0.1, -0.1, 0.0, 0.0}, 0.01, 1), 3, 1, 0);
  EXPECT_NEAR(moved.total_variation, 0.1, 0.01);
  EXPECT_LT(moved.chance_95, 0.06);
  EXPECT_LE(moved.p, 0.002);
  // Bodies that end where there is no run may end anywhere.
  GroupedMaps unknown = around({0.1, -0.1, 0.0, 0.0}, 0.01, 1);
  unknown.unsampled = 0.1;
  EXPECT_GT(group_difference(first, unknown, 3, 1, 0).p, 0.05);
  EXPECT_GT(group_difference(first, around({0.002, -0.002, 0.0, 0.0}, 0.01, 1), 3, 1, 0).p, 0.05);
}

TEST(GroupDifference, IsNoneWithinRounding) {
  const auto map = [](double there) { return CellProbabilities::Constant(1, 1, there); };
  GroupedMaps first{map(1.0), {}, 0.0}, second{map(1.0 - 1e-15), {}, 0.0};
  for (int g = 0; g < kTrialGroups; ++g) {
    first.groups.push_back(map(1.0));
    second.groups.push_back(map(1.0 - 1e-15));
  }
  EXPECT_EQ(group_difference(first, second, 3, 1, 0).p, 1.0);
}

TEST(Holm, ByHand) {
  // Smallest x 4, next x 3, next x 2, last x 1; never below an earlier one, never above 1.
  const std::vector<double> adjusted = holm({0.02, 0.01, 0.9, 0.02});
  EXPECT_DOUBLE_EQ(adjusted[1], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[0], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[3], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.9);
  EXPECT_EQ(holm({0.7, 0.8}), (std::vector<double>{1.0, 1.0}));
  EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace gatewalk::lattice
