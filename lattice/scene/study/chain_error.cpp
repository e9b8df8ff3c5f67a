// SPDX-License-Identifier: MIT
#include "lattice/scene/study/chain_error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "dynamics/disc/row_trials.h"
#include "lattice/gates/disc_field.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/study/chain_answers.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::lattice {
namespace {

using dynamics::StateSpace;
using dynamics::Transitions;
using dynamics::TrialRange;
using dynamics::Work;

constexpr std::int64_t kMostMatrices = 8;         // per point, of different trials
constexpr double kTimingSeconds = 0.5;            // work on which a cost per run is measured
constexpr std::int64_t kDirectDraws = 5'000'000;  // trials drawn per point of direct simulation

// ---- Time ----

/// Mean CPU seconds per item on one thread. Runs batches of `batch` items until they took
/// kTimingSeconds, or all of `most` items are done.
template <class Run>
double seconds_per_item(const Work& work, std::int64_t most, std::int64_t batch, const Run& run) {
  const auto ms = [](double seconds) { return std::llround(1e3 * seconds); };
  std::int64_t items = 0;
  double seconds = 0.0;
  while (items < most && seconds < kTimingSeconds) {
    work.tell("timing, ms", ms(seconds), ms(kTimingSeconds));
    const std::int64_t n = std::min(batch, most - items);
    seconds += one_thread_seconds([&] { run(TrialRange{items, n}); });
    items += n;
  }
  work.tell("timing, ms", ms(kTimingSeconds), ms(kTimingSeconds));
  return seconds / static_cast<double>(items);
}

/// Work of several kinds, reported as one in proportion to each kind's time on one thread.
class TimedWork {
 public:
  TimedWork(const Work& work, double ms)
      : work_(work), total_(std::max<std::int64_t>(1, std::llround(ms))) {}

  /// Runs items that take `each` ms.
  void in_pieces(double each, std::int64_t items, const std::function<void(TrialRange)>& run) {
    const Work part{[&](std::string_view, std::int64_t done, std::int64_t) {
      tell(done_ + each * static_cast<double>(done));
    }};
    part.in_pieces("", items, run);
    done_ += each * static_cast<double>(items);
  }
  /// For short work: does not advance the report, but can be stopped.
  [[nodiscard]] Work beside() const {
    return {[this](std::string_view, std::int64_t, std::int64_t) { tell(done_); }};
  }
  void finish() const { work_.tell(kWhat, total_, total_); }

