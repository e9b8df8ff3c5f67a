// SPDX-License-Identifier: MIT
#include "cli/render/chain_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <vector>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "cli/render/start.h"
#include "dynamics/disc/disc_section.h"

namespace gatewalk::cli {
namespace {

using lattice::ChainAnswer;
using lattice::ChainCurve;
using lattice::ChainErrorChart;
using lattice::ChainPoint;
using lattice::ChainSummary;
using lattice::DirectSimulation;
using lattice::FieldTruth;
using lattice::FinalGateError;
using lattice::kChainWalks;

std::string seconds_text(double s) { return fixed(s, s < 1 ? 3 : s < 100 ? 1 : 0); }

const char* row_starts(const ChainCurve& c) { return c.entries.empty() ? "uniform" : "visited"; }

// ---- Result ----

void describe(Fields& out, const FinalGateError& e) {
  out.number({"total_variation", "1", "total variation of the final gates from the truth"},
             e.total_variation);
  out.number(
      {"corrcoef", "1", "Pearson correlation of the final gates with the truth, over the gates"},
      e.corrcoef);
}

void describe(Fields& out, const ChainAnswer& a) {
  out.object({"exact", "error of the exact prediction, mean over the matrices"}, [&](Fields& f) {
    describe(f, a.exact);
    f.number({"total_variation_sd", "1",
              "standard deviation of total_variation over the matrices; null: there is only one"},
             a.exact_sd);
  });
  out.number({"exact_s", "s", "computing time of one exact prediction"}, a.exact_seconds);
  for (std::size_t w = 0; w < kChainWalks.size(); ++w) {
    const std::string name = fmt::format("walks_{}", kChainWalks[w]);
    out.object({name, fmt::format("error of {} walks, mean over the matrices", kChainWalks[w])},
               [&](Fields& f) { describe(f, a.walks[w]); });
    out.number({name + "_s", "s", "computing time of these walks"}, a.walk_seconds[w]);
  }
  out.number({"sampling_total_variation", "1",
              "part of the total variation that the sampling of the matrix alone causes"},
             a.sampling);
  out.number({"bins_total_variation", "1",
              "rest of the total variation: states are too coarse, or bodies remember more than "
              "their state"},
             a.bins);
  out.number({"never_sampled_share", "1",
              "share of walks that reach a state from which there is no gate run"},
             a.never_sampled);
}

/// The bins of a curve and of its points.
void describe_bins(Fields& out, const ChainCurve& c) {
  out.number({"bins", "1", "bins per axis, as a multiple of the usual number"}, c.factor);
  out.count({"states", "1", "states of the chain"}, c.space.size());
  out.text(
      Label(
          "row_starts",
          "where the runs of a row start: anywhere in its bin, or where bodies were seen to enter")
          .one_of({"uniform", "visited"}),
      row_starts(c));
}

void describe(Fields& out, const ChainPoint& p, const ChainErrorChart& chart) {
  describe_bins(out, chart.curves[p.curve]);
  out.count({"trials_per_row", "1", "number of gate runs from each state"}, p.trials);
  out.count({"gate_runs", "1", "number of gate runs in one matrix"}, p.runs);
  out.count({"matrices", "1", "number of matrices, each from runs of its own"}, p.matrices);
  out.number({"build_s", "s",
              "computing time to make one matrix, with the trials that saw where its rows start"},
             p.build_seconds);
  out.number({"clamped_share", "1",
              "share of crossings that lie outside all bins, mean over the matrices"},
             p.clamped_share);
  out.number({"rows_never_sampled", "1", "number of rows without a run, mean over the matrices"},
             p.rows_never_sampled);
  out.list({"starts", "one for each start"}, p.answers,
           [](Fields& f, const ChainAnswer& a) { describe(f, a); });
}

void describe(Fields& out, const ChainSummary& summary, const ChainErrorChart& chart,
              std::size_t s) {
  const auto place = [&](const Label& label, std::size_t i) {
    const ChainPoint& p = chart.points[i];
    out.object(label, [&](Fields& f) {
      f.number({"bins", "1", "bins per axis, as a multiple of the usual number"},
               chart.curves[p.curve].factor);
      f.count({"trials_per_row", "1", "number of gate runs from each state"}, p.trials);
      f.number({"seconds", "s", "computing time of one matrix and one prediction"}, p.seconds(s));
      f.number({"total_variation", "1", "total variation of the exact prediction from the truth"},
               p.error(s));
    });
  };
  place({"best", "point with the smallest error, of all curves but those of best_visited"},
        summary.best);
  place({"cheapest_near_best", "cheapest point with an error within 1.5 times that of best"},
        summary.cheapest);
  out.number({"chain_pays_from_s", "s",
              "shortest time of a point that has a smaller error than direct simulation in this "
              "time; null: none"},
             summary.pays_from);
  out.number({"chain_pays_until_s", "s",
              "time from which on direct simulation beats all points; 0: always; null: longer than "
              "this truth can tell"},
             summary.pays_until);
  out.number({"starts_to_pay", "1",
              "number of starts from which on cheapest_near_best takes less time than direct "
              "simulation; null: never"},
             summary.starts_to_pay);
  out.optional(summary.best_visited.has_value(), [&](Fields&) {
    place(
        {"best_visited",
         "point with the smallest error of those whose rows start where bodies were seen to enter"},
        summary.best_visited.value_or(summary.best));
  });
}

void describe_start_of(Fields& out, const ChainErrorChart& chart, std::size_t s) {
  const FieldTruth& t = chart.truths[s];
  describe_start(out, dynamics::disc_section(), t.start);
  out.object(
      {"truth", "trials of the full dynamics, from which errors are measured"}, [&](Fields& f) {
        f.count({"trials", "1", "trials of the full dynamics"}, t.tally.trials);
        f.number({"one_thread_s_per_trial", "s", "computing time of a trial on one thread"},
                 t.seconds_per_trial);
        f.object(
            {"floor",
             "error that a perfect prediction would show, from the sampling noise of these trials"},
            [&](Fields& floor) { describe(floor, t.floor); });
        describe_fates(f, t.tally);
        f.grid({"final_gates", "1", "number of trials by the gate in which they end"},
               t.tally.final_cells);
      });
  out.list({"direct_simulation", "error of direct simulation with fewer trials than the truth"},
           chart.direct[s], [](Fields& f, const DirectSimulation& d) {
             f.count({"trials", "1", "trials of the full dynamics"}, d.trials);
             f.number({"seconds", "s", "computing time of these trials on one thread"}, d.seconds);
             f.object(
                 {"drawn", "mean error of many samples of as many trials, drawn from the truth"},
                 [&](Fields& drawn) { describe(drawn, d.drawn); });
             f.object({"formula", "error of as many trials, expected by formula"},
                      [&](Fields& formula) { describe(formula, d.formula); });
           });
  out.list(
      {"trees",
       "predictions by trees for each accuracy that was asked for, means over predictions"},
      chart.trees[s], [](Fields& f, const lattice::TreePoint& p) {
        describe(f, p.error);
        f.number({"accuracy", "1", "total variation of the final gates that was asked for"},
                 p.accuracy);
        f.number({"error_95", "1", "mean of the predictions' own error_95"}, p.error_95);
        f.count({"predictions", "1", "number of predictions, each from trials of its own"},
                lattice::kTreePredictions);
        f.number({"gate_runs", "1", "mean number of gate runs of a prediction"}, p.gate_runs);
        f.number({"states", "1", "states of the chain"}, p.states);
        f.number({"seconds", "s", "mean computing time of a prediction on one thread"}, p.seconds);
      });
  out.object(
      {"summary", "the best points, and when the chain takes less time than direct simulation"},
      [&](Fields& f) { describe(f, summary_of(chart, s), chart, s); });
}

// ---- Table ----

/// Up to which accuracy the chain is cheaper than direct simulation, for one start and for many.
std::string when_it_pays(const ChainErrorChart& chart, const ChainSummary& summary, std::size_t s) {
  const FieldTruth& truth = chart.truths[s];
  std::string text = "For one start ";
  if (summary.pays_from == ChainSummary::kNever)
    text += "direct simulation beats bins at every cost charted.";
  else if (summary.pays_until == ChainSummary::kNever)
    text += fmt::format("bins beat direct simulation from {} s on, as far as this truth can tell.",
                        seconds_text(summary.pays_from));
  else
    text += fmt::format(
        "bins beat direct simulation from {} s to {} s ({} trials); beyond, direct simulation "
        "beats "
        "every matrix.",
        seconds_text(summary.pays_from), seconds_text(summary.pays_until),
        digits(std::round(summary.pays_until / truth.seconds_per_trial)));
  if (summary.starts_to_pay == ChainSummary::kNever)
    return wrapped(text +
                   " Bins never pay for many starts either: direct simulation costs less "
                   "than one prediction.");
  const double direct = truth.seconds_for(chart.points[summary.cheapest].error(s));
  return wrapped(fmt::format(
      "{} The cheapest matrix pays from {} on, as direct simulation takes {} s for each.", text,
      counted(std::llround(summary.starts_to_pay), "start", "starts"), seconds_text(direct)));
}

/// The error of direct simulation after this time (s), against the same truth.
std::string direct_text(const FieldTruth& truth, double seconds) {
  const auto trials = std::max<std::int64_t>(1, std::llround(seconds / truth.seconds_per_trial));
  return fixed(lattice::expected_total_variation(truth.p, truth.as_against_exact(trials)), 3);
}

/// "Trees (predict --accuracy): TV 0.045 in 0.03 s (direct simulation 0.103), ...": at most `most`
/// of the predictions, the most accurate last.
std::string trees_text(const ChainErrorChart& chart, std::size_t s, std::size_t most) {
  const auto& trees = chart.trees[s];
  if (trees.empty()) return "Trees: no prediction within --runs-limit.\n";
  std::string text;
  for (const lattice::TreePoint& p :
       trees | std::views::drop(trees.size() - std::min(most, trees.size())))
    text += fmt::format(
        "{}{} in {} s ({}{})", text.empty() ? "Trees (predict --accuracy): TV " : ", ",
        fixed(p.error.total_variation, 3), seconds_text(p.seconds),
        text.empty() ? "direct simulation " : "", direct_text(chart.truths[s], p.seconds));
  return wrapped(text + ".");
}

/// A matrix of the chart in words.
std::string place_text(const ChainErrorChart& chart, const ChainPoint& p, std::size_t s) {
  return fmt::format("{}, {} trials a row, {} s", name_of(chart.curves[p.curve]), p.trials,
                     seconds_text(p.seconds(s)));
}

/// The answer for one start, in at most eight lines.
std::string answer_for(const ChainErrorChart& chart, std::size_t s) {
  const ChainSummary summary = summary_of(chart, s);
  const ChainPoint& best = chart.points[summary.best];
  constexpr std::size_t kFewTrees = 2;
  return wrapped(
             fmt::format("S{}: the best matrix of bins errs by a total variation (TV) of {} ({}).",
                         name_of(chart.truths[s]).substr(1), fixed(best.error(s), 3),
                         place_text(chart, best, s))) +
         when_it_pays(chart, summary, s) + trees_text(chart, s, kFewTrees);
}

/// What limits the best matrix, and what other matrices reach.
std::string words_of(const ChainErrorChart& chart, std::size_t s) {
  const ChainSummary summary = summary_of(chart, s);
  const ChainPoint &best = chart.points[summary.best], &cheapest = chart.points[summary.cheapest];
  std::string text =
      summary.cheapest == summary.best
          ? "No cheaper matrix comes within 1.5 times of the best error.\n"
          : wrapped(fmt::format("The cheapest matrix within 1.5 times of the best error has TV {} "
                                "({}).",
                                fixed(cheapest.error(s), 3), place_text(chart, cheapest, s)));
  const ChainAnswer& a = best.answers[s];
  const std::string bins = fixed(a.bins, 3), sampling = fixed(a.sampling, 3);
  text += wrapped(
      a.bins > a.sampling
          ? fmt::format("The coarse states limit the best matrix (TV {}; sampling {}): more trials "
                        "would not help.",
                        bins, sampling)
          : fmt::format("Sampling limits the best matrix (TV {}; coarse states {}): more trials "
                        "would help.",
                        sampling, bins));
  if (summary.best_visited) {
    const ChainPoint& visited = chart.points[*summary.best_visited];
    text += wrapped(fmt::format(
        "With rows started where bodies were seen to enter, the best TV is {} ({}, which includes "
        "these trials).",
        fixed(visited.error(s), 3), place_text(chart, visited, s)));
  }
  return text + trees_text(chart, s, chart.trees[s].size());
}

/// The curves [first, beyond) side by side, for one start. Each line is a number of trials per row,
/// with seconds, the chain's total variation and that of direct simulation at this cost. Then the
/// parts of the last line's error.
std::string block_of(const ChainErrorChart& chart, std::size_t s, std::size_t first,
                     std::size_t beyond) {
  std::vector<TextColumn> columns{{"trials/row", 12}};
  for (std::size_t c = first; c < beyond; ++c)
    columns.push_back(
        {fmt::format("{} ({})", name_of(chart.curves[c]), chart.curves[c].space.size()), -29, 0, "",
         c == first ? " |" : "|"});
  TextTable table(columns);
  const auto row = [&](const std::string& name, const auto& cell) {
    std::vector<TextCell> cells{name};
    for (std::size_t c = first; c < beyond; ++c) cells.emplace_back(cell(c));
    table.row(cells);
  };
  const auto point = [&](std::size_t curve, std::int64_t trials) {
    const auto at =
        std::find_if(chart.points.begin(), chart.points.end(),
                     [&](const ChainPoint& p) { return p.curve == curve && p.trials == trials; });
    return at == chart.points.end() ? nullptr : &*at;
  };
  for (const std::int64_t trials : lattice::kChainTrials) {
    bool any = false;
    for (std::size_t c = first; c < beyond; ++c) any |= point(c, trials) != nullptr;
    if (any)
      row(std::to_string(trials), [&](std::size_t c) {
        const ChainPoint* p = point(c, trials);
        return p ? fmt::format("{:>8}{:>10}{:>8}", seconds_text(p->seconds(s)),
                               fixed(p->error(s), 3), direct_text(chart.truths[s], p->seconds(s)))
                 : std::string();
      });
  }
  for (const auto part : {&ChainAnswer::sampling, &ChainAnswer::bins})
    row(part == &ChainAnswer::sampling ? "sampling" : "bins", [&](std::size_t c) {
      const std::vector<std::int64_t>& trials = chart.curves[c].trials;
      return fmt::format(
          "{:>18}", trials.empty() ? "-" : fixed(point(c, trials.back())->answers[s].*part, 3));
    });
  return "\n" + table.text();
}

/// The body of a start: chart chain takes entries from below alone.
dynamics::BodyState from_below(const dynamics::Entry& start) {
  return {start.at[dynamics::kEntryD], 0.0, start.at[dynamics::kEntryVx],
          start.at[dynamics::kEntryVy]};
}

}  // namespace

std::string name_of(const FieldTruth& truth) {
  const dynamics::BodyState start = from_below(truth.start);
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  return fmt::format("start d = {}, v = ({}, {}) {}", quantity(start.x, "m"),
                     digits(start.vx / speed.size), digits(start.vy / speed.size), speed.name);
}

std::string name_of(const ChainCurve& curve) {
  return fmt::format("bins x {}{}", digits(curve.factor), curve.visited ? ", visited" : "");
}

void describe(Fields& out, const ChainErrorResult& result) {
  const auto& [chart, method, made_by] = result;
  out.text({"machine", "processor on which times were taken"}, machine());
  out.text({"seconds_are", "what kind of time all times are"}, "CPU time of one thread");
  out.count({"truth_trials", "1", "number of trials of the full dynamics from each start"},
            chart.options.truth_trials);
  out.count({"runs_limit", "1", "largest number of gate runs for one matrix or tree"},
            chart.options.runs_limit);
  out.count(
      {"pilot_trials", "1",
       "number of full trials from each start that saw where bodies enter; 0: none were made"},
      chart.pilot_trials);
  out.text(Label("bins", "kind of bins at factor 1, as in state_space.bins")
               .one_of({"paper", "auto", "scene"}),
           chart.bins.name());
  out.count({"matrices_drawn_anew", "1",
             "number of matrices drawn anew to find the sampling error of a matrix"},
            lattice::kMatricesDrawnAnew);
  out.list_of({"starts", "one for each start"}, chart.truths.size(),
              [&](Fields& f, std::size_t s) { describe_start_of(f, chart, s); });
  out.list({"curves", "one curve for each factor of the bins and each way to start rows"},
           chart.curves, [](Fields& f, const ChainCurve& c) {
             describe_bins(f, c);
             f.number(
                 {"one_thread_s_per_gate_run", "s", "computing time of a gate run on one thread"},
                 c.seconds_per_run);
             f.count({"points", "1", "number of points of the curve"}, c.trials.size());
           });
  out.list({"points", "one point for each curve and number of gate runs from each state"},
           chart.points, [&](Fields& f, const ChainPoint& p) { describe(f, p, chart); });
  describe_status(out, chart.health);
  describe_method(out, method);
  describe_made_by(out, made_by);
}

std::string csv_of(const ChainErrorChart& chart) {
  Csv csv(
      "d_m,vx_m_per_s,vy_m_per_s,answer,bins,states,row_starts,trials,gate_runs,matrices,build_s,"
      "answer_s,total_s,total_variation,total_variation_sd,corrcoef,sampling_total_variation,"
      "bins_total_variation,formula_total_variation,formula_corrcoef,truth_floor_total_variation,"
      "truth_floor_corrcoef,clamped_share,rows_never_sampled,never_sampled_share");
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const dynamics::BodyState start = from_below(chart.truths[s].start);
    const FinalGateError& floor = chart.truths[s].floor;
    for (const ChainPoint& p : chart.points) {
      const ChainAnswer& a = p.answers[s];
      const ChainCurve& curve = chart.curves[p.curve];
      const auto line = [&](const std::string& answer, double seconds, const FinalGateError& e,
                            double sd, double sampling, double bins) {
        csv.row(start.x, start.vx, start.vy, answer, curve.factor, curve.space.size(),
                row_starts(curve), p.trials, p.runs, p.matrices, p.build_seconds, seconds,
                p.build_seconds + seconds, e.total_variation, sd, e.corrcoef, sampling, bins,
                kUnknown, kUnknown, floor.total_variation, floor.corrcoef, p.clamped_share,
                p.rows_never_sampled, a.never_sampled);
      };
      line("exact", a.exact_seconds, a.exact, a.exact_sd, a.sampling, a.bins);
      for (std::size_t w = 0; w < kChainWalks.size(); ++w)
        line(fmt::format("{} walks", kChainWalks[w]), a.walk_seconds[w], a.walks[w], kUnknown,
             kUnknown, kUnknown);
    }
    for (const lattice::TreePoint& p : chart.trees[s])
      csv.row(start.x, start.vx, start.vy, "tree", kUnknown, p.states, "visited", kUnknown,
              p.gate_runs, lattice::kTreePredictions, kUnknown, kUnknown, p.seconds,
              p.error.total_variation, kUnknown, p.error.corrcoef, kUnknown, kUnknown, kUnknown,
              kUnknown, floor.total_variation, floor.corrcoef, kUnknown, kUnknown, kUnknown);
    for (const DirectSimulation& d : chart.direct[s])
      csv.row(start.x, start.vx, start.vy, "direct simulation", kUnknown, kUnknown, kUnknown,
              d.trials, kUnknown, kUnknown, kUnknown, d.seconds, d.seconds, d.drawn.total_variation,
              kUnknown, d.drawn.corrcoef, kUnknown, kUnknown, d.formula.total_variation,
              d.formula.corrcoef, floor.total_variation, floor.corrcoef, kUnknown, kUnknown,
              kUnknown);
  }
  return csv.text();
}

