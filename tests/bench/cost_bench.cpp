// SPDX-License-Identifier: MIT
/// cost_bench STUDY ...: one measurement per process, so that the peak of memory is its own. Prints
/// lines of CSV; run.sh writes the headers.
///   size trials METHOD N THREADS | size rows FACTOR THREADS | size lattice METHOD N THREADS
///   size walks MATRIX N THREADS | size field MATRIX SIDE GATES
///       prints study,what,size,threads,seconds,peak_MiB,note
///   evaluations        evaluations of gaps and forces per trial, by method
///   registers SCENES   time of a trial by `stable` for each instruction set, and without lanes
///   lanes N            outcomes of N trials in lanes beside those of the plain methods
///   budget MATRIX      full dynamics to a total variation of 0.01 beside one exact prediction

#include <hwy/targets.h>
#include <sys/resource.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/row_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/gates/disc_field.h"
#include "lattice/scene/scene.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/statistics/compare.h"
#include "markov/markov.h"
#include "scenes.h"

namespace {

using namespace gatewalk;
using dynamics::GateParams;
using dynamics::GateTally;
using markov::Chain;

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The least time (s) of several rounds, as many as fit into about a second.
double best_seconds(const std::function<void()>& work) {
  double best = seconds(work);
  for (double spent = best; spent < 1.0;) {
    const double now = seconds(work);
    spent += now;
    best = std::min(best, now);
  }
  return best;
}

double on_threads(int threads, const std::function<void()>& work) {
  tbb::task_arena arena(threads);
  return best_seconds([&] { arena.execute(work); });
}

struct Case {
  Chain chain;
  markov::Start start;  // in the paper's field
};
Case read_case(const std::string& matrix) {
  const dynamics::Transitions t = lattice::read_matrix(matrix).transitions;
  return {
      lattice::make_chain(t),
      lattice::chain_start(t.space, bench::kField, dynamics::entry_of(bench::kFieldStart)).start};
}

dynamics::Transitions build(double bins, std::int64_t trials) {
  const GateParams p = bench::field_gate();
  dynamics::Transitions t(dynamics::refined(dynamics::table3_space(p), bins));
  dynamics::add_trials(t, p, bench::kSeed, {0, trials});
  return t;
}

lattice::FieldTally cross_field(const char* method, std::int64_t trials,
                                std::uint64_t seed = bench::kSeed) {
  const GateParams p = bench::by(bench::field_gate(), method);
  return lattice::run_field(p, bench::kField, bench::kFieldStart, seed, {0, trials});
}

void size_study(const std::vector<std::string>& a) {
  const std::string& what = a.at(0);
  std::string name = what, size, note;
  int threads = 1;
  double time = 0.0;
  if (what == "trials" || what == "lattice") {
    name += " " + a.at(1);
    size = a.at(2);
    threads = std::stoi(a.at(3));
    const std::int64_t n = std::stoll(size);
    const GateParams p = bench::by(bench::condition('A'), a.at(1));
    time = on_threads(threads, [&] {
      if (what == "lattice")
        note = std::to_string(cross_field(a.at(1).c_str(), n).health.runs) + " gate runs";
      else
        note = std::to_string(dynamics::run_gate_trials(p, {}, bench::kSeed, {0, n}).health.steps) +
               " steps";
    });
  } else if (what == "rows") {
    threads = std::stoi(a.at(2));
    time = on_threads(threads, [&] {
      const auto t = build(std::stod(a.at(1)), bench::kTrialsPerRow);
      size = std::to_string(t.space.size());
      note = std::to_string(t.totals().nonzeros) + " nonzeros";
    });
  } else if (what == "walks") {
    const Case c = read_case(a.at(1));
    size = a.at(2);
    threads = std::stoi(a.at(3));
    const markov::Walker walker(c.chain);
    time = on_threads(threads, [&] {
      const markov::WalkRange range{0, std::stoll(size)};
      note = std::to_string(walker.walk({9, 9}, c.start, 13, bench::kSeed, range).steps) + " draws";
    });
  } else if (what == "field") {
    const Case c = read_case(a.at(1));
    size = a.at(2);
    const int side = std::stoi(size), gates = std::stoi(a.at(3));
    name += gates > 0 ? " limited" : " no limit";
    const markov::Predictor predictor(c.chain);
    markov::FinalDistribution d;
    time = best_seconds([&] {
      d = predictor.predict({side, side}, {side / 2, 0, c.start.input}, {.max_cells = gates});
    });
    note = std::to_string(d.steps) + " steps, remainder " + std::to_string(d.remainder);
    // An incomplete answer would make the time meaningless.
    if (!(std::abs(d.final_cells.sum() + d.remainder - 1.0) < 1e-9))
      throw std::runtime_error("probabilities do not sum to 1");
  } else {
    throw std::invalid_argument("unknown size study " + what);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::cout << name << ',' << size << ',' << threads << ',' << time << ','
            << static_cast<double>(usage.ru_maxrss) / 1024.0 << ',' << note << '\n';
}

void evaluations() {
  constexpr std::int64_t kTrials = 2000;
  for (const char* scene : {"A", "B", "field"})
    for (const char* method : {"paper", "moreau", "stable", "event"}) {
      const GateParams gate = scene[0] == 'f' ? bench::field_gate() : bench::condition(scene[0]);
      const GateParams p = bench::by(gate, method);
      const dynamics::BodyState start =
          scene[0] == 'f' ? bench::kFieldStart : dynamics::BodyState{};
      const GateTally tally = dynamics::run_gate_trials(p, start, bench::kSeed, {0, kTrials});
      const auto per_trial = [&](std::int64_t n) { return static_cast<double>(n) / kTrials; };
      std::cout << scene << ',' << method << ',';
      if (p.run.method != "event") std::cout << p.run.step;  // event has no step
      std::cout << ',' << kTrials << ',' << per_trial(tally.health.steps) << ','
                << per_trial(tally.health.evaluations) << '\n';
    }
}

/// The outcomes as a row of cells, for lattice::compare.
markov::CellCounts outcomes(const GateTally& t) {
  markov::CellCounts counts(1, dynamics::kOutcomes);
  for (std::size_t k = 0; k < dynamics::kOutcomes; ++k)
    counts(0, static_cast<Eigen::Index>(k)) = t.counts[k];
  return counts;
}

void lanes(std::int64_t trials) {
  for (const char* name : {"stable", "moreau"})
    for (const char condition : {'A', 'B'}) {
      const GateParams p = bench::by(bench::condition(condition), name);
      const auto method = dynamics::make_method(p);
      tbb::enumerable_thread_specific<GateTally> parts;
      tbb::parallel_for(std::int64_t{0}, trials, [&](std::int64_t i) {
        parts.local().add(p, dynamics::run_gate_trial(p, *method, {}, bench::kSeed, i));
      });
      GateTally plain;
      for (const GateTally& part : parts) plain += part;
      for (const std::uint64_t seed : {bench::kSeed, bench::kSeed + 1}) {
        const GateTally in_lanes = dynamics::run_gate_trials(p, {}, seed, {0, trials});
        const auto c = lattice::compare(outcomes(in_lanes), outcomes(plain), 1000, 1);
        std::cout << condition << ',' << name << ',' << trials << ','
                  << (seed == bench::kSeed ? "same" : "other") << ',' << c.total_variation << ','
                  << c.floor_total_variation << ',' << c.floor_total_variation_95 << ','
                  << c.p_total_variation << '\n';
      }
    }
}

/// Times (s) in interleaved rounds, the least of each.
void registers(const std::string& scenes) {
  struct Subject {
    std::string name;
    GateParams p;
    dynamics::BodyState start;
  };
  std::vector<Subject> subjects = {{"A", bench::by(bench::condition('A'), "stable"), {}},
                                   {"B", bench::by(bench::condition('B'), "stable"), {}}};
  for (const char* name : {"single_gate", "field", "soft_left", "wading", "undamped", "stiff"}) {
    const lattice::Scene scene = lattice::read_scene(scenes + "/" + name + ".toml", {});
    subjects.push_back({name, scene.gate, scene.start});
  }
  // The instruction sets that exist: all, 256 bits, none (0: trials one by one).
  std::vector<std::pair<std::string, std::int64_t>> sets = {{"plain", 0}};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    sets.emplace_back(hwy::TargetName(target), target);
  constexpr int kRounds = 7;
  constexpr std::int64_t kTrials = 4000, kPlainTrials = 1000;
  std::vector<double> best(subjects.size() * sets.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < best.size(); ++i) {
      const auto& subject = subjects[i / sets.size()];
      const auto& p = subject.p;
      const auto& start = subject.start;
      const std::int64_t target = sets[i % sets.size()].second;
      double microseconds = 0.0;
      if (target == 0) {
        const auto method = dynamics::make_method(p);
        microseconds =
            1e6 / kPlainTrials * seconds([&] {
              for (std::int64_t t = 0; t < kPlainTrials; ++t)
                static_cast<void>(dynamics::run_gate_trial(p, *method, start, bench::kSeed, t));
            });
      } else {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        tbb::task_arena arena(1);
        microseconds =
            1e6 / kTrials * seconds([&] {
              arena.execute([&] {
                static_cast<void>(dynamics::run_gate_trials(p, start, bench::kSeed, {0, kTrials}));
              });
            });
      }
      best[i] = std::min(best[i], microseconds);
    }
  for (std::size_t i = 0; i < best.size(); ++i)
    std::cout << subjects[i / sets.size()].name << ',' << sets[i % sets.size()].first << ','
              << best[i] << ',' << best[i - i % sets.size()] / best[i] << '\n';
}

void budget(const std::string& matrix) {
  constexpr double kGoal = 0.01;
  const auto line = [](const char* key, double value) { std::cout << key << ',' << value << '\n'; };
  dynamics::Transitions built = build(1.0, bench::kTrialsPerRow);
  const dynamics::Transitions stored = lattice::read_matrix(matrix).transitions;
  if (built.rows != stored.rows)
    throw std::runtime_error(matrix + ": not the matrix of this scene");

  // The truth comes from separate trials.
  constexpr std::int64_t kTruth = 400'000;
  const auto truth = cross_field("moreau", kTruth, bench::kSeed + 1);
  const lattice::CellProbabilities p =
      truth.final_cells.cast<double>() / static_cast<double>(kTruth);
  const std::int64_t needed = lattice::trials_for(p, kGoal);
  line("trials_for_0.01", static_cast<double>(needed));

  const auto one_thread = [](const std::function<void()>& work) { return on_threads(1, work); };
  const double building = one_thread([] { static_cast<void>(build(1.0, bench::kTrialsPerRow)); });
  line("matrix_seconds", building);
  const auto start =
      lattice::chain_start(stored.space, bench::kField, dynamics::entry_of(bench::kFieldStart))
          .start;
  const Chain chain = lattice::make_chain(stored);
  const markov::Predictor predictor(chain);
  const double prepare = best_seconds(
      [&] { static_cast<void>(markov::Predictor(lattice::make_chain(stored)).can_go_by_rows()); });
  line("prepare_seconds", prepare);
  markov::FinalDistribution exact;
  const double predict = best_seconds([&] {
    exact = predictor.predict({9, 9}, start, {.max_cells = bench::kField.max_gates});
  });
  line("predict_seconds", predict);
  const double chain_error = lattice::total_variation(exact.final_cells, p);
  line("chain_total_variation", chain_error);
  line("truth_floor", lattice::expected_total_variation(p, kTruth));
  const std::int64_t same_error = lattice::trials_for(p, chain_error);
  line("trials_for_chains_error", static_cast<double>(same_error));
  for (const char* method : {"stable", "moreau"}) {
    lattice::FieldTally tally(bench::kField);
    const double direct = one_thread([&] { tally = cross_field(method, needed); });
    const auto key = [&](const char* what) { return std::string(method) + "_" + what; };
    const auto seen = tally.final_cells.cast<double>() / static_cast<double>(needed);
    line(key("seconds").c_str(), direct);
    line(key("total_variation").c_str(), lattice::total_variation(seen, p));
    line(key("over_predict").c_str(), direct / predict);
    line(key("over_matrix_and_predict").c_str(), direct / (building + prepare + predict));
    line(key("pays_from_starts").c_str(), std::ceil((building + prepare) / (direct - predict)));
    // For the chain's own accuracy only, direct simulation needs fewer trials.
    const double cheap = direct * static_cast<double>(same_error) / static_cast<double>(needed);
    line(key("seconds_to_chains_error").c_str(), cheap);
    line(key("pays_from_starts_at_chains_error").c_str(),
         std::ceil((building + prepare) / (cheap - predict)));
  }
}

int run(const std::vector<std::string>& a) {
  const std::string study = a.empty() ? "" : a[0];
  if (study == "size")
    size_study({a.begin() + 1, a.end()});
  else if (study == "evaluations")
    evaluations();
  else if (study == "lanes")
    lanes(std::stoll(a.at(1)));
  else if (study == "registers")
    registers(a.at(1));
  else if (study == "budget")
    budget(a.at(1));
  else
    throw std::invalid_argument("which study? size, evaluations, lanes, registers or budget");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::cerr << "cost_bench: " << e.what() << '\n';
    return 1;
  }
}
