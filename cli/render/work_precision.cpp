// SPDX-License-Identifier: MIT
#include "cli/render/work_precision.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {

using dynamics::ChartPoint;
using dynamics::Errors;
using dynamics::Outcome;
using dynamics::StrongError;
using dynamics::WeakError;
using dynamics::WorkPrecision;

namespace {

/// A number as a chart shows it: none if it is below what the reference can show.
struct Shown {
  double value = std::nan("");
  bool below = false;
};
Shown shown(double value, double limit) {
  if (std::isfinite(value) && value < limit) return {std::nan(""), true};
  return {value, false};
}

// ---- CSV ----

std::string number(double x) { return std::isfinite(x) ? digits(x) : std::string(); }

/// "value,standard error,chance,limit that it is below"
std::string csv_of(const WeakError& e, double limit) {
  const Shown tv = shown(e.total_variation, limit);
  return number(tv.value) + ',' + (tv.below ? "" : number(e.standard_error)) + ',' +
         number(e.chance) + ',' + (tv.below ? number(limit) : "");
}

std::string csv_of(const ChartPoint& p, const WorkPrecision& chart) {
  const dynamics::Health& h = p.health;
  lattice::TextStream out;
  out << csv_text(chart.label) << ',' << p.setting.method << ',' << p.setting.key << ','
      << digits(p.setting.value) << ',' << (p.setting.usual ? 1 : 0) << ','
      << dynamics::name_of(p.verdict) << ',' << h.runs << ',';
  if (!p.ran()) {  // only the reason
    out << std::string(30, ',') << csv_text(p.refusal) << "\n";
    return out.str();
  }
  const auto& [outcomes, columns, strong] = p.errors;
  const Shown position = shown(strong.position, chart.position_limit());
  out << number(p.least_microseconds()) << ',' << number(p.median_microseconds()) << ','
      << number(p.steps_per_trial()) << ',' << number(p.evaluations_per_trial()) << ','
      << csv_of(outcomes, chart.outcome_bound(p.errors)) << ',' << outcomes.changed << ','
      << csv_of(columns, chart.column_bound(p.errors)) << ',' << strong.compared << ','
      << number(strong.parted_share()) << ',' << number(position.value) << ','
      << (position.below ? number(chart.position_limit()) : "");
  for (const auto what : {&StrongError::velocity, &StrongError::time, &StrongError::energy})
    out << ',' << number(shown(strong.*what, chart.strong_limit(what)).value);
  out << ',' << h.broken << ',' << p.out_of_work << ',' << h.penetrating << ',' << h.creating_energy
      << ',' << h.fast << ',' << h.unstable << ',' << h.undefined_contacts << ',' << h.forced_holds
      << ',' << number(h.worst_penetration) << ',' << number(h.worst_energy_created) << ",\n";
  return out.str();
}

// ---- Result ----

void describe(Fields& out, const WeakError& e, double limit) {
  const Shown tv = shown(e.total_variation, limit);
  out.number({"total_variation", "1",
              "total variation from the other setting's trials; null: less than below, or nothing "
              "to compare"},
             tv.value);
  out.number({"standard_error", "1", "standard error of total_variation; null: as total_variation"},
             tv.below ? kUnknown : e.standard_error);
  out.number(
      {"chance", "1", "total variation that the trials that changed would show by chance alone"},
      e.chance);
  out.count(
      {"trials_changed", "1", "number of trials that end otherwise than with the other setting"},
      e.changed);
  out.optional(tv.below, [&](Fields& f) {
    f.number({"below", "1", "smallest total variation that could be shown; the one seen is less"},
             limit);
  });
}

void describe(Fields& out, const StrongError& e, const WorkPrecision& chart, bool of_reference) {
  out.count(
      {"compared", "1", "pairs of trials that left the gate in the same way with both settings"},
      e.compared);
  out.count({"parted", "1",
             "pairs of trials that took different courses: they count as infinitely far apart"},
            e.parted);
  out.number({"parted_share", "1", "parted / (compared + parted)"}, e.parted_share());
  out.count({"trapped_in_both", "1",
             "pairs of trials that were trapped with both settings, with no exit to compare"},
            e.trapped);
  const auto median = [&](const Field& of, double value, double limit) {
    const Shown m = shown(value, of_reference ? 0.0 : limit);
    out.object(Label(of.key, of.meaning), [&](Fields& f) {
      f.number_or_object(
          {"median", of.unit,
           "median over compared and parted pairs; null: half or more have parted"},
          m.below ? std::nullopt : std::optional(m.value), [&](Fields& below) {
            below.number(
                {"below", of.unit, "smallest median that could be shown; the one seen is less"},
                limit);
          });
    });
  };
  median({"position_m", "m", "distance between the two bodies at their exits"}, e.position,
         chart.position_limit());
  median({"velocity_m_per_s", "m/s", "difference of the two bodies' velocities at their exits"},
         e.velocity, chart.strong_limit(&StrongError::velocity));
  median({"time_s", "s", "difference of the two bodies' times at their exits"}, e.time,
         chart.strong_limit(&StrongError::time));
  median({"energy_J", "J", "difference of the two bodies' kinetic energies at their exits"},
         e.energy, chart.strong_limit(&StrongError::energy));
}

/// Errors of the reference itself are given even below its limits.
void describe(Fields& out, const Errors& e, const WorkPrecision& chart, bool of_reference) {
  out.object(
      Label("errors", "differences between trials of two settings with the same random numbers")
          .shared(),
      [&](Fields& f) {
        f.object({"outcomes", "difference of the distributions of outcomes"}, [&](Fields& weak) {
          describe(weak, e.outcomes, of_reference ? 0.0 : chart.outcome_bound(e));
        });
        f.object({"columns",
                  "difference of the distributions of states in which the next gate is entered"},
                 [&](Fields& weak) {
                   describe(weak, e.columns, of_reference ? 0.0 : chart.column_bound(e));
                 });
        f.object({"strong", "differences of single trials, pair by pair"},
                 [&](Fields& strong) { describe(strong, e.strong, chart, of_reference); });
      });
}

void describe_reference(Fields& out, const WorkPrecision& chart) {
  const dynamics::Reference& r = chart.reference;
  out.text({"setting", "method and accuracy of the reference"}, r.setting.name());
  out.text(status_label("ok, or the worst fault that its runs showed"),
           dynamics::name_of(r.verdict));
  out.number({"evaluations_per_trial", "1", "mean number of evaluations of the forces per trial"},
             r.evaluations_per_trial);
  out.object({"outcomes", "number of the reference's trials by outcome"}, [&](Fields& f) {
    for (const auto& [outcome, key, words] : dynamics::kOutcomeNames)
      if (outcome != Outcome::traversed_even)  // even traversals count as right ones (accuracy.h)
        f.count({key, "1", fmt::format("number of trials with this outcome: {}", words)},
                r[outcome]);
  });
  const auto against = [&](const Label& label, const dynamics::Setting& other, const Errors& e) {
    out.object(label, [&](Fields& f) {
      f.text({"against", "method and accuracy with which the reference is compared"}, other.name());
      describe(f, e, chart, true);
    });
  };
  against({"own_error",
           "differences of the reference from the same method with ten times coarser accuracy"},
          r.second, r.own);
  against({"another_method", "differences of the reference from another method"}, r.other_method,
          r.other);
}

void describe(Fields& out, const ChartPoint& p, const WorkPrecision& chart) {
  out.text({"method", "method of the setting, as in run.method"}, p.setting.method);
  out.text(Label("key", "key of the scene that sets how exact the method is")
               .one_of({"run.step_s", "run.event_tolerance_m"}),
           p.setting.key);
  out.number({"value", "s or m", "value of this key, in the unit that ends the key's name"},
             p.setting.value);
  out.flag({"default", "whether this value is the default of the method"}, p.setting.usual);
  out.text(status_label("ok, or the worst fault that its runs showed"),
           dynamics::name_of(p.verdict));
  const auto ran = [&](Fields& f) {
    f.object(
        {"microseconds_per_trial", "computing time of a trial on one thread"}, [&](Fields& time) {
          time.number({"min", "us", "smallest of the rounds' means"}, p.least_microseconds());
          time.number({"median", "us", "median of the rounds' means"}, p.median_microseconds());
          time.numbers({"rounds", "us", "mean time of a trial in each round"}, p.microseconds);
        });
    f.number({"steps_per_trial", "1", "mean number of time steps per trial"}, p.steps_per_trial());
    f.number({"evaluations_per_trial", "1", "mean number of evaluations of the forces per trial"},
             p.evaluations_per_trial());
    f.count({"runs_cut_short", "1",
             "number of trials stopped because they took over 50 million steps or evaluations"},
            p.out_of_work);
    describe(f, p.errors, chart, false);
    f.object({"health", "numerical faults of the setting's trials"},
             [&](Fields& health) { cli::describe(health, p.health); });
  };
  out.either(p.ran(), ran, [&](Fields& f) {
    f.text({"reason", "why the method refuses this scene with this value"}, p.refusal);
  });
}

// ---- Table ----

/// "1.20e-03", or "<2.0e-02" below the limit.
std::string error_text(double value, double limit) {
  if (shown(value, limit).below) return "<" + scientific(limit, 1);
  return std::isfinite(value) ? scientific(value, 1) : "-";
}

/// A line for each setting.
std::string lines_of(const WorkPrecision& chart) {
  TextTable table({{"  setting", -20},
                   {"us/trial", 8, 1},
                   {"steps", 6},
                   {"outcomes", -9, 0, "", "  "},
                   {"+-", -8},
                   {"chance", -8},
                   {"columns", -9},
                   {"exit (m)", -9},
                   {"parted", 7},
                   {"status", 0, 0, "", "  "}});
  std::string refused;
  for (const ChartPoint& p : chart.points) {
    const std::string name = fmt::format("{}{} {}", p.setting.usual ? "* " : "  ", p.setting.method,
                                         digits(p.setting.value, 4));
    if (!p.ran()) {
      table.row({name, "refused"});
      refused += wrapped(name + " refused: " + p.refusal, "    ");
      continue;
    }
    const auto& [outcomes, columns, strong] = p.errors;
    const double bound = chart.outcome_bound(p.errors);
    table.row({name, p.least_microseconds(), fixed(p.steps_per_trial(), 0),
               error_text(outcomes.total_variation, bound),
               outcomes.total_variation < bound ? "" : error_text(outcomes.standard_error, 0.0),
               error_text(outcomes.chance, 0.0),
               error_text(columns.total_variation, chart.column_bound(p.errors)),
               error_text(strong.position, chart.position_limit()),
               percent(strong.parted_share(), 1.0), dynamics::name_of(p.verdict)});
  }
  return table.text() + refused;
}

std::string reference_text(const WorkPrecision& chart) {
  const dynamics::Reference& r = chart.reference;
  const auto share = [&](Outcome outcome) {
    return percent(static_cast<double>(r[outcome]), static_cast<double>(chart.trials));
  };
  const auto against = [&](const dynamics::Setting& setting, const Errors& e) {
    return wrapped(
        fmt::format("  against {:<20} outcomes {}, columns {}, exit {}, parted {}", setting.name(),
                    digits(e.outcomes.total_variation), digits(e.columns.total_variation),
                    quantity(e.strong.position, "m"), percent(e.strong.parted_share(), 1.0, 3)),
        "    ");
  };
  return wrapped(fmt::format("  reference {} ({}): traversed left {}, right {}, exited left {}, "
                             "right {}, trapped {}",
                             r.setting.name(), dynamics::name_of(r.verdict),
                             share(Outcome::traversed_left), share(Outcome::traversed_right),
                             share(Outcome::exited_left), share(Outcome::exited_right),
                             share(Outcome::trapped)),
                 "    ") +
         against(r.second, r.own) + against(r.other_method, r.other);
}

}  // namespace

