// SPDX-License-Identifier: MIT
/// Is a wrong chain found out, and is the cause named (lattice/pool/assumptions.h)?
///   assumptions_bench HOW AMOUNT ACCURACY FIRST CHAINS SCENE [KEY=VALUE ...]
/// makes CHAINS predictions with the seeds FIRST, FIRST + 1, ..., as `predict --accuracy` does, of
/// a scene that is wrong on purpose. HOW and AMOUNT:
///   right 0    as it should be
///   mirror 0   cells count as symmetric that are not
///   states N   as `build --states N`
///   traps Q    with this probability a body that came from the side before is trapped
///   keeps Q    with this probability such a body does not go back to where it came from
///   types 0    all cells count as one type
/// Prints lines "how,amount,seed,error,own_p,wrong,mirror,states,face_before,quarters,cells".
/// error: the total variation from 100 000 trials. own_p: the p-value of the chain's own trials.
/// wrong: the assumption that is named, or none. Then the p-value of each assumption (-1: not
/// checked).
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/cells/cell.h"
#include "lattice/pool/assumptions.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/statistics/compare.h"

namespace {

using namespace gatewalk;
using namespace gatewalk::lattice;
using dynamics::Body;
using dynamics::Entry;
using dynamics::Passage;
using dynamics::Random;

/// All cells of a field as if they were of one type. What a body remembers, and where it is, stands
/// behind the coordinates of its entry, where no chain sees it.
class Hidden : public dynamics::Cell {
 public:
  enum class Memory { none, traps, keeps };
  Hidden(dynamics::CellField cells, int start_column, Memory memory, double probability)
      : cells_(std::move(cells)),
        start_column_(start_column),
        memory_(memory),
        probability_(probability) {}

  [[nodiscard]] const dynamics::Section& section() const override { return cells_.map.section; }
  [[nodiscard]] bool is_symmetric() const override { return cells_.cells.front()->is_symmetric(); }
  [[nodiscard]] bool has_to_show_itself() const override { return false; }
  void begin(Body& body) const override {
    place(body.entry, start_column_, 0, kNone);
    cell(body).begin(body);
  }
  void forget(Body& body) const override { cell(body).forget(body); }
  void fork(Body& body, const Random& random) const override { cell(body).fork(body, random); }
  [[nodiscard]] bool lays_noise() const override { return cells_.cells.front()->lays_noise(); }
  void lay_noise(Body& body, const dynamics::Point& point) const override {
    cell(body).lay_noise(body, point);
  }
  [[nodiscard]] std::uint64_t stream_of(const Entry& start) const override {
    Entry plain = start;
    place(plain, 0, 0, 0);
    return cells_.cells.front()->stream_of(plain);
  }
  [[nodiscard]] Passage pass(Body& body) const override {
    const auto& faces = section().faces;
    const int column = static_cast<int>(body.entry.at[kColumn]),
              row = static_cast<int>(body.entry.at[kRow]),
              before = static_cast<int>(body.entry.at[kBefore]), now = body.entry.face;
    Passage passage = cell(body).pass(body);
    const bool acts = body.random.uniform() < probability_ && before != kNone;
    if (passage.fate != dynamics::Fate::left) return passage;
    const int side = before == kNone ? 0 : faces[static_cast<std::size_t>(before)].di_x;
    const auto move = [&] { return faces[static_cast<std::size_t>(passage.next.face)]; };
    if (memory_ == Memory::traps && acts && side != 0) passage.fate = dynamics::Fate::trapped;
    if (memory_ == Memory::keeps && acts && side != 0 && move().di_x == -side)
      passage.next = mirrored(section(), passage.next);
    place(passage.next, column + move().di_x, row + move().di_y, now);
    body.entry = passage.next;
    return passage;
  }

