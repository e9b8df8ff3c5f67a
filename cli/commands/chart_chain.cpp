#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>

#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/drawing.h"
#include "cli/render/matrix.h"
#include "cli/render/quantity.h"
#include "cli/render/report.h"
#include "cli/render/start.h"
#include "cli/render/states.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "markov/predict.h"

namespace gatewalk::cli {
namespace {

using markov::CellProbabilities;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::array<std::int64_t, 10> kTrialsPerRow{10,  20,   50,   100,  200,
                                                     500, 1000, 2000, 5000, 10'000};
constexpr std::array<std::int64_t, 2> kWalks{10'000, 1'000'000};
constexpr std::int64_t kMostMatrices = 8;         // per point, of different trials
constexpr std::int64_t kResampled = 8;            // per point, drawn anew from these
constexpr double kTimingSeconds = 0.5;            // work that a cost per run is measured on
constexpr std::int64_t kDirectDraws = 5'000'000;  // trials drawn per point of direct simulation

double cpu_seconds() {
  timespec now = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds that `work` takes on one thread: what else the machine does counts little.
template <class Work>
double one_thread_seconds(const Work& work) {
  tbb::task_arena one(1);
  return one.execute([&] {
    const double before = cpu_seconds();
    work();
    return cpu_seconds() - before;
  });
}

struct Error {
  double total_variation = 0.0, corrcoef = 0.0;
};

Error error_of(const CellProbabilities& p, const CellProbabilities& truth) {
  return {lattice::total_variation(p, truth), lattice::corrcoef(p, truth)};
}

CellProbabilities shares(const markov::CellCounts& counts) {
  return counts.cast<double>() / static_cast<double>(counts.sum());
}

/// Full dynamics from one start: what every error is taken against.
struct Truth {
  lattice::PaperStart start;
  lattice::FieldTally tally;
  CellProbabilities p;             // shares of the final gates
  double seconds_per_trial = 0.0;  // one thread
  Error floor;                     // what a perfect prediction would show, by the noise of `p`

  [[nodiscard]] std::string name() const {
    const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
    return "start d = " + quantity(start.d, "m") + ", v = (" + digits(start.vx / speed.size) +
           ", " + digits(start.vy / speed.size) + ") " + speed.name;
  }
  /// Direct simulation's n trials differ from these N as nN/(n + N) trials do from an exact truth,
  /// by 1/n + 1/N: told from the same noisy truth as the chain's errors are.
  [[nodiscard]] std::int64_t as_against_exact(std::int64_t trials) const {
    const auto n = static_cast<double>(trials), all = static_cast<double>(tally.trials);
    return std::max<std::int64_t>(1, std::llround(n * all / (n + all)));
  }
  /// One-thread seconds of direct simulation for as small an error; infinite if this truth cannot
  /// tell.
  [[nodiscard]] double seconds_for(double total_variation) const {
    const std::int64_t alone = lattice::trials_for(p, total_variation);
    if (alone >= tally.trials) return kInf;
    const auto n = static_cast<double>(alone), all = static_cast<double>(tally.trials);
    return seconds_per_trial * n * all / (all - n);
  }
};

/// Direct simulation with n trials, drawn from the truth; errors as_against_exact(n).
struct Direct {
  std::int64_t trials = 0;
  double seconds = 0.0;
  Error drawn;    // mean over many draws
  Error formula;  // expected_total_variation and the noise floor
};

/// A chain's answer for one start; errors are means over the point's matrices.
struct Answer {
  Error exact;
  double exact_sd = 0.0;  // of the total variation, over the matrices; NaN if there is only one
  std::array<Error, kWalks.size()> walks{};
  double exact_seconds = 0.0;
  std::array<double, kWalks.size()> walk_seconds{};
  double sampling = 0.0;       // total variation that the sampling of the matrix alone makes
  double bins = 0.0;           // what is left: states too coarse, memory beyond them
  double never_sampled = 0.0;  // share of the walks that end in a row without trials
};

/// One way to make a matrix: bins and trials per row.
struct Point {
  std::size_t curve = 0;
  std::int64_t trials = 0;     // per row
  std::int64_t runs = 0;       // of one matrix
  std::int64_t matrices = 0;   // made in this way, each from trials of its own
  double build_seconds = 0.0;  // one matrix on one thread
  double clamped_share = 0.0;
  double rows_never_sampled = 0.0;
  std::vector<Answer> answers;  // by start

  [[nodiscard]] double seconds(std::size_t start) const {
    return build_seconds + answers[start].exact_seconds;
  }
  [[nodiscard]] double error(std::size_t start) const {
    return answers[start].exact.total_variation;
  }
};

/// One space of states, and one way to start the trials of its rows.
struct Curve {
  double factor = 1.0;
  dynamics::StateSpace space;
  bool visited = false;          // charted beside a curve of uniform starts
  dynamics::Entries entries{};   // where rows start, as bodies were seen to enter; empty: uniform
  double pilot_seconds = 0.0;    // of the full trials that saw them; one thread
  double seconds_per_run = 0.0;  // one thread
  std::vector<std::int64_t> trials{};  // per row, those within the limit

  [[nodiscard]] double seconds_per_trial() const {  // one of every row, one thread
    return seconds_per_run * static_cast<double>(dynamics::runs_per_trial(space));
  }
  [[nodiscard]] const char* row_starts() const { return entries.empty() ? "uniform" : "visited"; }
  [[nodiscard]] std::string name() const {
    return "bins x " + digits(factor) + (visited ? ", visited" : "");
  }
};

struct Chart {
  std::vector<Truth> truths;
  std::vector<Curve> curves;
  std::vector<Point> points;                // by curve, then trials
  std::vector<std::vector<Direct>> direct;  // by start
  dynamics::Health health;
};

// ---- Measuring ----

/// Mean CPU seconds per item on one thread, from batches until they took kTimingSeconds or all of
/// `most` are done; `batch` items at a time. `done` gets their number.
template <class Work>
double seconds_per_item(std::int64_t most, std::int64_t batch, const Work& work,
                        std::int64_t* done = nullptr) {
  std::int64_t items = 0;
  double seconds = 0.0;
  while (items < most && seconds < kTimingSeconds) {
    if (interrupted()) throw Interrupted{};
    const std::int64_t n = std::min(batch, most - items);
    seconds += one_thread_seconds([&] { work(items, n); });
    items += n;
  }
  if (done != nullptr) *done = items;
  return seconds / static_cast<double>(items);
}

/// Begins the truth: as many trials as it takes to time one.
Truth begin_truth(const lattice::Scene& scene, const lattice::PaperStart& start,
                  std::int64_t trials, std::uint64_t seed) {
  Truth t{start, lattice::FieldTally(scene.field), {}, 0.0, {}};
  const auto space = lattice::fixed_space(scene);
  t.seconds_per_trial = seconds_per_item(trials, 10, [&](std::int64_t first, std::int64_t n) {
    t.tally += lattice::run_field(scene.gate, scene.field, start.body(), space, seed, {first, n});
  });
  return t;
}

void finish_truth(Truth& t, const lattice::Scene& scene, std::int64_t trials, std::uint64_t seed,
                  Progress& progress, double before, double each) {
  const auto space = lattice::fixed_space(scene);
  const std::int64_t done = t.tally.trials;
  run_in_batches(progress, before, each, trials - done, [&](std::int64_t first, std::int64_t n) {
    t.tally +=
        lattice::run_field(scene.gate, scene.field, t.start.body(), space, seed, {done + first, n});
  });
  if (t.tally.broken > 0)
    throw std::runtime_error(std::to_string(t.tally.broken) +
                             " trials of the full dynamics stopped "
                             "being finite numbers: they are no truth to compare with");
  t.p = shares(t.tally.final_gates);
  t.floor = {
      lattice::expected_total_variation(t.p, trials),
      lattice::noise_floor(lattice::concentration(t.tally.final_gates), t.p.size(), trials, 0)
          .corrcoef};
}

double time_gate_runs(const lattice::Scene& scene, const dynamics::StateSpace& space,
                      std::uint64_t seed, const dynamics::Entries& entries) {
  dynamics::Transitions scratch(space);
  return seconds_per_item(kTrialsPerRow.back(), 1,
                          [&](std::int64_t first, std::int64_t n) {
                            dynamics::add_trials(scratch, scene.gate, seed, {first, n}, entries);
                          }) /
         static_cast<double>(dynamics::runs_per_trial(space));
}

/// Transitions of consecutive ranges of trials, from which those of any longer range between their
/// borders are put together.
class Trials {
 public:
  /// Borders for kMostMatrices matrices, as far as they go, of every number of trials in `wanted`.
  explicit Trials(const std::vector<std::int64_t>& wanted) {
    for (const std::int64_t n : wanted)
      for (std::int64_t k = 0; k <= kMostMatrices && k * n <= wanted.back(); ++k)
        borders_.insert(k * n);
  }
  [[nodiscard]] const std::set<std::int64_t>& borders() const { return borders_; }
  void add(dynamics::Transitions part) { parts_.push_back(std::move(part)); }
  /// Matrices of `trials` each, of different trials.
  [[nodiscard]] std::vector<dynamics::Transitions> matrices(std::int64_t trials) const {
    std::vector<dynamics::Transitions> all;
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
  std::vector<dynamics::Transitions> parts_;  // between two borders each
};

double square(double x) { return x * x; }

/// All that matrices of `trials` a row say about each start.
Point point_of(const lattice::Scene& scene, const Chart& chart, std::size_t place,
               const std::vector<dynamics::Transitions>& matrices, std::int64_t trials,
               std::uint64_t seed) {
  const Curve& curve = chart.curves[place];
  const std::vector<Truth>& truths = chart.truths;
  const auto count = static_cast<std::int64_t>(matrices.size());
  const auto n = static_cast<double>(count);
  const markov::Field field{scene.field.columns, scene.field.rows};
  const int max_gates = scene.field.max_gates;
  std::vector<markov::Start> starts;
  for (const Truth& t : truths)
    starts.push_back(lattice::chain_start(curve.space, scene.field, t.start.body()).start);

  struct Said {  // by one matrix about one start
    CellProbabilities exact;
    Answer answer;
  };
  std::vector<std::vector<Said>> said(count, std::vector<Said>(truths.size()));
  double freezing_seconds = 0.0;
  const auto ask = [&](std::int64_t k) {
    std::optional<markov::Chain> chain;
    std::optional<markov::Predictor> predictor;
    const double freezing = one_thread_seconds([&] {
      chain = lattice::make_chain(matrices[k]);
      predictor.emplace(*chain);
    });
    if (k == 0) freezing_seconds = freezing;
    std::optional<markov::Walker> walker;
    const double tables = one_thread_seconds([&] { walker.emplace(*chain); });
    for (std::size_t s = 0; s < truths.size() && !interrupted(); ++s) {
      auto& [exact, a] = said[k][s];
      markov::FinalDistribution f;
      a.exact_seconds = one_thread_seconds(
          [&] { f = predictor->predict(field, starts[s], {.max_cells = max_gates}); });
      a.exact = error_of(f.final_cells, truths[s].p);
      a.never_sampled = f.unsampled;
      exact = f.final_cells;
      for (std::size_t w = 0; w < kWalks.size(); ++w) {
        markov::WalkTally walked;
        a.walk_seconds[w] =
            tables + one_thread_seconds([&] {
              walked = walker->walk(field, starts[s], max_gates, seed, {0, kWalks[w]});
            });
        a.walks[w] = error_of(shares(walked.final_cells), truths[s].p);
      }
    }
  };
  ask(0);  // alone, for its times
  tbb::parallel_for(std::int64_t{1}, count, ask);

  std::vector<std::vector<double>> moved(truths.size(), std::vector<double>(kResampled));
  tbb::parallel_for(std::int64_t{0}, kResampled, [&](std::int64_t k) {
    if (interrupted()) return;
    const std::int64_t of = k % count;
    const markov::Predictor other(
        lattice::make_chain(lattice::resampled(matrices[of], seed, static_cast<std::uint64_t>(k))));
    for (std::size_t s = 0; s < truths.size(); ++s)
      moved[s][k] = lattice::total_variation(
          other.predict(field, starts[s], {.max_cells = max_gates}).final_cells, said[of][s].exact);
  });
  if (interrupted()) throw Interrupted{};

  dynamics::Transitions::Totals total;
  Point point{place, trials, 0, count, 0.0, 0.0, 0.0, {}};
  for (const auto& t : matrices) {
    total = t.totals();
    point.clamped_share += total.clamped_share() / n;
    point.rows_never_sampled += static_cast<double>(total.empty_rows) / n;
  }
  point.runs = total.runs;
  point.build_seconds = curve.pilot_seconds +
                        curve.seconds_per_run * static_cast<double>(point.runs) + freezing_seconds;
  for (std::size_t s = 0; s < truths.size(); ++s) {
    const CellProbabilities& truth = truths[s].p;
    Answer a;
    a.exact_seconds = said[0][s].answer.exact_seconds;
    a.walk_seconds = said[0][s].answer.walk_seconds;
    CellProbabilities mean = CellProbabilities::Zero(truth.rows(), truth.cols());
    const auto add = [&](Error& sum, const Error& e) {
      sum.total_variation += e.total_variation / n;
      sum.corrcoef += e.corrcoef / n;
    };
    for (const auto& of_matrix : said) {
      mean += of_matrix[s].exact / n;
      add(a.exact, of_matrix[s].answer.exact);
      a.never_sampled += of_matrix[s].answer.never_sampled / n;
      for (std::size_t w = 0; w < kWalks.size(); ++w) add(a.walks[w], of_matrix[s].answer.walks[w]);
    }
    double squares = 0.0;
    for (const auto& of_matrix : said)
      squares += square(of_matrix[s].answer.exact.total_variation - a.exact.total_variation);
    a.exact_sd = std::sqrt(squares / (n - 1.0));  // 0/0 for one matrix
    for (const double tv : moved[s]) a.sampling += tv / static_cast<double>(kResampled);
    // Independent errors add up in squares: the matrices', the truth's, and what is not chance.
    a.bins = std::sqrt(std::max(0.0, square(lattice::total_variation(mean, truth)) -
                                         square(a.sampling) / n -
                                         square(truths[s].floor.total_variation)));
    point.answers.push_back(a);
  }
  return point;
}

/// Numbers of trials 1, 2, 5, 10, ... whose cost covers [low, high] seconds.
std::vector<Direct> direct_simulation(const Truth& truth, double low, double high,
                                      std::uint64_t seed) {
  std::vector<Direct> curve;
  const double concentration = truth.p.square().sum();
  double decade = 1.0;
  for (std::size_t i = 0;; ++i) {
    constexpr std::array<double, 3> kSteps{1, 2, 5};
    if (i > 0 && i % 3 == 0) decade *= 10.0;
    const auto trials = static_cast<std::int64_t>(kSteps[i % 3] * decade);
    const double seconds = truth.seconds_per_trial * static_cast<double>(trials);
    if (2.5 * seconds < low) continue;  // the next one is below as well
    if (interrupted()) throw Interrupted{};
    const std::int64_t n = truth.as_against_exact(trials);
    const std::int64_t draws = std::clamp<std::int64_t>(kDirectDraws / n, 10, 2000);
    std::vector<Error> errors(draws);
    tbb::parallel_for(std::int64_t{0}, draws, [&](std::int64_t k) {
      errors[k] = error_of(
          shares(lattice::sampled(truth.p, n, seed, static_cast<std::uint64_t>(k))), truth.p);
    });
    Direct d{trials,
             seconds,
             {},
             {lattice::expected_total_variation(truth.p, n),
              lattice::noise_floor(concentration, truth.p.size(), n, 0).corrcoef}};
    for (const Error& e : errors) {
      d.drawn.total_variation += e.total_variation / static_cast<double>(draws);
      d.drawn.corrcoef += e.corrcoef / static_cast<double>(draws);
    }
    curve.push_back(d);
    if (seconds >= high) return curve;
  }
}

// ---- What it comes to ----

/// For one start; points by their place in the chart. The chain is the one of uniform starts.
struct Summary {
  std::size_t best = 0;      // smallest error
  std::size_t cheapest = 0;  // cheapest within kWithin of it
  double pays_from = kInf;   // s, the first cost at which no direct simulation is as good
  double pays_until = 0.0;   // s, from here on direct simulation is better than any point
  double starts_to_pay =
      kInf;  // predictions for which `cheapest` costs less than direct simulation
  std::optional<std::size_t> best_visited;  // smallest error with rows started as bodies enter
};
constexpr double kWithin = 1.5;

Summary summary_of(const Chart& chart, std::size_t start) {
  Summary s;
  const auto& points = chart.points;
  const auto visited = [&](std::size_t i) { return chart.curves[points[i].curve].visited; };
  // The first point is of uniform starts: those curves come first.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!visited(i) && points[i].error(start) < points[s.best].error(start)) s.best = i;
    if (visited(i) &&
        (!s.best_visited || points[i].error(start) < points[*s.best_visited].error(start)))
      s.best_visited = i;
  }
  s.cheapest = s.best;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!visited(i) && points[i].error(start) <= kWithin * points[s.best].error(start) &&
        points[i].seconds(start) < points[s.cheapest].seconds(start))
      s.cheapest = i;
  const Truth& truth = chart.truths[start];
  for (const Point& p : points) {
    if (chart.curves[p.curve].visited) continue;
    const double direct = truth.seconds_for(p.error(start));
    if (direct <= p.seconds(start)) continue;
    s.pays_from = std::min(s.pays_from, p.seconds(start));
    s.pays_until = std::max(s.pays_until, direct);
  }
  const Point& p = points[s.cheapest];
  const double direct = truth.seconds_for(p.error(start)), each = p.answers[start].exact_seconds;
  if (direct > each) s.starts_to_pay = std::floor(p.build_seconds / (direct - each)) + 1.0;
  return s;
}

// ---- Giving out ----

std::string seconds_text(double s) { return fixed(s, s < 1 ? 3 : s < 100 ? 1 : 0); }

std::string csv_of(const Chart& chart) {
  std::ostringstream out;
  out << "d_m,vx_m_per_s,vy_m_per_s,answer,bins,states,row_starts,trials,gate_runs,matrices,build_"
         "s,answer_s,"
         "total_s,total_variation,total_variation_sd,corrcoef,sampling_total_variation,bins_total_"
         "variation,"
         "formula_total_variation,formula_corrcoef,truth_floor_total_variation,truth_floor_"
         "corrcoef,"
         "clamped_share,rows_never_sampled,never_sampled_share\n";
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const Truth& truth = chart.truths[s];
    const auto begin = [&](const std::string& answer) {
      for (const double x : {truth.start.d, truth.start.vx, truth.start.vy})
        out << digits(x) << ",";
      out << answer << ",";
    };
    const std::string floors =
        digits(truth.floor.total_variation) + "," + digits(truth.floor.corrcoef);
    for (const Point& p : chart.points) {
      const Answer& a = p.answers[s];
      const auto line = [&](const std::string& answer, double seconds, const Error& e, bool exact) {
        begin(answer);
        const Curve& curve = chart.curves[p.curve];
        out << digits(curve.factor) << "," << curve.space.size() << "," << curve.row_starts() << ","
            << p.trials << "," << p.runs << "," << p.matrices << "," << digits(p.build_seconds)
            << "," << digits(seconds) << "," << digits(p.build_seconds + seconds) << ","
            << digits(e.total_variation) << ","
            << (exact && p.matrices > 1 ? digits(a.exact_sd) : "") << "," << digits(e.corrcoef)
            << "," << (exact ? digits(a.sampling) + "," + digits(a.bins) : std::string(","))
            << ",,," << floors << "," << digits(p.clamped_share) << ","
            << digits(p.rows_never_sampled) << "," << digits(a.never_sampled) << "\n";
      };
      line("exact", a.exact_seconds, a.exact, true);
      for (std::size_t w = 0; w < kWalks.size(); ++w)
        line(std::to_string(kWalks[w]) + " walks", a.walk_seconds[w], a.walks[w], false);
    }
    for (const Direct& d : chart.direct[s]) {
      begin("direct simulation");
      out << ",,," << d.trials << ",,,," << digits(d.seconds) << "," << digits(d.seconds) << ","
          << digits(d.drawn.total_variation) << ",," << digits(d.drawn.corrcoef) << ",,,"
          << digits(d.formula.total_variation) << "," << digits(d.formula.corrcoef) << "," << floors
          << ",,,\n";
    }
  }
  return out.str();
}

Json to_json(const Error& e) {
  return {{"total_variation", e.total_variation}, {"corrcoef", e.corrcoef}};
}

/// Infinity, which JSON has not, as null.
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(); }

Json to_json(const Chart& chart, const Point& p) {
  const Curve& curve = chart.curves[p.curve];
  Json j{{"bins", curve.factor},
         {"states", curve.space.size()},
         {"row_starts", curve.row_starts()},
         {"trials_per_row", p.trials},
         {"gate_runs", p.runs},
         {"matrices", p.matrices},
         {"build_s", p.build_seconds},
         {"clamped_share", p.clamped_share},
         {"rows_never_sampled", p.rows_never_sampled},
         {"starts", Json::array()}};
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const Answer& a = p.answers[s];
    Json of{{"exact", to_json(a.exact)}, {"exact_s", a.exact_seconds}};
    of["exact"]["total_variation_sd"] = finite(a.exact_sd);
    for (std::size_t w = 0; w < kWalks.size(); ++w) {
      const std::string name = "walks_" + std::to_string(kWalks[w]);
      of[name] = to_json(a.walks[w]);
      of[name + "_s"] = a.walk_seconds[w];
    }
    of["sampling_total_variation"] = a.sampling;
    of["bins_total_variation"] = a.bins;
    of["never_sampled_share"] = a.never_sampled;
    j["starts"].push_back(std::move(of));
  }
  return j;
}

Json to_json(const Chart& chart, std::size_t s) {
  const Truth& t = chart.truths[s];
  const Summary summary = summary_of(chart, s);
  const auto n = static_cast<double>(t.tally.trials);
  Json j;
  j["start"] = {{"d_m", t.start.d}, {"vx_m_per_s", t.start.vx}, {"vy_m_per_s", t.start.vy}};
  j["truth"] = {{"trials", t.tally.trials},
                {"one_thread_s_per_trial", t.seconds_per_trial},
                {"floor", to_json(t.floor)},
                {"trapped", static_cast<double>(t.tally.trapped) / n},
                {"left_field", static_cast<double>(t.tally.left_field) / n},
                {"cut_off", static_cast<double>(t.tally.cut_off) / n},
                {"final_gates", grid(t.tally.final_gates)}};
  j["direct_simulation"] = Json::array();
  for (const Direct& d : chart.direct[s])
    j["direct_simulation"].push_back({{"trials", d.trials},
                                      {"seconds", d.seconds},
                                      {"drawn", to_json(d.drawn)},
                                      {"formula", to_json(d.formula)}});
  const auto place = [&](std::size_t i) {
    const Point& p = chart.points[i];
    return Json{{"bins", chart.curves[p.curve].factor},
                {"trials_per_row", p.trials},
                {"seconds", p.seconds(s)},
                {"total_variation", p.error(s)}};
  };
  j["summary"] = {{"best", place(summary.best)},
                  {"cheapest_near_best", place(summary.cheapest)},
                  {"chain_pays_from_s", finite(summary.pays_from)},
                  {"chain_pays_until_s", finite(summary.pays_until)},
                  {"starts_to_pay", finite(summary.starts_to_pay)}};
  if (summary.best_visited) j["summary"]["best_visited"] = place(*summary.best_visited);
  return j;
}

/// A paragraph for one start.
std::string words_of(const Chart& chart, std::size_t s) {
  const Truth& truth = chart.truths[s];
  const Summary summary = summary_of(chart, s);
  const auto place = [&](const Point& p) {
    return chart.curves[p.curve].name() + ", " + std::to_string(p.trials) + " trials a row, " +
           seconds_text(p.seconds(s)) + " s";
  };
  const Point &best = chart.points[summary.best], &cheapest = chart.points[summary.cheapest];
  std::string text = "The chain's best error is TV " + fixed(best.error(s), 3) + " (" +
                     place(best) + "; the truth's noise: " + fixed(truth.floor.total_variation, 3) +
                     "); ";
  text += summary.cheapest == summary.best
              ? "nothing cheaper comes within 1.5 times of it.\n"
              : "the cheapest within 1.5 times of it is TV " + fixed(cheapest.error(s), 3) + " (" +
                    place(cheapest) + ").\n";
  if (summary.pays_from == kInf) {
    text += "For one start direct simulation is better at every cost charted";
  } else {
    text += "For one start the chain is better from " + seconds_text(summary.pays_from) + " s";
    text += summary.pays_until == kInf
                ? " on, as far as this truth can tell"
                : "; from " + seconds_text(summary.pays_until) + " s (" +
                      digits(std::round(summary.pays_until / truth.seconds_per_trial)) +
                      " trials) on direct simulation is better than any matrix charted";
  }
  const double direct = truth.seconds_for(cheapest.error(s));
  if (summary.starts_to_pay == kInf)
    text += ". Its error costs direct simulation less than one prediction: it never pays.\n";
  else
    text += ". For many starts, at that cheapest point, it pays from " +
            digits(summary.starts_to_pay) + (summary.starts_to_pay == 1.0 ? " start" : " starts") +
            " on (" + seconds_text(direct) + " s of direct simulation each).\n";
  const Answer& a = best.answers[s];
  text += std::string("At its best the chain is limited by ") +
          (a.bins > a.sampling ? "its states (TV " + fixed(a.bins, 3) +
                                     " from bins and what they forget; sampling makes " +
                                     fixed(a.sampling, 3) + "): more trials would not help.\n"
                               : "the sampling of its matrix (TV " + fixed(a.sampling, 3) +
                                     "; bins and what they forget make " + fixed(a.bins, 3) +
                                     "): more trials would help.\n");
  if (summary.best_visited) {
    const Point& visited = chart.points[*summary.best_visited];
    text += "With rows started where bodies were seen to enter its best is TV " +
            fixed(visited.error(s), 3) + " (" + place(visited) +
            ", the trials that saw them included).\n";
  }
  return text;
}

std::string table_of(const Chart& chart, std::int64_t runs_limit) {
  std::ostringstream out;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const Truth& truth = chart.truths[s];
    out << (s == 0 ? "" : "\n") << "S" << truth.name().substr(1) << ": " << truth.tally.trials
        << " full trials, " << fixed(1e3 * truth.seconds_per_trial, 2)
        << " ms each; seconds, TV of the exact chain, TV of direct simulation at that cost\n";
    for (std::size_t first = 0; first < chart.curves.size(); first += 4) {  // as many fit in a line
      const std::size_t beyond = std::min(first + 4, chart.curves.size());
      const auto row = [&](const std::string& name, const auto& cell) {
        out << padded(name, 12) << " ";
        for (std::size_t c = first; c < beyond; ++c) out << "|" << padded(cell(c), -29);
        out << "\n";
      };
      const auto point = [&](std::size_t curve, std::int64_t trials) {
        return std::find_if(chart.points.begin(), chart.points.end(),
                            [&](const Point& p) { return p.curve == curve && p.trials == trials; });
      };
      out << "\n";
      row("trials/row", [&](std::size_t c) {
        const Curve& curve = chart.curves[c];
        return curve.name() + " (" + std::to_string(curve.space.size()) + ")";
      });
      for (const std::int64_t trials : kTrialsPerRow) {
        bool any = false;
        for (std::size_t c = first; c < beyond; ++c) any |= point(c, trials) != chart.points.end();
        if (any)
          row(std::to_string(trials), [&](std::size_t c) -> std::string {
            const auto at = point(c, trials);
            if (at == chart.points.end()) return "";
            const double seconds = at->seconds(s);
            const auto direct =
                std::max<std::int64_t>(1, std::llround(seconds / truth.seconds_per_trial));
            return padded(seconds_text(seconds), 8) + padded(fixed(at->error(s), 3), 10) +
                   padded(fixed(lattice::expected_total_variation(truth.p,
                                                                  truth.as_against_exact(direct)),
                                3),
                          8);
          });
      }
      for (const auto part : {&Answer::sampling, &Answer::bins})
        row(part == &Answer::sampling ? "sampling" : "bins", [&](std::size_t c) -> std::string {
          if (chart.curves[c].trials.empty()) return padded("-", 18);
          const auto last = point(c, chart.curves[c].trials.back());
          return padded(fixed(last->answers[s].*part, 3), 18);
        });
    }
    out << "\n" << words_of(chart, s);
  }
  out << "\nSampling, bins: the parts of the last line's TV that come from the matrix's trials and "
         "from its\n"
         "states. Seconds: CPU time of one thread, one matrix and one prediction. TV: against the "
         "full trials,\n"
         "whose noise both share; the chain's a mean over up to 8 matrices of different trials.\n";
  for (const Curve& c : chart.curves)
    if (c.trials.empty())
      out << c.name() << ": no point, " << c.space.size() << " rows of " << kTrialsPerRow.front()
          << " trials exceed --runs-limit " << runs_limit << ".\n";
  return out.str();
}

