// SPDX-License-Identifier: MIT
// Predictions from matrices with two outcomes, by hand.
#include "lattice/study/prediction.h"
#include "tests/support/disc_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace gatewalk::lattice {
namespace {

using dynamics::Boundary;
using markov::Ending;

/// From every entry, `up` of 1000 runs go on upwards, into the same state; the others are trapped.
SceneMatrix matrix(std::int64_t up, const std::string& keys = "") {
  Scene scene = parse_scene("field = { columns = 3, rows = 3, max_gates = 9 }\n" + keys, "scene");
  dynamics::Transitions t(dynamics::table3_space(scene.gate));
  const int state = t.space.index_of({Boundary::enter, {0.0, 0.0, 15.0}}).state;
  for (std::size_t row = 0; row < t.rows.size(); ++row) {
    if (up > 0) t.rows[row][state] = up;
    if (up < 1000) t.rows[row][t.space.trapped()] = 1000 - up;
    t.trials[row] = 1000;
  }
  return {std::make_shared<const MatrixFile>(MatrixFile{std::move(t), {}}), std::move(scene)};
}

Prediction predicted(const SceneMatrix& m, const std::vector<RowMatrix>& others = {}) {
  const ChainStart start =
      chain_start(m.file->transitions.space, m.scene.field, {0, {0.0, 0.0, 15.0}});
  return predict(field_of(m, "base.nc", others), m.scene.field, {start}, {}, 1);
}

double share(const Prediction& p, Ending e) {
  return p.starts.front().shares.share[static_cast<std::size_t>(e)];
}

TEST(Prediction, OfThreeRowsIsAPower) {
  const Prediction p = predicted(matrix(750));
  EXPECT_NEAR(share(p, Ending::far_edge), 27.0 / 64, 1e-15);
  EXPECT_NEAR(share(p, Ending::trapped), 37.0 / 64, 1e-15);
  EXPECT_NEAR(p.starts[0].final.final_cells(1, 1), 0.75 * 0.25, 1e-15);
  EXPECT_EQ(p.left_out.matrices, 0);
  // 1000 runs per row; all rows are equal but resampled independently, and the walk uses one of
  // them.
  EXPECT_EQ(p.starts[0].replicates, 999);
  const auto [low, high] = p.starts[0].shares.interval[static_cast<std::size_t>(Ending::far_edge)];
  const double sd = 3.0 * 0.75 * 0.75 * std::sqrt(0.75 * 0.25 / 1000);  // of q^3
  EXPECT_NEAR(27.0 / 64 - low, 1.96 * sd, 0.4 * sd);
  EXPECT_NEAR(high - 27.0 / 64, 1.96 * sd, 0.4 * sd);
  EXPECT_GT(p.starts[0].total_variation_95, p.starts[0].mean_total_variation);
}

TEST(Prediction, RowsOfOtherMatrices) {
  const SceneMatrix base = matrix(750);
  const std::vector<RowMatrix> trap{{1, 1, "trap.nc", matrix(0)}};
  const Prediction p = predicted(base, trap);
  EXPECT_EQ(share(p, Ending::far_edge), 0.0);
  EXPECT_NEAR(p.starts[0].final.final_cells(1, 1), 0.75, 1e-15);
  const std::vector<RowMatrix> open{{0, 1, "open.nc", matrix(1000)},
                                    {2, 2, "open.nc", matrix(1000)}};
  EXPECT_EQ(field_of(base, "base.nc", open).counts.size(), 2u);  // one file, one type
  EXPECT_DOUBLE_EQ(share(predicted(base, open), Ending::far_edge), 1.0);
}

TEST(FieldOf, RefusesWhatMakesNoField) {
  const SceneMatrix base = matrix(750);
  const auto message = [&](std::vector<RowMatrix> others) {
    try {
      (void)field_of(base, "base.nc", others);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({{2, 1, "a.nc", base}}), "--row 2-1=a.nc: the lower row comes first");
  EXPECT_EQ(message({{1, 3, "a.nc", base}}), "--row 1-3=a.nc: the rows of this field are 0 to 2");
  EXPECT_EQ(message({{1, 2, "a.nc", base}, {2, 2, "b.nc", base}}),
            "--row 2=b.nc: row 2 is given twice");
  EXPECT_EQ(message({{1, 1, "a.nc", matrix(1, "body.radius_m = 9.0")}}),
            "--row 1=a.nc: it was built with another body than base.nc");
  EXPECT_EQ(
      message({{1, 1, "a.nc", matrix(1, "beams.joint_x_m = 26.0")}}),
      "--row 1=a.nc: its gates are 52.000 m wide and 60.000 m long, those of base.nc 50.000 and "
      "60.000 m: they make no field");
}

TEST(Prediction, IsStoppedByWhoWatches) {
  const SceneMatrix m = matrix(600);
  const ChainStart a = chain_start(m.file->transitions.space, m.scene.field, {0, {0.0, 0.0, 15.0}});
  const dynamics::Work work{
      [](std::string_view, std::int64_t, std::int64_t) { throw std::runtime_error("enough"); }};
  EXPECT_THROW((void)predict(field_of(m, "base.nc", {}), m.scene.field, {a}, {}, 1, work),
               std::runtime_error);
}

TEST(Prediction, OfManyStartsIsOneEach) {
  const SceneMatrix m = matrix(600);
  const ChainStart a = chain_start(m.file->transitions.space, m.scene.field, {0, {0.0, 0.0, 15.0}}),
                   b = chain_start(m.file->transitions.space, m.scene.field, {0, {9.0, 3.0, 5.0}});
  const Prediction p = predict(field_of(m, "base.nc", {}), m.scene.field, {a, b}, {}, 1);
  ASSERT_EQ(p.starts.size(), 2u);
  EXPECT_EQ(p.starts[1].start.start.input, b.start.input);
  for (const StartPrediction& s : p.starts) EXPECT_NEAR(s.final.trapped(), 1 - 0.216, 1e-14);
}

/// Prediction from rows of few runs, by the face that bodies came through; without a limit of
/// gates.
Prediction of_few_runs(const std::function<std::map<int, std::int64_t>(int face)>& row_of) {
  SceneMatrix m = matrix(1000);
  m.scene.field.max_gates = 0;
  dynamics::Transitions t = m.file->transitions;
  for (std::size_t row = 0; row < t.rows.size(); ++row) {
    t.rows[row] = row_of(t.space.face(static_cast<int>(row)));
    t.trials[row] = 0;
    for (const auto& [to, runs] : t.rows[row]) t.trials[row] += runs;
  }
  m.file = std::make_shared<const MatrixFile>(MatrixFile{std::move(t), {}});
  CountedField gates = field_of(m, "base.nc", {});
  gates.small_rows = true;
  const ChainStart start =
      chain_start(m.file->transitions.space, m.scene.field, {0, {0.0, 0.0, 15.0}});
  return predict(gates, m.scene.field, {start}, {}, 1);
}

// Bodies move back and forth between two gates until one of few runs, or the only one, traps them.
// No resampled matrix loses that way out.
TEST(Prediction, NoResampledMatrixLosesTheOnlyWayOut) {
  const dynamics::StateSpace space = matrix(1000).file->transitions.space;
  const int right = space.first(Boundary::right_deflect),
            left = space.first(Boundary::left_deflect);
  for (const std::int64_t runs : {5, 5000}) {
    const Prediction p = of_few_runs([&](int face) {
      std::map<int, std::int64_t> row{{face == Boundary::right_deflect ? left : right, runs}};
      if (face != Boundary::left_deflect) row[space.trapped()] = 1;
      return row;
    });
    EXPECT_NEAR(share(p, Ending::trapped), 1.0, 1e-9);
    EXPECT_EQ(p.left_out.matrices, 0);
    EXPECT_EQ(p.starts[0].replicates, p.left_out.of);
    EXPECT_EQ(p.left_out.of, 999);
    EXPECT_LE(p.starts[0].shares.interval[0][0], 1.0);
    EXPECT_EQ(p.starts[0].shares.interval[0][1], 1.0);
  }
}

// One half is trapped, the other never ends: each share may be larger by that half.
TEST(Prediction, WhatNeverEndsWidensEachInterval) {
  const dynamics::StateSpace space = matrix(1000).file->transitions.space;
  const int right = space.first(Boundary::right_deflect),
            left = space.first(Boundary::left_deflect);
  const Prediction p = of_few_runs([&](int face) -> std::map<int, std::int64_t> {
    if (face == Boundary::right_deflect) return {{left, 100}};
    if (face == Boundary::left_deflect) return {{right, 100}};
    return {{right, 50}, {space.trapped(), 50}};
  });
  const StartPrediction& s = p.starts[0];
  EXPECT_EQ(s.final.endless, 0.5);
  EXPECT_EQ(share(p, Ending::trapped), 0.5);
  const auto& trapped = s.shares.interval[static_cast<std::size_t>(Ending::trapped)];
  EXPECT_NEAR(trapped[0], 0.5 - 1.96 * 0.05, 0.03);
  EXPECT_EQ(trapped[1], 1.0);
  const auto& crossed = s.shares.interval[static_cast<std::size_t>(Ending::far_edge)];
  EXPECT_EQ(crossed[0], 0.0);
  EXPECT_GE(crossed[1], 0.5);
  EXPECT_EQ(s.shares.interval[static_cast<std::size_t>(Ending::cut_off)], (std::array{0.0, 0.0}));
  EXPECT_GE(s.exits[kFarSide].interval[0][1], 0.5);
  EXPECT_EQ(p.left_out.matrices, 0);
  EXPECT_GT(s.replicates, 0);
}

}  // namespace
}  // namespace gatewalk::lattice
