// SPDX-License-Identifier: MIT
#include "lattice/field/field_trials.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "dynamics/disc/disc_cell.h"
#include "lattice/field/gate_chain.h"
#include "markov/predict.h"
#include "tests/support/disc_fields.h"
#include "tests/support/numbers.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

const BodyState kStart{0, 0, 0, 15};  // Sec. III-C

/// A tally with the final gate of each trial.
struct Ran : FieldTally {
  FieldTrials each;

  explicit Ran(const FieldParams& field) : FieldTally(field) {}
  Ran& operator+=(const Ran& other) {
    FieldTally::operator+=(other);
    each.append(other.each);
    return *this;
  }
};

Ran run(const FieldGates& gates, const FieldParams& field, TrialRange range, std::uint64_t seed = 1,
        const BodyState& start = kStart) {
  Ran ran(field);
  const StateSpace space = table3_space(gates.at(field.start_column(), field.start_row));
  static_cast<FieldTally&>(ran) = run_field(gates, field, start, seed, range, &ran.each, &space);
  return ran;
}

void expect_same(const Ran& a, const Ran& b) {
  EXPECT_TRUE((a.final_cells == b.final_cells).all());
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.endings, b.endings);
  EXPECT_EQ(a.mixed_cells, b.mixed_cells);
  EXPECT_EQ(a.entries, b.entries);
  EXPECT_EQ(a.clamped, b.clamped);
  EXPECT_EQ(a.each.final_gates, b.each.final_gates);
  EXPECT_EQ(a.health.runs, b.health.runs);
  EXPECT_EQ(a.health.impacts, b.health.impacts);
  EXPECT_TRUE(test::same_bits(a.health.worst_speed, b.health.worst_speed));
  EXPECT_TRUE(test::same_bits(a.health.worst_energy_created, b.health.worst_energy_created));
}

TEST(FieldTally, CountsByGateAndEnding) {
  using markov::Ending;
  FieldTally tally({.columns = 2, .rows = 2});
  tally.count({3, 0, 3, 1, 3},
              {Ending::far_edge, Ending::trapped, Ending::trapped, std::nullopt, Ending::far_edge});
  tally.count({0, 1}, {Ending::left_edge, Ending::trapped});
  EXPECT_EQ(tally.trials, 7);
  EXPECT_EQ(tally.broken(), 1);
  EXPECT_EQ(tally.trapped(), 3);
  EXPECT_EQ(tally.left_field(), 3);
  using Cells = std::vector<std::int64_t>;
  const auto numbers = [](const markov::CellCounts& cells) {
    return Cells(cells.data(), cells.data() + cells.size());
  };
  EXPECT_EQ(numbers(tally.final_cells), (Cells{2, 2, 0, 3}));
  EXPECT_EQ(numbers(trapped_cells(tally)), (Cells{1, 1, 0, 1}));
  EXPECT_EQ(numbers(departed_cells(tally)), (Cells{1, 0, 0, 2}));
}

void expect_adds_up(const Ran& t, const FieldParams& field) {
  EXPECT_EQ(t.final_cells.rows(), field.rows);
  EXPECT_EQ(t.final_cells.cols(), field.columns);
  EXPECT_EQ(t.final_cells.sum(), t.trials);
  EXPECT_EQ(t.trapped() + t.left_field() + t.cut_off() + t.broken(), t.trials);
  EXPECT_EQ(t[markov::Ending::near_edge] + t.unsampled(), 0);
  EXPECT_EQ(trapped_cells(t).sum(), t.trapped());
  EXPECT_EQ(departed_cells(t).sum(), t.left_field());
  EXPECT_TRUE((trapped_cells(t) + departed_cells(t) <= t.final_cells).all());
  // Bodies leave over a side only from its column, and over the far edge only from the last row.
  if (field.rows > 2 && field.columns > 2) {
    EXPECT_EQ(departed_cells(t).block(0, 1, field.rows - 1, field.columns - 2).sum(), 0);
  }
  EXPECT_EQ(static_cast<std::int64_t>(t.each.final_gates.size()), t.trials);
  markov::CellCounts again = markov::CellCounts::Zero(field.rows, field.columns);
  for (const std::int32_t gate : t.each.final_gates)
    ++again(gate / field.columns, gate % field.columns);
  EXPECT_TRUE((again == t.final_cells).all());
  // One run per trial, plus one per crossing between gates.
  EXPECT_EQ(t.health.runs,
            t.trials + std::accumulate(t.entries.begin(), t.entries.end(), std::int64_t{0}));
  for (int b = 0; b < kBoundaries; ++b) {
    EXPECT_GE(t.clamped[b], 0);
    EXPECT_LE(t.clamped[b], t.entries[b]);
  }
  if (field.max_gates > 0) {
    EXPECT_LE(t.health.runs, t.trials * field.max_gates);
  }
}