void describe(Fields& out, const WorkPrecision& chart) {
  out.text({"scene", "name of the scene"}, chart.label);
  out.count({"trials", "1", "number of trials with each setting"}, chart.trials);
  out.count({"timed_trials", "1",
             "number of trials with each setting that were timed; with slow settings fewer"},
            chart.timed_trials);
  out.object({"reference", "the setting that all others are compared with"},
             [&](Fields& f) { describe_reference(f, chart); });
  out.list({"settings", "the charted settings, method by method, from coarse to fine"},
           chart.points, [&](Fields& f, const ChartPoint& p) { describe(f, p, chart); });
}

void describe(Fields& out, const ChartResult& result) {
  out.text({"machine", "processor on which times were taken"}, machine());
  out.list_of({"scenes", "results of each scene"}, result.charts.size(),
              [&](Fields& f, std::size_t s) {
                describe(f, result.charts[s]);
                describe_made_by(f, result.made_by[s]);
              });
}

std::string csv_of(const std::vector<WorkPrecision>& charts) {
  std::string out =
      "scene,method,key,value,default,status,trials,microseconds_min,microseconds_median,"
      "steps_per_trial,evaluations_per_trial,outcome_tv,outcome_tv_se,outcome_tv_chance,"
      "outcome_tv_below,outcomes_changed,column_tv,column_tv_se,column_tv_chance,column_tv_below,"
      "trials_compared,parted_share,position_median_m,position_median_below_m,"
      "velocity_median_m_per_s,time_median_s,energy_median_J,runs_not_finite,runs_cut_short,"
      "runs_penetrating,runs_creating_energy,runs_too_fast,runs_beyond_bound,"
      "contacts_without_formula,forced_holds,worst_penetration_m,worst_energy_created_J,reason\n";
  for (const WorkPrecision& chart : charts)
    for (const ChartPoint& p : chart.points) out += csv_of(p, chart);
  return out;
}