std::string answer_text(const ChainErrorChart& chart) {
  std::string text;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) text += answer_for(chart, s);
  const FieldTruth& first = chart.truths.front();
  return text + wrapped(fmt::format(
                    "TV is the difference from {} full trials for each start. Their own sampling "
                    "noise is TV {}{}.",
                    first.tally.trials, fixed(first.floor.total_variation, 3),
                    chart.truths.size() > 1 ? " for the first start" : ""));
}

std::string details_text(const ChainErrorChart& chart) {
  constexpr std::size_t kBeside = 2;  // curves that fit into the width of a screen
  std::string out;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const FieldTruth& truth = chart.truths[s];
    out += fmt::format(
        "\nS{}: {} full trials, {} ms each.\n"
        "Each cell has seconds, TV of the exact chain, and TV of direct simulation at that cost.\n",
        name_of(truth).substr(1), truth.tally.trials, fixed(1e3 * truth.seconds_per_trial, 2));
    for (std::size_t first = 0; first < chart.curves.size(); first += kBeside)
      out += block_of(chart, s, first, std::min(first + kBeside, chart.curves.size()));
    out += "\n" + words_of(chart, s);
  }
  out +=
      "\nsampling, bins: the parts of the last line's TV that come from the matrix's trials and "
      "from\n"
      "its states. Seconds: CPU time of one thread for one matrix and one prediction. The chain's "
      "TV\n"
      "is a mean over up to 8 matrices of different trials.\n";
  for (const ChainCurve& c : chart.curves)
    if (c.trials.empty())
      out += fmt::format("{}: no point, {} rows of {} trials exceed --runs-limit {}.\n", name_of(c),
                         c.space.size(), lattice::kChainTrials.front(), chart.options.runs_limit);
  return out;
}