 private:
  static constexpr std::string_view kWhat = "chart, ms of work";
  void tell(double done) const {
    work_.tell(kWhat, std::min<std::int64_t>(std::llround(done), total_ - 1), total_);
  }
  const Work& work_;
  std::int64_t total_;  // ms
  double done_ = 0.0;   // ms
};

// ---- The plan ----

/// Curves with the pilot's states for each factor, or with the usual states refined.
std::vector<ChainCurve> curves_of(const Scene& scene, const std::vector<double>& factors,
                                  const Pilot* pilot) {
  const StateSpace fixed = fixed_space(scene);
  std::vector<ChainCurve> curves;
  for (const double factor : factors) {
    if (pilot == nullptr) {
      curves.push_back({factor, dynamics::refined(fixed, factor)});
      continue;
    }
    SeenStates made = seen_states(scene, *pilot, factor);
    curves.push_back({factor, std::move(made.space)});
    curves.back().entries = std::move(made.entries);
  }
  return curves;
}

// ---- Carrying it out ----

/// Starts the truths: runs as many trials as are needed to time one.
void begin_truths(ChainErrorChart& chart, const Scene& scene, const Work& work) {
  const StateSpace space = fixed_space(scene);
  for (const dynamics::Entry& start : chart.options.starts) {
    FieldTruth t{start, FieldTally(scene.field)};
    t.seconds_per_trial =
        seconds_per_item(work, chart.options.truth_trials, 10, [&](TrialRange range) {
          t.tally += run_field(scene.gate, scene.field, entry_state(scene.gate, start),
                               chart.options.seed, range, nullptr, &space);
        });
    chart.truths.push_back(std::move(t));
  }
}

/// Fills in where the rows of visited curves start, from separate trials that follow those of the
/// truth.
void see_entries(ChainErrorChart& chart, const Scene& scene, const Work& work) {
  if (std::none_of(chart.curves.begin(), chart.curves.end(),
                   [](const ChainCurve& c) { return c.visited; }))
    return;
  const StateSpace space = fixed_space(scene);
  std::vector<dynamics::Entry> seen;
  for (const dynamics::Entry& start : chart.options.starts) {
    work.in_pieces("pilot", chart.pilot_trials, [&](TrialRange range) {
      FieldTrials each{.final_gates = {}, .keep_passages = true};
      chart.health +=
          run_field(scene.gate, scene.field, entry_state(scene.gate, start), chart.options.seed,
                    {chart.options.truth_trials + range.first, range.count}, &each, &space)
              .health;
      const auto entries = each.entries();
      seen.insert(seen.end(), entries.begin(), entries.end());
    });
    seen.insert(seen.end(), chart.pilot_trials, start);
  }
  for (ChainCurve& c : chart.curves)
    if (c.visited) c.entries = dynamics::entries_of(c.space, seen);
}

void time_gate_runs(ChainErrorChart& chart, const Scene& scene, const Work& work) {
  double pilot_seconds = 0.0;
  for (const FieldTruth& t : chart.truths)
    pilot_seconds += t.seconds_per_trial * static_cast<double>(chart.pilot_trials);
  for (ChainCurve& curve : chart.curves) {
    if (curve.trials.empty()) continue;
    if (!curve.entries.empty()) curve.pilot_seconds = pilot_seconds;
    Transitions scratch(curve.space);
    curve.seconds_per_run =
        seconds_per_item(work, kChainTrials.back(), 1,
                         [&](TrialRange range) {
                           dynamics::add_trials(scratch, scene.gate, chart.options.seed, range,
                                                curve.entries);
                         }) /
        static_cast<double>(dynamics::runs_per_trial(curve.space));
  }
}

/// Milliseconds of one thread that truths and matrices still need.
double milliseconds_left(const ChainErrorChart& chart) {
  double ms = 0.0;
  for (const ChainCurve& curve : chart.curves)
    if (!curve.trials.empty())
      ms += 1e3 * curve.seconds_per_trial() * static_cast<double>(curve.trials.back());
  for (const FieldTruth& t : chart.truths)
    ms += 1e3 * t.seconds_per_trial *
          static_cast<double>(chart.options.truth_trials - t.tally.trials);
  return ms;
}

void finish_truths(ChainErrorChart& chart, const Scene& scene, TimedWork& work) {
  const StateSpace space = fixed_space(scene);
  for (FieldTruth& t : chart.truths) {
    const std::int64_t done = t.tally.trials;
    work.in_pieces(
        1e3 * t.seconds_per_trial, chart.options.truth_trials - done, [&](TrialRange range) {
          t.tally +=
              run_field(scene.gate, scene.field, entry_state(scene.gate, t.start),
                        chart.options.seed, {done + range.first, range.count}, nullptr, &space);
        });
    t = field_truth(t.start, std::move(t.tally), t.seconds_per_trial);
    chart.health += t.tally.health;
  }
}

/// Transitions of consecutive ranges of trials, which can be merged to any longer range between
/// their borders.
class Ranges {
 public:
  /// Borders of kMostMatrices matrices, as far as the trials reach, for every number of trials in
  /// `wanted`.
  explicit Ranges(const std::vector<std::int64_t>& wanted) {
    for (const std::int64_t n : wanted)
      for (std::int64_t k = 0; k <= kMostMatrices && k * n <= wanted.back(); ++k)
        borders_.insert(k * n);
  }
  [[nodiscard]] const std::set<std::int64_t>& borders() const { return borders_; }
  void add(Transitions part) { parts_.push_back(std::move(part)); }
  /// Matrices with `trials` trials each, all from different trials.
  [[nodiscard]] std::vector<Transitions> matrices(std::int64_t trials) const {
    std::vector<Transitions> all;
    auto part = parts_.begin();
    for (auto from = borders_.begin(); std::next(from) != borders_.end(); ++from, ++part) {
      if (*from % trials == 0) {
        const bool fits = *from + trials <= *borders_.rbegin();
        if (!fits || all.size() == kMostMatrices) break;
        all.emplace_back(part->space);
      }
      all.back() += *part;
    }
    return all;
  }

