#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>

#include "cli/command.h"
#include "cli/render/drawing.h"
#include "cli/render/quantity.h"
#include "cli/render/report.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "dynamics/runs.h"
#include "dynamics/study/accuracy.h"

namespace gatewalk::cli {
namespace {

using dynamics::Setting;
using dynamics::StrongError;
using dynamics::Verdict;
using dynamics::WeakError;

constexpr double kSamePlace = 1e-9;    // of R: what is nearer is rounding, or the same bits
constexpr double kChances = 2.0;       // times what chance would show: what stands out from it
constexpr double kTimedSeconds = 0.1;  // of the usual setting: the trials that are timed

struct Errors {
  WeakError outcomes, columns;
  StrongError strong;
};

struct Point {
  Setting setting;
  Verdict verdict = Verdict::refused;
  std::string refusal;  // why, if it was refused
  dynamics::Health health;
  std::int64_t cut_short = 0;
  Errors errors;
  std::vector<double> microseconds;  // per trial, one value per round

  [[nodiscard]] bool ran() const { return verdict != Verdict::refused; }
};

struct SceneChart {
  std::string label;
  lattice::Scene scene;
  std::int64_t trials = 0, timed_trials = 0;
  Verdict reference_verdict = Verdict::fine;
  double reference_evaluations = 0.0;  // per trial
  std::vector<std::int64_t> reference_outcomes = std::vector<std::int64_t>(dynamics::kOutcomes, 0);
  Errors own;                   // of the reference: against the one ten times coarser
  Setting independent_setting;  // another method
  Errors independent;           // the reference against it
  std::vector<Point> points;

