// SPDX-License-Identifier: MIT
#include "lattice/field/gate_chain.h"
#include "lattice/field/matrix_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "dynamics/disc/row_trials.h"
#include "lattice/statistics/matrix_noise.h"
#include "markov/chain.h"
#include "markov/predict.h"
#include "tests/support/disc_fields.h"
#include "tests/support/numbers.h"

namespace gatewalk::lattice {
namespace {

namespace fs = std::filesystem;
using namespace dynamics;

StateSpace paper() { return table3_space(GateParams{}); }

/// Counts without physics: every third row, with a few columns each.
Transitions made_up() {
  Transitions t(paper());
  test::Draw draw(1);
  for (int row = 0; row < t.space.size(); row += 3) {
    for (int i = 0; i < 4; ++i) {
      const std::int64_t n = 1 + draw.below(50);
      t.rows[row][draw.below(88)] += n;
      t.trials[row] += n;
    }
    t.clamped[row] = draw.below(static_cast<int>(t.trials[row]));
  }
  return t;
}

// ---- Exits ----

TEST(Exits, LeadToTheirStateInTheNeighbour) {
  const auto exits = exits_of(paper());
  ASSERT_EQ(exits.size(), 88u);
  for (int state = 0; state < 87; ++state) {
    EXPECT_EQ(exits[state].next_input, state);  // output O_j is input I_j of the next gate
    const int di_x = state < 25 ? 0 : state < 55 || state == 85 ? -1 : 1;  // EN | RD, RT | LD, LT
    EXPECT_EQ(exits[state].di_x, di_x) << state;
    EXPECT_EQ(exits[state].di_y, state < 25 ? 1 : 0) << state;
  }
  EXPECT_EQ(exits[87], markov::Exit{});
  EXPECT_EQ(exits[87].next_input, markov::Exit::kTrapped);
  EXPECT_NO_THROW(markov::validate(exits, 87, 88));
}

// ---- Chain ----

TEST(GateChain, HasTheSharesOfTheCounts) {
  const Transitions t = made_up();
  const markov::Chain chain = make_chain(t);
  EXPECT_EQ(chain.inputs(), 87);
  EXPECT_EQ(chain.outputs(), 88);
  EXPECT_EQ(chain.exits(), exits_of(t.space));
  EXPECT_EQ(chain.unsampled_rows(), 58);
  for (int row = 0; row < 87; ++row) {
    EXPECT_EQ(chain.is_sampled(row), row % 3 == 0);
    for (int column = 0; column < 88; ++column) {
      const auto it = t.rows[row].find(column);
      const double expected = it == t.rows[row].end() ? 0.0
                                                      : static_cast<double>(it->second) /
                                                            static_cast<double>(t.trials[row]);
      EXPECT_NEAR(chain.matrix().coeff(row, column), expected, test::kEps);
    }
  }
}

// ---- Resampling ----

/// The shares of a row.
std::map<int, double> shares_of(const markov::Counts& counts, int row) {
  std::map<int, double> shares;
  double all = 0.0;
  for (markov::Counts::InnerIterator entry(counts, row); entry; ++entry) {
    shares[static_cast<int>(entry.col())] = static_cast<double>(entry.value());
    all += static_cast<double>(entry.value());
  }
  for (auto& [column, share] : shares) share /= all;
  return shares;
}

// Resampled rows vary around the row's own shares as rows of that many runs do; also with two or
// three runs.
TEST(Resampled, HasItsOwnSharesForMeanAndVariesAsSoManyRuns) {
  Transitions t = made_up();
  t.rows[1] = {{3, 2}, {7, 1}};
  t.trials[1] = 3;
  t.rows[2] = {{3, 1}, {7, 1}};
  t.trials[2] = 2;
  constexpr int kReplicates = 4000;
  std::vector<std::map<int, double>> sum(t.space.size()), squares(t.space.size());
  for (int k = 0; k < kReplicates; ++k) {
    const markov::Counts drawn = resampled(t.counts(), 1, static_cast<std::uint64_t>(k));
    for (int row = 0; row < t.space.size(); ++row) {
      const std::map<int, double> shares = shares_of(drawn, row);
      ASSERT_EQ(shares.size(),
                t.rows[row].size());  // no outcome is lost, and none is added
      for (const auto& [column, share] : shares) {
        ASSERT_TRUE(t.rows[row].contains(column));
        ASSERT_GT(share, 0.0);
        sum[row][column] += share;
        squares[row][column] += share * share;
      }
    }
  }
  for (int row = 0; row < t.space.size(); ++row) {
    for (const auto& [column, n] : t.rows[row]) {
      const auto trials = static_cast<double>(t.trials[row]);
      const double mean = static_cast<double>(n) / trials;
      const double variance = mean * (1.0 - mean) / trials;
      // Five standard errors, for about 100 entries.
      EXPECT_NEAR(sum[row][column] / kReplicates, mean,
                  5 * std::sqrt(variance / kReplicates) + 1e-12);
      const double m = sum[row][column] / kReplicates;
      if (variance == 0.0 || n == 1) continue;  // the fourth moments of a single run are large
      EXPECT_NEAR((squares[row][column] / kReplicates - m * m) / variance, 1.0, 0.15);
    }
  }
}

// A run with two counts, its own and its mirror image's, is one run.
TEST(Resampled, CountsMirrorImagesOnce) {
  markov::Counts counts(1, 2);
  counts.insert(0, 0) = 60;
  counts.insert(0, 1) = 20;
  const auto variance = [&](const std::vector<std::int64_t>& images) {
    double sum = 0.0, squares = 0.0;
    constexpr int kReplicates = 4000;
    for (std::uint64_t k = 0; k < kReplicates; ++k) {
      const markov::Counts drawn = resampled(counts, 1, k, true, images);
      const double share = static_cast<double>(drawn.coeff(0, 0)) /
                           static_cast<double>(drawn.coeff(0, 0) + drawn.coeff(0, 1));
      sum += share;
      squares += share * share;
    }
    return squares / kReplicates - sum * sum / kReplicates / kReplicates;
  };
  EXPECT_NEAR(variance({}) / (0.75 * 0.25 / 80.0), 1.0, 0.12);
  EXPECT_NEAR(variance({2}) / (0.75 * 0.25 / 40.0), 1.0, 0.12);
}

// Trees of a symmetric gate count every run with its mirror image: twice in each leaf, and in the
// row of a start in the middle. A start beside the middle counts once, and so does every run if the
// gate is not symmetric.
TEST(CountedField, KnowsWhichRowsHoldMirrorImages) {
  GateParams even;
  even.beams.stiffness_right = even.beams.stiffness_left;
  GateParams uneven = even;
  uneven.beams.stiffness_right *= 2.0;
  Transitions t(
      StateSpace(disc_section(), std::vector<Tree>(kBoundaries),
                 {{Boundary::enter, {0.0, 0.0, 1.0}}, {Boundary::enter, {0.1, 0.0, 1.0}}}));
  ASSERT_EQ(t.space.size(), kBoundaries + 2);
  for (int row = 0; row < t.space.size(); ++row) t.rows[row][0] = t.trials[row] = 40;
  const auto runs = [&](const CountedField& field) {
    std::vector<std::int64_t> all;
    for (int row = 0; row < t.space.size(); ++row) all.push_back(field.runs_at({0, 0, row}));
    return all;
  };
  using Runs = std::vector<std::int64_t>;
  EXPECT_EQ(runs(counted_field(FieldGates(even).map(), {t})), (Runs{20, 20, 20, 20, 20, 20, 40}));
  EXPECT_EQ(runs(counted_field(FieldGates(uneven).map(), {t})), (Runs{40, 40, 40, 40, 40, 40, 40}));
  EXPECT_EQ(counted_field(FieldGates(even).map(), {made_up()}).images.size(),
            0U);  // bins count no mirror images
}

TEST(Resampled, IsNamedBySeedAndReplicate) {
  const markov::Counts counts = made_up().counts();
  const auto drawn = [&](std::uint64_t seed, std::uint64_t replicate) {
    return Eigen::MatrixX<std::int64_t>(resampled(counts, seed, replicate));
  };
  EXPECT_EQ(drawn(1, 2), drawn(1, 2));
  EXPECT_NE(drawn(1, 2), drawn(1, 3));
  EXPECT_NE(drawn(1, 2), drawn(2, 2));
}

TEST(ChainStart, IsTheStateOfTheBody) {
  const StateSpace space = paper();
  const FieldParams field;
  // Sec. III-C: the origin, 15 m/s forward, is the middle of EN, in gate (0, 0).
  const ChainStart s = chain_start(space, field, {0, {0, 0, 15}});
  EXPECT_EQ(s.start.column, 4);
  EXPECT_EQ(s.start.row, 0);
  EXPECT_EQ(s.start.input, 2 * 5 + 2);
  EXPECT_FALSE(s.clamped);
  EXPECT_EQ(chain_start(space, field, {0, {-20, 10, 12}}).start.input, 0 * 5 + 3);
  const FieldParams narrow{.columns = 5, .rows = 1, .max_gates = 0};
  EXPECT_EQ(chain_start(space, narrow, {0, {0, 0, 15}}).start.column, 2);
  const FieldParams own{.own_start_column = 7, .start_row = 5};
  EXPECT_EQ(chain_start(space, own, {0, {0, 0, 15}}).start.column, 7);
  EXPECT_EQ(chain_start(space, own, {0, {0, 0, 15}}).start.row, 5);
}

TEST(ChainStart, SaysWhenItWasClamped) {
  const ChainStart s = chain_start(paper(), {}, {0, {0, 0, 5}});  // slower than all bins
  EXPECT_EQ(s.start.input, 2 * 5 + 2);
  EXPECT_TRUE(s.clamped);
}

TEST(ChainStart, InsideTheGateIsRefused) {
  Scene scene;
  for (const double y : {1e-9, 5.0, -1.0}) {
    scene.start.y = y;
    try {
      (void)own_start(scene);
      ADD_FAILURE() << y;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("start.y_m"), std::string::npos);
    }
  }
}

// ---- The file ----

class MatrixOnDisk : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gatewalk-matrix-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string path() const { return (folder_ / "matrix.nc").string(); }

