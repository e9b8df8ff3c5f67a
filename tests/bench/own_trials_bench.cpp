// SPDX-License-Identifier: MIT
/// Are wrong chains found out by the full trials that they were made from
/// (lattice/pool/hausman_check.h)?
///   own_trials_bench FIRST CHAINS ACCURACY TRUTH SCENE [KEY=VALUE ...]
///   own_trials_bench FIRST CHAINS ACCURACY MEMORY
/// makes so many pools of trials from seed FIRST on, as `predict --accuracy` does, and of each a
/// chain as it should be and chains that are broken on purpose. TRUTH: a file with the true shares
/// of the final gates. MEMORY, 0 to 1: bodies of cells that keep turning to one side, which no
/// state shows. Prints lines "how,accuracy,trials,error,p,differs": total variation from the truth,
/// p-value and verdict.
#include <cstdio>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/cells/cell.h"
#include "lattice/pool/hausman_check.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/scene/scene_problem.h"

namespace {

using namespace gatewalk;
using namespace gatewalk::lattice;
using dynamics::CellMap;
using dynamics::Random;

/// The share of the leaves that a mild and a strong fault changes.
constexpr double kMild = 0.1, kStrong = 0.4;

/// A square cell: bodies go on, turn left or right, or are trapped. Each body prefers one side from
/// its start on.
class Handed : public dynamics::Cell {
 public:
  explicit Handed(double memory) : memory_(memory) {
    section_.faces = {{"S", 0, 1, 0, 0, "from below", {}},
                      {"R", -1, 0, 2, 0, "from the right", {}},
                      {"L", 1, 0, 1, 0, "from the left", {}}};
    section_.coordinates = {{"s", "s", "1", "place", 1.0}};
  }
  [[nodiscard]] const dynamics::Section& section() const override { return section_; }
  void begin(dynamics::Body& body) const override {
    body.carried.put<double>(body.random.uniform() < 0.5 ? memory_ : -memory_);
  }
  [[nodiscard]] dynamics::Passage pass(dynamics::Body& body) const override {
    constexpr double kTrapped = 0.1, kTurn = 0.25;
    const double turns_left = kTurn * (1.0 + body.carried.as<double>());
    const double u = body.random.uniform();
    if (u < kTrapped) return {dynamics::Fate::trapped, body.entry, {}};
    body.entry.face = u < kTrapped + turns_left ? 1 : u < kTrapped + 2.0 * kTurn ? 2 : 0;
    body.entry.at[0] = body.random.uniform();
    return {dynamics::Fate::left, body.entry, {}};
  }

 private:
  dynamics::Section section_;
  double memory_;
};

class Study {
 public:
  Study(const Problem& problem, const CellProbabilities& truth, std::uint64_t seed, double accuracy,
        const char* usual)
      : problem_(problem), truth_(truth), seed_(seed), accuracy_(accuracy) {
    (void)predict_pooled(problem, pool_, {problem.start}, {.accuracy = accuracy, .seed = seed});
    say(usual, kernel_of(problem.map(), pool_), problem.map());
  }

  void break_it() {
    const Kernel right = kernel_of(problem_.map(), pool_);
    for (const double part : {kMild, kStrong}) {
      const auto done = [&](const char* how, const auto& use) {
        say(how, changed(right, part, use), problem_.map());
      };
      done("leaves merged", [](Sources& a, Sources& b) {
        a.insert(b.begin(), b.end());
        b = a;
      });
      done("rows swapped", [](Sources& a, Sources& b) { std::swap(a, b); });
    }
    if (right.counts.size() > 1) {  // takes gates of one type for those of another
      Kernel wrong = right;
      std::swap(wrong.counts[0], wrong.counts[1]);
      say("types mislabelled", wrong, problem_.map());
    }
    CellMap mirrored = problem_.map();
    bool is_wrong = false;
    for (auto& type : mirrored.types) is_wrong = !std::exchange(type.symmetric, true) || is_wrong;
    if (is_wrong) say("a mirror that is none", kernel_of(mirrored, pool_), mirrored);
  }