TEST(Field, StartsInTheMiddleOfTheFirstRow) {
  EXPECT_EQ((FieldParams{.columns = 9}.start_column()), 4);
  EXPECT_EQ((FieldParams{.columns = 1}.start_column()), 0);
  EXPECT_EQ((FieldParams{.columns = 4}.start_column()), 2);
  const FieldParams f;
  EXPECT_TRUE(f.contains(0, 0) && f.contains(8, 8));
  EXPECT_FALSE(f.contains(-1, 0) || f.contains(9, 0) || f.contains(0, -1) || f.contains(0, 9));
}

// Discs do not move back a row, so rows behind the start change nothing but the numbers of rows.
TEST(RunField, StartsInAnyCell) {
  GateParams stiff;
  stiff.beams.stiffness_right = 600.0;
  constexpr int kBehind = 2, kColumns = 4, kRows = 3;
  const auto gates_with = [&](int rows_behind) {  // the types ahead of the start are the same
    std::vector<int> types(static_cast<std::size_t>(kColumns * rows_behind), 1);
    for (int cell = 0; cell < kColumns * kRows; ++cell) types.push_back(cell % 3 == 0 ? 1 : 0);
    return FieldGates::by_cell({GateParams(), stiff}, kColumns, types);
  };
  for (const Fidelity fidelity : {Fidelity::active, Fidelity::remember}) {
    FieldParams field{.columns = kColumns, .rows = kRows, .fidelity = fidelity};
    field.own_start_column = 3;
    FieldParams further = field;
    further.rows += kBehind;
    further.start_row = kBehind;
    GateParams plain;
    plain.run.method = "moreau";
    const bool one_type = fidelity != Fidelity::active;
    const BodyState side{-25.0, 10.0, 6.0, 12.0};
    const Ran a = run(one_type ? FieldGates(plain) : gates_with(0), field, {0, 300}, 1, side);
    const Ran b =
        run(one_type ? FieldGates(plain) : gates_with(kBehind), further, {0, 300}, 1, side);
    EXPECT_EQ(a.endings, b.endings);
    EXPECT_EQ(a.entries, b.entries);
    EXPECT_EQ(a.health.runs, b.health.runs);
    EXPECT_EQ(b.final_cells.topRows(kBehind).sum(), 0);
    EXPECT_TRUE((a.final_cells == b.final_cells.bottomRows(kRows)).all());
    EXPECT_GT(a[markov::Ending::right_edge], 0);
  }
  FieldParams one{.columns = 9, .rows = 9, .max_gates = 1};
  one.own_start_column = 7;
  one.start_row = 5;
  EXPECT_EQ(run(GateParams(), one, {0, 50}).final_cells(5, 7), 50);
}

TEST(RunField, TalliesAddUp) {
  const GateParams p;
  for (const FieldParams& field :
       {FieldParams{}, FieldParams{3, 2, 13}, FieldParams{9, 9, 4}, FieldParams{9, 9, 0},
        FieldParams{1, 5, 0}, FieldParams{4, 1, 2}}) {
    SCOPED_TRACE(testing::Message()
                 << field.columns << " x " << field.rows << ", at most " << field.max_gates);
    const Ran t = run(p, field, {0, 200});
    expect_adds_up(t, field);
    EXPECT_TRUE(t.health.clean());
    if (field.max_gates == 0) {
      EXPECT_EQ(t.cut_off(), 0);
    }
  }
}

