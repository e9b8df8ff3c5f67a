// SPDX-License-Identifier: MIT
#include "cli/render/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"

namespace gatewalk::cli {

using dynamics::FinishedMap;
using dynamics::Limit;
using dynamics::LimitNumberInfo;
using dynamics::MapAxis;
using dynamics::MethodLimits;
using dynamics::Verdict;

namespace {

const LimitNumberInfo& info_of(dynamics::LimitNumber number) {
  return dynamics::limit_numbers()[static_cast<std::size_t>(number)];
}

// ---- Result ----

void describe_sign(Fields& out, Verdict verdict) {
  const dynamics::Sign& sign = dynamics::sign_of(verdict);
  out.text({"sign", "what the program's warning says of this fault; empty: none"}, sign.words);
  out.text({"status_key", "number of a result's status that shows this fault; empty: none does"},
           sign.key);
}

void describe_axis(Fields& out, const MapAxis& axis) {
  out.text({"name", "what varies along this axis"}, axis.name);
  out.text({"unit", "unit of the values; 1: a pure number"}, axis.unit);
  out.numbers({"values", "its own", "values along this axis"}, axis.values);
  out.number({"own", "its own", "the scene's own value; null: the scene has none"},
             axis.own ? axis.values[*axis.own] : kUnknown);
}

void describe(Fields& out, const Limit& limit) {
  out.text({"number", "what varies; step or tolerance is what sets how exact the method is"},
           limit.axis.name);
  out.text({"unit", "unit of the numbers beside; 1: a pure number"}, limit.axis.unit);
  out.number({"own", "its own", "the scene's own value; null: the scene has none"},
             limit.axis.own ? limit.axis.values[*limit.axis.own] : kUnknown);
  out.number({"fine_to", "its own",
              "last value without fault on the way to fault_at; null: the first one has it"},
             limit.fine_to.value_or(kUnknown));
  out.number({"fault_at", "its own",
              "value nearest to own at which the method shows a fault; null: none does"},
             limit.fault_at.value_or(kUnknown));
  out.number({"factor", "1", "fault_at / own; null: one of them is missing"},
             limit.factor().value_or(kUnknown));
  out.text(status_label("worst fault of the trials at fault_at; ok: none within the map"),
           dynamics::name_of(limit.verdict));
  describe_sign(out, limit.verdict);
  out.maybe({"remedy", "what helps at fault_at; null: nothing that was tried, or no fault"},
            limit.remedy, [](Fields& f, const dynamics::Remedy& r) {
              f.if_any({"method", "value to give run.method, if it is to change"},
                       r.method.empty() ? std::nullopt : std::optional(r.method));
              f.if_any({"setting",
                        "key of the scene to change, if it is: run.step_s or "
                        "run.event_tolerance_m"},
                       r.key.empty() ? std::nullopt : std::optional(r.key));
              f.if_any({"value", "s or m", "value to give it"},
                       r.key.empty() ? std::nullopt : std::optional(r.value));
            });
}

void describe(Fields& out, const MethodLimits& m) {
  out.text({"name", "run.method of the trials"}, m.method);
  out.text(Label("setting", "key of the scene that sets how exact the method is")
               .one_of({"run.step_s", "run.event_tolerance_m"}),
           m.own.key);
  out.number({"value", "s or m",
              "its value in this scene: the scene's, or the default of the method, in the unit "
              "that ends the key's name"},
             m.own.value);
  out.text(status_label("worst fault of the scene's own trials, or ok"),
           dynamics::name_of(m.verdict));
  describe_sign(out, m.verdict);
  out.object({"health", "numerical faults of the scene's own trials"},
             [&](Fields& f) { cli::describe(f, m.health); });
  out.list({"limits",
            "nearest fault along each axis, all else as in the scene; the first contact "
            "near a joint and the graze from the mildest on"},
           m.limits, [](Fields& f, const Limit& l) { describe(f, l); });
}

void describe(Fields& out, const FinishedMap& m, const dynamics::LimitScene& scene) {
  const auto& [map, points, seconds] = m;
  out.text({"number", "what varies beside the step"}, info_of(map.number).name);
  out.text({"method", "run.method of the trials"}, map.method);
  out.object({"x", "horizontal axis"}, [&](Fields& f) { describe_axis(f, map.x); });
  out.object({"y", "vertical axis"}, [&](Fields& f) { describe_axis(f, map.y); });
  TextRows status(map.y.values.size());
  for (std::size_t iy = 0; iy < status.size(); ++iy)
    for (std::size_t ix = 0; ix < map.x.values.size(); ++ix)
      status[iy].emplace_back(std::string(dynamics::name_of(m.at(ix, iy).verdict)));
  out.text_rows(
      {"status", "worst fault in the trials of each point, or ok; one row for each value of y"},
      status);
  out.list({"borders", "borders known without trials, as lines"},
           points.empty() ? std::vector<dynamics::Border>() : dynamics::borders(scene, map),
           [](Fields& f, const dynamics::Border& b) {
             f.text({"label", "what the line is"}, b.label);
             f.numbers({"x", "its own", "coordinates of the line's points on the axis x"}, b.x);
             f.numbers({"y", "its own", "coordinates of the line's points on the axis y"}, b.y);
           });
}

}  // namespace

void describe(Fields& out, const LimitsResult& result) {
  out.text({"scene", "name of the scene"}, result.label);
  out.texts({"types_not_charted", "other types of gates that the scene has"}, result.other_types);
  out.count({"trials_per_point", "1", "number of trials at each point"},
            result.scene.options.trials);
  out.number({"holds_share", "1",
              "limit of the share of steps forced to hold; beyond it the status is stuck"},
             dynamics::Health::kPermittedHolds);
  out.list({"methods", "how far each method is from its nearest faults"}, result.limits,
           [](Fields& f, const MethodLimits& m) { describe(f, m); });
  out.list({"maps", "one map for each number and each method"}, result.maps,
           [&](Fields& f, const FinishedMap& m) { describe(f, m, result.scene); });
  describe_made_by(out, result.made_by);
}

std::string csv_of(const std::vector<FinishedMap>& maps) {
  Csv csv(
      "number,method,x_name,x,y_name,y,own,status,trials,not_finite,cut_short,penetrating,"
      "creating_energy,too_fast,beyond_bound,contacts_without_formula,forced_holds,outcome_error,"
      "steps,evaluations,worst_penetration_m,worst_energy_created_J,worst_speed_m_per_s");
  for (const FinishedMap& m : maps) {
    const std::string number(info_of(m.map.number).name), x(m.map.x.name), y(m.map.y.name);
    for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
        const dynamics::MapPoint& p = m.at(ix, iy);
        const dynamics::Health& h = p.health;
        csv.row(number, m.map.method, x, m.map.x.values[ix], y, m.map.y.values[iy],
                static_cast<int>(m.map.x.own == ix && m.map.y.own == iy),
                std::string(dynamics::name_of(p.verdict)), h.runs, h.broken, p.out_of_work,
                h.penetrating, h.creating_energy, h.fast, h.unstable, h.undefined_contacts,
                h.forced_holds, h.outcome_error, h.steps, h.evaluations, h.worst_penetration,
                h.worst_energy_created, h.worst_speed);
      }
  }
  return csv.text();
}

