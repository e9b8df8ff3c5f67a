// SPDX-License-Identifier: MIT
// Chains that remember: their counts against plain ones, their predictions against the process
// itself, and the order that agents with a known memory are found to have.
#include "lattice/study/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

#include "dynamics/base/random.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/remembered.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

enum Turn : int { kTurnLeft, kAhead, kTurnRight, kBack };
constexpr std::array<std::array<int, 2>, 4> kMoves{{{0, 1}, {-1, 0}, {0, -1}, {1, 0}}};

/// A field of square cells with four faces in the order S, E, N, W: each turn to the left is the
/// next face.
CellFile square_cells(const std::string& more, const std::string& field) {
  return parse_cell_file("[cell]\nwidth_m = 0.1\nlength_m = 0.1\n" + more + R"(
[[cell.faces]]
name = "S"
odd = ["s"]
move = [0, 1]
[[cell.faces]]
name = "E"
odd = ["s"]
move = [-1, 0]
[[cell.faces]]
name = "N"
odd = ["s"]
move = [0, -1]
[[cell.faces]]
name = "W"
odd = ["s"]
move = [1, 0]
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[field]
)" + field,
                         "cell.toml");
}
int face_after(int face, int turn) {
  return (face + (turn == kBack ? 2 : turn == kTurnRight ? 3 : turn == kTurnLeft ? 1 : 0)) % 4;
}

/// The chances of left, ahead, right, back after these turns, the latest at the end, for a body
/// that enters at this place of the face.
using Law = std::function<std::array<double, 4>(const std::vector<int>& turns, double place)>;

int drawn_turn(const std::array<double, 4>& chances, Random& random) {
  const double u = random.uniform();
  int turn = 0;
  for (double sum = chances[0]; u > sum && turn < kBack;
       sum += chances[static_cast<std::size_t>(turn)])
    ++turn;
  return turn;
}

/// Bodies that turn by the law, `passages` each, and enter anywhere within `spread` of a face.
RunPool agents(const CellFile& cells, const Law& law, int bodies, int passages, std::uint64_t seed,
               double spread = 1.0) {
  RecordedRuns runs;
  runs.passages.begin(cells.map.section);
  for (std::int32_t body = 0; body < bodies; ++body) {
    Random random(Purpose::field, {seed, 7, static_cast<std::uint64_t>(body)});
    runs.bodies.push_back(std::to_string(body));
    int face = 0;
    runs.trials.push_back({{face, {}}, body, std::ssize(runs.passages), passages});
    std::vector<int> turns;
    double place = 0.0;
    for (int k = 0; k < passages; ++k) {
      const int turn = drawn_turn(law(turns, place), random);
      face = face_after(face, turn);
      turns.push_back(turn);
      place = spread * (random.uniform() - 0.5);
      runs.passages.push_back({Fate::left, 0, {face, {place}}, {}});
    }
  }
  return pool_of(std::move(runs));
}

std::array<double, 4> without_memory(const std::vector<int>&, double) {
  return {0.25, 0.4, 0.25, 0.1};
}
/// Left and right alternate, with the turn `back` turns ago.
Law alternating(std::size_t back) {
  return [back](const std::vector<int>& turns, double) -> std::array<double, 4> {
    if (turns.size() < back) return {0.3, 0.3, 0.3, 0.1};
    const int before = turns[turns.size() - back];
    if (before == kTurnLeft) return {0.1, 0.3, 0.5, 0.1};
    if (before == kTurnRight) return {0.5, 0.3, 0.1, 0.1};
    return {0.3, 0.3, 0.3, 0.1};
  };
}

const CellFile& cells() {
  static const CellFile file = square_cells("", "columns = 7\nrows = 7\nmax_gates = 12\n");
  return file;
}

Problem remembering(const Problem& plain, const RunPool& pool, int order,
                    LettersOf of = LettersOf::turns) {
  Problem problem = plain;
  problem.cells.map = with_words(
      plain.map(), words_of(letters_of(of, plain.map(), pool), pool, order, kEntriesPerLeaf).words);
  return problem;
}