TEST(RunField, OneGateIsTheStartGate) {
  const FieldParams field{9, 9, 1};
  const Ran t = run(GateParams(), field, {0, 200});
  expect_adds_up(t, field);
  EXPECT_EQ(t.final_cells(0, 4), 200);
  EXPECT_EQ(t.left_field(), 0);
  EXPECT_EQ(t.cut_off() + t.trapped(), 200);
  EXPECT_GT(t.cut_off(), 100);
  EXPECT_EQ(t.health.runs, 200);
}

TEST(RunField, FieldOfOneGateIsLeftOrKept) {
  const FieldParams field{1, 1, 13};
  const Ran t = run(GateParams(), field, {0, 200});
  expect_adds_up(t, field);
  EXPECT_EQ(t.final_cells(0, 0), 200);
  EXPECT_EQ(t.cut_off(), 0);
  EXPECT_EQ(t.left_field() + t.trapped(), 200);
  EXPECT_GT(t.left_field(), 100);
  EXPECT_EQ(t.health.runs, 200);
  // The same trials as those cut off after one gate: bodies that would go on there leave here.
  EXPECT_EQ(t.left_field(), run(GateParams(), {9, 9, 1}, {0, 200}).cut_off());
}

TEST(StreamRow, NamesAStart) {
  const GateParams p;
  const BodyState a{0, 0, 0, 15};
  EXPECT_EQ(stream_row(p, a), stream_row(p, {-0.0, -0.0, 0, 15}));
  EXPECT_NE(stream_row(p, a), stream_row(p, {4, 0, 5, 10}));
  EXPECT_NE(stream_row(p, a), stream_row(p, {0, 0, 15, 0}));
  EXPECT_LT(stream_row(p, a), std::uint64_t{1} << 56);  // the purpose stands above
}

// Second route: the trial gate by gate, with the indices and shifts of the model written out.
TEST(RunField, TrialsCanBeReplayedAlone) {
  const GateParams p;
  const FieldParams field;
  const auto method = make_method(p);
  const Ran t = run(p, field, {100, 60}, 8);
  FaceCounts entries{};
  for (int i = 0; i < 60; ++i) {
    RandomForce force(p.forces, Random(Purpose::field, {8, stream_row(p, kStart),
                                                        static_cast<std::uint64_t>(100 + i)}));
    BodyState body = kStart;
    int ix = 0, iy = 0;
    for (int gates = 1;; ++gates) {
      const GateRun r = run_gate(p, *method, body, force);
      if (r.outcome == Outcome::trapped) break;
      const int to_x =
          ix + (r.outcome == Outcome::exited_right) - (r.outcome == Outcome::exited_left);
      const int to_y = iy + is_traversed(r.outcome);
      if (std::abs(to_x) > 4 || to_y > 8 || gates == 13) break;
      const bool below = r.exit.y < 30.0;
      ++entries[is_traversed(r.outcome)             ? 0
                : r.outcome == Outcome::exited_left ? (below ? 1 : 3)
                                                    : (below ? 2 : 4)];
      body = r.exit;
      body.x -= 50.0 * (to_x - ix);
      body.y -= 60.0 * (to_y - iy);
      ix = to_x;
      iy = to_y;
    }
    EXPECT_EQ(t.each.final_gates[i], iy * 9 + ix + 4) << i;
  }
  EXPECT_EQ(t.entries, entries);
}