  // What cannot be told from the reference's own error.
  [[nodiscard]] double outcome_limit() const { return weak_limit(own.outcomes, trials); }
  [[nodiscard]] double column_limit() const { return weak_limit(own.columns, trials); }
  /// What a setting's error must reach to stand out from that and from chance.
  [[nodiscard]] double outcome_bound(const Errors& e) const {
    return std::max(outcome_limit(), kChances * e.outcomes.chance);
  }
  [[nodiscard]] double column_bound(const Errors& e) const {
    return std::max(column_limit(), kChances * e.columns.chance);
  }
  /// Infinite when the reference has parted from itself.
  [[nodiscard]] double strong_limit(double StrongError::*what) const {
    if (std::isfinite(own.strong.*what)) return dynamics::kReferenceMargin * own.strong.*what;
    return own.strong.parted > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  }
  [[nodiscard]] double position_limit() const {
    return std::max(strong_limit(&StrongError::position), kSamePlace * scene.gate.body.radius);
  }
};

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}
double least(const std::vector<double>& values) {
  return values.empty() ? std::nan("") : *std::min_element(values.begin(), values.end());
}
double per_run(std::int64_t n, const dynamics::Health& h) {
  return h.runs > 0 ? static_cast<double>(n) / static_cast<double>(h.runs) : std::nan("");
}

std::string unit_of(const Setting& s) { return s.key == "run.step_s" ? " s" : " m"; }
std::string name_of(const Setting& s) { return s.method + " " + digits(s.value) + unit_of(s); }

// ---- Running ----

dynamics::TrialEnds run_setting(const Options& options, const SceneChart& chart, const Setting& s) {
  const dynamics::GateParams p = s.applied_to(chart.scene.gate);
  (void)dynamics::make_method(p);  // refuses before any work
  dynamics::TrialEnds ends;
  run_in_batches(chart.label + ", " + name_of(s), chart.trials, options.talk(),
                 [&](std::int64_t first, std::int64_t n) {
                   add_trial_ends(ends, p, chart.scene.start, options.seed(), {first, n});
                 });
  return ends;
}

Errors errors_of(const SceneChart& chart, const dynamics::StateSpace& space,
                 const dynamics::TrialEnds& run, const dynamics::TrialEnds& reference) {
  return {outcome_error(run.trials, reference.trials),
          column_error(run.trials, reference.trials, space),
          strong_error(chart.scene.gate, run.trials, reference.trials)};
}

/// Seconds of trials 0 .. n - 1 on this thread, or of as many as take `enough` seconds.
struct Timed {
  std::int64_t trials = 0;
  double seconds = 0.0;
};
Timed time_trials(const SceneChart& chart, const Setting& s, std::uint64_t seed, std::int64_t n,
                  double enough) {
  const dynamics::GateParams p = s.applied_to(chart.scene.gate);
  const auto method = dynamics::make_method(p);
  Timed timed;
  const Stopwatch watch;
  dynamics::carry_out(
      p, *method,
      [&](dynamics::RunSlot& slot, const dynamics::GateRun*) {
        timed.seconds = watch.seconds();
        if (timed.trials == n || timed.seconds >= enough) return false;
        if (interrupted()) throw Interrupted{};
        slot.start = chart.scene.start;
        slot.force = dynamics::gate_force(p, seed, timed.trials++);
        return true;
      },
      dynamics::kMostWork);
  return timed;
}

/// Every setting once, round by round, so that noise of the machine hits all alike. The first round
/// warms up and is not kept.
void time_settings(const Options& options, SceneChart& chart, std::int64_t rounds) {
  constexpr double kForEver = std::numeric_limits<double>::infinity();
  const Point* pace = nullptr;  // `stable` as scenes get it, or whatever ran
  for (const Point& point : chart.points)
    if (point.ran() &&
        (pace == nullptr || (point.setting.usual && point.setting.method == "stable")))
      pace = &point;
  if (pace == nullptr) return;
  chart.timed_trials =
      time_trials(chart, pace->setting, options.seed(), chart.trials, kTimedSeconds).trials;
  const auto settings = static_cast<std::int64_t>(chart.points.size());
  Progress progress(chart.label + ", times", (rounds + 1) * settings, options.talk());
  for (std::int64_t round = 0; round <= rounds; ++round) {
    for (std::int64_t i = 0; i < settings; ++i) {
      Point& point = chart.points[static_cast<std::size_t>(i)];
      progress.update(round * settings + i);
      if (!point.ran()) continue;
      const Timed timed =
          time_trials(chart, point.setting, options.seed(), chart.timed_trials, kForEver);
      if (round > 0)
        point.microseconds.push_back(1e6 * timed.seconds / static_cast<double>(timed.trials));
    }
  }
}

SceneChart chart_scene(const Options& options, const std::string& path,
                       const std::vector<std::string>& methods, std::int64_t rounds) {
  SceneChart chart;
  chart.label = std::filesystem::path(path).stem().string();
  chart.scene = lattice::read_scene(path, options.overrides());
  chart.trials = options.count("trials");
  const dynamics::GateParams& gate = chart.scene.gate;
  const auto space = dynamics::StateSpace::paper(gate);

  const auto reference = run_setting(options, chart, dynamics::reference_setting(gate));
  chart.reference_verdict = reference.verdict();
  chart.reference_evaluations = per_run(reference.health.evaluations, reference.health);
  for (const auto& end : reference.trials)
    ++chart.reference_outcomes[static_cast<std::size_t>(end.outcome)];
  chart.own =
      errors_of(chart, space, run_setting(options, chart, dynamics::second_reference_setting(gate)),
                reference);

  chart.independent_setting = dynamics::chart_settings("stable", gate).back();
  bool compared = false;
  for (const std::string& method : methods) {
    for (const Setting& setting : dynamics::chart_settings(method, gate)) {
      Point point;
      point.setting = setting;
      try {
        const auto run = run_setting(options, chart, setting);
        point.verdict = run.verdict();
        point.health = run.health;
        point.cut_short = run.cut_short;
        point.errors = errors_of(chart, space, run, reference);
        if (name_of(setting) == name_of(chart.independent_setting)) {
          chart.independent = point.errors;
          compared = true;
        }
      } catch (const dynamics::InvalidParameter& e) {
        point.refusal = e.what();
      }
      chart.points.push_back(std::move(point));
    }
  }
  if (!compared) {
    try {
      const auto run = run_setting(options, chart, chart.independent_setting);
      chart.independent = errors_of(chart, space, run, reference);
    } catch (const dynamics::InvalidParameter&) {
      chart.independent.outcomes.total_variation = std::nan("");  // no second opinion
    }
  }
  time_settings(options, chart, rounds);
  return chart;
}

// ---- Files ----

/// A figure as the chart may give it: nothing when it is below what the reference can show.
struct Shown {
  double value = std::nan("");
  bool below = false;
};
Shown shown(double value, double limit) {
  if (std::isfinite(value) && value < limit) return {std::nan(""), true};
  return {value, false};
}

std::string csv_of(const std::vector<SceneChart>& charts) {
  std::ostringstream out;
  out << "scene,method,key,value,default,status,trials,microseconds_min,microseconds_median,"
         "steps_per_trial,evaluations_per_trial,outcome_tv,outcome_tv_se,outcome_tv_chance,"
         "outcome_tv_below,outcomes_changed,column_tv,column_tv_se,column_tv_chance,column_tv_"
         "below,"
         "trials_compared,parted_share,position_median_m,position_median_below_m,"
         "velocity_median_m_per_s,time_median_s,energy_median_J,runs_not_finite,runs_cut_short,"
         "runs_penetrating,runs_creating_energy,"
         "runs_too_fast,runs_beyond_bound,contacts_without_formula,forced_holds,worst_penetration_"
         "m,"
         "worst_energy_created_J,reason\n";
  const auto number = [](double x) { return std::isfinite(x) ? digits(x) : std::string(); };
  for (const SceneChart& chart : charts) {
    for (const Point& p : chart.points) {
      const auto& h = p.health;
      const auto& [outcomes, columns, strong] = p.errors;
      out << csv_text(chart.label) << ',' << p.setting.method << ',' << p.setting.key << ','
          << digits(p.setting.value) << ',' << (p.setting.usual ? 1 : 0) << ','
          << dynamics::name_of(p.verdict) << ',' << h.runs << ',';
      if (!p.ran()) {  // nothing but the reason
        out << std::string(30, ',') << csv_text(p.refusal) << "\n";
        continue;
      }
      const auto weak = [&](const WeakError& e, double limit) {
        const Shown tv = shown(e.total_variation, limit);
        out << number(tv.value) << ',' << (tv.below ? "" : number(e.standard_error)) << ','
            << number(e.chance) << ',' << (tv.below ? number(limit) : "") << ',';
      };
      out << number(least(p.microseconds)) << ',' << number(median(p.microseconds)) << ','
          << number(per_run(h.steps, h)) << ',' << number(per_run(h.evaluations, h)) << ',';
      weak(outcomes, chart.outcome_bound(p.errors));
      out << outcomes.changed << ',';
      weak(columns, chart.column_bound(p.errors));
      out << strong.compared << ',' << number(strong.parted_share()) << ',';
      const Shown position = shown(strong.position, chart.position_limit());
      out << number(position.value) << ','
          << (position.below ? number(chart.position_limit()) : "");
      for (const auto what : {&StrongError::velocity, &StrongError::time, &StrongError::energy})
        out << ',' << number(shown(strong.*what, chart.strong_limit(what)).value);
      out << ',' << h.broken << ',' << p.cut_short << ',' << h.penetrating << ','
          << h.creating_energy << ',' << h.fast << ',' << h.unstable << ',' << h.undefined_contacts
          << ',' << h.forced_holds << ',' << number(h.worst_penetration) << ','
          << number(h.worst_energy_created) << ",\n";
    }
  }
  return out.str();
}

Json to_json(const WeakError& e, double limit) {
  const Shown tv = shown(e.total_variation, limit);
  Json j;
  j["total_variation"] = tv.value;
  j["standard_error"] = tv.below ? std::nan("") : e.standard_error;
  j["chance"] = e.chance;
  j["trials_changed"] = e.changed;
  if (tv.below) j["below"] = limit;
  return j;
}

Json to_json(const StrongError& e, const SceneChart& chart, bool of_reference) {
  Json j;
  j["compared"] = e.compared;
  j["parted"] = e.parted;
  j["parted_share"] = e.parted_share();
  j["trapped_in_both"] = e.trapped;
  const auto add = [&](const char* name, double value, double limit) {
    const Shown median = shown(value, of_reference ? 0.0 : limit);
    j[name]["median"] = median.below ? Json{{"below", limit}} : Json(median.value);
  };
  add("position_m", e.position, chart.position_limit());
  add("velocity_m_per_s", e.velocity, chart.strong_limit(&StrongError::velocity));
  add("time_s", e.time, chart.strong_limit(&StrongError::time));
  add("energy_J", e.energy, chart.strong_limit(&StrongError::energy));
  return j;
}

Json to_json(const Errors& e, const SceneChart& chart, bool of_reference) {
  return {{"outcomes", to_json(e.outcomes, of_reference ? 0.0 : chart.outcome_bound(e))},
          {"columns", to_json(e.columns, of_reference ? 0.0 : chart.column_bound(e))},
          {"strong", to_json(e.strong, chart, of_reference)}};
}

Json to_json(const Options& options, const SceneChart& chart) {
  Json j;
  j["scene"] = chart.label;
  j["trials"] = chart.trials;
  j["timed_trials"] = chart.timed_trials;
  const auto& n = chart.reference_outcomes;
  j["reference"] = {{"setting", name_of(dynamics::reference_setting(chart.scene.gate))},
                    {"status", dynamics::name_of(chart.reference_verdict)},
                    {"evaluations_per_trial", chart.reference_evaluations},
                    {"outcomes",
                     {{"traversed_left", n[0]},
                      {"traversed_right", n[1]},
                      {"exited_left", n[2]},
                      {"exited_right", n[3]},
                      {"trapped", n[4]},
                      {"not_finite", n[5]}}},
                    {"own_error",
                     {{"against", name_of(dynamics::second_reference_setting(chart.scene.gate))},
                      {"errors", to_json(chart.own, chart, true)}}},
                    {"another_method",
                     {{"against", name_of(chart.independent_setting)},
                      {"errors", to_json(chart.independent, chart, true)}}}};
  j["settings"] = Json::array();
  for (const Point& p : chart.points) {
    Json s;
    s["method"] = p.setting.method;
    s["key"] = p.setting.key;
    s["value"] = p.setting.value;
    s["default"] = p.setting.usual;
    s["status"] = dynamics::name_of(p.verdict);
    if (!p.ran()) {
      s["reason"] = p.refusal;
    } else {
      s["microseconds_per_trial"] = {{"min", least(p.microseconds)},
                                     {"median", median(p.microseconds)},
                                     {"rounds", p.microseconds}};
      s["steps_per_trial"] = per_run(p.health.steps, p.health);
      s["evaluations_per_trial"] = per_run(p.health.evaluations, p.health);
      s["runs_cut_short"] = p.cut_short;
      s["errors"] = to_json(p.errors, chart, false);
      s["health"] = gatewalk::cli::to_json(p.health);
    }
    j["settings"].push_back(std::move(s));
  }
  j["made_by"] = manifest(options, chart.scene);
  return j;
}

// ---- Figure ----

char letter_of(Verdict v) {
  switch (v) {
    case Verdict::penetration:
      return 'P';
    case Verdict::energy:
      return 'E';
    case Verdict::too_fast:
      return 'F';
    case Verdict::beyond_bound:
      return 'B';
    case Verdict::no_formula:
      return 'N';
    case Verdict::stuck:
      return 'S';
    case Verdict::not_finite:
      return 'X';
    default:
      return '?';
  }
}

/// Settings that have no place in a panel, with the reason: "paper 0.02 to 0.005 s: not finite".
std::vector<std::string> strip(const std::vector<std::pair<const Point*, std::string>>& without) {
  std::vector<std::string> lines;
  constexpr std::size_t kLongest = 95;  // letters that a panel is wide
  for (std::size_t i = 0; i < without.size();) {
    const auto& [first, reason] = without[i];
    std::size_t last = i;  // of a run of neighbours in the list with the same reason
    while (last + 1 < without.size() && without[last + 1].first == without[last].first + 1 &&
           without[last + 1].first->setting.method == first->setting.method &&
           without[last + 1].second == reason)
      ++last;
    const auto value = [](const Point* p) {
      char text[16];
      std::snprintf(text, sizeof text, "%.3g", p->setting.value);
      return std::string(text);
    };
    const std::string text = first->setting.method + " " + value(first) +
                             (last > i ? " to " + value(without[last].first) : "") +
                             unit_of(first->setting) + ": " + reason;
    if (lines.empty() || lines.back().size() + text.size() > kLongest)
      lines.push_back(lines.empty() ? "no point: " + text : text);
    else
      lines.back() += "; " + text;
    i = last + 1;
  }
  return lines;
}

/// Why a setting that ran has no strong error.
std::string lacks(const StrongError& e, double limit) {
  if (std::isinf(limit)) return "the reference itself parted";
  if (e.compared > 0) return "half or more parted";
  return e.parted > 0 ? "all parted" : "no exits";
}

/// A point's error, its standard error, and what it must reach to be told from no error.
struct Drawn {
  double error, spread, bound;
};

/// One panel: least time per trial against error. What is below its bound is drawn there, as less
/// than that; `limit` is the bound that the reference sets to all. `tag` makes names of data
/// blocks.
template <class Value>
std::string panel(const SceneChart& chart, const std::string& tag, const std::string& title,
                  const std::string& label, double limit, double own, Value value) {
  std::ostringstream blocks, plot;
  std::vector<std::pair<const Point*, std::string>> without;
  std::string separator = "plot ";
  const auto element = [&](const std::string& text) {
    plot << separator << text;
    separator = ", ";
  };
  double lowest = limit, highest = limit;
  double quickest = std::numeric_limits<double>::infinity(), slowest = 0.0;
  std::vector<std::string> methods;
  for (const Point& p : chart.points)
    if (std::find(methods.begin(), methods.end(), p.setting.method) == methods.end())
      methods.push_back(p.setting.method);

  for (const std::string& method : methods) {
    std::string line, good, bars, failed, below, usual;
    for (const Point& p : chart.points) {
      if (p.setting.method != method) continue;
      const auto [error, spread, bound] = value(p);
      const double time = least(p.microseconds);
      if (!p.ran() || !std::isfinite(error) || !std::isfinite(bound)) {
        without.emplace_back(&p, p.ran() ? lacks(p.errors.strong, limit)
                                         : std::string(dynamics::name_of(p.verdict)));
        continue;
      }
      quickest = std::min(quickest, time);
      slowest = std::max(slowest, time);
      const double y = std::max(error, bound);
      const std::string x_y = digits(time) + " " + digits(y);
      line += x_y + "\n";
      const bool fails = p.verdict != Verdict::fine;
      if (fails) failed += x_y + " " + letter_of(p.verdict) + "\n";
      if (error < bound)
        below += x_y + "\n";
      else if (!fails)
        good += x_y + "\n";
      if (error >= bound && std::isfinite(spread))
        bars += x_y + " " + digits(std::max(error - 2 * spread, 0.1 * error)) + " " +
                digits(error + 2 * spread) + "\n";
      if (p.setting.usual) usual += x_y + "\n";
      lowest = std::min(lowest, y);
      highest = std::max(highest, y);
    }
    if (line.empty()) continue;
    const Look look = look_of(method);
    const std::string colour = std::string(" lc rgb '") + look.colour + "'";
    const auto block = [&](const char* kind, const std::string& rows) {
      const std::string name = "$" + tag + "_" + method + "_" + kind;
      blocks << data_block(name, rows);
      return name;
    };
    element(block("line", line) + " using 1:2 with lines lw 1.2" + colour);
    if (!bars.empty())
      element(block("bars", bars) + " using 1:2:3:4 with yerrorbars pt 0 lw 0.8" + colour);
    if (!good.empty())
      element(block("good", good) + " using 1:2 with points ps 0.8 pt " +
              std::to_string(look.marker) + colour);
    if (!below.empty())
      element(block("below", below) + " using 1:2 with points pt 10 ps 1.1 lw 1.5" + colour);
    if (!failed.empty()) {
      const std::string name = block("failed", failed);
      element(name + " using 1:2 with points pt 2 ps 0.8 lw 1.8" + colour);
      element(name + " using 1:2:3 with labels font ',8' offset 0.7,0.5 tc rgb '" + look.colour +
              "'");
    }
    if (!usual.empty())
      element(block("usual", usual) + " using 1:2 with points pt 6 ps 1.8 lw 1.2 lc rgb 'black'");
  }
  if (separator == "plot ") {
    plot << "plot [1:10] [0.1:1] NaN";
  } else {
    if (limit > 0.0 && std::isfinite(limit))
      element(digits(limit) + " with lines dt 2 lw 1 lc rgb '#666666'");
    if (own > 0.0 && own >= 0.01 * lowest) {
      element(digits(own) + " with lines dt 3 lw 1 lc rgb '#666666'");
      lowest = std::min(lowest, own);
    }
  }

  std::ostringstream out;
  const std::vector<std::string> lines = strip(without);
  out << blocks.str() << "unset label\nset title " << literal(chart.label + ": " + title)
      << " offset 0," << 0.3 + 0.8 * static_cast<double>(lines.size()) << "\nset ylabel "
      << literal(label) << "\n";
  for (std::size_t i = 0; i < lines.size(); ++i)
    out << "set label " << 11 + i << " " << literal(lines[i]) << " at graph 0, graph "
        << 1.03 + 0.045 * static_cast<double>(lines.size() - 1 - i)
        << " font ',8' tc rgb '#444444'\n";
  if (limit > 0.0 && slowest > 0.0)
    out << "set label 10 'below: not told from the reference' at graph 0.99, first "
        << digits(limit) << " right offset 0,-0.6 font ',8' tc rgb '#666666'\n";
  if (slowest > 0.0)
    out << "set xrange [" << digits(quickest / 1.5) << ":" << digits(slowest * 1.5)
        << "]\nset xtics nomirror (" << tics_1_2_5(quickest / 1.5, slowest * 1.5)
        << ")\nset yrange [" << digits(lowest / 2.5) << ":" << digits(highest * 2.0) << "]\n";
  out << plot.str() << "\n";
  return out.str();
}

void draw(const std::string& path, const std::vector<SceneChart>& charts) {
  const int rows = static_cast<int>(charts.size());
  constexpr int kRow = 395;
  const int header = 60, height = kRow * rows + header;
  std::ostringstream out;
  out << "set multiplot\nset format y '10^{%L}'\nset xtics nomirror\n"
         "set ytics nomirror\nset border 3\n"
         "set grid lc rgb '#eeeeee' lt 1\nunset key\nset xlabel 'least time per trial (µs)' offset "
         "0,0.3\n"
         "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\n";
  for (int row = 0; row < rows; ++row) {
    const SceneChart& chart = charts[static_cast<std::size_t>(row)];
    const double top = 1.0 - static_cast<double>(header + kRow * row + 86) / height;
    const double bottom = top - 240.0 / height;
    const auto place = [&](double left, double right) {
      out << "set lmargin at screen " << left << "\nset rmargin at screen " << right
          << "\nset tmargin at screen " << top << "\nset bmargin at screen " << bottom << "\n";
    };
    if (row == 0) {
      // The legend, drawn with a plot that has nothing else.
      out << "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\n"
             "set bmargin at screen 0\nunset border\nunset tics\nunset xlabel\n";
      double x = 0.02;
      const double y = 1.0 - 16.0 / height;
      int label = 10;
      const auto entry = [&](const std::string& text, const std::string& point, double width) {
        out << "set label " << label++ << " " << literal(text) << " at screen " << x << ", screen "
            << y << " left point " << point << " offset 1,0\n";
        x += width;
      };
      std::set<std::string> drawn;
      for (const Point& p : chart.points) {
        if (!drawn.insert(p.setting.method).second) continue;
        const Look look = look_of(p.setting.method);
        entry(p.setting.method,
              "pt " + std::to_string(look.marker) + " ps 0.8 lc rgb '" + look.colour + "'", 0.085);
      }
      entry("usual: the method's default", "pt 6 ps 1.8 lc rgb 'black'", 0.21);
      entry("less: below what the reference or chance can show", "pt 10 ps 1.1 lc rgb '#444444'",
            0.3);
      out << "set label " << label++ << " "
          << literal(
                 "x fails: E energy from nothing, P disc sinks into a beam, F too fast for its "
                 "steps, "
                 "S stuck, N contact without a formula, B beyond the stability bound, X not "
                 "finite. "
                 "Bars: 2 standard errors.")
          << " at screen 0.016, screen " << 1.0 - 40.0 / height << " font ',10'\n"
          << "plot [0:1] [0:1] NaN\nunset label\nset border 3\nset xtics nomirror\n"
             "set ytics nomirror\nset xlabel 'least time per trial (µs)' offset 0,0.3\n"
             "set logscale xy\n";
    }
    place(0.075, 0.485);
    const std::string tag = "S" + std::to_string(row);
    out << panel(chart, tag + "weak", "distribution of outcomes", "total variation",
                 chart.outcome_limit(), chart.own.outcomes.total_variation, [&](const Point& p) {
                   const WeakError& e = p.errors.outcomes;
                   return Drawn{e.total_variation, e.standard_error, chart.outcome_bound(p.errors)};
                 });
    place(0.575, 0.985);
    out << panel(chart, tag + "strong", "where a trial ends, median", "distance (m)",
                 chart.position_limit(), chart.own.strong.position, [&](const Point& p) {
                   return Drawn{p.errors.strong.position, std::nan(""), chart.position_limit()};
                 });
  }
  out << "unset multiplot\n";
  draw_svg(path, 1000, height, out.str());
}

// ---- Table ----

/// The cheapest setting without faults whose outcomes are shown to be within run.tolerance.
std::string advice(const SceneChart& chart) {
  const double tolerance = chart.scene.gate.run.tolerance;
  const Point* best = nullptr;
  for (const Point& p : chart.points) {
    const double most = std::max(p.errors.outcomes.total_variation, chart.outcome_bound(p.errors));
    if (p.verdict != Verdict::fine || !(most <= tolerance)) continue;
    if (best == nullptr || least(p.microseconds) < least(best->microseconds)) best = &p;
  }
  const std::string text =
      "  cheapest setting without faults, outcomes within " + digits(tolerance) + ": ";
  return text +
         (best == nullptr ? "none shown; more --trials may show one" : name_of(best->setting)) +
         "\n";
}

std::string table_of(const SceneChart& chart) {
  std::ostringstream out;
  const auto& n = chart.reference_outcomes;
  const auto share = [&](std::size_t i) {
    return percent(static_cast<double>(n[i]), static_cast<double>(chart.trials));
  };
  const auto of_reference = [&](const Errors& e, const Setting& against) {
    out << "  against " << padded(name_of(against), -20) << " outcomes "
        << digits(e.outcomes.total_variation) << ", columns " << digits(e.columns.total_variation)
        << ", exit " << quantity(e.strong.position, "m") << ", parted "
        << percent(e.strong.parted_share(), 1.0, 3) << "\n";
  };
  out << chart.label << ": " << chart.trials << " trials per setting, " << chart.timed_trials
      << " timed\n"
      << "  reference " << name_of(dynamics::reference_setting(chart.scene.gate)) << " ("
      << dynamics::name_of(chart.reference_verdict) << "): traversed left " << share(0)
      << ", right " << share(1) << ", exited left " << share(2) << ", right " << share(3)
      << ", trapped " << share(4) << "\n";
  of_reference(chart.own, dynamics::second_reference_setting(chart.scene.gate));
  of_reference(chart.independent, chart.independent_setting);
  out << "  setting                us/trial   steps  outcomes  +-        chance    columns   exit "
         "(m)   "
         "parted   status\n";
  for (const Point& p : chart.points) {
    out << (p.setting.usual ? "* " : "  ") << padded(name_of(p.setting), -20);
    if (!p.ran()) {
      out << "   refused: " << p.refusal << "\n";
      continue;
    }
    const auto text = [](double value, double limit) {
      const Shown s = shown(value, limit);
      char buffer[32];
      if (s.below)
        std::snprintf(buffer, sizeof buffer, "<%.1e", limit);
      else
        std::snprintf(buffer, sizeof buffer, std::isfinite(value) ? "%.2e" : "-", value);
      return std::string(buffer);
    };
    const auto& e = p.errors;
    const bool below = e.outcomes.total_variation < chart.outcome_bound(e);
    out << padded(fixed(least(p.microseconds), 1), 11)
        << padded(fixed(per_run(p.health.steps, p.health), 0), 8) << "  "
        << padded(text(e.outcomes.total_variation, chart.outcome_bound(e)), -10)
        << padded(below ? "" : text(e.outcomes.standard_error, 0.0), -10)
        << padded(text(e.outcomes.chance, 0.0), -10)
        << padded(text(e.columns.total_variation, chart.column_bound(e)), -10)
        << padded(text(e.strong.position, chart.position_limit()), -11)
        << padded(percent(e.strong.parted_share(), 1.0, 2), 8) << "  "
        << dynamics::name_of(p.verdict) << "\n";
  }
  out << advice(chart);
  return out.str();
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<std::string> chosen_methods(const Options& options) {
  const auto known = dynamics::chart_methods();
  if (!options.has("methods")) return {known.begin(), known.end()};
  std::vector<std::string> methods = split(options.text("methods"));
  std::string names;
  for (const auto name : known) names += (names.empty() ? "" : ", ") + std::string(name);
  if (methods.empty()) throw UsageError("--methods needs at least one of " + names);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (std::find(known.begin(), known.end(), methods[i]) == known.end())
      throw UsageError("--methods: no method '" + methods[i] + "'; there are " + names);
    if (std::find(methods.begin(), methods.begin() + static_cast<std::ptrdiff_t>(i), methods[i]) !=
        methods.begin() + static_cast<std::ptrdiff_t>(i))
      throw UsageError("--methods: " + methods[i] + " stands there twice");
  }
  return methods;
}

constexpr std::int64_t kMostTrials =
    10'000'000;  // the ends of four settings at a time are in memory: 2 GB

/// A mistake is said before long work, not after it.
void require_chartable(const std::string& path, const lattice::Scene& scene) {
  try {
    (void)dynamics::StateSpace::paper(scene.gate);  // refuses gates too short for their beams
    for (const Setting& s :
         {dynamics::reference_setting(scene.gate), dynamics::second_reference_setting(scene.gate)})
      (void)dynamics::make_method(s.applied_to(scene.gate));
  } catch (const dynamics::InvalidParameter& e) {
    throw lattice::SceneError(path + ": no reference for a chart: " + e.what());
  }
}

}  // namespace