namespace {

/// A line for the default setting of each method.
std::string usual_lines(const WorkPrecision& chart) {
  TextTable table({{"  default setting", -25},
                   {"us/trial", 10, 1},
                   {"error of outcomes", 20},
                   {"status", 0, 0, "", "  "}});
  for (const ChartPoint& p : chart.points)
    if (p.setting.usual && p.ran())
      table.row({"  " + p.setting.name(), p.least_microseconds(),
                 error_text(p.errors.outcomes.total_variation, chart.outcome_bound(p.errors)),
                 dynamics::name_of(p.verdict)});
    else if (p.setting.usual)
      table.row({"  " + p.setting.name(), "refused"});
  return table.text();
}

}  // namespace

std::string answer_text(const std::vector<WorkPrecision>& charts) {
  std::string text;
  for (const WorkPrecision& chart : charts) {
    const ChartPoint* cheapest = chart.cheapest();
    const std::string allowed = digits(chart.params.run.tolerance);
    text += wrapped(
        cheapest ? fmt::format("{}: the fastest setting without faults, with outcomes within {} of "
                               "the reference, is {} ({} us per trial).",
                               chart.label, allowed, cheapest->setting.name(),
                               fixed(cheapest->least_microseconds(), 1))
                 : fmt::format("{}: no setting without faults was shown to have outcomes within {} "
                               "of the reference; more --trials may show one.",
                               chart.label, allowed));
  }
  if (charts.size() == 1) text += usual_lines(charts.front());
  return text + wrapped(fmt::format(
                    "From {} trials for each setting, with the random numbers of the reference. "
                    "Outcomes differ by total variation; <: not told from no error.",
                    charts.front().trials));
}

