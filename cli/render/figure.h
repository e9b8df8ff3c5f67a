// SPDX-License-Identifier: MIT
#pragma once
/// What the figures of several commands share: text for gnuplot, and one look.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// Font sizes in figures of width Sheet::kWidth. Printed 3.5 inches wide (a column of a journal)
/// they are 7.5 (6 in an index) and 6 points; nothing is smaller.
inline constexpr int kFont = 15, kSmallFont = 12;

/// A figure for gnuplot: its size in points of the screen, and a script without a terminal.
struct Figure {
  int width = 0, height = 0;
  std::string commands;
  int font = 12;  // size of the font
};

/// The metadata in a figure's file.
struct AboutFigure {
  std::string title;    // one line
  std::string made_by;  // the command
};

/// A rectangle of a figure, in points from the left and upper edges.
struct Box {
  double left, right, top, bottom;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
  /// The place for a colour bar to the right of the box.
  [[nodiscard]] Box beside(double gap = 12, double wide = 10) const {
    return {right + gap, right + gap + wide, top, bottom};
  }
};

/// Axes of a panel, with outward tics and numbers close to them; and thin lines in the text's
/// colour that help to read.
inline constexpr char kFrame[] =
    "unset key\nset border 3\nset tics out scale 0.5\nset xtics nomirror offset 0,0.5\nset "
    "ytics nomirror offset 0.4,0\n";
inline constexpr char kThin[] = " lt -1 lw 0.2";

/// The sheet on which a figure is drawn.
struct Sheet {
  static constexpr int kWidth = 504;
  int height = 0;

  /// gnuplot's margins for a panel in this box.
  [[nodiscard]] std::string margins(const Box& box) const;
  /// "x,y" as fractions of the whole figure.
  [[nodiscard]] std::string at(double left, double top) const;
};

/// Colours for shares in %, from 0 to `most`, by their square root, so that small shares can be
/// distinguished.
class RootScale {
 public:
  explicit RootScale(double most) : most_(most > 0.0 ? most : 1.0) {}
  [[nodiscard]] double most() const { return most_; }
  /// "'0' 0, '1' 1, '4' 2"
  [[nodiscard]] std::string tics() const;

 private:
  double most_;
};

/// gnuplot's "rgb variable" for text on sequential colours from 0 to `most` (column 3 of the data):
/// black on light colours, white on dark ones.
[[nodiscard]] std::string ink(double most);

/// A share of all bodies with its 95 % interval (NaN: none), for a horizontal bar.
struct ShareBar {
  std::string name;
  double share;
  std::array<double, 2> interval;
};
/// The height (points) of a panel with this number of bars.
[[nodiscard]] constexpr double height_of_bars(std::size_t bars) {
  return 24.0 * static_cast<double>(bars);
}

/// The sequential colours (viridis), dark to light; and the colour of bars and first curves.
inline constexpr char kSequential[] =
    "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', "
    "5 '#4ac16d', 6 '#a0da39', 7 '#fde725')\n";
/// Colours of bars and curves that can be distinguished on white and dark paper (Okabe and Ito's,
/// except the fifth); and a diverging scale for differences.
inline constexpr char kFirstColour[] = "#0072b2", kSecondColour[] = "#d55e00",
                      kThirdColour[] = "#009e73", kFourthColour[] = "#cc79a7",
                      kFifthColour[] = "#8c6d1f";
inline constexpr char kDiverging[] =
    "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')\n";

/// Text for titles and labels, with gnuplot's markup escaped.
[[nodiscard]] std::string literal(std::string_view text);

/// "name << EOD ... EOD": the rows of a table, which `plot` reads by this name.
[[nodiscard]] std::string data_block(std::string_view name, const std::string& rows);

/// Tics of a logarithmic axis from low to high, `length` points long: 1, 2 and 5 times powers of
/// ten. Numbers stand at these, or only at some of them if they would touch.
[[nodiscard]] std::string tics_1_2_5(double low, double high, double length);

/// A tic step that cuts `span` into about `parts`: 1, 2 or 5 times a power of ten.
[[nodiscard]] double tic_step(double span, double parts);

/// x rounded down to one digit: 0.0271 becomes "0.02".
[[nodiscard]] std::string short_number(double x);

}  // namespace gatewalk::cli