// ---- Table ----

namespace {

/// The factor to the nearest fault: "x3.2", "/10"; "at 0.9", "<0.01" on axes without factors; "-":
/// no fault. For a scene that has a fault itself, the nearest step without one: "ok /4".
std::string cell_of(const Limit& limit, const MethodLimits& method) {
  if (!limit.fault_at) return "-";
  const auto factor = [](double f) {
    const double most = std::max(f, 1.0 / f);
    return (f > 1.0 ? "x" : "/") + digits(most, most < 10.0 ? 2 : 3);
  };
  if (!limit.axis.own) return limit.fine_to ? "<" + digits(*limit.fine_to, 2) : "all";
  if (method.verdict == Verdict::fine)
    return limit.axis.logarithmic ? factor(*limit.factor()) : "at " + digits(*limit.fault_at, 2);
  const bool is_finer_step =
      &limit == &method.limits.front() && limit.remedy && limit.remedy->method.empty();
  return is_finer_step ? "ok " + factor(limit.remedy->value / method.own.value) : ".";
}

/// The setting as a scene and --set take it, with enough digits for the step to divide the random
/// force's hold. It has no blanks, so that a screen never breaks it.
std::string setting_of(const dynamics::Remedy& remedy) {
  std::string text = remedy.method.empty() ? "" : fmt::format("run.method=\"{}\"", remedy.method);
  if (!remedy.key.empty())
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", remedy.key, digits(remedy.value));
  return text;
}

/// What helps at a fault of a method.
std::string advice_of(const Limit& limit, const MethodLimits& m) {
  if (!limit.remedy) return "nothing that was tried helps";
  const dynamics::Remedy& r = *limit.remedy;
  const bool is_fine = m.verdict == Verdict::fine, is_own = r.method.empty() &&
                                                            r.key == m.own.key &&
                                                            digits(r.value) == digits(m.own.value);
  if (is_own) return "the scene's own value has no fault";
  return (is_fine ? "there take " : "take ") + setting_of(r);
}

/// "stable, moreau and event"
std::string listed(const std::vector<std::string>& names) {
  if (names.size() < 2) return names.front();
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

/// Which methods show no fault at the scene's own numbers.
std::string sound_methods(const LimitsResult& result) {
  std::vector<std::string> sound, faulty;
  for (const MethodLimits& m : result.limits)
    (m.verdict == Verdict::fine ? sound : faulty).emplace_back(m.method);
  if (sound.empty()) return "every method shows faults";
  if (faulty.empty()) return "no method shows a fault";
  return fmt::format("{} show{} no fault; {} do{}", listed(sound), sound.size() == 1 ? "s" : "",
                     listed(faulty), faulty.size() == 1 ? "es" : "");
}

/// A line on a method.
std::string sentence_of(const MethodLimits& m) {
  const bool is_fine = m.verdict == Verdict::fine;
  const Limit* const limit = is_fine ? m.nearest() : &m.limits.front();
  if (!limit) return fmt::format("  {:<9}shows no fault at the values tried\n", m.method);
  const dynamics::Sign& sign = dynamics::sign_of(limit->verdict);
  return wrapped(
      fmt::format("  {:<9}{}: {}{}; {}", m.method,
                  is_fine ? fmt::format("{} {}", limit->axis.name, cell_of(*limit, m)) : "here",
                  sign.words, sign.key.empty() ? "" : fmt::format(" ({})", sign.key),
                  advice_of(*limit, m)),
      std::string(11, ' '));
}

}  // namespace

std::string answer_text(const LimitsResult& result) {
  const std::string types =
      result.other_types.empty()
          ? ""
          : fmt::format(", not of type {}", fmt::join(result.other_types, " or "));
  std::string text = wrapped(fmt::format(
      "{}: at the scene's own numbers {} ({} at each point; its own gate{}). The nearest faults:",
      result.label, sound_methods(result), counted(result.scene.options.trials, "trial", "trials"),
      types));
  for (const MethodLimits& m : result.limits) text += sentence_of(m);
  return text +
         "x3: at 3 times the scene's number; /3: at a third of it; at 1: at this value; here: "
         "at its own.\n";
}

std::string details_text(const LimitsResult& result) {
  const auto& first = result.limits.front().limits;
  constexpr std::size_t kBeside = 6;  // limits that fit into the width of a screen
  std::string text;
  for (std::size_t begin = 0; begin < first.size(); begin += kBeside) {
    const std::size_t end = std::min(begin + kBeside, first.size());
    std::vector<TextColumn> columns{
        {"", -kFit, 0, "", "  "}, {"its own", kFit, 0, "", "  "}, {"here", -kFit, 0, "", "  "}};
    for (std::size_t k = begin; k < end; ++k)
      columns.push_back({std::string(first[k].axis.name.substr(first[k].axis.name.find('_') + 1)),
                         kFit, 0, "", "  "});
    TextTable table(columns);
    for (const MethodLimits& m : result.limits) {
      std::vector<TextCell> cells{m.method, quantity(m.own.value, m.own.unit(), 3),
                                  dynamics::name_of(m.verdict)};
      for (std::size_t k = begin; k < end; ++k) cells.emplace_back(cell_of(m.limits[k], m));
      table.row(cells);
    }
    text += "\n" + table.text();
  }
  return text +
         "x3: a fault at 3 times the scene's number, and none at the values tried before. -: no "
         "fault\n"
         "from a hundredth to 100 times (step: from a quarter to one draw of the random force). "
         "lever:\n"
         "share of the beam, graze: share of the radius, below which there are faults at the "
         "scene's\n"
         "step.\n";
}

std::string figure_name(dynamics::LimitNumber number) {
  return std::string(info_of(number).name) + ".svg";
}

namespace {

/// A colour for each verdict, in their order; pale if the numbers hold.
constexpr std::array<const char*, dynamics::kVerdictNames.size()> kColours{
    "#e3f1dc",  // ok
    "#ffe169",  // missed hit
    "#a9c3d9",  // no formula
    "#f2a04e",  // too fast
    "#d987e0",  // outcomes off
    "#d04a00",  // energy
    "#9066c9",  // penetration
    "#7a1010",  // beyond bound
    "#1f5fae",  // stuck
    "#111111",  // not finite
    "#8f8f8f",  // refused
};
static_assert(kColours.back() != nullptr, "one colour per verdict");

constexpr double kPanelWidth = 128, kPanelHeight = 112;
constexpr Pen kMark{.colour = "#000000", .mark = 7, .size = 0.8};
constexpr Pen kOwnStep{.colour = "#000000", .width = 1.2};

/// An axis as gnuplot draws it.
struct DrawnAxis {
  std::vector<double> low, high;  // edges of each value's cell
  bool logarithmic;

