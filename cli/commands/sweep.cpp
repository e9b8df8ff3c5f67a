#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

constexpr std::size_t kMostPoints = 100'000;

/// A varied key and its values as text, ready for --set.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  if (text.ends_with(at)) parts.emplace_back();
  return parts;
}

double number_in(const std::string& text, const lattice::Variation& v) {
  double x = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), x);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(x))
    throw lattice::SceneError(v.origin + ": '" + text + "' in '" + v.values + "' is not a number");
  return x;
}

/// "4:1:9": 4, 5, ... 9; "4:9" in steps of 1, as in MATLAB; or values between commas.
Axis axis_of(const lattice::Variation& v) {
  Axis axis{v.key, {}};
  const auto ends = split(v.values, ':');
  if (ends.size() <= 1) {
    axis.values = split(v.values, ',');
    if (axis.values.empty() || std::any_of(axis.values.begin(), axis.values.end(),
                                           [](const std::string& s) { return s.empty(); }))
      throw lattice::SceneError(v.origin + ": '" + v.values +
                                "' lacks a value: from:step:to, or values between commas");
    return axis;
  }
  if (ends.size() > 3)
    throw lattice::SceneError(v.origin + ": '" + v.values + "' is not from:step:to");
  const double from = number_in(ends.front(), v), to = number_in(ends.back(), v);
  const double step = ends.size() == 3 ? number_in(ends[1], v) : 1.0;
  if (step == 0.0) throw lattice::SceneError(v.origin + ": the step in '" + v.values + "' is 0");
  const double count = std::floor((to - from) / step + 1e-9) + 1.0;
  if (!(count >= 1.0))
    throw lattice::SceneError(v.origin + ": '" + v.values +
                              "' holds no value: the step leads away from the end");
  if (count > static_cast<double>(kMostPoints))
    throw lattice::SceneError(v.origin + ": '" + v.values + "' holds more than " +
                              std::to_string(kMostPoints) + " values");
  for (int i = 0; i < static_cast<int>(count); ++i) {
    std::ostringstream text;
    text.precision(15);  // 0.1 * 3 is 0.3
    const double value = from + i * step;
    text << (std::abs(value) < 1e-9 * std::abs(step) ? 0.0 : value);
    axis.values.push_back(text.str());
  }
  return axis;
}

/// The scene's own variations, replaced and completed by those of --vary.
std::vector<Axis> axes_of(const std::vector<lattice::Variation>& own,
                          const std::vector<std::string>& given) {
  std::vector<lattice::Variation> all = own;
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string origin = "--vary " + text;
    if (equals == text.npos)
      throw lattice::SceneError(origin + ": must be key=from:step:to or key=value,value");
    const lattice::Variation v{text.substr(0, equals), text.substr(equals + 1), origin};
    lattice::require_key(v.key, origin);
    const auto same = std::find_if(all.begin(), all.end(),
                                   [&](const lattice::Variation& a) { return a.key == v.key; });
    if (same == all.end()) {
      all.push_back(v);
    } else if (same->origin.starts_with("--vary")) {
      throw lattice::SceneError(origin + ": " + v.key + " is varied twice");
    } else {
      *same = v;
    }
  }
  if (all.empty())
    throw UsageError(
        "nothing to vary: give --vary KEY=from:step:to, or a scene with a table [sweep]");
  std::vector<Axis> axes;
  std::size_t points = 1;
  for (const lattice::Variation& v : all) {
    axes.push_back(axis_of(v));
    points *= axes.back().values.size();
    if (points > kMostPoints)
      throw lattice::SceneError(v.origin + ": the grid has more than " +
                                std::to_string(kMostPoints) + " points");
  }
  return axes;
}

struct Point {
  std::vector<std::string> values;  // one per axis
  lattice::Scene scene;
  Json settled;
  dynamics::GateTally tally;
};