// Second route: gate by gate, with the hold dropped at every crossing. Lanes (moreau) round
// differently.
TEST(RunField, DrawsTheForceAnewWhenAsked) {
  for (const char* const name : {"stable", "moreau"}) {
    GateParams p;
    p.run.method = name;
    const auto method = make_method(p);
    FieldTrials each;
    each.keep_passages = true;
    (void)run_field(p, {9, 9, 4}, kStart, 8, {0, 20}, &each, nullptr, Memory::dropped);
    for (std::size_t i = 0; i < 20; ++i) {
      RandomForce force(p.forces, Random(Purpose::field, {8, stream_row(p, kStart), i}));
      BodyState body = kStart;
      for (const CellPassage passage : each.of_trial(i)) {
        const GateRun r = run_gate(p, *method, body, force);
        ASSERT_EQ(r.outcome == Outcome::trapped, passage.fate == Fate::trapped) << name << ' ' << i;
        if (r.outcome == Outcome::trapped) break;
        const Entry expected = crossing_of(p, r.outcome, r.exit);
        EXPECT_EQ(expected.face, passage.entry.face) << name << ' ' << i;
        for (std::size_t axis = 0; axis < expected.at.size(); ++axis)
          EXPECT_NEAR(expected.at[axis], passage.entry.at[axis],
                      p.run.method == "moreau" ? 1e-6 : 0.0);
        body = shifted_into_next(p, r.outcome, r.exit);
        force.drop_hold();
      }
    }
  }
}

TEST(RunField, SameTallyOnAnyNumberOfThreadsAndForAnySplit) {
  const GateParams p;
  const FieldParams field;
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] { return run(p, field, {0, 100}); });
  };
  const Ran whole = on(1);
  expect_same(on(2), whole);
  expect_same(on(8), whole);
  Ran split(field);
  for (const TrialRange part : {TrialRange{0, 1}, {1, 0}, {1, 66}, {67, 33}})
    split += run(p, field, part);
  expect_same(split, whole);
}

TEST(RunField, KeepsCrossingsWhenAsked) {
  const GateParams p;
  const FieldParams field;
  const BodyState start{0, 0, 0, 15};
  const StateSpace space = table3_space(p);
  const auto kept = [&](std::initializer_list<TrialRange> ranges) {
    FieldTrials each{.keep_passages = true};
    FieldTally tally(field);
    for (const TrialRange range : ranges)
      tally += run_field(p, field, start, 1, range, &each, &space);
    return std::pair(tally, each.entries());
  };
  EXPECT_TRUE(run(p, field, {0, 20}).each.entries().empty());
  const auto [split, in_pieces] = kept({{0, 15}, {15, 5}});
  const auto [whole, crossings] = test::on_threads(3, [&] { return kept({{0, 20}}); });
  FaceCounts entries{}, clamped{};
  for (const Entry& c : crossings) {
    ++entries[c.face];
    clamped[c.face] += space.index_of(c).clamped;
  }
  EXPECT_GT(crossings.size(), 20u);
  EXPECT_EQ(entries, whole.entries);
  EXPECT_EQ(clamped, whole.clamped);
  EXPECT_EQ(split.entries, whole.entries);
  ASSERT_EQ(in_pieces.size(), crossings.size());
  for (std::size_t i = 0; i < crossings.size(); ++i)
    EXPECT_TRUE(test::same_bits(in_pieces[i].at[kEntryVx], crossings[i].at[kEntryVx])) << i;
}

TEST(RunField, TalliesAddInAnyOrderAndNoTrialTwice) {
  const GateParams p;
  const FieldParams field;
  const StateSpace space = table3_space(p);
  const auto part = [&](TrialRange range) {
    return run_field(p, field, kStart, 1, range, nullptr, &space);
  };
  FieldTally tally = part({30, 20});
  tally += part({0, 30});
  EXPECT_EQ(tally.held, TrialSet({0, 50}));
  EXPECT_TRUE((tally.final_cells == part({0, 50}).final_cells).all());
  EXPECT_THROW(tally += part({49, 3}), std::invalid_argument);
  EXPECT_EQ(tally.trials, 50);
}