// ---- Figure ----

/// Coarse to fine (Okabe and Ito's colours).
constexpr std::array<const char*, 5> kColours{"#e69f00", "#d55e00", "#009e73", "#0072b2",
                                              "#cc79a7"};

void draw(const std::string& path, const Chart& chart) {
  std::ostringstream out;
  double least_seconds = kInf, most_seconds = 0.0, least_tv = kInf, least_lack = kInf;
  const auto seen = [](double& least, double x) {
    if (x > 0.0) least = std::min(least, x);
  };
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const std::string of = std::to_string(s);
    const Error& floor = chart.truths[s].floor;
    seen(least_tv, floor.total_variation);
    seen(least_lack, 1.0 - floor.corrcoef);
    for (std::size_t c = 0; c < chart.curves.size(); ++c) {
      std::string rows;
      for (const Point& p : chart.points) {
        if (p.curve != c) continue;
        const Answer& a = p.answers[s];
        rows += digits(p.seconds(s)) + " " + digits(p.error(s)) + " " +
                digits(1.0 - a.exact.corrcoef) + " " + digits(a.sampling) + "\n";
        seen(least_seconds, p.seconds(s));
        most_seconds = std::max(most_seconds, p.seconds(s));
        seen(least_tv, p.error(s));
        seen(least_lack, 1.0 - a.exact.corrcoef);
      }
      out << data_block("$chain_" + std::to_string(c) + "_" + of, rows);
    }
    std::string rows;
    for (const Direct& d : chart.direct[s])
      rows += digits(d.seconds) + " " + digits(d.drawn.total_variation) + " " +
              digits(1.0 - d.drawn.corrcoef) + "\n";
    out << data_block("$direct_" + of, rows);
  }
  // A figure with a power of ten on its axis, or it has no number there.
  least_seconds =
      std::min(0.7 * least_seconds, std::pow(10.0, std::floor(std::log10(1.4 * most_seconds))));

  const int panels = static_cast<int>(chart.truths.size());
  constexpr int kLeft = 95, kPanel = 310, kGap = 14, kPanelHeight = 300, kTop = 35, kKeyRow = 20;
  const int wide = panels > 1 ? kPanel : 2 * kPanel;
  const int width = kLeft + panels * (wide + kGap);
  const bool has_visited = chart.curves.back().visited;
  const int uniform = static_cast<int>(chart.curves.size()) / (has_visited ? 2 : 1);
  const int key_columns = width / 400;
  const int key_rows = (uniform + 3 + has_visited + key_columns - 1) / key_columns;
  const int height = kTop + 2 * kPanelHeight + kGap + 80 + kKeyRow * key_rows;
  const auto margins = [&](int left, int right, int top, int bottom) {  // pixels from the left, top
    const auto at = [&](const char* side, double share) {
      out << "set " << side << "margin at screen " << digits(share) << "\n";
    };
    at("l", static_cast<double>(left) / width);
    at("r", static_cast<double>(right) / width);
    at("t", 1.0 - static_cast<double>(top) / height);
    at("b", 1.0 - static_cast<double>(bottom) / height);
  };
  const auto colour = [&](std::size_t curve) {
    std::size_t place = 0;  // among those of uniform starts: the same bins have the same colour
    while (chart.curves[place].factor != chart.curves[curve].factor) ++place;
    return std::string(" lc rgb '") + kColours[place % kColours.size()] + "'";
  };
  const std::string kDirect = " with lines lc rgb '#000000' lw 2";
  const std::string kNoise = " with lines lc rgb '#888888' lw 1.5 dt 3";
  const std::string kChain = " with linespoints pt 7 ps 0.5 lw 2",
                    kSampling = " with lines lw 1.2 dt 2";
  const std::string kVisited = " with linespoints pt 6 ps 0.6 lw 1.2";
  const auto plot = [&](const std::vector<std::string>& items) {
    for (std::size_t i = 0; i < items.size(); ++i)
      out << (i == 0 ? "plot " : ", \\\n  ") << items[i];
    out << "\n";
  };
  out << "set multiplot\nset logscale xy\nset grid lc rgb '#dddddd' lt 1\nunset key\n"
      << "set xrange [" << digits(least_seconds) << ":" << digits(1.4 * most_seconds) << "]\n";
  for (int s = 0; s < panels; ++s) {
    const std::string of = std::to_string(s);
    const Error& floor = chart.truths[s].floor;
    const auto panel = [&](int column, double noise) {
      std::vector<std::string> items{
          digits(noise) + kNoise, "$direct_" + of + " using 1:" + std::to_string(column) + kDirect};
      for (std::size_t c = 0; c < chart.curves.size(); ++c) {
        if (chart.curves[c].trials.empty()) continue;
        const std::string data = "$chain_" + std::to_string(c) + "_" + of + " using 1:";
        const bool visited = chart.curves[c].visited;
        items.push_back(data + std::to_string(column) + (visited ? kVisited : kChain) + colour(c));
        if (column == 2 && !visited) items.push_back(data + "4" + kSampling + colour(c));
      }
      plot(items);
    };
    const int left = kLeft + s * (wide + kGap), below = kTop + kPanelHeight + kGap;
    margins(left, left + wide, kTop, kTop + kPanelHeight);
    out << "set title " << literal(chart.truths[s].name()) << " offset 0,-0.6\nunset xlabel\n"
        << "set format x ''\nset format y '" << (s == 0 ? "%g" : "") << "'\n"
        << "set yrange [" << digits(0.6 * least_tv) << ":1]\n"
        << "set ylabel '" << (s == 0 ? "total variation" : "") << "'\n";
    panel(2, floor.total_variation);
    margins(left, left + wide, below, below + kPanelHeight);
    out << "unset title\nset format x '%g'\n"
        << "set xlabel 'seconds on one thread: matrix and one prediction' font ',11'\n"
        << "set yrange [" << digits(0.6 * least_lack) << ":1]\n"
        << "set ylabel '" << (s == 0 ? "1 - corrcoef" : "") << "'\n";
    panel(3, 1.0 - floor.corrcoef);
  }
  // The key, as a panel of its own: gnuplot makes a key no wider than its panel.
  margins(kLeft, width - kGap, height - 10 - kKeyRow * key_rows, height - 5);
  out << "unset logscale\nunset grid\nunset border\nunset tics\nunset xlabel\nunset ylabel\n"
      << "set xrange [0:1]\nset yrange [0:1]\n"
      << "set key center center horizontal maxcols " << key_columns << " Left reverse samplen 3\n";
  std::vector<std::string> key{
      "NaN" + kNoise + " title " +
          literal("the truth's noise (" + std::to_string(chart.truths[0].tally.trials) +
                  " trials)"),
      "NaN" + kDirect + " title 'direct simulation'"};
  for (std::size_t c = 0; c < chart.curves.size(); ++c)
    if (!chart.curves[c].trials.empty() && !chart.curves[c].visited)
      key.push_back("NaN" + kChain + colour(c) + " title " +
                    literal("chain, " + chart.curves[c].name() + " (" +
                            std::to_string(chart.curves[c].space.size()) + " states)"));
  key.push_back("NaN" + kSampling + " lc rgb '#000000' title 'its part from sampling the matrix'");
  if (has_visited)
    key.push_back("NaN" + kVisited + " lc rgb '#000000' title 'rows started where bodies enter'");
  plot(key);
  out << "unset multiplot\n";
  draw_svg(path, width, height, out.str());
}