std::string details_text(const std::vector<WorkPrecision>& charts, std::int64_t rounds) {
  std::string text;
  for (const WorkPrecision& chart : charts)
    text += fmt::format("\n{}: {} trials per setting, {} timed\n{}{}", chart.label, chart.trials,
                        chart.timed_trials, reference_text(chart), lines_of(chart));
  return text +
         wrapped(fmt::format("\nsetting: step in s, of event the tolerance in m; *: default. "
                             "us/trial: least of {} on one thread, {}",
                             counted(rounds, "round", "rounds"), machine())) +
         "outcomes, columns: total variation from the reference, of the outcomes and of the "
         "crossing\n"
         "states; +-: its standard error; chance: what chance alone would show; <: not told from "
         "no\n"
         "error. exit (m): median distance at the exit; parted: share of exits that took another\n"
         "course, which count as infinitely far. status: ok, or the worst fault seen.\n";
}

namespace {

/// Colour and filled marker of a method.
Pen pen_of(const std::string& method) {
  if (method == "paper") return {.colour = kSecondColour, .mark = 5, .size = 0.7};
  if (method == "stable") return {.colour = kFirstColour, .mark = 7, .size = 0.7};
  if (method == "moreau") return {.colour = kThirdColour, .mark = 9, .size = 0.7};
  if (method == "penalty") return {.colour = kFifthColour, .mark = 13, .size = 0.7};
  return {.colour = kFourthColour, .mark = 15, .size = 0.7};
}

// Marks of points. Panels draw them in the method's colour, the key in the text's colour.
constexpr Pen kUsual{kInk, 1.2, 6, 1.2}, kFault{kInk, 2, 2, 0.7}, kLess{kInk, 1.2, 10, 0.9},
    kParted{kInk, 1.2, 8, 0.9};
constexpr Pen kLimit{.colour = kInk, .width = 0.8, .dashes = 2},
    kOwn{.colour = kInk, .width = 0.8, .dashes = 3};

/// A point's error (infinite: at least half of the trials parted; NaN: none), its standard error,
/// and the bound above which an error is significant.
struct Drawn {
  double error, spread, bound;

