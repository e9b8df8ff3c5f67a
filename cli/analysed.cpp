// SPDX-License-Identifier: MIT
#include "cli/analysed.h"

#include <utility>

#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/variance_shares.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// From gate runs, to which more are added until the error bar says enough.
AnalysedSubject chain_of_runs(const Options& options, Subject& s) {
  auto prediction = predict(options, s);
  const lattice::StartAnswer& answer = prediction.starts.front();
  AnalysedSubject c{.chain = lattice::analysed_chain(
                        s.problem, *s.pool, s.pool->begin(s.starts.front()), s.how.per_leaf),
                    .endings = answer.endings,
                    .status = cli::to_json(prediction.health),
                    .method = s.settled ? cli::to_json(*s.settled) : Json(),
                    .clean = status_of(options, prediction.health) == kFine,
                    .from_trials = answer.from_trials,
                    .reached = prediction.reached,
                    .gate_runs = prediction.gate_runs,
                    .states = prediction.states,
                    .seconds = prediction.seconds};
  c.of_runs = std::move(prediction);
  return c;
}

/// From a matrix of bins.
AnalysedSubject chain_of_bins(const Options& options, const Subject& s) {
  refuse(options, {"accuracy", "gate-runs"},
         "for " + s.path + ": it has bins, and keeps no gate runs that could be added to");
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto start = ready_start(options, matrices, s.problem, *s.starts.front(), s.name_of(0));
  auto prediction =
      lattice::predict(s.counted(), s.problem.field, {start}, {}, options.seed(), options.work());
  const Json status = recorded_status(*s.file);
  AnalysedSubject c{.chain = lattice::analysed_chain(s.problem, matrices, start.start),
                    .endings = prediction.starts.front().shares,
                    .status = status,
                    .method = recorded(*s.file, s.path, "method"),
                    .clean = faults_recorded(status).empty(),
                    .states = s.file->transitions.space.size(),
                    .seconds = prediction.seconds};
  c.of_bins = std::move(prediction);
  return c;
}

}  // namespace

AnalysedSubject analysed(const Options& options, Subject& s) {
  return s.pool ? chain_of_runs(options, s) : chain_of_bins(options, s);
}

lattice::ParameterEffects effects_of(const lattice::ParameterOptions& how, Subject& s,
                                     const AnalysedSubject& c, const lattice::Analysis& analysis,
                                     const dynamics::Work& work) {
  if (how.runs == 0 || s.is_recorded()) return {};
  if (analysis.is_certain()) {
    lattice::ParameterEffects none;
    none.chance = analysis.target_chance;
    return none;
  }
  if (!s.pool) return lattice::parameter_effects(s.problem, *c.chain, analysis.target, how, work);
  return lattice::parameter_effects(s.problem, *s.pool, analysis.target, how, s.how.per_leaf,
                                    s.how.most_runs - c.gate_runs, work);
}

void add_ranges(Options& options) {
  options.add_texts("over", "KEY=LOW:HIGH",
                    "a number of the scene and a range: how much of the variance of the target's "
                    "chance each of these\nmakes, all of them anywhere in their ranges alike "
                    "(Sobol's first and total indices; at most " +
                        std::to_string(lattice::kMostVaried) + ";\nmay be repeated)");
  options.add_count("over-trials", "N",
                    "full trials for that, at most, all together (default: 200000)");
}

std::optional<lattice::RangedScene> ranges_of(const Options& options, const Subject& s) {
  const auto given = options.texts("over");
  if (given.empty()) {
    if (options.has("over-trials")) throw UsageError("--over-trials: is for --over");
    return {};
  }
  if (!s.scene || s.file)
    throw UsageError("--over: is for a scene of gates, whose numbers vary; " + s.path + " is none");
  const auto numbers = static_cast<int>(given.size());
  if (numbers > lattice::kMostVaried)
    throw UsageError("--over: at most " + std::to_string(lattice::kMostVaried) +
                     " numbers can vary");
  if (options.has("over-trials"))
    (void)options.count("over-trials", lattice::least_trials_of_shares(numbers));
  lattice::RangedScene ranged(lattice::scene_text(s.path), s.path, options.overrides(), given,
                              "--over");
  for (const lattice::NumberRange& r : ranged.ranges()) {
    if (s.given && r.key.starts_with("start."))
      throw UsageError("--over " + r.key + ": varies the scene's start, and --start gives another");
    if (s.scene->gate.run.method == "auto" && r.key.starts_with("run."))
      throw UsageError("--over " + r.key +
                       ": varies what run.method = \"auto\" chooses; name a "
                       "method");
  }
  return ranged;
}

SharesAnswer shares_of(const Options& options, const std::optional<lattice::RangedScene>& ranged,
                       const Subject& s, markov::Ending target) {
  if (!ranged) return {};
  lattice::VarianceSharesOptions how{.seed = options.seed()};
  if (options.has("over-trials")) how.trials = options.count("over-trials");
  const auto problem_at = [&](const std::vector<double>& point) {
    lattice::Scene scene = ranged->at(point);
    if (s.settled) {  // the method chosen for the scene as it is
      const dynamics::RunParams& chosen = s.scene->gate.run;
      scene.gate.run.method = chosen.method;
      scene.gate.run.step = chosen.step;
      scene.gate.run.event_tolerance = chosen.event_tolerance;
    }
    lattice::Problem problem = lattice::problem_of(scene);
    if (s.given) problem.start = *s.starts.front();
    return problem;
  };
  const RangedShares shares{ranged->ranges(), target,
                            lattice::variance_shares(static_cast<int>(ranged->ranges().size()),
                                                     problem_at, target, how, options.work())};
  return {cli::to_json(shares), table_of(shares),
          status_of(options, shares.found.health, "at the points of --over ") == kFine};
}

}  // namespace gatewalk::cli