TEST(Remembered, RunsKeepTheirFacesAndGetTheirTurns) {
  const RunPool pool = agents(cells(), alternating(1), 40, 60, 1);
  const Problem problem = remembering(problem_of(cells(), pool), pool, 2);
  const RunPool labelled = with_words(pool, problem.map());
  const RunPool again = without_words(labelled, problem.map().section);
  const auto& [starts, trials] = pool.scattered;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    int face = 0;
    std::vector<int> turns;
    for (std::size_t k = 0; k < trials.of_trial(i).size(); ++k) {
      const int next = trials.of_trial(i)[k].entry.face;
      for (const int turn : {kTurnLeft, kAhead, kTurnRight, kBack})
        if (face_after(face, turn) == next) turns.push_back(turn);
      face = next;
      std::string name = problem.map().section.faces[static_cast<std::size_t>(face)].name;
      for (std::size_t t = turns.size() < 2 ? 0 : turns.size() - 2; t < turns.size(); ++t)
        name += (t + 2 == turns.size() || turns.size() == 1 ? "." : "") +
                std::string(1, "lsrb"[turns[t]]);
      const int label = labelled.scattered.each.of_trial(i)[k].entry.face;
      ASSERT_EQ(problem.map().section.faces[static_cast<std::size_t>(label)].name, name);
      ASSERT_EQ(again.scattered.each.of_trial(i)[k].entry, trials.of_trial(i)[k].entry);
    }
  }
}

TEST(Remembered, RareWordsTakeTheRunsOfTheirEnds) {
  // 20 bodies with few passages: many words of two turns have fewer than 14 entries by a face.
  RunPool pool = agents(cells(), alternating(1), 20, 25, 2);
  const Problem problem = remembering(problem_of(cells(), pool), pool, 2);
  const Section& section = problem.map().section;
  const Words& words = *section.words;
  const RunPool labelled = with_words(pool, problem.map());
  const Kernel kernel = kernel_of(problem.map(), labelled, 1000);  // one leaf for each label
  // The same rows, straight from the definition, with 2000 as the least number of runs.
  const auto ends_with = [&](int word, int end) {
    const auto &w = words.word(word), &e = words.word(end);
    return e.size() <= w.size() && std::equal(e.rbegin(), e.rend(), w.rbegin());
  };
  const Kernel small = kernel_of(problem.map(), labelled, 7);
  for (const auto& [made, least] : {std::pair{&kernel, 2000}, std::pair{&small, 14}}) {
    for (int w = 0; w < words.size(); ++w)
      for (int face = 0; face < 4; ++face) {
        const auto runs_with = [&](int end, bool only) {
          std::map<std::string, std::int64_t> outcomes;
          const auto& [starts, trials] = labelled.scattered;
          for (std::size_t i = 0; i < trials.passed.size(); ++i) {
            Entry from = starts[i];
            for (const CellPassage passage : trials.of_trial(i)) {
              const int word = words.word_of(from.face);
              if (words.face_of(from.face) == face && (only ? word == end : ends_with(word, end))) {
                const Entry as{words.label(face, w), from.at};
                ++outcomes[section
                               .faces[static_cast<std::size_t>(
                                   words.next_label(0, as, words.face_of(passage.entry.face)))]
                               .name];
              }
              from = passage.entry;
            }
          }
          return outcomes;
        };
        const auto count = [](const auto& outcomes) {
          std::int64_t n = 0;
          for (const auto& [name, k] : outcomes) n += k;
          return n;
        };
        auto expected = runs_with(w, true);
        for (int end = w; count(expected) < least; end = words.shorter(end)) {
          expected = runs_with(end, false);
          if (end == 0) break;
        }
        std::map<std::string, std::int64_t> row;
        for (int state = 0; state < made->space.size(); ++state)
          if (made->space.face(state) == words.label(face, w))
            for (markov::Counts::InnerIterator it(made->counts[0], state); it; ++it)
              row[section
                      .faces[static_cast<std::size_t>(made->space.face(static_cast<int>(it.col())))]
                      .name] += it.value();
        EXPECT_EQ(row, expected)
            << section.faces[static_cast<std::size_t>(words.label(face, w))].name << ", least "
            << least;
      }
  }
}

