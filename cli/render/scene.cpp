// SPDX-License-Identifier: MIT
#include "cli/render/scene.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/final_gates.h"
#include "cli/render/quantity.h"
#include "lattice/scene/scene_bins.h"
#include "lattice/scene/terrain.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

/// A number of a scene with at most seven digits, unless it is an integer.
std::string shortened(const std::string& number) {
  if (number.find_first_of(".en") == number.npos) return number;
  const double x = lattice::number_of(number);
  const std::string text = digits(x);
  return lattice::number_of(text) == x ? number : text;
}

/// A key's value: a number, or text in quotation marks.
std::string shown_value(const lattice::KeyInfo& k) {
  return k.value.starts_with('"') ? k.value : shortened(k.value);
}

/// The range "[low, high]" with both ends shortened.
std::string shown_range(const lattice::KeyInfo& k) {
  const std::size_t comma = k.range.find(", ");
  if (comma == k.range.npos) return k.range;
  const std::size_t high = comma + 2, end = k.range.size() - 1;
  return fmt::format("{}{}, {}{}", k.range.front(), shortened(k.range.substr(1, comma - 1)),
                     shortened(k.range.substr(high, end - high)), k.range.back());
}

}  // namespace

std::string limits_text(const ShownField& shown) {
  std::string text =
      std::isnan(shown.time_limit)
          ? fmt::format("Trapped: as the {} say{}.",
                        shown.is_simulated ? "cell program" : "runs or counts of the file",
                        shown.is_simulated ? "s" : "")
          : fmt::format("Trapped: still in the same gate {} after entering it.",
                        quantity(shown.time_limit, "s"));
  return text + (shown.field.max_gates > 0
                     ? fmt::format("\nCut off: would go on after {} gates (field.max_gates).\n",
                                   shown.field.max_gates)
                     : "\nNo body is cut off: field.max_gates = 0 sets no limit.\n");
}

std::vector<markov::Ending> impossible_endings(const ShownField& shown) {
  const lattice::FieldParams& field = shown.field;
  const std::vector<dynamics::Face>& faces = shown.map.section.faces;
  const std::int64_t
      cells = std::int64_t{field.columns} * field.rows,
      // A walk longer than there are cells comes back to one, and can go on for ever.
      most = field.max_gates > 0 ? std::min<std::int64_t>(field.max_gates, cells + 1) : cells + 1;
  constexpr std::int64_t kMostMoves = 10'000'000;
  if (most * cells * std::ssize(faces) > kMostMoves) return {};
  std::array<bool, markov::kEndings> possible{};
  std::vector<bool> here(static_cast<std::size_t>(cells));
  here[static_cast<std::size_t>(field.start_row * field.columns + field.start_column())] = true;
  bool goes_on = true;
  for (std::int64_t gate = 0; gate < most && goes_on; ++gate) {
    std::vector<bool> next(here.size());
    goes_on = false;
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column) {
        if (!here[static_cast<std::size_t>(row * field.columns + column)]) continue;
        for (const dynamics::Face& face : faces) {
          const int to_column = column + face.di_x, to_row = row + face.di_y;
          if (field.contains(to_column, to_row)) {
            next[static_cast<std::size_t>(to_row * field.columns + to_column)] = true;
            goes_on = true;
          } else {
            possible[static_cast<std::size_t>(
                markov::edge_before({field.columns, field.rows}, to_column, to_row))] = true;
          }
        }
      }
    here = std::move(next);
  }
  possible[static_cast<std::size_t>(markov::Ending::cut_off)] = goes_on;
  std::vector<markov::Ending> impossible;
  for (const EndingName& e : kAllEndingNames)
    if (e.ending != markov::Ending::trapped && !possible[static_cast<std::size_t>(e.ending)])
      impossible.push_back(e.ending);
  return impossible;
}

std::string too_few_gates(const ShownField& shown) {
  const lattice::FieldParams& field = shown.field;
  const int ahead = field.rows - field.start_row;  // moves of one row until the field is crossed
  int longest = 1;                                 // rows that a body can advance in a move
  for (const dynamics::Face& face : shown.map.section.faces) longest = std::max(longest, face.di_y);
  if (field.max_gates == 0 || field.max_gates >= (ahead + longest - 1) / longest) return "";
  return fmt::format("nobody can cross: field.max_gates = {} is less than field.rows{} = {}",
                     field.max_gates, field.start_row > 0 ? " - field.start_row" : "", ahead);
}