 private:
  /// The leaves whose runs make a row.
  using Sources = std::set<std::size_t>;

  void say(const char* how, const Kernel& kernel, const CellMap& map) const {
    const OwnRuns& s = pool_.starts.front();
    const auto row = first_rows(kernel, map, pool_, {&s}, problem_.start_type());
    const auto chain = answers_of(kernel, map, row, problem_.field, seed_).final.front();
    const HausmanCheck own = *hausman_check({{s.full, chain}}, problem_.field, seed_);
    std::printf("%s,%g,%lld,%.5f,%.4f,%d\n", how, accuracy_, static_cast<long long>(own.trials),
                total_variation(chain.final_cells, truth_), own.p, own.differs());
  }

  /// The kernel after `use` has changed the rows of `part` of the leaves, each together with
  /// another leaf of its face.
  template <class Use>
  Kernel changed(const Kernel& right, double part, const Use& use) const {
    Kernel wrong = right;
    Random random(dynamics::Purpose::resampling, {seed_, 77, 0});
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (int leaf = 0; leaf < right.space.size(); ++leaf) {
      const auto other = static_cast<int>(random.uniform() * right.space.size());
      if (random.uniform() < part && other != leaf &&
          right.space.face(other) == right.space.face(leaf))
        pairs.emplace_back(leaf, other);
    }
    std::vector<Sources> sources(static_cast<std::size_t>(right.space.size()));
    for (std::size_t leaf = 0; leaf < sources.size(); ++leaf) sources[leaf] = {leaf};
    for (const auto& [a, b] : pairs) use(sources[a], sources[b]);
    for (markov::Counts& counts : wrong.counts) {
      std::vector<Eigen::Triplet<std::int64_t>> entries;
      for (std::size_t leaf = 0; leaf < sources.size(); ++leaf)
        for (const std::size_t source : sources[leaf])
          for (markov::Counts::InnerIterator it(counts, static_cast<Eigen::Index>(source)); it;
               ++it)
            entries.emplace_back(static_cast<int>(leaf), static_cast<int>(it.col()), it.value());
      counts.setFromTriplets(entries.begin(), entries.end());
    }
    return wrong;
  }

  const Problem& problem_;
  const CellProbabilities& truth_;
  std::uint64_t seed_;
  double accuracy_;
  RunPool pool_;
};

Problem handed(double memory) {
  Problem problem;
  problem.cells.cells = {std::make_shared<Handed>(memory)};
  problem.cells.map = {problem.cells.cells.front()->section(), {{false}}, 0, {}};
  problem.start = {0, {0.5}};
  problem.width = problem.length = 1.0;
  problem.types = {"handed"};
  return problem;
}

CellProbabilities shares_by_trials(const Problem& problem) {
  constexpr std::int64_t kTrials = 1'000'000;
  return shares(
      run_field(problem.cells, problem.field, problem.start, 9001, {0, kTrials}).final_cells);
}

CellProbabilities read_shares(const char* path, const FieldParams& field) {
  CellProbabilities p(field.rows, field.columns);
  std::ifstream in(path);
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (!(in >> p.data()[i])) throw std::runtime_error(std::string(path) + ": too few shares");
  return p;
}

int study(int argc, char** argv) {
  if (argc < 5) return std::fprintf(stderr, "see the comment in own_trials_bench.cpp\n"), 2;
  const auto first = std::stoull(argv[1]), chains = std::stoull(argv[2]);
  const double accuracy = std::stod(argv[3]);
  const bool remembers = argc == 5;
  const double memory = remembers ? std::stod(argv[4]) : 0.0;
  const Problem problem =
      remembers ? handed(memory)
                : problem_of(read_scene(argv[5], std::vector<std::string>(argv + 6, argv + argc)));
  const CellProbabilities truth =
      remembers ? shares_by_trials(problem) : read_shares(argv[4], problem.field);
  for (auto seed = first; seed < first + chains; ++seed) {
    Study one(problem, truth, seed, accuracy, memory > 0.0 ? "memory planted" : "right");
    if (!remembers) one.break_it();
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