/// Where bodies with this law end after the field's number of gates, by simulation of the law.
CellProbabilities truth(const Law& law, const FieldParams& field, int walks) {
  CellProbabilities final_gates = CellProbabilities::Zero(field.rows, field.columns);
  for (int i = 0; i < walks; ++i) {
    Random random(Purpose::field, {99, 8, static_cast<std::uint64_t>(i)});
    int face = 0, column = field.start_column(), row = 0, at_column = column, at_row = row;
    std::vector<int> turns;
    for (int k = 0; k < field.max_gates; ++k) {
      const int turn = drawn_turn(law(turns, 0.0), random);
      face = face_after(face, turn);
      turns.push_back(turn);
      at_column = column, at_row = row;
      column += kMoves[static_cast<std::size_t>(face)][0];
      row += kMoves[static_cast<std::size_t>(face)][1];
      if (column < 0 || column >= field.columns || row < 0 || row >= field.rows) break;
    }
    final_gates(at_row, at_column) += 1.0 / walks;
  }
  return final_gates;
}

TEST(Remembered, PredictsWhatTheProcessDoes) {
  const Law law = alternating(2);
  const RunPool pool = agents(cells(), law, 2000, 40, 3);
  const Problem plain = problem_of(cells(), pool);
  const CellProbabilities true_gates = truth(law, cells().field, 200'000);
  const auto distance = [&](int order) {
    const Problem problem = order == 0 ? plain : remembering(plain, pool, order);
    const RunPool runs = order == 0 ? pool : with_words(pool, problem.map());
    return total_variation(
        predict_whole(problem, runs, {std::nullopt}, kEntriesPerLeaf, 1).front().final_cells,
        true_gates);
  };
  const double none = distance(0), two = distance(2);
  EXPECT_GT(none, 0.05);
  EXPECT_LT(two, 0.025);
}

TEST(Remembered, MirrorImagesHaveMirroredWords) {
  const CellFile symmetric =
      square_cells("symmetric = true\n", "columns = 5\nrows = 5\nmax_gates = 6\n");
  const RunPool pool = agents(symmetric, alternating(1), 60, 30, 4, 0.0);
  const Problem problem = remembering(problem_of(symmetric, pool), pool, 2);
  const auto said =
      predict_whole(problem, with_words(pool, problem.map()), {Entry{}}, kEntriesPerLeaf, 1)
          .front();
  const CellProbabilities image = said.final_cells.rowwise().reverse();
  EXPECT_LT(total_variation(said.final_cells, image), 1e-9);
}

TEST(Remembered, WordsAsText) {
  const RunPool pool = agents(cells(), alternating(1), 40, 60, 1);
  const Problem plain = problem_of(cells(), pool);
  for (const LettersOf of : {LettersOf::turns, LettersOf::faces}) {
    const Section section = remembering(plain, pool, 3, of).map().section;
    const auto words = words_in(text_of(*section.words), plain.map());
    EXPECT_EQ(Words::labelled(plain.map().section, words, false), section);
    EXPECT_EQ(text_of(*words), text_of(*section.words));
  }
  EXPECT_THROW(
      (void)words_in(R"({"of":"turns","order":1,"open_sides":[4,4],"words":[]})", plain.map()),
      std::invalid_argument);
  EXPECT_THROW(
      (void)words_in(R"({"of":"steps","order":1,"open_sides":[4],"words":[]})", plain.map()),
      std::invalid_argument);
}

TEST(Remembered, TheRarestWordsAreLeftOut) {
  // 60 ways to enter: far more words of two faces than a chain has room for.
  std::string faces;
  for (int k = 0; k < 60; ++k)
    faces += "[[cell.faces]]\nname = \"F" + std::to_string(k) + "\"\nmove = [0, 1]\n";
  const CellFile many =
      parse_cell_file("[cell]\nwidth_m = 0.1\nlength_m = 0.1\nsymmetric = false\n" + faces +
                          "[[cell.coordinates]]\nname = \"s\"\nunit = \"m\"\nscale = 0.1\n"
                          "[field]\ncolumns = 3\nrows = 3\nmax_gates = 3\n",
                      "many.toml");
  RecordedRuns runs;
  runs.passages.begin(many.map.section);
  Random random(Purpose::field, {5, 9, 0});
  for (std::int32_t body = 0; body < 50; ++body) {
    runs.bodies.push_back(std::to_string(body));
    runs.trials.push_back({{0, {}}, body, std::ssize(runs.passages), 2000});
    for (int k = 0; k < 2000; ++k)  // half of them by one face
      runs.passages.push_back(
          {Fate::left,
           0,
           {random.uniform() < 0.5 ? 7 : static_cast<int>(random.below(60)), {}},
           {}});
  }
  const RunPool pool = pool_of(std::move(runs));
  const Problem plain = problem_of(many, pool);
  const ChosenWords chosen = words_of(letters_of(LettersOf::faces, plain.map(), pool), pool, 2, 7);
  EXPECT_GT(chosen.left_out, 0);
  EXPECT_LE(chosen.words->labels(), dynamics::Words::kMostLabels);
  EXPECT_GT(chosen.words->labels(), dynamics::Words::kMostLabels - 3 * 60);
  EXPECT_EQ(chosen.words->next(chosen.words->next(0, 7), 7),
            chosen.words->next(chosen.words->next(chosen.words->next(0, 7), 7), 7));
}

TEST(Letters, TurnsCountWhereACellHasThreeOpenSides) {
  // Type 0 is a corridor from S to N and back; type 1 has all four sides.
  CellMap map = cells().map;
  map.types.resize(2);
  RunPool pool;
  FieldTrials& each = pool.scattered.each;
  each.passages.begin(map.section);
  pool.scattered.starts = {{0, {}}, {0, {}}};
  each.bodies = {0, 1};
  for (const int out : {0, 2}) each.passages.push_back({Fate::left, 0, {out, {}}, {}});
  each.passed.push_back(2);
  for (const int out : {1, 0, 3}) each.passages.push_back({Fate::left, 1, {out, {}}, {}});
  each.passed.push_back(5);
  const Letters letters = letters_of(LettersOf::turns, map, pool);
  EXPECT_EQ(letters.of_passage(0, {0, {}}, 0), kNoLetter);
  EXPECT_EQ(letters.of_passage(0, {0, {}}, 2), kBack);
  EXPECT_EQ(letters.of_passage(1, {0, {}}, 1), kTurnLeft);
  EXPECT_EQ(letters.of_passage(1, {1, {}}, 0), kTurnRight);
  EXPECT_EQ(letters.of_passage(1, {0, {}}, 0), kAhead);
  // Faces count everywhere.
  EXPECT_EQ(letters_of(LettersOf::faces, map, pool).of_passage(0, {2, {}}, 0), 2);
}

TEST(Order, IsThatOfTheAgents) {
  const auto found = [&](const Law& law, LettersOf of, std::uint64_t seed) {
    const RunPool pool = agents(cells(), law, 50, 200, seed);
    const OrderStudy study = study_order(problem_of(cells(), pool), pool,
                                         {.of = of, .least = 0, .most = 3, .with_halves = false});
    return study.answer().order;
  };
  EXPECT_EQ(found(without_memory, LettersOf::turns, 11), 0);
  EXPECT_EQ(found(alternating(1), LettersOf::turns, 12), 1);
  EXPECT_EQ(found(alternating(2), LettersOf::turns, 13), 2);
  EXPECT_EQ(found(without_memory, LettersOf::states, 14), 0);
  // The turn before is the face before, once the face is known.
  EXPECT_EQ(found(alternating(1), LettersOf::faces, 15), 1);
}

TEST(Order, IsNoneWhereOnlyThePlaceMatters) {
  // Here a chain with words predicts other bodies better, because it learns from two trees.
  const Law by_place = [](const std::vector<int>&, double place) -> std::array<double, 4> {
    return {0.25 + 0.4 * place, 0.4, 0.25 - 0.4 * place, 0.1};
  };
  for (const std::uint64_t seed : {21, 22, 23}) {
    const RunPool pool = agents(cells(), by_place, 100, 60, seed);
    const OrderStudy study =
        study_order(problem_of(cells(), pool), pool, {.least = 0, .most = 3, .with_halves = false});
    EXPECT_EQ(study.answer().order, 0) << "seed " << seed;
  }
}

TEST(Order, ComparesHalvesAsCrossValidationDoes) {
  const RunPool pool = agents(cells(), alternating(1), 40, 50, 5);
  const Problem problem = problem_of(cells(), pool);
  const OrderStudy study = study_order(problem, pool, {.least = 0, .most = 1, .seed = 3});
  const CrossValidation halves = cross_validate(problem, pool, {.null_draws = {}, .seed = 3});
  EXPECT_EQ(study.orders[0].halves.p, halves.p);
  EXPECT_EQ(study.passages, 40 * 50);
  // A second body of the same seed, or another number of threads, changes nothing.
  const OrderStudy again = study_order(problem, pool, {.least = 0, .most = 1, .seed = 3});
  EXPECT_EQ(again.orders[1].likelihood, study.orders[1].likelihood);
  EXPECT_EQ(again.orders[1].interval, study.orders[1].interval);
}

/// A cell in which a body turns to the right, else to the left, with a chance that depends on its
/// three coordinates and on a number that it carries, drawn anew in each cell: by `effect` times
/// the number, and by `joint` times the number and its place. The number is a copy of a coordinate
/// if `is_copy`, else it also shifts the body's next place.
class CarryingCell : public Cell {
 public:
  CarryingCell(double effect, double joint, bool is_copy)
      : effect_(effect), joint_(joint), is_copy_(is_copy) {
    section_ = cells().map.section;
    section_.coordinates.front().scale = 0.3;
    for (const char* name : {"u", "v"})
      section_.coordinates.push_back(
          {.name = name, .key = name, .unit = "1", .words = name, .scale = 0.3});
  }
  [[nodiscard]] const Section& section() const override { return section_; }
  void begin(Body& body) const override { body.carried.put(body.random.uniform() - 0.5); }
  [[nodiscard]] std::vector<Remembered> remembered(const Body& body) const override {
    return {{.key = "grip", .value = std::exp(9.0 * body.carried.as<double>())}};
  }
  [[nodiscard]] Passage pass(Body& body) const override {
    const double grip = body.carried.as<double>(), place = body.entry.at[0];
    const double right =
        0.5 + 0.4 * place + 0.4 * body.entry.at[1] + (effect_ + joint_ * place) * grip;
    const int turn = body.random.uniform() < right ? kTurnRight : kTurnLeft;
    std::array<double, 4> next{};
    for (double& x : next) x = body.random.uniform() - 0.5;
    body.entry = {face_after(body.entry.face, turn), {0.5 * (next[0] + next[3]), next[1], next[2]}};
    body.carried.put(is_copy_ ? next[1] : next[3]);
    return {Fate::left, body.entry, {1.0}};
  }

 private:
  Section section_;
  double effect_, joint_;
  bool is_copy_;
};

TEST(Order, TellsWhetherAChainForgetsWhatBodiesCarry) {
  const auto answer = [](double effect, double joint, bool is_copy, std::uint64_t seed) {
    Problem problem;
    problem.cells = CellField::uniform(std::make_shared<CarryingCell>(effect, joint, is_copy));
    problem.field = cells().field;
    const auto bodies = remembering_bodies(problem, 400, seed);
    const RunPool seen = bodies->seen_in(problem);
    const OrderOptions how{.least = 0, .most = 1, .seed = seed, .with_halves = false};
    const OrderStudy study = study_order(problem, seen, how, {}, &*bodies);
    if (seed == 1) {  // the trials are those of bodies whose memory nobody reads
      const RunPool plain = simulated_bodies(problem, 400, seed);
      EXPECT_EQ(seen.scattered.each.passed, plain.scattered.each.passed);
      EXPECT_EQ(seen.scattered.each.passages[17].entry, plain.scattered.each.passages[17].entry);
      EXPECT_EQ(study.orders[1].likelihood, study_order(problem, plain, how).orders[1].likelihood);
      EXPECT_EQ(study.remembered->keys, std::vector<std::string>{"grip"});
    }
    EXPECT_GT(study.remembered->passages, 0);
    EXPECT_LE(study.remembered->passages, study.passages - 400);  // not the first of a trial
    return study.remembered->matters();
  };
  int found = 0, jointly = 0, alarms = 0, copies = 0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    found += answer(0.5, 0.0, false, seed);
    jointly += answer(0.0, 4.0, false, seed);
    alarms += answer(0.0, 0.0, false, seed);
    copies += answer(0.0, 0.0, true, seed);
  }
  EXPECT_GE(found, kSeeds - 1);
  EXPECT_GE(jointly, kSeeds - 1);
  EXPECT_LE(alarms, 2);  // 2.5 % of them
  EXPECT_LE(copies, 2);
}

TEST(Order, NeedsBodies) {
  const RunPool pool = agents(cells(), without_memory, 20, 10, 6);
  EXPECT_THROW((void)study_order(problem_of(cells(), pool), pool, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