std::string scene_line(const lattice::Scene& scene, const std::vector<std::string>& actions) {
  const auto& gate = scene.gate;
  const auto& start = scene.start;
  const auto number = [](double x) { return digits(x, 6); };
  // Two numbers share one unit, that of the larger.
  const Sized place = readable_unit("m", std::max(std::abs(start.x), std::abs(start.y)));
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  const std::string text =
      fmt::format("{}: start x {}, y {} {}, v ({}, {}) {}\nbody {}, radius {}; ", scene.source,
                  number(start.x / place.size), number(start.y / place.size), place.name,
                  number(start.vx / speed.size), number(start.vy / speed.size), speed.name,
                  quantity(gate.body.mass, "kg", 6), quantity(gate.body.radius, "m", 6));
  if (!actions.empty()) return fmt::format("{}actions {}\n", text, fmt::join(actions, ", "));
  return fmt::format(
      "{}push {}, random force {}\n"
      "beams: stiffness left {}, right {} Nm/rad, damping {} Nms/rad\n"
      "method {}, {} {}\n",
      text, quantity(gate.forces.propulsion, "N", 6), quantity(gate.forces.random, "N", 6),
      number(gate.beams.stiffness_left), number(gate.beams.stiffness_right),
      number(gate.beams.damping), gate.run.method,
      gate.run.method == "event" ? "tolerance" : "step",
      gate.run.method == "event" ? quantity(gate.run.event_tolerance, "m", 6)
                                 : quantity(gate.run.step, "s", 6));
}

std::string table_of(const std::vector<lattice::KeyInfo>& keys) {
  TextTable table({{"key", -kFit}, {"value", -kFit, 0, "", "  "}, {"unit", -kFit, 0, "", "  "}});
  for (const lattice::KeyInfo& k : keys) table.row({k.key, shown_value(k), k.unit});
  std::string text = "Every number: key, value, unit and source; below it meaning and range\n";
  const std::string rows = table.rows();
  std::size_t begin = 0;
  for (const lattice::KeyInfo& k : keys) {
    const std::size_t end = rows.find('\n', begin);
    std::string row = rows.substr(begin, end - begin);
    const std::string source = "  " + k.source,
                      meaning = k.meaning + (k.range.empty() ? "" : "; " + shown_range(k));
    begin = end + 1;
    const bool fits = row.size() + source.size() <= kScreenColumns;
    if (!fits) row.erase(row.find_last_not_of(' ') + 1);
    text += row + (fits ? source + "\n" : "\n" + wrapped("    from" + source.substr(1), "      ")) +
            wrapped("    " + meaning, "      ");
  }
  return text;
}

std::string commented(const lattice::Scene& scene) {
  std::vector<lattice::KeyInfo> keys = lattice::describe(scene);
  std::string text =
      "# A scene for gatewalk: one body, one gate with two beams, a field of such gates. Units are "
      "in the keys.\n"
      "# A key that is left out, as behind #, follows from the others by the paper's proportions: "
      "from body.radius_m,\n"
      "# body.mass_kg and forces.propulsion_N. gatewalk scene FILE shows every value and its "
      "source.\n";
  std::string table;
  std::size_t width = 0;
  const auto leaf = [](const lattice::KeyInfo& k) { return k.key.substr(k.key.find('.') + 1); };
  const auto of_terrain = [](const lattice::KeyInfo& k) {
    return k.key.starts_with("terrain.") || k.key.starts_with("actions.");
  };
  for (lattice::KeyInfo& k : keys) {
    if (k.source == "derived")
      k.value = digits(lattice::number_of(k.value));  // as a comment, with few digits
    if (!of_terrain(k)) width = std::max(width, leaf(k).size() + k.value.size() + 5);
  }
  for (const lattice::KeyInfo& k : keys) {
    if (of_terrain(k)) break;  // written as a table below
    if (const std::string own = k.key.substr(0, k.key.find('.')); own != table)
      text += "\n[" + (table = own) + "]\n";
    const bool follows = k.source == "derived";
    text +=
        fmt::format("{:<{}}  # {}", fmt::format("{}{} = {}", follows ? "# " : "", leaf(k), k.value),
                    width, k.meaning);
    if (!k.range.empty()) text += ", in " + shown_range(k) + (k.unit.empty() ? "" : " " + k.unit);
    if (follows || k.source == "paper") text += "; " + k.source;
    text += "\n";
  }
  if (scene.bins) text += "\n" + lattice::bins_toml(*scene.bins);
  if (scene.terrain) text += "\n" + lattice::terrain_toml(*scene.terrain, scene.field);
  text += lattice::gates_toml("actions", scene.actions);
  if (!scene.sweep.empty()) text += "\n[sweep]\n";
  for (const lattice::Variation& v : scene.sweep)
    text += fmt::format("\"{}\" = \"{}\"\n", v.key, v.values);
  return text;
}