std::vector<double> factors_of(const Options& options) {
  if (!options.has("bins")) return {0.5, 1.0, 2.0, 4.0};
  std::vector<double> factors = options.get<std::vector<double>>("bins");
  std::sort(factors.begin(), factors.end());
  if (std::adjacent_find(factors.begin(), factors.end()) != factors.end())
    throw UsageError("--bins: the same factor twice");
  return factors;
}

constexpr std::int64_t kMostPilotTrials =
    1'000'000;  // per start; what all of them saw is in memory

}  // namespace

int run_chart_chain(const std::vector<std::string>& arguments) {
  Options options(
      "chart-chain SCENE -o DIR [options]",
      "Charts the chain's error against its cost: matrices of coarser and finer bins and of\n"
      "10 to 10000 trials a row, against the full dynamics, beside direct simulation at the\n"
      "same cost. Writes chain.csv, chain.json and chain.svg into DIR.",
      "gatewalk chart-chain scenes/field.toml -o results/chain --truth-trials 1e5");
  options.positional("scene", "scene file (TOML)", true);
  options.output_folder("folder to write to, made if missing",
                        {"chain.csv", "chain.json", "chain.svg"});
  options.add()("truth-trials",
                po::value<Count>()->default_value(Count{100'000}, "1e5")->value_name("N"),
                "trials of the full dynamics per start, against which errors are taken")(
      "runs-limit", po::value<Count>()->default_value(Count{1'000'000}, "1e6")->value_name("N"),
      "gate runs that one matrix may take")(
      "bins", po::value<std::vector<double>>()->composing()->value_name("FACTOR"),
      "bins per axis, as a multiple of those that build has without --bins (may be repeated; "
      "default: 0.5, 1, 2, 4)")(
      "visited", po::value<Count>()->value_name("N"),
      "also chart matrices whose rows start not anywhere in their bins but where N full trials per "
      "start were seen to enter; these trials count as cost. Bins that are made from what is seen "
      "always start so, "
      "by default from 2000 trials per start");
  add_starts(options);
  add_seed(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const std::vector<lattice::PaperStart> starts = starts_of(options, scene);
  lattice::require_inside(starts, scene);
  const auto bodies = lattice::entries_at(starts);
  const lattice::BinsChoice choice = lattice::usual_bins(scene);
  const bool from_pilot = choice.kind == lattice::BinsChoice::Kind::automatic;
  const dynamics::StateSpace fixed_bins = lattice::fixed_space(scene);
  if (!from_pilot) require_inside_bins(starts, scene, fixed_bins);
  const Json settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  const std::int64_t truth_trials = options.count("truth-trials", 100);
  const std::int64_t runs_limit = options.count("runs-limit");
  const std::uint64_t seed = options.seed();

  const std::int64_t pilot_trials = options.has("visited")
                                        ? options.count("visited", 1, kMostPilotTrials)
                                    : from_pilot ? lattice::kPilotTrials
                                                 : 0;

  Chart chart;
  const std::vector<double> factors = factors_of(options);
  for (const double factor : factors) {
    try {
      if (from_pilot) (void)lattice::states_for(factor);
    } catch (const std::invalid_argument& e) {
      throw UsageError("--bins " + Json(factor).dump() + ": " + e.what());
    }
  }
  const lattice::Pilot pilot =
      from_pilot ? lattice::run_pilot(scene, bodies, pilot_trials, options.seed(), options.work())
                 : lattice::Pilot{};
  chart.health += pilot.health;
  for (const double factor : factors) {
    Curve curve{factor, fixed_bins};
    if (from_pilot) {
      lattice::SeenStates made = lattice::seen_states(scene, pilot, factor);
      curve.space = std::move(made.space);
      curve.entries = std::move(made.entries);
    } else {
      curve.space = dynamics::refined(fixed_bins, factor);
    }
    for (const std::int64_t trials : kTrialsPerRow)
      if (trials * dynamics::runs_per_trial(curve.space) <= runs_limit)
        curve.trials.push_back(trials);
    chart.curves.push_back(std::move(curve));
  }
  if (pilot_trials > 0 && !from_pilot)
    for (std::size_t c = 0, uniform = chart.curves.size(); c < uniform; ++c) {
      chart.curves.push_back(chart.curves[c]);
      chart.curves.back().visited = true;
    }
  if (std::all_of(chart.curves.begin(), chart.curves.end(),
                  [](const Curve& c) { return c.trials.empty(); }))
    throw UsageError("--runs-limit " + std::to_string(runs_limit) + ": too few for " +
                     std::to_string(kTrialsPerRow.front()) + " trials a row of any of these bins");
  const std::string folder = options.text("output");
  const auto file = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  require_folder(folder);

  // Costs first, on one thread: they say how long the rest will take.
  remark(options, "measuring the cost of a trial and of a gate run");
  for (const lattice::PaperStart& start : starts)
    chart.truths.push_back(begin_truth(scene, start, truth_trials, seed));
  std::vector<dynamics::Crossing> seen;
  double pilot_seconds = 0.0;
  for (const Truth& t : chart.truths) {
    pilot_seconds += t.seconds_per_trial * static_cast<double>(pilot_trials);
    if (from_pilot) continue;
    // Trials of their own: they follow those of the truth.
    run_in_batches("pilot", pilot_trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
      const auto part = lattice::run_field(scene.gate, scene.field, t.start.body(), fixed_bins,
                                           seed, {truth_trials + first, n}, true);
      seen.insert(seen.end(), part.crossings.begin(), part.crossings.end());
      chart.health += part.health;
    });
    seen.insert(seen.end(), pilot_trials,
                {dynamics::Boundary::enter, t.start.d, t.start.vx, t.start.vy});
  }
  for (Curve& c : chart.curves)
    if (c.visited) c.entries = dynamics::entries_of(c.space, seen);
  double work = 0.0;  // ms on one thread
  for (Curve& curve : chart.curves) {
    if (curve.trials.empty()) continue;
    if (!curve.entries.empty()) curve.pilot_seconds = pilot_seconds;
    curve.seconds_per_run = time_gate_runs(scene, curve.space, seed, curve.entries);
    work += 1e3 * curve.seconds_per_trial() * static_cast<double>(curve.trials.back());
  }
  for (const Truth& t : chart.truths)
    work += 1e3 * t.seconds_per_trial * static_cast<double>(truth_trials - t.tally.trials);

  Progress progress("chart, ms of work", std::llround(work), options.talk());
  double done = 0.0;
  for (Truth& t : chart.truths) {
    const auto rest = static_cast<double>(truth_trials - t.tally.trials);
    finish_truth(t, scene, truth_trials, seed, progress, done, 1e3 * t.seconds_per_trial);
    done += 1e3 * t.seconds_per_trial * rest;
    chart.health += t.tally.health;
  }
  for (std::size_t c = 0; c < chart.curves.size(); ++c) {
    const Curve& curve = chart.curves[c];
    if (curve.trials.empty()) continue;
    Trials all(curve.trials);
    const double each = 1e3 * curve.seconds_per_trial();
    for (auto from = all.borders().begin(); std::next(from) != all.borders().end(); ++from) {
      dynamics::Transitions t(curve.space);
      const std::int64_t trials = *std::next(from) - *from;
      run_in_batches(progress, done, each, trials, [&](std::int64_t first, std::int64_t n) {
        dynamics::add_trials(t, scene.gate, seed, {*from + first, n}, curve.entries);
      });
      lattice::require_unbroken(t);
      done += each * static_cast<double>(trials);
      chart.health += t.health;
      all.add(std::move(t));
    }
    for (const std::int64_t trials : curve.trials)
      chart.points.push_back(point_of(scene, chart, c, all.matrices(trials), trials, seed));
  }
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    double low = kInf, high = 0.0;
    for (const Point& p : chart.points) {
      low = std::min(low, p.seconds(s));
      high = std::max(high, p.seconds(s));
    }
    chart.direct.push_back(direct_simulation(chart.truths[s], low, high, seed));
  }
  progress.finish();

  Json json;
  json["machine"] = machine();
  json["seconds_are"] = "CPU time of one thread";
  json["truth_trials"] = truth_trials;
  json["runs_limit"] = runs_limit;
  json["pilot_trials"] = pilot_trials;
  json["bins"] = choice.name();
  json["matrices_drawn_anew"] = kResampled;
  json["starts"] = Json::array();
  for (std::size_t s = 0; s < chart.truths.size(); ++s) json["starts"].push_back(to_json(chart, s));
  json["curves"] = Json::array();
  for (const Curve& c : chart.curves)
    json["curves"].push_back({{"bins", c.factor},
                              {"states", c.space.size()},
                              {"row_starts", c.row_starts()},
                              {"one_thread_s_per_gate_run", c.seconds_per_run},
                              {"points", c.trials.size()}});
  json["points"] = Json::array();
  for (const Point& p : chart.points) json["points"].push_back(to_json(chart, p));
  json["status"] = to_json(chart.health);
  if (!settled.is_null()) json["method"] = settled;
  json["made_by"] = manifest(options, scene);
  std::filesystem::remove(file("chain.svg"));  // an old figure shall not stand beside new numbers
  write_text_atomically(file("chain.csv"), csv_of(chart));
  write_text_atomically(file("chain.json"), text_of(json) + "\n");
  options.give_out(json, table_of(chart, runs_limit));
  draw(file("chain.svg"), chart);
  if (!chart.health.clean()) warn(complaint(chart.health));
  return exit_status(options, chart.health.clean());
}

}  // namespace gatewalk::cli