/// Every combination, the last axis running fastest.
std::vector<Point> grid_of(const Options& options, const std::string& scene,
                           const std::vector<Axis>& axes) {
  std::vector<Point> points(1);
  for (const Axis& axis : axes) {
    std::vector<Point> longer;
    for (const Point& p : points)
      for (const std::string& value : axis.values) {
        longer.push_back(p);
        longer.back().values.push_back(value);
      }
    points = std::move(longer);
  }
  for (Point& p : points) {
    std::vector<std::string> overrides = options.overrides();
    for (std::size_t i = 0; i < axes.size(); ++i)
      overrides.push_back(axes[i].key + "=" + p.values[i]);
    p.scene = lattice::parse_scene(scene, options.text("scene"), overrides);
    p.scene.sweep.clear();  // this is one of its points
  }
  return points;
}

/// What a share is of, and how many of those. Right of those that pushed more past one beam than
/// past the other: the paper's Fig. 12.
struct Share {
  const char* name;
  std::int64_t part, whole;
};
std::vector<Share> shares_of(const dynamics::GateTally& t) {
  return {{"traversed", t.traversed(), t.trials},
          {"traversed_left", t.traversed_left, t.trials},
          {"traversed_right", t.traversed_right, t.trials},
          {"exited", t.exited_left + t.exited_right, t.trials},
          {"trapped", t.trapped, t.trials},
          {"right_of_traversed", t.traversed_right, t.traversed_left + t.traversed_right}};
}

std::string csv_of(const std::vector<Axis>& axes, const std::vector<Point>& points) {
  std::ostringstream out;
  out.precision(8);
  for (const Axis& axis : axes) out << axis.key << ',';
  out << "method,trials,traversed_left_count,traversed_right_count,traversed_even_count,exited_"
         "left_count,"
         "exited_right_count,trapped_count,not_finite_count";
  for (const Share& s : shares_of({}))
    out << ',' << s.name << ',' << s.name << "_low," << s.name << "_high";
  out << ",clean\n";
  for (const Point& p : points) {
    const dynamics::GateTally& t = p.tally;
    for (const std::string& value : p.values) out << csv_text(value) << ',';
    out << p.scene.gate.run.method << ',' << t.trials << ',' << t.traversed_left << ','
        << t.traversed_right << ',' << t.traversed_even << ',' << t.exited_left << ','
        << t.exited_right << ',' << t.trapped << ',' << t.broken;
    for (const Share& s : shares_of(t)) {
      if (s.whole == 0) {
        out << ",,,";  // of none there is no share
        continue;
      }
      const auto [low, high] = share_interval(s.part, s.whole);
      out << ',' << static_cast<double>(s.part) / static_cast<double>(s.whole) << ',' << low << ','
          << high;
    }
    out << ',' << t.health.clean() << '\n';
  }
  return out.str();
}

std::string table_of(const lattice::Scene& scene, const std::vector<Axis>& axes,
                     const std::vector<Point>& points) {
  std::string text = scene_line(scene) + "but for the keys varied. " +
                     std::to_string(points.size()) + " points of " +
                     std::to_string(points.front().tally.trials) +
                     " trials, all under the same noise; % of them with 95 % intervals.\n\n";
  std::vector<int> widths;
  for (const Axis& axis : axes) {
    std::size_t width = axis.key.size();
    for (const std::string& v : axis.values) width = std::max(width, v.size());
    widths.push_back(static_cast<int>(width) + 2);
    text += padded(axis.key, widths.back());
  }
  text += "   traversed             right of those        exited   trapped\n";
  for (const Point& p : points) {
    for (std::size_t i = 0; i < axes.size(); ++i) text += padded(p.values[i], widths[i]);
    const auto shares = shares_of(p.tally);
    const auto with_interval = [](const Share& s) {
      if (s.whole == 0) return padded("-", 6) + std::string(16, ' ');
      const auto [low, high] = share_interval(s.part, s.whole);
      return padded(fixed(100.0 * static_cast<double>(s.part) / static_cast<double>(s.whole), 1),
                    6) +
             padded(" [" + fixed(100.0 * low, 1) + ", " + fixed(100.0 * high, 1) + "]", -16);
    };
    text +=
        "    " + with_interval(shares[0]) + with_interval(shares[5]) +
        padded(percent(static_cast<double>(shares[3].part), static_cast<double>(shares[3].whole)),
               8) +
        padded(percent(static_cast<double>(shares[4].part), static_cast<double>(shares[4].whole)),
               10) +
        (p.tally.health.clean() ? "\n" : "  faults\n");
  }
  return text;
}

}  // namespace