namespace {

using lattice::Scene;

constexpr double kSceneWide = 720, kSceneTop = 44, kEdge = 48, kRoomWide = 276, kRoomTall = 320;
constexpr double kTable = 374, kKeys = 406, kRow = 16.5;

/// Draws at places on the sheet, in points from its upper left corner.
class Drawing {
 public:
  void line(double x, double y, double to_x, double to_y, const std::string& style) {
    out_ += fmt::format("set arrow from {} to {} {}\n", at(x, y), at(to_x, to_y), style);
  }
  void circle(double x, double y, double radius, const std::string& style) {
    out_ += fmt::format("set object circle at {} size {} {}\n", at(x, y), digits(radius), style);
  }
  /// Draws `text` in gnuplot's quotes; `where`: left, center or right, and more.
  void text(const std::string& text, double x, double y, const std::string& where) {
    out_ += fmt::format("set label {} at {} {}\n", text, at(x, y), where);
  }
  [[nodiscard]] const std::string& commands() const { return out_; }

 private:
  std::string out_;
  [[nodiscard]] static std::string at(double x, double y) { return digits(x) + "," + digits(y); }
};

const std::string kThinLine = "nohead lt -1 lw 0.5", kDashed = "nohead lt -1 lw 0.7 dt (4,4)";
const std::string kMeasure = "heads filled size 5,18 lt -1 lw 0.5";

std::string coloured(const char* colour) { return fmt::format(" lc rgb '{}'", colour); }
std::string force_arrow(const char* head, const char* colour) {
  return std::string(head) + " filled size 7,20 lw 2" + coloured(colour);
}

/// The keys of the drawing with their symbols.
struct KeySymbol {
  const char *sign, *key;
};
constexpr std::array<KeySymbol, 21> kSceneSymbols{{{"M", "body.mass_kg"},
                                                   {"R", "body.radius_m"},
                                                   {"L", "beams.length_m"},
                                                   {"m", "beams.mass_kg"},
                                                   {"k_L", "beams.stiffness_left_Nm_per_rad"},
                                                   {"k_R", "beams.stiffness_right_Nm_per_rad"},
                                                   {"d", "beams.damping_Nms_per_rad"},
                                                   {"x_J", "beams.joint_x_m"},
                                                   {"y_J", "beams.joint_y_m"},
                                                   {"y_T", "run.traverse_y_m"},
                                                   {"F", "forces.propulsion_N"},
                                                   {"Rm", "forces.random_N"},
                                                   {"f", "forces.random_rate_Hz"},
                                                   {"D", "forces.drag_Ns_per_m"},
                                                   {"e", "contact.restitution"},
                                                   {"e_t", "contact.tip_restitution"},
                                                   {"t", "run.time_limit_s"},
                                                   {"x_0", "start.x_m"},
                                                   {"y_0", "start.y_m"},
                                                   {"v_x", "start.vx_m_per_s"},
                                                   {"v_y", "start.vy_m_per_s"}}};

/// Draws a table of symbols, keys and values, with another colour for keys that the scene leaves
/// out. Returns where the table ends.
double draw_table(Drawing& drawing, const Scene& scene) {
  const std::string left_out = fmt::format("left tc rgb '{}'", kSecondColour);
  const std::vector<lattice::KeyInfo> keys = lattice::describe(scene);
  double y = kSceneTop;
  bool any_left_out = false;
  for (const KeySymbol& symbol : kSceneSymbols) {
    const auto found = std::find_if(keys.begin(), keys.end(),
                                    [&](const lattice::KeyInfo& k) { return k.key == symbol.key; });
    const bool own = found->source != "derived" && found->source != "paper";
    any_left_out |= !own;
    drawing.text(fmt::format("'{}'", symbol.sign), kTable, y, "left");
    drawing.text(literal(found->key + " = " + digits(lattice::number_of(found->value))), kKeys, y,
                 own ? "left" : left_out);
    y += kRow;
  }
  if (!any_left_out) return y;
  drawing.text("'left out: the paper''s value or proportions'", kTable, y + 4, left_out);
  return y + 4 + kRow;
}

/// Draws a torsion spring around a joint.
void draw_spring(Drawing& drawing, double x, double y) {
  constexpr int kParts = 30;
  const auto point = [&](int i) {
    const double angle = 4.5 * std::numbers::pi * i / kParts, radius = 2.5 + 6.5 * i / kParts;
    return std::array{x + radius * std::cos(angle), y + radius * std::sin(angle)};
  };
  for (int i = 0; i < kParts; ++i) {
    const auto a = point(i), b = point(i + 1);
    drawing.line(a[0], a[1], b[0], b[1], "nohead lw 1.2" + coloured(kThirdColour));
  }
}

/// Draws the disc with its forces, with a radius of `disc` points.
void draw_body(Drawing& drawing, const Scene& scene, double x, double y, double disc) {
  const auto& forces = scene.gate.forces;
  drawing.circle(x, y, disc, "fs empty border lt -1 lw 1.5");
  const double longest = std::clamp(0.85 * disc, 36.0, 80.0);
  const double most = std::max(forces.propulsion, forces.random);
  const auto length = [&](double force) { return most > 0.0 ? longest * force / most : 0.0; };
  const double push = length(forces.propulsion), noise = length(forces.random);
  const double eighth = std::sqrt(0.5) * disc;
  drawing.line(x, y, x + eighth, y + eighth, kThinLine);
  drawing.text("'R'", x + 0.5 * eighth + 9, y + 0.5 * eighth - (disc < 30 ? -8 : 3), "center");
  drawing.text("'M'", x + std::max(0.58 * disc, 24.0), y - std::max(0.5 * disc, 22.0), "center");
  if (noise > 0.0) {
    drawing.line(x - noise, y, x + noise, y, force_arrow("heads", kFourthColour));
    const bool outside = noise > disc;
    drawing.text("'Rm, f'", x + std::max(noise, 10.0) + (outside ? 4 : 2), outside ? y : y - 9,
                 fmt::format("{} tc rgb '{}'", outside ? "left" : "right", kFourthColour));
  }
  if (push > 0.0) {
    drawing.line(x, y, x, y - push, force_arrow("head", kFirstColour));
    drawing.text("'F'", x + 6, y - std::max(push - 5.0, 21.0),
                 fmt::format("left tc rgb '{}'", kFirstColour));
  }
  if (forces.drag > 0.0) {
    const double against = push > 0.0 ? push : 0.6 * longest;
    drawing.line(x, y, x, y + against, force_arrow("head", kFifthColour));
    drawing.text("'D v'", x - 6, y + std::max(against - 5.0, 13.0),
                 fmt::format("right tc rgb '{}'", kFifthColour));
  }
  const auto& start = scene.start;
  if (const double speed = std::hypot(start.vx, start.vy); speed > 0.0) {
    const double from_x = x - std::max(0.45 * disc, 14.0), from_y = y - 8.0, long_ = 0.6 * longest;
    drawing.line(from_x, from_y, from_x + long_ * start.vx / speed,
                 from_y - long_ * start.vy / speed, "head filled size 6,18 lt -1 lw 1");
    drawing.text("'v'", from_x - 4, from_y - 0.5 * long_ * std::max(0.0, start.vy) / speed,
                 "right");
  }
  drawing.circle(x, y, 2.0, "fs solid noborder fc rgb 'black'");
}

}  // namespace