// Gates of three types. The reference is one run_gate after another, each with the parameters of
// its own gate, under one force that continues.
TEST(RunField, GatesOfSeveralTypes) {
  GateParams soft, strong, slow;
  soft.beams.stiffness_left = soft.beams.stiffness_right = 150.0;
  strong.forces.propulsion = 14.0;
  strong.forces.random = 60.0;
  strong.run.method = "event";     // each with its own method
  slow.forces.random_rate = 25.0;  // each with its own rate
  const FieldParams field{5, 6, 13};
  std::vector<int> types(30);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 5; ++column) types[row * 5 + column] = (row + 2 * column) % 3;
  const FieldGates gates = FieldGates::by_cell({soft, strong, slow}, 5, types);
  const GateParams& first = gates.at(2, 0);
  FieldTrials each{.keep_passages = true};
  (void)run_field(gates, field, kStart, 4, {0, 60}, &each);
  std::vector<Entry> crossings;
  int upward = 0, sideways = 0;
  for (std::int64_t i = 0; i < 60; ++i) {
    RandomForce force(first.forces,
                      Random(Purpose::field, {4, stream_row(first, kStart), std::uint64_t(i)}));
    BodyState body = kStart;
    int column = 2, row = 0;
    for (int visited = 1;; ++visited) {
      const GateParams& p = gates.at(column, row);
      force.enter(p.forces);
      const GateRun r = run_gate(p, *make_method(p), body, force);
      if (r.outcome == Outcome::trapped) break;
      const Entry crossing = crossing_of(p, r.outcome, r.exit);
      const Face& move = disc_section().faces[crossing.face];
      if (!field.contains(column + move.di_x, row + move.di_y) || visited == 13) break;
      crossings.push_back(crossing);
      column += move.di_x;
      row += move.di_y;
      ++(move.di_y != 0 ? upward : sideways);  // every move leads to another type
      body = shifted_into_next(p, r.outcome, r.exit);
    }
    EXPECT_EQ(each.final_gates[i], row * 5 + column) << i;
  }
  EXPECT_GT(upward, 10);
  EXPECT_GT(sideways, 10);
  EXPECT_TRUE(each.entries() == crossings);  // to the last bit
  const Ran whole = run(gates, field, {0, 60}, 4);
  // The order of the types does not matter.
  std::vector<int> others = types;
  for (int& type : others) type = (type + 1) % 3;
  expect_same(run(FieldGates::by_cell({slow, soft, strong}, 5, others), field, {0, 60}, 4), whole);
  const auto on_four = test::on_threads(4, [&] { return run(gates, field, {0, 60}, 4); });
  expect_same(on_four, whole);
  // Equal gates under several names are gates of one type.
  expect_same(run(FieldGates::by_cell({soft, soft, soft}, 5, types), field, {0, 60}, 4),
              run(soft, field, {0, 60}, 4));
  EXPECT_THROW((void)run(gates, {9, 9, 13}, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)run(gates, {5, 6, 13, Fidelity::remember}, {0, 1}), InvalidParameter);
}

TEST(RunField, OtherSeedOtherTrials) {
  EXPECT_NE(run(GateParams(), {}, {0, 100}, 1).each.final_gates,
            run(GateParams(), {}, {0, 100}, 2).each.final_gates);
}

// A mirrored start with mirrored beams: the field is symmetric, so the path without noise is, too.
TEST(RunField, QuietFieldsAreMirrorSymmetric) {
  GateParams p;
  p.forces.random = 0.0;
  p.beams.stiffness_left = 60.0;
  p.beams.stiffness_right = 90.0;
  GateParams m = p;
  std::swap(m.beams.stiffness_left, m.beams.stiffness_right);
  const FieldParams field{9, 9, 0};
  int moved_sideways = 0;
  for (const double x : {-12.0, -4.0, 3.0, 9.0, 16.0}) {
    const Ran a = run(p, field, {0, 1}, 1, {x, 0, 12, 15});
    const Ran b = run(m, field, {0, 1}, 1, {-x, 0, -12, 15});
    const int gate = a.each.final_gates[0];
    EXPECT_EQ(b.each.final_gates[0], gate / 9 * 9 + 8 - gate % 9);
    EXPECT_EQ(a.entries[1], b.entries[2]);
    EXPECT_EQ(a.entries[3], b.entries[4]);
    moved_sideways += gate % 9 != 4;
  }
  EXPECT_GT(moved_sideways, 0);
}