  explicit DrawnAxis(const MapAxis& axis) : logarithmic(axis.logarithmic) {
    std::vector<double> at = axis.values;  // places, on a scale where cells are even
    if (logarithmic)
      for (double& place : at) place = std::log(place);
    const auto drawn = [&](double place) { return logarithmic ? std::exp(place) : place; };
    const std::size_t n = at.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double before = i > 0 ? at[i - 1] : 2 * at[0] - at[1];
      const double after = i + 1 < n ? at[i + 1] : 2 * at[n - 1] - at[n - 2];
      low.push_back(drawn(0.5 * (before + at[i])));
      high.push_back(drawn(0.5 * (at[i] + after)));
    }
  }

  /// `length` of the axis, in points.
  [[nodiscard]] Axis axis(std::string_view name, double length) const {
    const double from = low.front(), to = high.back();
    std::string tics = digits(tic_step(to - from, 3));
    if (logarithmic && to / from < 1000.0)
      tics = fmt::format("({})", tics_1_2_5(from, to, length));
    else if (logarithmic)
      tics = digits(std::pow(10.0, std::ceil(std::log10(to / from) / 3.5)));
    return {verbatim(std::string(name)),    from, to,         tics,
            logarithmic ? "10^{%L}" : "%g", true, logarithmic};
  }
};

/// Adds a box for each point, for boxxyerror.
void add_boxes(Rows& rows, const FinishedMap& m, const DrawnAxis& x, const DrawnAxis& y) {
  for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
    for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
      const char* colour = kColours[static_cast<std::size_t>(m.at(ix, iy).verdict)];
      rows.add(std::sqrt(x.low[ix]) * std::sqrt(x.high[ix]), 0, x.low[ix], x.high[ix], y.low[iy],
               y.high[iy], std::string("0x") + (colour + 1));
    }
}