  /// Writes a good matrix, lets `spoil` change it under a valid checksum, and tries to read it.
  [[nodiscard]] std::string refusal(const std::function<void(markov::CountsFile&)>& spoil) const {
    write_matrix(path(), {made_up(), {}});
    markov::CountsFile file = markov::read_counts(path());
    spoil(file);
    markov::write_counts(path(), file);
    try {
      (void)read_matrix(path());
    } catch (const markov::BadFile& e) {
      EXPECT_NE(std::string(e.what()).find(path()), std::string::npos) << e.what();
      return e.what();
    }
    return "accepted";
  }

  fs::path folder_;
};

std::vector<double>& edges(markov::CountsFile& file, const std::string& name) {
  for (auto& array : file.arrays)
    if (array.name == name) return array.values;
  throw std::logic_error("no array " + name);
}

TEST_F(MatrixOnDisk, ComesBackAsItWas) {
  const Transitions t = made_up();
  const std::map<std::string, std::string> text{{"scene", "F = 8\nRm = 40"}, {"seed", "1"}};
  write_matrix(path(), {t, text});
  const MatrixFile back = read_matrix(path());
  EXPECT_EQ(back.transitions.space, t.space);
  EXPECT_EQ(back.transitions.rows, t.rows);
  EXPECT_EQ(back.transitions.trials, t.trials);
  EXPECT_EQ(back.transitions.clamped, t.clamped);
  EXPECT_EQ(back.text, text);
}

