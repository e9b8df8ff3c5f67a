// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/cut_tracks.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"

namespace gatewalk::cli {
namespace {

using lattice::CutEnd;
using lattice::CutPassage;
using lattice::CutTracks;

constexpr std::size_t kMostPlaces = 40'000, kMostMarks = 3'000;  // of a picture
constexpr long kMostBorders = 100;                               // along one axis

/// Whole cells, columns and rows, the last ones not included.
struct Span {
  long left, right, bottom, top;

  /// Those of them that are in the lattice.
  [[nodiscard]] Span within(long columns, long rows) const {
    if (columns == 0) return *this;
    return {std::clamp(left, 0L, columns), std::clamp(right, 0L, columns),
            std::clamp(bottom, 0L, rows), std::clamp(top, 0L, rows)};
  }
};
/// That hold all pieces.
Span span_of(const CutTracks& cut, const lattice::CellFile& cell) {
  double left = HUGE_VAL, right = -HUGE_VAL, bottom = HUGE_VAL, top = -HUGE_VAL;
  for (const lattice::TrackPiece& p : cut.pieces)
    for (std::size_t i = p.begin; i < p.end; ++i) {
      left = std::min(left, p.track->x[i]);
      right = std::max(right, p.track->x[i]);
      bottom = std::min(bottom, p.track->y[i]);
      top = std::max(top, p.track->y[i]);
    }
  const auto cells = [](double low, double high, double size) {
    const long first = std::lround(std::floor(low / size));
    return std::array{first, std::max(first + 1, std::lround(std::ceil(high / size)))};
  };
  const auto across = cells(left, right, cell.width), along = cells(bottom, top, cell.length);
  return {across[0], across[1], along[0], along[1]};
}

/// Ways with a gap between two.
void add_ways(Rows& rows, const CutTracks& cut, const Sized& metre) {
  std::size_t all = 0;
  for (const lattice::TrackPiece& p : cut.pieces) all += p.size();
  const std::size_t stride = all / kMostPlaces + 1;
  for (const lattice::TrackPiece& p : cut.pieces) {
    const auto add = [&](std::size_t i) {
      rows.add(p.track->x[i] / metre.size, p.track->y[i] / metre.size);
    };
    for (std::size_t i = p.begin; i < p.end; i += stride) add(i);
    add(p.end - 1);
    rows.gap();
  }
}

/// The borders of the cells: "x y dx dy".
void add_borders(Rows& rows, const Span& span, const lattice::CellFile& cell, const Sized& metre) {
  const double w = cell.width / metre.size, l = cell.length / metre.size;
  const double wide = w * static_cast<double>(span.right - span.left),
               tall = l * static_cast<double>(span.top - span.bottom);
  for (long i = span.left; i <= span.right; ++i)
    rows.add(w * static_cast<double>(i), l * static_cast<double>(span.bottom), 0, tall);
  for (long i = span.bottom; i <= span.top; ++i)
    rows.add(w * static_cast<double>(span.left), l * static_cast<double>(i), wide, 0);
}

}  // namespace

Figure figure_of(const CutTracks& cut, const lattice::CellFile& cell) {
  const Span span = span_of(cut, cell);
  const double left = cell.width * static_cast<double>(span.left),
               right = cell.width * static_cast<double>(span.right),
               bottom = cell.length * static_cast<double>(span.bottom),
               top = cell.length * static_cast<double>(span.top);
  const Sized metre = readable_unit("m", std::max({-left, right, -bottom, top}));
  std::vector<std::array<double, 2>> crossed, lost, trapped;
  for (std::size_t i = 0; i < cut.passages.size(); ++i) {
    const CutPassage& p = cut.passages[i];
    const bool goes_on =
        i > 0 && cut.passages[i - 1].track == p.track && cut.passages[i - 1].trial == p.trial;
    if (!goes_on) crossed.push_back(p.from);
    (p.end == CutEnd::left ? crossed : p.end == CutEnd::lost ? lost : trapped).push_back(p.to);
  }
  const double scale = std::min(414.0 / (right - left), 520.0 / (top - bottom));
  const Box box{78, 78 + scale * (right - left), 44, 44 + scale * (top - bottom)};
  const bool with_borders =
      span.right - span.left <= kMostBorders && span.top - span.bottom <= kMostBorders;
  const std::size_t most = std::max({crossed.size(), lost.size(), trapped.size()});
  Panels out;
  Rows& ways = out.data("$ways");
  add_ways(ways, cut, metre);
  Panel& panel = out.add(box);
  panel.say(fmt::format("{} passages of {} pieces of track{}{}", cut.passages.size(),
                        cut.pieces.size(), most > kMostMarks ? "; not all marks are drawn" : "",
                        with_borders ? "" : "; too many borders to be drawn"),
            8, 18);
  panel.border = 15;
  panel.x = {fmt::format("x ({})", metre.name), left / metre.size, right / metre.size,
             digits(tic_step((right - left) / metre.size, std::max(1.0, box.width() / 70.0)))};
  panel.y = {fmt::format("y ({})", metre.name), bottom / metre.size, top / metre.size};
  if (with_borders) {
    Rows& borders = out.data("$borders");
    add_borders(borders, span.within(cut.columns, cut.rows), cell, metre);
    panel.draw(borders, "1:2:3:4", "vectors nohead", {"#999999", 0.6});
  }
  panel.draw(ways, "1:2", "lines", {kFirstColour, 0.7});
  double at = 8.0;
  const auto add = [&](const char* name, const std::vector<std::array<double, 2>>& marks,
                       const Pen& pen, const std::string& word) {
    if (marks.empty()) return;
    Rows& rows = out.data(name);  // no more than can be told apart
    for (std::size_t i = 0; i < marks.size(); i += marks.size() / kMostMarks + 1)
      rows.add(marks[i][0] / metre.size, marks[i][1] / metre.size);
    panel.draw(rows, "1:2", "points", pen);
    out.add_key(at, box.bottom + 62,
                {entry("points", pen, fmt::format("{} {}", word, marks.size()))});
    at += 166.0;
  };
  add("$crossed", crossed, {.colour = "#000000", .mark = 7, .size = 0.3}, "border crossed");
  add("$trapped", trapped, {.colour = kThirdColour, .mark = 5, .size = 0.6}, "trapped");
  add("$lost", lost, {kSecondColour, 1.5, 2, 0.8}, "lost");
  return out.figure(static_cast<int>(box.bottom + 88));
}

}  // namespace gatewalk::cli