/// The maps of one number: three methods in a row, and a key in the sixth place.
class PanelGroup {
 public:
  PanelGroup(const dynamics::LimitScene& scene, std::span<const FinishedMap> maps, double top,
             std::string tag)
      : maps_(maps), top_(top), tag_(std::move(tag)) {
    for (const FinishedMap& m : maps_) {
      lines_.push_back(dynamics::borders(scene, m.map));
      for (const dynamics::Border& border : lines_.back())
        if (std::find(borders_.begin(), borders_.end(), border.label) == borders_.end())
          borders_.push_back(border.label);
    }
  }

  [[nodiscard]] double end() const {
    return row_of(1) + kPanelHeight + 70 + 20 * static_cast<double>((borders_.size() + 1) / 2);
  }

  void draw_on(Panels& out) const {
    const dynamics::LimitMap& map = maps_.front().map;
    out.say(fmt::format("Step and {}", info_of(map.number).words), 8, top_ + 14);
    for (std::size_t i = 0; i < maps_.size(); ++i) add_panel(out, i);
    std::vector<Layer> verdicts;
    for (std::size_t v = 0; v < kColours.size(); ++v)
      if (std::any_of(maps_.begin(), maps_.end(), [v](const FinishedMap& m) {
            return m.count(static_cast<dynamics::Verdict>(v)) > 0;
          }))
        verdicts.push_back(entry("points", {.colour = kColours[v], .mark = 5, .size = 1.4},
                                 verbatim(std::string(dynamics::kVerdictNames[v]))));
    verdicts.push_back(map.y.own ? entry("points", kMark, "the scene")
                                 : entry("lines", kOwnStep, "the scene"));
    out.add_key(left_of(2), row_of(1), std::move(verdicts));
    for (std::size_t i = 0; i < borders_.size(); ++i)
      out.add_key(i % 2 == 0 ? 70 : 270,
                  end() - 8 - 20 * static_cast<double>((borders_.size() + 1) / 2 - i / 2),
                  {entry("lines", {.colour = kInk, .width = 1.5, .dashes = static_cast<int>(i + 1)},
                         verbatim(borders_[i]))});
  }