namespace {

/// How curves look. Curves of finer and coarser bins are thin.
struct CurveLook {
  const char* with;
  Pen pen;
};
constexpr CurveLook kDirect{"lines", {kInk, 1.5}},
    kNoise{"lines", {.colour = kInk, .width = 0.8, .dashes = 3}}, kOthers{"lines", {kInk, 0.4}},
    kUniform{"linespoints", {kSecondColour, 1.5, 5, 0.5}},
    kVisited{"linespoints", {kFourthColour, 1.5, 13, 0.6}},
    kTree{"linespoints", {kFirstColour, 1.5, 7, 0.6}};

/// Whether a curve has the bins nearest to the usual ones.
bool is_usual(const ChainErrorChart& chart, const lattice::ChainCurve& curve) {
  const auto off = [](const lattice::ChainCurve& c) { return std::abs(std::log(c.factor)); };
  return std::none_of(chart.curves.begin(), chart.curves.end(), [&](const auto& other) {
    return !other.trials.empty() && off(other) < off(curve);
  });
}

/// The range of positive numbers that an axis must show.
struct Extent {
  double low = HUGE_VAL, high = 0.0;

  void see(double x) {
    if (x > 0.0) low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Draws total variation over seconds, for one start; the truth's sampling error is a level.
void draw_curves(Panels& out, Panel& panel, const ChainErrorChart& chart, std::size_t s,
                 Extent& seconds, Extent& errors) {
  const std::string of = fmt::format("_{}", s);
  const double noise = chart.truths[s].floor.total_variation;
  errors.see(noise);
  panel.draw_level(noise, kNoise.pen);
  const auto add = [&](Rows& rows, double second, double error) {
    seconds.see(second);
    errors.see(error);
    rows.add(second, error);
  };
  const auto draw = [&](Rows rows, const CurveLook& look) {
    if (!rows.empty()) panel.draw(out.data(std::move(rows)), "1:2", look.with, look.pen);
  };
  Rows direct("$direct" + of), trees("$tree" + of);
  for (const lattice::DirectSimulation& d : chart.direct[s])
    add(direct, d.seconds, d.drawn.total_variation);
  draw(direct, kDirect);
  for (std::size_t c = 0; c < chart.curves.size(); ++c) {
    Rows chain(fmt::format("$chain{}{}", c, of));
    for (const lattice::ChainPoint& p : chart.points)
      if (p.curve == c) add(chain, p.seconds(s), p.error(s));
    const lattice::ChainCurve& curve = chart.curves[c];
    draw(chain, !is_usual(chart, curve) ? kOthers : curve.visited ? kVisited : kUniform);
  }
  for (const lattice::TreePoint& p : chart.trees[s]) add(trees, p.seconds, p.error.total_variation);
  draw(trees, kTree);
}

/// Adds a key of the curves.
void add_keys(Panels& out, const ChainErrorChart& chart) {
  const auto named = [](const CurveLook& look, const std::string& name) {
    return entry(look.with, look.pen, verbatim(name));
  };
  std::vector<Layer> chains,
      others{named(kDirect, "direct simulation"), named(kNoise, "noise of the truth")};
  bool finer = false;
  for (const lattice::ChainCurve& curve : chart.curves) {
    if (curve.trials.empty()) continue;
    if (!is_usual(chart, curve))
      finer = true;
    else
      chains.push_back(named(curve.visited ? kVisited : kUniform, "chain, " + name_of(curve)));
  }
  if (std::any_of(chart.trees.begin(), chart.trees.end(),
                  [](const auto& points) { return !points.empty(); }))
    chains.push_back(named(kTree, "chain of trees"));
  if (finer) others.push_back(named(kOthers, "chain, coarser and finer bins"));
  out.add_key(78, 6, std::move(chains));
  out.add_key(270, 6, std::move(others));
}

}  // namespace

Figure figure_of(const ChainErrorChart& chart) {
  const std::size_t starts = chart.truths.size(), columns = starts > 1 ? 2 : 1;
  constexpr double kHead = 70, kPanel = 168, kRow = 232;
  const double wide = columns == 1 ? 406.0 : 184.0;
  Panels out;
  add_keys(out, chart);
  std::vector<Panel*> panels;
  Extent seconds, errors;
  for (std::size_t s = 0; s < starts; ++s) {
    const double left = s % columns == 0 ? 82 : 298,
                 top = kHead + kRow * static_cast<double>(s / columns) + 26;
    panels.push_back(&out.add({left, left + wide, top, top + kPanel}));
    panels[s]->say(name_of(chart.truths[s]), left, top - 12, kSmallFont);
    draw_curves(out, *panels[s], chart, s, seconds, errors);
  }
  // Without positive numbers the axis has some range.
  for (Extent* extent : {&seconds, &errors})
    if (!std::isfinite(extent->low)) *extent = {0.1, 1.0};
  const double low = seconds.low / 1.4, high = 1.4 * seconds.high;
  for (std::size_t s = 0; s < starts; ++s) {
    Panel& panel = *panels[s];
    const bool first = s % columns == 0;
    panel.x = {s + columns >= starts ? "seconds on one thread" : "", low, high,
               fmt::format("({})", tics_1_2_5(low, high, wide))};
    panel.y = {first ? "total variation" : "",
               0.6 * errors.low,
               std::max(1.0, 1.4 * errors.high),
               "",
               "%g",
               first};
    panel.x.logarithmic = panel.y.logarithmic = true;
    panel.grid = kThin;
  }
  return out.figure(
      static_cast<int>(kHead + kRow * static_cast<double>((starts - 1) / columns + 1)) + 24);
}

}  // namespace gatewalk::cli