TEST_F(MatrixOnDisk, KeepsBinsThatAreNotThePapers) {
  GateParams p;
  p.beams.joint_x = 31.0;
  p.body.radius = 7.1;
  auto bins = table3_space(p).bins();
  bins[0].edges[kEntryVy] = {0.1, 10.0, 20.0};  // 50 EN states
  const Transitions t{StateSpace(disc_section(p), bins)};
  write_matrix(path(), {t, {}});
  const StateSpace back = read_matrix(path()).transitions.space;
  EXPECT_EQ(back, t.space);
  EXPECT_EQ(back.size(), 112);
}

TEST_F(MatrixOnDisk, KeepsOpenBinsAndSingleEntries) {
  const std::vector<Entry> points{{Boundary::enter, {0, 0, 15}},
                                  {Boundary::left_traverse, {12, 3.5, -1}}};
  Transitions t{StateSpace(disc_section(), paper().bins(), true, points)};
  t.rows[88][89] = 7;
  t.trials[88] = 7;
  write_matrix(path(), {t, {}});
  const MatrixFile back = read_matrix(path());
  EXPECT_EQ(back.transitions.space, t.space);
  EXPECT_TRUE(back.transitions.space.open());
  EXPECT_EQ(back.transitions.space.points(), points);
  EXPECT_EQ(back.transitions.rows, t.rows);
  const ChainStart s = chain_start(back.transitions.space, {}, {0, {0, 0, 15}});
  EXPECT_EQ(s.start.input, 87);
  EXPECT_FALSE(s.clamped || s.beyond);
  const ChainStart far = chain_start(back.transitions.space, {}, {0, {0, 0, 99}});
  EXPECT_TRUE(far.beyond && !far.clamped);

  markov::CountsFile file = markov::read_counts(path());
  edges(file, "point_boundary")[1] = 5;
  markov::write_counts(path(), file);
  EXPECT_THROW((void)read_matrix(path()), markov::BadFile);
  edges(file, "point_boundary")[1] = 4;
  for (markov::NamedArray& array : file.arrays)
    if (array.name == "point_vx") {
      array.values.pop_back();
      array.dimension = "";
    }
  markov::write_counts(path(), file);
  EXPECT_THROW((void)read_matrix(path()), markov::BadFile);
}