// Without noise all trials are equal, and a chain made of that one path walks to the same gate.
TEST(RunField, QuietTrialsAreAllAlikeAndTheChainFollowsThem) {
  GateParams p;
  p.forces.random = 0.0;
  p.beams.stiffness_left = p.beams.stiffness_right = 60.0;
  const FieldParams field;
  // Bins so fine that no two gates of a path have the same state.
  auto bins = table3_space(p).bins();
  bins[0].edges[kEntryVx] = {-30, 30};
  bins[0].edges[kEntryVy].clear();
  for (int i = 0; i <= 160; ++i) bins[0].edges[kEntryVy].push_back(0.25 * i);
  const StateSpace space(disc_section(p), bins);
  int moves = 0, followed = 0;
  for (const double x : {-17.0, -9.0, -2.0, 0.0, 6.0, 13.0, 21.0}) {
    SCOPED_TRACE(x);
    const BodyState start{x, 0, 2, 15};
    const Ran t = run(p, field, {0, 5}, 1, start);
    const int gate = t.each.final_gates[0];
    EXPECT_EQ(t.final_cells(gate / 9, gate % 9), 5);

    // The path's states, with one transition each.
    Transitions path(space);
    const auto method = make_method(p);
    RandomForce quiet(p.forces, Random(Purpose::field, {}));
    const ChainStart first = chain_start(space, field, entry_of(start));
    int state = first.start.input;
    BodyState body = start;
    bool revisited = false;
    for (int gates = 0; gates < 13; ++gates) {
      const GateRun r = run_gate(p, *method, body, quiet);
      int next = space.trapped();
      if (r.outcome != Outcome::trapped)
        next = space.index_of(crossing_of(p, r.outcome, r.exit)).state;
      if (path.trials[state] > 0 && !path.rows[state].contains(next)) revisited = true;
      ++path.rows[state][next];
      ++path.trials[state];
      if (next == space.trapped()) break;
      body = shifted_into_next(p, r.outcome, r.exit);
      state = next;
      ++moves;
    }
    if (revisited) continue;  // one state with two successors, which no chain can follow
    ++followed;
    const auto walked = markov::predict(make_chain(path), {field.columns, field.rows},
                                        {first.start}, {.max_cells = field.max_gates})
                            .front();
    EXPECT_NEAR(walked.final_cells(gate / 9, gate % 9), 1.0, 1e-12);
    EXPECT_NEAR(walked.trapped(), t.trapped() == 5, 1e-12);
    EXPECT_NEAR(walked.left_field(), t.left_field() == 5, 1e-12);
    EXPECT_NEAR(walked.cut_off(), t.cut_off() == 5, 1e-12);
  }
  EXPECT_GE(followed, 4);
  EXPECT_GE(moves, 4 * 7);
}

// ---- Fidelities

GateParams moreau(double step = 0.004) {
  GateParams p;
  p.run.method = "moreau";
  p.run.step = step;
  return p;
}

// `active` is exactly this loop, whatever else there is: a fresh gate each time, to the last bit.
TEST(Fidelity, ActiveIsGateByGate) {
  const FieldParams field;
  for (const char* name : {"stable", "paper"}) {
    SCOPED_TRACE(name);
    GateParams p;
    p.run.method = name;
    const auto method = make_method(p);
    const StateSpace space = table3_space(p);
    Ran plain(field);
    for (std::uint64_t trial = 0; trial < 60; ++trial) {
      RandomForce force(p.forces, Random(Purpose::field, {6, stream_row(p, kStart), trial}));
      BodyState body = kStart;
      int column = 4, row = 0;
      auto why = markov::Ending::trapped;  // no run breaks here
      for (int gates = 1;; ++gates) {
        const GateRun r = run_gate(p, *method, body, force);
        add_run(plain.health, p, r);
        if (r.outcome == Outcome::trapped || r.outcome == Outcome::broken) break;
        const Entry crossing = crossing_of(p, r.outcome, r.exit);
        const Face& move = disc_section().faces[crossing.face];
        const bool leaves = !field.contains(column + move.di_x, row + move.di_y);
        if (leaves)
          why = row + move.di_y > 8      ? markov::Ending::far_edge
                : column + move.di_x < 0 ? markov::Ending::left_edge
                                         : markov::Ending::right_edge;
        if (!leaves && gates == 13) why = markov::Ending::cut_off;
        if (leaves || gates == 13) break;
        ++plain.entries[crossing.face];
        plain.clamped[crossing.face] += space.index_of(crossing).clamped;
        column += move.di_x;
        row += move.di_y;
        body = shifted_into_next(p, r.outcome, r.exit);
      }
      plain.each.final_gates.push_back(row * 9 + column);
      plain.each.endings.emplace_back(why);
    }
    plain.count(plain.each.final_gates, plain.each.endings);
    expect_same(run(p, field, {0, 60}, 6), plain);
  }
}