 private:
  [[nodiscard]] static double left_of(std::size_t column) {
    return 76 + (kPanelWidth + 16) * static_cast<double>(column);
  }
  [[nodiscard]] double row_of(std::size_t row) const {
    return top_ + 52 + 196 * static_cast<double>(row);
  }

  /// Draws the known borders of a map. Each border has the same dashes everywhere, visible on every
  /// colour.
  void draw_borders(Panels& out, Panel& panel, std::size_t i, const std::string& tag) const {
    std::size_t n = 0;
    for (const dynamics::Border& border : lines_[i]) {
      const auto place = std::find(borders_.begin(), borders_.end(), border.label);
      const int dash = static_cast<int>(place - borders_.begin()) + 1;
      Rows& rows = out.data(fmt::format("{}B{}", tag, ++n));
      for (std::size_t k = 0; k < border.x.size(); ++k) rows.add(border.x[k], border.y[k]);
      panel.draw_outlined(rows, "1:2", "lines", {"#ffffff", 3.5},
                          {.colour = "#000000", .width = 1.5, .dashes = dash});
    }
  }

  /// Draws the scene's place: a point, or its step alone.
  static void draw_scene(Panels& out, Panel& panel, const dynamics::LimitMap& map,
                         const std::string& tag) {
    const double x = map.x.values[map.x.from];
    if (!map.y.own) return panel.uprights.push_back({x, kOwnStep, true});
    Rows& rows = out.data(tag + "S");
    rows.add(x, map.y.values[*map.y.own]);
    panel.draw_outlined(rows, "1:2", "points", {.colour = "#ffffff", .mark = 7, .size = 1.3},
                        kMark);
  }

  void add_panel(Panels& out, std::size_t i) const {
    const dynamics::LimitMap& map = maps_[i].map;
    const DrawnAxis x(map.x), y(map.y);
    const double left = left_of(i % 3), top = row_of(i / 3);
    // The title under the middle map serves its row, except for a map with another axis.
    const bool named = i % 3 == 1 || (i == 3 && map.x.label != maps_.back().map.x.label);
    Rows& rows = out.data(tag_ + std::to_string(i));
    add_boxes(rows, maps_[i], x, y);
    Panel& panel = out.add({left, left + kPanelWidth, top, top + kPanelHeight});
    if (i == 0)
      panel.texts.push_back(
          {verbatim(std::string(map.y.label)), 10, row_of(1) - 20, kFont, "center rotate by 90"});
    panel.say(map.method, left, top - 12);
    panel.x = x.axis(named ? map.x.label : "", kPanelWidth);
    panel.y = y.axis("", kPanelHeight);
    if (i % 3 != 0) panel.y.tics = kNoTics;
    panel.draw(rows, "1:2:3:4:5:6:7", kBars, {kOwnColour});
    draw_borders(out, panel, i, rows.name());
    draw_scene(out, panel, map, rows.name());
  }

  std::span<const FinishedMap> maps_;
  double top_;
  std::string tag_;
  std::vector<std::vector<dynamics::Border>> lines_;  // by map
  std::vector<std::string> borders_;                  // labels, in the order of their dashes
};

}  // namespace

Figure figure_of(const dynamics::LimitScene& scene, std::span<const FinishedMap> maps) {
  std::vector<PanelGroup> groups;
  double height = 0.0;
  for (std::size_t begin = 0, end = 0; begin < maps.size(); begin = end) {
    while (end < maps.size() && maps[end].map.number == maps[begin].map.number) ++end;
    groups.emplace_back(scene, maps.subspan(begin, end - begin), height,
                        fmt::format("$map{}_", groups.size()));
    height = groups.back().end();
  }
  Panels out;
  for (const PanelGroup& group : groups) group.draw_on(out);
  return out.figure(static_cast<int>(height));
}

}  // namespace gatewalk::cli