  [[nodiscard]] bool parted() const { return !std::isnan(error) && !std::isfinite(height()); }
  /// Where the point is drawn.
  [[nodiscard]] double height() const { return std::max(error, bound); }
};

/// A kind of error in a chart: the reference's limit for all points, and its own error.
struct OutcomeKind {
  double limit, own;
  std::function<Drawn(const ChartPoint&)> value;
};
OutcomeKind outcomes_of(const WorkPrecision& chart) {
  return {chart.outcome_limit(), chart.reference.own.outcomes.total_variation,
          [&chart](const ChartPoint& p) {
            const dynamics::WeakError& e = p.errors.outcomes;
            return Drawn{e.total_variation, e.standard_error, chart.outcome_bound(p.errors)};
          }};
}
OutcomeKind positions_of(const WorkPrecision& chart) {
  return {chart.position_limit(), chart.reference.own.strong.position,
          [&chart](const ChartPoint& p) {
            const dynamics::StrongError& e = p.errors.strong;
            const bool parted = !std::isfinite(e.position) && e.compared + e.parted > 0;
            return Drawn{parted ? HUGE_VAL : e.position, std::nan(""), chart.position_limit()};
          }};
}

/// The range of positive numbers on a logarithmic axis.
struct Range {
  double low = HUGE_VAL, high = 0.0;