// Builds, writes and reads matrices with spaces other than the paper's: the exact prediction is the
// same before and after, and a distribution.
TEST_F(MatrixOnDisk, CarriesRefinedSpacesToThePrediction) {
  GateParams p;
  p.forces.propulsion = 7.0;
  p.forces.random = 50.0;
  const FieldParams field;
  const markov::Field cells{field.columns, field.rows};
  for (const double factor : {0.5, 1.5}) {
    Transitions t(refined(paper(), factor));
    add_trials(t, p, 1, {0, 2});
    ASSERT_EQ(t.health.broken, 0);
    write_matrix(path(), {t, {{"bins", std::to_string(factor)}}});
    const MatrixFile back = read_matrix(path());
    EXPECT_EQ(back.transitions.space, t.space);
    EXPECT_EQ(back.transitions.rows, t.rows);
    EXPECT_EQ(back.transitions.trials, t.trials);
    EXPECT_EQ(back.transitions.clamped, t.clamped);

    const markov::Chain chain = make_chain(back.transitions);
    EXPECT_EQ(chain.inputs(), t.space.size());
    EXPECT_EQ(chain.outputs(), t.space.size() + 1);
    EXPECT_EQ(chain.unsampled_rows(), 0);
    const auto start = chain_start(back.transitions.space, field, {0, {4, 5, 12}});
    EXPECT_FALSE(start.clamped);
    const auto f =
        markov::predict(chain, cells, {start.start}, {.max_cells = field.max_gates}).front();
    // markov/predict.h: nothing is normalised; 13 steps lose about 1e-16 per row.
    EXPECT_NEAR(f.final_cells.sum() + f.remainder, 1.0, 1e-12);
    EXPECT_NEAR(f.trapped() + f.left_field() + f.cut_off() + f.unsampled() + f.remainder, 1.0,
                1e-12);
    EXPECT_GT((f.final_cells > 0.0).count(), 3);  // walks reached other gates
    const auto direct =
        markov::predict(make_chain(t), cells, {start.start}, {.max_cells = field.max_gates})
            .front();
    EXPECT_TRUE((f.final_cells == direct.final_cells).all());
  }
}

