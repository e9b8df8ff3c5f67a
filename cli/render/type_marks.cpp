// SPDX-License-Identifier: MIT
#include "cli/render/type_marks.h"

#include <algorithm>
#include <array>
#include <utility>

#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

constexpr double kLegendLine = 17, kLeftEnd = 8, kRightEnd = 496, kLetter = 7.6;  // points
constexpr std::size_t kLongestName = 40;

/// Shapes of gnuplot, white on black and black on white. What is beyond has one look together.
constexpr std::array kShapes{7, 9, 5, 13, 11, 15};
constexpr std::size_t kMarkLooks = 2 * kShapes.size();

/// A mark as two points, the larger one first: seen on every colour.
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

std::string mark_point(int shape, const char* size, const char* colour) {
  return "pt " + std::to_string(shape) + " ps " + size + " lc rgb '" + colour + "'";
}
constexpr char kAroundMark[] = "0.75", kInsideMark[] = "0.45";

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
    names[kMarkLooks] = std::to_string(others) + " others";
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

TypeMarks::Drawn TypeMarks::on(const FieldMap& map, double width, double height,
                               const std::string& tag) const {
  constexpr double kLeast = 7.0, kAside = 6.0;  // points
  if (entries_.empty() || map.rows.block > 1 || map.columns.block > 1 ||
      std::min(width, height) < kLeast)
    return {};
  // In the upper left corner, where it leaves room for a number.
  const double left = std::max(0.0, 0.5 - kAside / width),
               up = std::max(0.0, 0.5 - kAside / height);
  Drawn drawn{.data = {}, .plot = {}, .fits = true};
  for (std::size_t type = 1; type < map_.types.size(); ++type) {
    std::string rows;
    for (Eigen::Index r = 0; r < map.rows.count; ++r)
      for (Eigen::Index c = 0; c < map.columns.count; ++c)
        if (static_cast<std::size_t>(map_.type_of(static_cast<int>(map.columns.first + c),
                                                  static_cast<int>(map.rows.first + r))) == type)
          rows += digits(static_cast<double>(c) - left) + " " +
                  digits(static_cast<double>(r) + up) + "\n";
    if (rows.empty()) continue;
    const std::string name = "$type" + tag + "_" + std::to_string(type);
    const MarkLook look = look_of_mark(type);
    drawn.data += data_block(name, rows);
    drawn.plot += ", " + name + " using 1:2 with points " +
                  mark_point(look.shape, kAroundMark, look.around) + ", " + name +
                  " using 1:2 with points " + mark_point(look.shape, kInsideMark, look.inside);
  }
  return drawn;
}

double TypeMarks::legend_height() const {
  return entries_.empty() ? 0.0 : entries_.back().top + kLegendLine;
}

std::string TypeMarks::legend(const Sheet& sheet, double top, bool marked) const {
  if (entries_.empty()) return "";
  if (!marked)
    return sheet.text("gates are of several types: too small to be marked here", kLeftEnd,
                      top + 0.5 * kLegendLine, kSmallFont);
  std::string out;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& e = entries_[i];
    const double middle = top + e.top + 0.5 * kLegendLine;
    const bool has_mark = i > 0 && i + 1 < entries_.size();
    if (has_mark) {
      const MarkLook look = look_of_mark(i);
      for (const auto& [size, colour] :
           {std::pair{kAroundMark, look.around}, std::pair{kInsideMark, look.inside}})
        out += "set label '' at screen " + sheet.at(e.left + 6, middle) + " point " +
               mark_point(look.shape, size, colour) + "\n";
    }
    out += sheet.text(e.name, e.left + (has_mark ? 14 : 0), middle, kSmallFont);
  }
  return out;
}

}  // namespace gatewalk::cli