Figure figure_of(const Scene& scene) {
  const dynamics::GateParams& gate = scene.gate;
  const dynamics::Beams& beams = gate.beams;
  const double low =
      std::max(std::min(0.0, scene.start.y - gate.body.radius), -gate.run.traverse_y);
  const double half =
      std::clamp(std::abs(scene.start.x) + gate.body.radius, beams.joint_x, 2.0 * beams.joint_x);
  const double scale = std::min(kRoomWide / (2.0 * half), kRoomTall / (gate.run.traverse_y - low));
  const double middle = kEdge + 0.5 * kRoomWide,
               floor = kSceneTop + scale * (gate.run.traverse_y - low);
  const auto x_at = [&](double x) { return middle + scale * x; };
  const auto y_at = [&](double y) { return floor - scale * (y - low); };
  const double left = x_at(-beams.joint_x), right = x_at(beams.joint_x), bottom = y_at(0.0),
               joint = y_at(beams.joint_y), far = y_at(gate.run.traverse_y);

  Drawing d;
  d.text(
      literal(scene.source + ": one gate, to scale" + (scene.terrain ? " (the scene's own)" : "")),
      8, 14, fmt::format("left font ',{}'", kFont));
  for (const double side : {left, right}) d.line(side, bottom, side, far, kDashed);
  for (const double edge : {bottom, far}) d.line(left, edge, right, edge, kDashed);
  d.line(x_at(0.0), bottom, x_at(0.0), far, "nohead lt -1 lw 0.3 dt (2,5)");
  d.text("'traversed'", x_at(0.0), far - 9, "center");
  for (const double side : {left + 9, right - 8})
    d.text("'exited'", side, 0.5 * (bottom + joint), "center rotate by 90");

  // Lengths stand beside the gate, below it and above the beams.
  d.line(left - 16, bottom, left - 16, joint, kMeasure);
  d.text("'y_J'", left - 21, 0.5 * (bottom + joint), "right");
  d.line(right + 14, bottom, right + 14, far, kMeasure);
  d.text("'y_T'", right + 19, 0.5 * (bottom + far), "left");
  const double below = std::max(bottom, y_at(scene.start.y - gate.body.radius)) + 16;
  const double least = std::max(below, std::min(y_at(scene.start.y) + 60, floor + 44));
  d.line(x_at(0.0), least, right, least, kMeasure);
  d.text("'x_J'", 0.5 * (x_at(0.0) + right), least + 10, "center");
  for (const double x : {x_at(0.0), right}) d.line(x, bottom, x, least + 4, "nohead lt -1 lw 0.3");
  d.line(left - 20, joint, left, joint, kThinLine);
  for (const double y : {bottom, far}) d.line(right, y, right + 18, y, kThinLine);
  d.line(left - 20, bottom, left, bottom, kThinLine);
  const double tip = left + scale * beams.length;
  d.line(left, joint - 14, tip, joint - 14, kMeasure);
  d.text("'L, m'", 0.5 * (left + tip) + (scale * beams.length < 90 ? 30 : 0), joint - 24, "center");

  for (const double side : {1.0, -1.0}) {
    const double x = side > 0 ? left : right;
    d.line(x, joint, x + side * scale * beams.length, joint,
           "nohead lw 4" + coloured(kThirdColour));
    d.circle(x + side * scale * beams.length, joint, 2.5, "fs solid border fc rgb '#ffffff'");
    draw_spring(d, x, joint);
    d.text(side > 0 ? "'k_L, d'" : "'k_R, d'", x + side * 12, joint + 14,
           fmt::format("{} tc rgb '{}'", side > 0 ? "left" : "right", kThirdColour));
  }
  if (joint - far > 70)
    d.text(literal("trapped: still inside after " + quantity(gate.run.time_limit, "s", 3)),
           x_at(0.0), far + 0.4 * (joint - far), "center");
  draw_body(d, scene, x_at(scene.start.x), y_at(scene.start.y), scale * gate.body.radius);

  const double end = std::max(draw_table(d, scene), least + 16);
  const int height = static_cast<int>(end + 6);
  return {
      static_cast<int>(kSceneWide), height,
      fmt::format(
          "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin "
          "at screen 0\nunset key\nunset border\nunset tics\n{}plot [0:{}] [{}:0] NaN\n",
          d.commands(), digits(kSceneWide), height),
      kSmallFont};
}

}  // namespace gatewalk::cli