int run_sweep(const std::vector<std::string>& arguments) {
  Options options(
      "sweep SCENE [options]",
      "Runs one gate many times at every point of a grid over any keys of the scene and counts "
      "how\n"
      "the runs end. Values are from:step:to or a list; the grid is all their combinations. A "
      "scene\n"
      "may bring its own in a table [sweep]; --vary adds to it or replaces its values of a key.",
      "gatewalk sweep scenes/single_gate.toml --vary forces.propulsion_N=4:1:9 "
      "--vary forces.random_N=0,10,20 --trials 1000 --csv sweep.csv");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "runs of the gate at each point");
  add_strict(options);
  options.add()("vary",
                po::value<std::vector<std::string>>()->composing()->value_name("KEY=VALUES"),
                "a key and its values, e.g. forces.random_N=0:10:40 or run.method=stable,paper "
                "(may be repeated)");
  options.output_file("csv", "FILE", "write the grid as CSV; - is standard output");
  if (!options.parse(arguments)) return kFine;
  const std::string csv = options.text("csv");
  const std::int64_t trials = options.count("trials");
  const std::string text = lattice::scene_text(options.text("scene"));
  const lattice::Scene scene =
      lattice::parse_scene(text, options.text("scene"), options.overrides());
  const std::vector<Axis> axes =
      axes_of(scene.sweep, options.has("vary") ? options.get<std::vector<std::string>>("vary")
                                               : std::vector<std::string>());
  for (const std::string& set : options.overrides())
    for (const std::string& key : lattice::keys_set_by(set))
      for (const Axis& axis : axes)
        if (key == axis.key)
          throw UsageError("--set " + set + " has no effect: " + key + " is varied; --vary " + key +
                           "=VALUE fixes it");
  std::vector<Point> points = grid_of(options, text, axes);

  constexpr std::int64_t kEach = 1000;  // of the progress line
  Progress progress("sweep", kEach * static_cast<std::int64_t>(points.size()), options.talk());
  dynamics::Health health;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& p = points[i];
    p.settled = settle_method(options, p.scene, lattice::RunsFrom::start);
    run_in_batches(progress, static_cast<double>(kEach * static_cast<std::int64_t>(i)),
                   static_cast<double>(kEach) / static_cast<double>(trials), trials,
                   [&](std::int64_t first, std::int64_t n) {
                     p.tally += dynamics::run_gate_trials(p.scene.gate, p.scene.start,
                                                          options.seed(), {first, n});
                   });
    lattice::check_outcomes(p.scene, lattice::RunsFrom::start, options.seed(), trials,
                            p.tally.health, options.work());
    health += p.tally.health;
  }
  progress.finish();

  const auto value = [](const std::string& given) {
    const Json number = Json::parse(given, nullptr, false);
    return number.is_number() ? number : Json(given);
  };
  Json json;
  json["vary"] = Json::array();
  for (const Axis& axis : axes) {
    json["vary"].push_back({{"key", axis.key}, {"values", Json::array()}});
    for (const std::string& v : axis.values) json["vary"].back()["values"].push_back(value(v));
  }
  json["points"] = Json::array();
  for (const Point& p : points) {
    Json point;
    for (std::size_t i = 0; i < axes.size(); ++i) point["at"][axes[i].key] = value(p.values[i]);
    point.update(to_json(p.tally));
    const Share right = shares_of(p.tally).back();
    if (right.whole > 0)
      point["intervals_95"][right.name] = share_interval(right.part, right.whole);
    if (!p.settled.is_null()) point["method"] = p.settled;
    point["status"] = to_json(p.tally.health);
    json["points"].push_back(std::move(point));
  }
  json["made_by"] = manifest(options, scene);

  if (csv == "-") {
    write_text_atomically("-", csv_of(axes, points));
    if (!options.text("json").empty()) options.give_out(json, "");
  } else {
    if (!csv.empty()) write_text_atomically(csv, csv_of(axes, points));
    options.give_out(json, table_of(scene, axes, points));
  }
  if (!health.clean()) warn(complaint(health));
  return exit_status(options, std::all_of(points.begin(), points.end(),
                                          [](const Point& p) { return p.tally.health.clean(); }));
}

}  // namespace gatewalk::cli