 private:
  std::set<std::int64_t> borders_;
  std::vector<Transitions> parts_;  // one per pair of neighbouring borders
};

void add_points(ChainErrorChart& chart, std::size_t place, const Scene& scene, TimedWork& work) {
  const ChainCurve& curve = chart.curves[place];
  if (curve.trials.empty()) return;
  Ranges all(curve.trials);
  for (auto from = all.borders().begin(); std::next(from) != all.borders().end(); ++from) {
    Transitions t(curve.space);
    work.in_pieces(1e3 * curve.seconds_per_trial(), *std::next(from) - *from,
                   [&](TrialRange range) {
                     dynamics::add_trials(t, scene.gate, chart.options.seed,
                                          {*from + range.first, range.count}, curve.entries);
                   });
    require_unbroken(t);
    chart.health += t.health;
    all.add(std::move(t));
  }
  for (const std::int64_t trials : curve.trials) {
    ChainPoint point{ask_matrices(all.matrices(trials), scene.field, chart.truths,
                                  chart.options.seed, work.beside()),
                     place, trials};
    point.build_seconds = curve.pilot_seconds +
                          curve.seconds_per_run * static_cast<double>(point.runs) +
                          point.freezing_seconds;
    chart.points.push_back(std::move(point));
  }
}

/// Predictions by trees for each accuracy, until one would take more runs than the limit.
std::vector<TreePoint> tree_points(const ChainErrorChart& chart, const Scene& scene,
                                   const FieldTruth& truth, dynamics::Health& health,
                                   const Work& work) {
  constexpr auto n = static_cast<double>(kTreePredictions);
  const Problem problem = problem_of(scene);
  std::vector<TreePoint> points;
  for (const double accuracy : kTreeAccuracies) {
    TreePoint p{};
    p.accuracy = accuracy;
    for (std::int64_t k = 0; k < kTreePredictions; ++k) {
      PooledPrediction made;
      double elapsed = 0.0;
      const double cpu = one_thread_seconds([&] {
        const dynamics::Stopwatch watch;
        RunPool pool;
        made = predict_pooled(problem, pool, {truth.start},
                              {.accuracy = accuracy,
                               .most_runs = chart.options.runs_limit,
                               .seed = chart.options.seed + static_cast<std::uint64_t>(k)},
                              work);
        elapsed = watch.seconds();
      });
      health += made.health;
      if (!made.reached) return points;
      p.seconds += cpu * made.seconds / elapsed / n;  // without the check of a sample
      p.gate_runs += static_cast<double>(made.gate_runs) / n;
      p.states += static_cast<double>(made.states) / n;
      p.error_95 += made.starts.front().error.total_variation / n;
      add_to_mean(p.error, error_of(made.starts.front().final.final_cells, truth.p), n);
    }
    points.push_back(p);
  }
  return points;
}

/// Direct simulation with 1, 2, 5, 10, ... trials, over the costs [low, high] in seconds.
std::vector<DirectSimulation> direct_simulation(const FieldTruth& truth, double low, double high,
                                                std::uint64_t seed, const Work& work) {
  std::vector<DirectSimulation> curve;
  const double concentration = truth.p.square().sum();
  double decade = 1.0;
  for (std::size_t i = 0;; ++i) {
    constexpr std::array<double, 3> kSteps{1, 2, 5};
    if (i > 0 && i % 3 == 0) decade *= 10.0;
    const auto trials = static_cast<std::int64_t>(kSteps[i % 3] * decade);
    const double seconds = truth.seconds_per_trial * static_cast<double>(trials);
    if (2.5 * seconds < low) continue;  // the next number of trials is below as well
    work.tell("direct simulation", 0, 1);
    const std::int64_t n = truth.as_against_exact(trials);
    const std::int64_t draws = std::clamp<std::int64_t>(kDirectDraws / n, 10, 2000);
    std::vector<FinalGateError> errors(draws);
    tbb::parallel_for(std::int64_t{0}, draws, [&](std::int64_t k) {
      errors[k] =
          error_of(shares(sampled(truth.p, n, seed, static_cast<std::uint64_t>(k))), truth.p);
    });
    DirectSimulation d{trials,
                       seconds,
                       {},
                       {expected_total_variation(truth.p, n),
                        noise_floor(concentration, truth.p.size(), n, 0).corrcoef}};
    for (const FinalGateError& e : errors) add_to_mean(d.drawn, e, static_cast<double>(draws));
    curve.push_back(d);
    if (seconds >= high) return curve;
  }
}

}  // namespace

