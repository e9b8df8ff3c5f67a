// SPDX-License-Identifier: MIT
#include "cli/render/type_marks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "lattice/gates/gates.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {
namespace {

constexpr double kLegendLine = 17, kLeftEnd = 8, kRightEnd = 496, kLetter = 7.6;  // points
constexpr std::size_t kLongestName = 40;

/// gnuplot's shapes: white on black, then black on white. Further types share one look.
constexpr std::array kShapes{7, 9, 5, 13, 11, 15};
constexpr std::size_t kMarkLooks = 2 * kShapes.size();

/// A mark as two points, the larger one first, visible on every colour.
struct MarkLook {
  int shape;
  const char *around, *inside;
};
MarkLook look_of_mark(std::size_t type) {
  const std::size_t i = type - 1;
  if (i >= kMarkLooks) return {3, "#000000", "#ffffff"};
  const bool white = i < kShapes.size();
  return {kShapes[i % kShapes.size()], white ? "#000000" : "#ffffff",
          white ? "#ffffff" : "#000000"};
}

/// Both points of a mark.
std::array<Pen, 2> pens_of_mark(std::size_t type) {
  const MarkLook look = look_of_mark(type);
  return {Pen{.colour = look.around, .mark = look.shape, .size = 0.75},
          Pen{.colour = look.inside, .mark = look.shape, .size = 0.45}};
}

}  // namespace

std::vector<std::string> type_names(const lattice::Scene& scene) {
  if (!scene.terrain) return {};
  std::vector<std::string> names(lattice::gates_of(scene).types().size());
  if (names.size() == 1) return {};
  names.front() = lattice::kOwnGate;
  const std::vector<int> gate_type = lattice::gate_types(scene);
  for (std::size_t i = 0; i < gate_type.size(); ++i) {
    std::string& name = names[static_cast<std::size_t>(gate_type[i])];
    name += (name.empty() ? "" : "/") + scene.terrain->types[i].name;
  }
  return names;
}

TypeMarks::TypeMarks(const ShownField& shown) : map_(shown.map) {
  std::vector<std::string> names = shown.types;
  if (names.empty()) return;
  std::rotate(names.begin(), names.begin() + 1, names.end());
  if (names.size() > kMarkLooks + 1) {
    const std::size_t others = names.size() - 1 - kMarkLooks;
    names[kMarkLooks] = fmt::format("{} others", others);
    names.erase(names.begin() + kMarkLooks + 1, names.end() - 1);
  }
  names.back() = "unmarked: " + names.back();
  names.insert(names.begin(), "gates:");
  double left = kLeftEnd, top = 0.0;
  for (std::string& name : names) {
    if (name.size() > kLongestName) name.replace(kLongestName - 3, std::string::npos, "...");
    const double width = kLetter * static_cast<double>(name.size()) + 26;
    if (left + width > kRightEnd && left > kLeftEnd) {
      left = kLeftEnd;
      top += kLegendLine;
    }
    entries_.push_back({name, left, top});
    left += width;
  }
}

bool TypeMarks::draw_on(Panels& out, Panel& panel, const FieldMap& map,
                        const std::string& tag) const {
  constexpr double kLeast = 7.0, kAside = 6.0;  // points
  const double width = panel.box.width() / static_cast<double>(map.columns.blocks()),
               height = panel.box.height() / static_cast<double>(map.rows.blocks());
  if (entries_.empty() || map.rows.block > 1 || map.columns.block > 1 ||
      std::min(width, height) < kLeast)
    return false;
  // The mark stands in the upper left corner, where it leaves room for a number.
  const double left = std::max(0.0, 0.5 - kAside / width),
               up = std::max(0.0, 0.5 - kAside / height);
  for (std::size_t type = 1; type < map_.types.size(); ++type) {
    Rows rows(fmt::format("$type{}_{}", tag, type));
    for (Eigen::Index r = 0; r < map.rows.count; ++r)
      for (Eigen::Index c = 0; c < map.columns.count; ++c)
        if (static_cast<std::size_t>(map_.type_of(static_cast<int>(map.columns.first + c),
                                                  static_cast<int>(map.rows.first + r))) == type)
          rows.add(static_cast<double>(c) - left, static_cast<double>(r) + up);
    if (rows.empty()) continue;
    const auto [around, inside] = pens_of_mark(type);
    panel.draw_outlined(out.data(rows), "1:2", "points", around, inside);
  }
  return true;
}

double TypeMarks::legend_height() const {
  return entries_.empty() ? 0.0 : entries_.back().top + kLegendLine;
}

void TypeMarks::add_legend(Panel& panel, double top, bool marked) const {
  if (!entries_.empty() && !marked)
    panel.say("gates are of several types: too small to be marked here", kLeftEnd,
              top + 0.5 * kLegendLine, kSmallFont);
  for (std::size_t i = 0; i < entries_.size() && marked; ++i) {
    const Entry& e = entries_[i];
    const double middle = top + e.top + 0.5 * kLegendLine;
    const bool has_mark = i > 0 && i + 1 < entries_.size();
    if (has_mark)
      for (const Pen& pen : pens_of_mark(i))
        panel.texts.push_back({.left = e.left + 6, .middle = middle, .mark = pen});
    panel.say(e.name, e.left + (has_mark ? 14 : 0), middle, kSmallFont);
  }
}

}  // namespace gatewalk::cli