 private:
  static constexpr int kNone = -1;
  static constexpr std::size_t kColumn = 5, kRow = 6, kBefore = 7;
  static void place(Entry& entry, int column, int row, int before) {
    entry.at[kColumn] = column;
    entry.at[kRow] = row;
    entry.at[kBefore] = before;
  }
  [[nodiscard]] const dynamics::Cell& cell(const Body& body) const {
    const int type = cells_.map.type_of(static_cast<int>(body.entry.at[kColumn]),
                                        static_cast<int>(body.entry.at[kRow]));
    return *cells_.cells[static_cast<std::size_t>(type)];
  }

  dynamics::CellField cells_;
  int start_column_;
  Memory memory_;
  double probability_;
};

/// The problem with all its cells hidden in one.
Problem hidden(Problem problem, Hidden::Memory memory, double probability) {
  const dynamics::CellMap map = problem.map();
  const bool symmetric = map.types.size() == 1 && map.types.front().symmetric;
  problem.cells.cells = {
      std::make_shared<Hidden>(problem.cells, problem.field.start_column(), memory, probability)};
  problem.cells.map = {map.section, {{symmetric}}, 0, {}};
  problem.types.resize(1);
  return problem;
}

struct Found {
  markov::FinalDistribution answer;
  std::optional<HausmanCheck> own;
  std::vector<AssumptionCheck> assumptions;
};

Found predicted(const Problem& problem, double accuracy, std::uint64_t seed, int most_states) {
  if (most_states == 0) {
    RunPool pool;
    PooledPrediction p =
        predict_pooled(problem, pool, {problem.start}, {.accuracy = accuracy, .seed = seed});
    return {p.starts.front().final, p.hausman_check, p.assumptions};
  }
  const TreeChain chain =
      make_tree_chain(problem, {.accuracy = {.accuracy = accuracy, .seed = seed},
                                .starts = {problem.start},
                                .most_states = most_states});
  const auto row = first_rows(chain.kernel, problem.map(), chain.pool, {&chain.pool.starts[0]},
                              problem.start_type());
  return {answers_of(chain.kernel, problem.map(), row, problem.field, seed).final.front(),
          chain.hausman_check, chain.assumptions};
}

int study(int argc, char** argv) {
  if (argc < 7) return std::fprintf(stderr, "see the comment in assumptions_bench.cpp\n"), 2;
  const std::string how = argv[1];
  const double amount = std::stod(argv[2]), accuracy = std::stod(argv[3]);
  const auto first = std::stoull(argv[4]), chains = std::stoull(argv[5]);
  Problem problem =
      problem_of(read_scene(argv[6], std::vector<std::string>(argv + 7, argv + argc)));
  problem.check = {};
  if (how == "traps") problem = hidden(problem, Hidden::Memory::traps, amount);
  if (how == "keeps") problem = hidden(problem, Hidden::Memory::keeps, amount);
  if (how == "types") problem = hidden(problem, Hidden::Memory::none, 0.0);
  constexpr std::int64_t kTrials = 100'000;
  const CellProbabilities truth = shares(
      run_field(problem.cells, problem.field, problem.start, 9001, {0, kTrials}).final_cells);
  if (how == "mirror")
    for (auto& type : problem.cells.map.types) type.symmetric = true;
  for (auto seed = first; seed < first + chains; ++seed) {
    const Found found =
        predicted(problem, accuracy, seed, how == "states" ? static_cast<int>(amount) : 0);
    const AssumptionCheck* const wrong = wrong_assumption(found.assumptions);
    std::printf("%s,%g,%llu,%.5f,%.4f,%s", how.c_str(), amount,
                static_cast<unsigned long long>(seed),
                total_variation(found.answer.final_cells, truth), found.own ? found.own->p : -1.0,
                wrong ? key_of(wrong->assumption).data() : "none");
    for (const Assumption a : kAssumptions) {
      double p = -1.0;
      for (const AssumptionCheck& check : found.assumptions)
        if (check.assumption == a) p = check.p;
      std::printf(",%.4f", p);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return study(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