bool ChainErrorPlan::empty() const {
  return std::all_of(curves.begin(), curves.end(),
                     [](const ChainCurve& c) { return c.trials.empty(); });
}

ChainErrorPlan plan_chain_error(const Scene& scene, const ChainErrorOptions& options,
                                const Work& work) {
  require_no_terrain(scene, "a chart of the chain's error");
  ChainErrorPlan plan{options, usual_bins(scene)};
  const std::vector<dynamics::BodyState> bodies = bodies_at(scene, options.starts);
  const bool from_pilot = plan.bins.kind == BinsChoice::Kind::automatic;
  plan.pilot_trials = options.visited.value_or(from_pilot ? kPilotTrials : 0);
  if (from_pilot) {
    for (const double factor : options.factors)
      (void)states_for(factor);  // throws before the pilot runs
    const Pilot pilot = run_pilot(scene, bodies, plan.pilot_trials, options.seed, work);
    plan.health = pilot.health;
    plan.curves = curves_of(scene, options.factors, &pilot);
  } else {
    plan.curves = curves_of(scene, options.factors, nullptr);
  }
  for (ChainCurve& curve : plan.curves)
    for (const std::int64_t trials : kChainTrials)
      if (trials * dynamics::runs_per_trial(curve.space) <= options.runs_limit)
        curve.trials.push_back(trials);
  if (plan.pilot_trials > 0 && !from_pilot)
    for (std::size_t c = 0; c < options.factors.size(); ++c) {
      plan.curves.push_back(plan.curves[c]);
      plan.curves.back().visited = true;
    }
  return plan;
}

ChainErrorChart chart_chain_error(const Scene& scene, ChainErrorPlan plan, const Work& work) {
  if (plan.empty())
    throw std::invalid_argument("chart_chain_error: no matrix within the limit of runs");
  ChainErrorChart chart{std::move(plan)};
  // First measures costs, which predict how long the rest will take.
  begin_truths(chart, scene, work);
  see_entries(chart, scene, work);
  time_gate_runs(chart, scene, work);

  TimedWork rest(work, milliseconds_left(chart));
  finish_truths(chart, scene, rest);
  for (std::size_t c = 0; c < chart.curves.size(); ++c) add_points(chart, c, scene, rest);
  for (const FieldTruth& truth : chart.truths)  // tree_points reports its own runs
    chart.trees.push_back(tree_points(chart, scene, truth, chart.health, work));
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const auto [low, high] = std::minmax_element(
        chart.points.begin(), chart.points.end(),
        [&](const ChainPoint& a, const ChainPoint& b) { return a.seconds(s) < b.seconds(s); });
    chart.direct.push_back(direct_simulation(chart.truths[s], low->seconds(s), high->seconds(s),
                                             chart.options.seed, rest.beside()));
  }
  rest.finish();
  return chart;
}

ChainSummary summary_of(const ChainErrorChart& chart, std::size_t start) {
  ChainSummary s;
  const auto& points = chart.points;
  const auto visited = [&](std::size_t i) { return chart.curves[points[i].curve].visited; };
  // The first point has uniform starts, because those curves come first.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!visited(i) && points[i].error(start) < points[s.best].error(start)) s.best = i;
    if (visited(i) &&
        (!s.best_visited || points[i].error(start) < points[*s.best_visited].error(start)))
      s.best_visited = i;
  }
  const FieldTruth& truth = chart.truths[start];
  s.cheapest = s.best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (visited(i)) continue;
    const double error = points[i].error(start), seconds = points[i].seconds(start);
    if (error <= kNearBest * points[s.best].error(start) &&
        seconds < points[s.cheapest].seconds(start))
      s.cheapest = i;
    const double direct = truth.seconds_for(error);
    if (direct <= seconds) continue;
    s.pays_from = std::min(s.pays_from, seconds);
    s.pays_until = std::max(s.pays_until, direct);
  }
  const ChainPoint& p = points[s.cheapest];
  const double direct = truth.seconds_for(p.error(start)), each = p.answers[start].exact_seconds;
  if (direct > each) s.starts_to_pay = std::floor(p.build_seconds / (direct - each)) + 1.0;
  return s;
}

}  // namespace gatewalk::lattice
