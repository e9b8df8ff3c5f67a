// SPDX-License-Identifier: MIT
/// One gate from rest, conditions A and B, by our methods and by general engines, on one thread.
/// Every repetition runs other trials, the same ones for all methods: same seed, same random force.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <functional>
#include <iostream>
#include <memory>
#include <string>

#include "dynamics/disc/ensemble.h"
#include "peers.h"
#include "scenes.h"

namespace {

using namespace gatewalk;
using dynamics::GateParams;
using dynamics::GateTally;
using dynamics::Outcome;
using dynamics::TrialRange;

/// Runs trials and returns how they ended; `health.steps` counts the steps.
using Trials = std::function<GateTally(const GateParams&, TrialRange)>;

GateTally ours(const GateParams& p, TrialRange range) {
  return dynamics::run_gate_trials(p, {}, bench::kSeed, range);
}

/// Runs one trial after the other: `stable` and `moreau` without lanes.
GateTally one_by_one(const GateParams& p, TrialRange range) {
  const auto method = dynamics::make_method(p);
  GateTally tally;
  for (std::int64_t i = 0; i < range.count; ++i)
    tally.add(p, dynamics::run_gate_trial(p, *method, {}, bench::kSeed, range.first + i));
  return tally;
}

using Make = std::unique_ptr<bench::Engine> (*)(const GateParams&);
GateTally engine_trials(Make make, const GateParams& p, TrialRange range) {
  GateTally tally;
  for (std::int64_t i = 0; i < range.count; ++i) {
    dynamics::RandomForce force = dynamics::gate_force(p, bench::kSeed, range.first + i);
    const auto engine = make(p);
    const auto limit = std::lround(p.run.time_limit / p.run.step);
    dynamics::GateRun run;
    dynamics::GateState state;
    while (run.watch.steps < limit && !dynamics::outside(p, state.body)) {
      state.body = engine->step(force.value());
      force.pass(p.run.step);
      ++run.watch.steps;
    }
    run.outcome = dynamics::outcome_of(p, state, run.watch);
    tally.add(p, run);
  }
  return tally;
}

void add(const std::string& name, const char* method, double step, std::int64_t batch,
         const Trials& trials) {
  for (const char condition : {'A', 'B'}) {
    GateParams p = bench::by(bench::condition(condition), method);
    p.run.step = step;
    // Repetitions share the number of the next trial.
    auto next = std::make_shared<std::int64_t>(0);
    benchmark::RegisterBenchmark(
        (name + "/" + condition).c_str(),
        [=](benchmark::State& state) {
          GateTally tally;
          for (auto _ : state)
            tally += tbb::task_arena(1).execute([&] { return trials(p, {*next, batch}); });
          *next += batch;
          const auto count = [&](const char* key, std::int64_t n) {
            state.counters[key] = static_cast<double>(n);
          };
          count("trials", tally.trials);
          count("steps", tally.health.steps);
          count("traversed", tally.traversed());
          count("exited", tally.exited());
          count("trapped", tally[Outcome::trapped]);
          count("broken", tally[Outcome::broken]);
        })
        ->Iterations(1)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double paper_step = dynamics::kPaperStep;
  const auto engine = [&](const char* name, std::int64_t batch, Make make) {
    add(name, "moreau", paper_step, batch,
        [make](const GateParams& p, TrialRange range) { return engine_trials(make, p, range); });
  };
  // Batches of about a third of a second.
  engine("Chipmunk", 200, bench::make_chipmunk);
  engine("Box2D", 100, bench::make_box2d);
  engine("ODE", 80, bench::make_ode);
  add("paper", "paper", paper_step, 2000, ours);
  add("stable", "stable", 0.02, 2000, one_by_one);
  add("stable lanes", "stable", 0.02, 8000, ours);
  add("moreau", "moreau", paper_step, 2000, one_by_one);
  add("moreau lanes", "moreau", paper_step, 10000, ours);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
