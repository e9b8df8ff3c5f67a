// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/cut_tracks.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

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

std::string place(double x, double y, const Sized& metre) {
  return digits(x / metre.size) + " " + digits(y / metre.size) + "\n";
}

/// Ways, a blank line between two.
std::string ways_of(const CutTracks& cut, const Sized& metre) {
  std::size_t all = 0;
  for (const lattice::TrackPiece& p : cut.pieces) all += p.size();
  const std::size_t stride = all / kMostPlaces + 1;
  std::string rows;
  for (const lattice::TrackPiece& p : cut.pieces) {
    for (std::size_t i = p.begin; i < p.end; i += stride)
      rows += place(p.track->x[i], p.track->y[i], metre);
    rows += place(p.track->x[p.end - 1], p.track->y[p.end - 1], metre) + "\n";
  }
  return rows;
}

/// The places of those marks that are drawn: no more than can be told apart.
std::string some_of(const std::vector<std::array<double, 2>>& marks, const Sized& metre) {
  std::string rows;
  for (std::size_t i = 0; i < marks.size(); i += marks.size() / kMostMarks + 1)
    rows += place(marks[i][0], marks[i][1], metre);
  return rows;
}

/// The borders of the cells: "x y dx dy".
std::string borders_of(const Span& span, const lattice::CellFile& cell, const Sized& metre) {
  const double w = cell.width / metre.size, l = cell.length / metre.size;
  const double wide = w * static_cast<double>(span.right - span.left),
               tall = l * static_cast<double>(span.top - span.bottom);
  const auto line = [](double x, double y, double dx, double dy) {
    return digits(x) + " " + digits(y) + " " + digits(dx) + " " + digits(dy) + "\n";
  };
  std::string rows;
  for (long i = span.left; i <= span.right; ++i)
    rows += line(w * static_cast<double>(i), l * static_cast<double>(span.bottom), 0.0, tall);
  for (long i = span.bottom; i <= span.top; ++i)
    rows += line(w * static_cast<double>(span.left), l * static_cast<double>(i), wide, 0.0);
  return rows;
}

}  // namespace

Figure figure_of(const CutTracks& cut, const lattice::CellFile& cell) {
  const Span span = span_of(cut, cell);
  const double left = cell.width * static_cast<double>(span.left),
               right = cell.width * static_cast<double>(span.right),
               bottom = cell.length * static_cast<double>(span.bottom),
               top = cell.length * static_cast<double>(span.top);
  const Sized metre = readable_unit("m", std::max({-left, right, -bottom, top}));
  const auto length = [&](double x) { return digits(x / metre.size); };
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
  const Sheet sheet{static_cast<int>(box.bottom + 88)};
  const bool with_borders =
      span.right - span.left <= kMostBorders && span.top - span.bottom <= kMostBorders;
  const auto dot = [](const char* mark) { return std::string("with points ") + mark; };
  const std::string at_crossed = dot("pt 7 ps 0.3 lc rgb '#000000'"),
                    at_lost = dot("pt 2 ps 0.8 lw 1.5 lc rgb '") + kSecondColour + "'",
                    at_trapped = dot("pt 5 ps 0.6 lc rgb '") + kThirdColour + "'";
  std::string data = data_block("$ways", ways_of(cut, metre)), plot, keys;
  if (with_borders) {
    data += data_block("$borders", borders_of(span.within(cut.columns, cut.rows), cell, metre));
    plot += "$borders using 1:2:3:4 with vectors nohead lw 0.6 lc rgb '#999999', ";
  }
  plot += std::string("$ways using 1:2 with lines lw 0.7 lc rgb '") + kFirstColour + "'";
  double at = 8.0;
  const auto add = [&](const char* name, const std::vector<std::array<double, 2>>& marks,
                       const std::string& style, const std::string& word) {
    if (marks.empty()) return;
    data += data_block(name, some_of(marks, metre));
    plot += std::string(", ") + name + " using 1:2 " + style;
    keys += sheet.key(at, box.bottom + 62,
                      {style + " title '" + word + " " + std::to_string(marks.size()) + "'"});
    at += 166.0;
  };
  add("$crossed", crossed, at_crossed, "border crossed");
  add("$trapped", trapped, at_trapped, "trapped");
  add("$lost", lost, at_lost, "lost");
  const std::size_t most = std::max({crossed.size(), lost.size(), trapped.size()});
  const std::string title = std::to_string(cut.passages.size()) + " passages of " +
                            std::to_string(cut.pieces.size()) + " pieces of track" +
                            (most > kMostMarks ? "; not all marks are drawn" : "") +
                            (with_borders ? "" : "; too many borders to be drawn");
  return {Sheet::kWidth, sheet.height,
          data + "set multiplot\n" + sheet.margins(box) + sheet.text(title, 8, 18) + kFrame +
              "set border 15\n" +
              Sheet::axes("'x (" + metre.name + ")'", "'y (" + metre.name + ")'") + "set xrange [" +
              length(left) + ":" + length(right) + "]\nset yrange [" + length(bottom) + ":" +
              length(top) + "]\nset xtics " +
              digits(tic_step((right - left) / metre.size,
                              std::max(1.0, (box.right - box.left) / 70.0))) +
              "\nplot " + plot + "\nunset label\n" + keys + "unset multiplot\n",
          kFont};
}

}  // namespace gatewalk::cli