TEST(Fidelity, TalliesAddUp) {
  const GateParams p = moreau();
  for (const Fidelity f : {Fidelity::remember, Fidelity::all})
    for (const FieldParams& field : {FieldParams{9, 9, 13, f}, FieldParams{3, 2, 0, f},
                                     FieldParams{1, 5, 0, f}, FieldParams{4, 1, 2, f}}) {
      SCOPED_TRACE(testing::Message() << field.columns << " x " << field.rows);
      const Ran t = run(p, field, {0, 60});
      expect_adds_up(t, field);
      EXPECT_EQ(t.broken(), 0);
      EXPECT_GT(t.trapped() + t.left_field(), 0);
      EXPECT_GT(t.health.impacts, 0);
    }
}

// Without neighbours there is nothing to remember, and no other gate to meet.
TEST(Fidelity, OneGateHasNoMemory) {
  GateParams p = moreau();
  p.forces.propulsion = 7.0;
  p.forces.random = 20.0;
  const auto tally = [&](Fidelity f) { return run(p, {1, 1, 0, f}, {0, 150}); };
  const Ran remember = tally(Fidelity::remember);
  expect_same(tally(Fidelity::all), remember);
  EXPECT_GT(remember.trapped(), 0);
  EXPECT_GT(remember.left_field(), 0);
  // Two implementations of one stepper: round-off may separate a few trials near grazing.
  const Ran active = tally(Fidelity::active);
  EXPECT_LE(std::abs(active.trapped() - remember.trapped()), 5);
  EXPECT_LE(std::abs(active.left_field() - remember.left_field()), 5);
}

// The three fidelities share the noise: most trials end in the same gate, unlike those of another
// seed.
TEST(Fidelity, SharesTheNoise) {
  const GateParams p = moreau();
  const auto gates = [&](Fidelity f, std::uint64_t seed) {
    return run(p, {9, 9, 13, f}, {0, 100}, seed).each.final_gates;
  };
  const auto changed = [](const auto& a, const auto& b) {
    int n = 0;
    for (std::size_t i = 0; i < a.size(); ++i) n += a[i] != b[i];
    return n;
  };
  const auto remember = gates(Fidelity::remember, 1), all = gates(Fidelity::all, 1);
  EXPECT_GT(changed(remember, all), 0);
  EXPECT_LT(changed(remember, all), 45);
  EXPECT_GT(changed(remember, gates(Fidelity::all, 2)), 75);
  const auto active = gates(Fidelity::active, 1);
  EXPECT_GT(changed(active, remember), 0);
  EXPECT_LT(changed(active, remember), 45);
}

TEST(Fidelity, SameTallyOnAnyNumberOfThreadsAndForAnySplit) {
  const GateParams p = moreau();
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    const FieldParams field{9, 9, 13, f};
    const auto on = [&](int threads) {
      return test::on_threads(threads, [&] { return run(p, field, {0, 50}); });
    };
    const Ran whole = on(1);
    expect_same(on(2), whole);
    expect_same(on(8), whole);
    Ran split(field);
    for (const TrialRange part : {TrialRange{0, 1}, {1, 32}, {33, 17}})
      split += run(p, field, part);
    expect_same(split, whole);
  }
}