  void see(double x) {
    if (!(x > 0.0) || !std::isfinite(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// The range with margins; a default range if no number was seen.
  [[nodiscard]] Range wider(double below, double above) const {
    return high > 0.0 ? Range{low / below, high * above} : Range{0.1, 1.0};
  }
};

/// The ranges of all scenes' panels, equal so that scenes can be compared.
struct Ranges {
  Range time, outcomes, positions;

  explicit Ranges(const std::vector<WorkPrecision>& charts) {
    for (const WorkPrecision& chart : charts) {
      const auto see = [&](Range& range, const OutcomeKind& kind) {
        range.see(kind.limit);
        for (const ChartPoint& p : chart.points)
          if (p.ran()) range.see(kind.value(p).height());
      };
      see(outcomes, outcomes_of(chart));
      see(positions, positions_of(chart));
      for (const ChartPoint& p : chart.points) time.see(p.least_microseconds());
    }
    time = time.wider(1.3, 1.3);
    outcomes = outcomes.wider(4.0, 2.0);
    positions = positions.wider(20.0, 10.0);
  }
};

/// Draws the least time per trial against the error, for all methods. An error below its bound is
/// drawn there as "less than"; trials that parted are drawn at the top.
void draw_methods(Panels& out, Panel& panel, const WorkPrecision& chart, const OutcomeKind& kind,
                  const Range& range, const std::string& tag) {
  const auto level = [&](double at, const Pen& pen) {
    if (at > range.low && std::isfinite(at)) panel.draw_level(at, pen);
  };
  level(kind.limit, kLimit);
  level(kind.own, kOwn);
  bool compared = false;
  for (std::size_t begin = 0, end = 0; begin < chart.points.size(); begin = end) {
    const std::string& method = chart.points[begin].setting.method;
    const auto rows_of = [&](const char* what) {
      return Rows(fmt::format("${}{}{}", tag, method, what));
    };
    Rows line = rows_of("line"), bars = rows_of("bars"), good = rows_of("good"),
         fault = rows_of("fault"), less = rows_of("less"), parted = rows_of("parted"),
         usual = rows_of("usual");
    for (; end < chart.points.size() && chart.points[end].setting.method == method; ++end) {
      const ChartPoint& p = chart.points[end];
      if (!p.ran()) continue;
      const Drawn drawn = kind.value(p);
      const auto [error, spread, bound] = drawn;
      if (std::isnan(error)) continue;
      const double time = p.least_microseconds(),
                   at = drawn.parted() ? range.high / 1.6 : drawn.height();
      if (p.setting.usual) usual.add(time, at);
      if (drawn.parted()) {
        parted.add(time, at);
        continue;
      }
      line.add(time, at);
      (error < bound ? less : p.verdict == dynamics::Verdict::fine ? good : fault).add(time, at);
      if (error >= bound && std::isfinite(spread))
        bars.add(time, std::max(error - 2 * spread, 0.1 * error), error + 2 * spread);
    }
    const Pen own = pen_of(method);
    const auto draw = [&](Rows& rows, const char* columns, const char* with, Pen pen,
                          const char* colour) {
      if (rows.empty()) return;
      compared = true;
      pen.colour = colour;
      panel.draw(out.data(std::move(rows)), columns, with, pen);
    };
    draw(line, "1:2", "lines", {.width = 1}, own.colour);
    draw(bars, "1:2:(0):($3-$2)", "vectors heads size graph 0.015,90", {.width = 0.8}, own.colour);
    draw(good, "1:2", "points", own, own.colour);
    draw(fault, "1:2", "points", kFault, own.colour);
    draw(less, "1:2", "points", kLess, own.colour);
    draw(parted, "1:2", "points", kParted, own.colour);
    draw(usual, "1:2", "points", kUsual, kInk);
  }
  if (!compared) panel.more = "set label 'nothing to compare' at graph 0.5,0.5 center\n";
}

/// Lines on the settings that a method refused, as wide as the figure: "refused: penalty 0.02 to
/// 0.01 s".
std::vector<std::string> refused_lines(const WorkPrecision& chart) {
  constexpr std::size_t kLongest = 76;
  const auto refused = [&](std::size_t i, const std::string& method) {
    return i < chart.points.size() && !chart.points[i].ran() &&
           chart.points[i].setting.method == method;
  };
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const dynamics::Setting& first = chart.points[i].setting;
    if (!refused(i, first.method)) continue;
    while (refused(i + 1, first.method)) ++i;
    const dynamics::Setting& last = chart.points[i].setting;
    std::string text = first.method + " " + digits(first.value);
    if (!(last == first)) text += " to " + digits(last.value);
    text += std::string(" ") + first.unit();
    if (lines.empty() || lines.back().size() + text.size() > kLongest)
      lines.push_back(lines.empty() ? "refused: " + text : text);
    else
      lines.back() += ", " + text;
  }
  return lines;
}

void add_keys(Panels& out, const std::vector<WorkPrecision>& charts) {
  std::vector<Layer> methods;
  for (const ChartPoint& p : charts.front().points)
    if (const std::string& method = p.setting.method;
        methods.empty() || methods.back().title.text != method)
      methods.push_back(entry("linespoints", pen_of(method), method));
  std::vector<Layer> marks{entry("points", kUsual, "usual setting"),
                           entry("points", kFault, "shows a fault"),
                           entry("points", kLess, "less than this")};
  const bool parted = std::any_of(charts.begin(), charts.end(), [](const WorkPrecision& chart) {
    return std::any_of(chart.points.begin(), chart.points.end(), [&](const ChartPoint& p) {
      return p.ran() && positions_of(chart).value(p).parted();
    });
  });
  if (parted) marks.push_back(entry("points", kParted, "half or more parted"));
  out.add_key(8, 6, std::move(methods));
  out.add_key(116, 6, std::move(marks));
  out.add_key(
      296, 6,
      {entry("lines", kLimit, "limit of the reference"), entry("lines", kOwn, "its own error")});
}

}  // namespace

Figure figure_of(const std::vector<WorkPrecision>& charts) {
  constexpr double kTop = 112, kPanel = 142, kBelow = 30, kLine = 16;
  const Ranges ranges(charts);
  const std::string tics = fmt::format("({})", tics_1_2_5(ranges.time.low, ranges.time.high, 160));
  Panels out;
  add_keys(out, charts);
  double top = kTop;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const WorkPrecision& chart = charts[i];
    out.say(chart.label, 8, top + 14);
    for (const std::string& line : refused_lines(chart))
      out.say(line, 8, (top += kLine) + 14, kSmallFont);
    top += 30;
    const auto add = [&](double left, const char* name, const OutcomeKind& kind, const Range& range,
                         const char* tag) {
      Panel& panel = out.add({left, left + 156, top, top + kPanel});
      panel.x = {i + 1 == charts.size() ? "µs per trial" : "", ranges.time.low, ranges.time.high,
                 tics};
      const double decades = std::log10(range.high / range.low);
      panel.y = {name, range.low, range.high, digits(std::pow(10.0, std::ceil(decades / 6.0))),
                 "10^{%L}"};
      panel.x.logarithmic = panel.y.logarithmic = true;
      panel.grid = kThin;
      draw_methods(out, panel, chart, kind, range, tag + std::to_string(i));
    };
    add(80, "total variation", outcomes_of(chart), ranges.outcomes, "weak");
    add(330, "exit off by (m)", positions_of(chart), ranges.positions, "strong");
    top += kPanel + kBelow;
  }
  return out.figure(static_cast<int>(top + 32));
}

}  // namespace gatewalk::cli