TEST_F(MatrixOnDisk, HasTheEdgesByName) {
  write_matrix(path(), {made_up(), {}});
  markov::CountsFile file = markov::read_counts(path());
  std::erase_if(file.arrays, [](const auto& a) { return a.name.starts_with("state_"); });
  EXPECT_EQ(file.arrays.size(), 15u);
  EXPECT_EQ(edges(file, "EN_d_edges"), (std::vector<double>{-25, -15, -5, 5, 15, 25}));
  EXPECT_EQ(edges(file, "RD_vx_edges"), (std::vector<double>{-30, -20, -10, 0}));
  EXPECT_EQ(edges(file, "LT_vy_edges"), (std::vector<double>{-20, 30}));
  for (const auto& array : file.arrays)
    EXPECT_EQ(array.unit, array.name.find("_d_") != array.name.npos ? "m" : "m s-1") << array.name;
}

TEST_F(MatrixOnDisk, NamesItsStatesAndSaysWhatTheyAre) {
  const Transitions t = made_up();
  write_matrix(path(), {t, {}});
  markov::CountsFile file = markov::read_counts(path());
  ASSERT_EQ(file.state_names.size(), 88u);
  EXPECT_EQ(file.state_names[0], "EN_0");
  EXPECT_EQ(file.state_names[86], "LT_86");
  EXPECT_EQ(file.state_names[87], "trapped");
  for (int state = 0; state < t.space.size(); ++state) {
    const StateRange range = t.space.range(state);
    EXPECT_EQ(edges(file, "state_face")[static_cast<std::size_t>(state)], range.face);
    EXPECT_EQ(edges(file, "state_vx_low")[static_cast<std::size_t>(state)], range.at[1][0]);
    EXPECT_EQ(edges(file, "state_vy_high")[static_cast<std::size_t>(state)], range.at[2][1]);
  }
}

TEST_F(MatrixOnDisk, UntouchedIsAccepted) {
  EXPECT_EQ(refusal([](markov::CountsFile&) {}), "accepted");
}

TEST_F(MatrixOnDisk, WrongBinsAreRefused) {
  const auto expect_refused = [&](const char* array, const char* reason, auto change) {
    const std::string why = refusal([&](markov::CountsFile& f) { change(edges(f, array)); });
    EXPECT_NE(why.find(reason), why.npos) << array << ": " << why;
  };
  expect_refused("EN_d_edges", "82 states", [](auto& e) { e.pop_back(); });
  expect_refused("LD_vy_edges", "93 states", [](auto& e) { e.push_back(40); });
  expect_refused("RD_vx_edges", "RD", [](auto& e) { std::swap(e[0], e[1]); });
  expect_refused("RT_d_edges", "RT", [](auto& e) { e.resize(1); });
  expect_refused("LT_d_edges", "LT", [](auto& e) { e[1] = std::nan(""); });
}

TEST_F(MatrixOnDisk, MissingBinsAreRefused) {
  for (const char* name : {"EN_d_edges", "RT_vx_edges", "LD_vy_edges"}) {
    const std::string why = refusal([&](markov::CountsFile& f) {
      std::erase_if(f.arrays, [&](const auto& a) { return a.name == name; });
    });
    EXPECT_NE(why.find(name), std::string::npos) << why;
  }
}

TEST_F(MatrixOnDisk, ForeignExitsAreRefused) {
  EXPECT_NE(refusal([](markov::CountsFile& f) { f.exits[30].di_x = 1; }).find("exits"),
            std::string::npos);
  EXPECT_NE(refusal([](markov::CountsFile& f) { f.exits[0].next_input = 1; }).find("exits"),
            std::string::npos);
  EXPECT_NE(refusal([](markov::CountsFile& f) {
              f.exits[87] = {0, 0, 1};
            }).find("exits"),
            std::string::npos);
}

TEST_F(MatrixOnDisk, MissingFileIsRefused) {
  EXPECT_THROW((void)read_matrix((folder_ / "none.nc").string()), markov::BadFile);
}

}  // namespace
}  // namespace gatewalk::lattice