TEST(Fidelity, QuietFieldsAreMirrorSymmetric) {
  GateParams p = moreau();
  p.forces.random = 0.0;
  p.beams.stiffness_left = 60.0;
  p.beams.stiffness_right = 90.0;
  GateParams m = p;
  std::swap(m.beams.stiffness_left, m.beams.stiffness_right);
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    int moved_sideways = 0;
    for (const double x : {-12.0, -4.0, 3.0, 9.0, 16.0}) {
      const Ran a = run(p, {9, 9, 0, f}, {0, 1}, 1, {x, 0, 12, 15});
      const Ran b = run(m, {9, 9, 0, f}, {0, 1}, 1, {-x, 0, -12, 15});
      const int gate = a.each.final_gates[0];
      EXPECT_EQ(b.each.final_gates[0], gate / 9 * 9 + 8 - gate % 9);
      EXPECT_EQ(a.entries[0], b.entries[0]);
      EXPECT_EQ(a.entries[1], b.entries[2]);
      EXPECT_EQ(a.entries[3], b.entries[4]);
      EXPECT_EQ(a.health.impacts, b.health.impacts);
      moved_sideways += gate % 9 != 4;
    }
    EXPECT_GT(moved_sideways, 0);
  }
}

TEST(Fidelity, NeedsMethodMoreau) {
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    GateParams p;
    try {
      (void)run(p, {9, 9, 13, f}, {0, 1});
      ADD_FAILURE() << "not refused";
    } catch (const InvalidParameter& e) {
      EXPECT_EQ(e.key(), "field.fidelity");
      const std::string what = e.what();
      const std::string named = "field.fidelity = \"" + std::string(name_of(f)) + "\"";
      EXPECT_NE(what.find(named), what.npos) << what;
      EXPECT_NE(what.find("run.method = \"stable\""), what.npos) << what;
    }
  }
  // Beams that reach over many gates would make every gate a neighbour.
  GateParams p = moreau();
  p.beams.length = 141.0;
  EXPECT_THROW(validate(p, {9, 9, 13, Fidelity::all}), InvalidParameter);
  p.beams.length = 140.0;  // 3 times 50 m, minus the radius
  EXPECT_NO_THROW(validate(p, {9, 9, 13, Fidelity::all}));
  EXPECT_NO_THROW(validate({}, FieldParams{}));
}

TEST(RunField, ScenesThatCannotBeRunAreRefused) {
  GateParams p;
  p.run.step = 0.003;
  EXPECT_THROW((void)run_field(p, {}, kStart, 1, {0, 1}), InvalidParameter);
}

// A traced trial is the one that was counted: final gate, ending, and every crossing on the way.
TEST(FieldTrace, IsTheTrialItself) {
  const GateParams p;
  const FieldParams field;
  std::map<std::optional<markov::Ending>, std::int64_t> endings;
  const Ran tally = run(p, field, {0, 40}, 3);
  for (std::int64_t i = 0; i < 40; ++i) {
    const FieldTrace t = trace_field(p, field, kStart, 3, i);
    ++endings[t.ending];
    EXPECT_EQ(t.visits.back().row * field.columns + t.visits.back().column,
              tally.each.final_gates[i]);
    for (std::size_t v = 1; v < t.visits.size(); ++v) {
      const auto &from = t.visits[v - 1], &to = t.visits[v];
      EXPECT_EQ(std::abs(from.column - to.column) + to.row - from.row, 1);
      const BodyState entry = shifted_into_next(p, from.trace.run.outcome, from.trace.run.exit);
      EXPECT_TRUE(test::same_bits(to.trace.samples.front().state.body.x, entry.x));
      EXPECT_TRUE(test::same_bits(to.trace.samples.front().state.body.vy, entry.vy));
      EXPECT_EQ(to.trace.samples.front().state.beams[kLeft].theta, 0.0);
    }
  }
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    SCOPED_TRACE(e);
    EXPECT_EQ(endings[static_cast<markov::Ending>(e)], tally.endings[e]);
  }
  EXPECT_EQ(endings[std::nullopt], tally.broken());
}

TEST(FieldTrace, OnlyTheActiveGate) {
  GateParams p;
  p.run.method = "moreau";
  p.run.step = 0.004;
  FieldParams field;
  field.fidelity = Fidelity::remember;
  EXPECT_THROW((void)trace_field(p, field, kStart, 1, 0), InvalidParameter);
}

}  // namespace
}  // namespace gatewalk::lattice