int run_chart(const std::vector<std::string>& arguments) {
  Options options(
      "chart SCENE... -o DIR [options]",
      "Charts the methods' speed against their accuracy, each over its own settings: time per\n"
      "trial on one thread, and error against a reference under the same noise. Writes chart.csv\n"
      "and chart.json, again after each scene, and chart.svg. With 1e5 trials a scene takes some\n"
      "ten minutes; --trials 2000 --repeats 3 gives a first look in one.",
      "gatewalk chart scenes/field.toml scenes/stiff.toml -o results/chart --trials 1e4");
  options.positional_list("scene", "scene files (TOML); a scene is called by its file's name");
  constexpr std::array kFiles{"chart.csv", "chart.json", "chart.svg"};
  options.output_folder("folder to write to", {kFiles.begin(), kFiles.end()});
  options.add()("trials", po::value<Count>()->default_value(Count{100'000}, "1e5")->value_name("N"),
                "trials per setting")(
      "repeats", po::value<Count>()->default_value(Count{10}, "10")->value_name("N"),
      "rounds of timing, after one that warms up")("methods",
                                                   po::value<std::string>()->value_name("A,B,..."),
                                                   "methods to chart (default: all)");
  add_seed(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const std::vector<std::string> methods = chosen_methods(options);
  (void)options.count("trials", 1, kMostTrials);
  const std::int64_t rounds = options.count("repeats");
  const auto& paths = options.get<std::vector<std::string>>("scene");
  std::set<std::string> labels;
  for (const std::string& path : paths) {
    require_chartable(path, lattice::read_scene(path, options.overrides()));
    if (!labels.insert(std::filesystem::path(path).stem().string()).second)
      throw UsageError("two scenes are called " + std::filesystem::path(path).stem().string());
  }
  const std::string folder = options.text("output");
  const auto file = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  require_folder(folder);

  std::vector<SceneChart> charts;
  Json json;
  json["machine"] = machine();
  json["scenes"] = Json::array();
  std::string table;
  try {
    for (const std::string& path : paths) {
      charts.push_back(chart_scene(options, path, methods, rounds));
      json["scenes"].push_back(to_json(options, charts.back()));
      table += (table.empty() ? "" : "\n") + table_of(charts.back());
      std::filesystem::remove(
          file("chart.svg"));  // an old figure shall not stand beside new numbers
      write_text_atomically(file("chart.csv"), csv_of(charts));
      write_text_atomically(file("chart.json"), text_of(json) + "\n");
    }
  } catch (const Interrupted&) {
    if (charts.empty()) throw;
    draw(file("chart.svg"), charts);
    warn("stopped before the end; " + file("chart.csv") + ", chart.json and chart.svg hold the " +
         std::to_string(charts.size()) + " of " + std::to_string(paths.size()) +
         " scenes that were finished");
    return kStopped;
  }
  options.give_out(json, table + "\n* usual: the method's default. us/trial: least of " +
                             std::to_string(rounds) + " rounds on one thread, " + machine() +
                             "\noutcomes, columns: total variation from the reference, of the "
                             "outcomes and of the crossing"
                             "\nstates; +-: its standard error; chance: what chance alone would "
                             "show; <: not told from no error."
                             "\nexit (m): median distance at the exit; parted: share of exits that "
                             "took another course, these count"
                             "\nas infinitely far. status: ok, or the worst fault seen.\n");
  draw(file("chart.svg"), charts);
  for (const SceneChart& chart : charts)
    if (chart.reference_verdict != Verdict::fine)
      warn(chart.label + ": the reference itself shows faults: " +
           std::string(dynamics::name_of(chart.reference_verdict)));
  return exit_status(options,
                     std::all_of(charts.begin(), charts.end(), [](const SceneChart& chart) {
                       return chart.reference_verdict == Verdict::fine;
                     }));
}

}  // namespace gatewalk::cli
