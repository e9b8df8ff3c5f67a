// SPDX-License-Identifier: MIT
#pragma once
/// What the figures of several commands share: text for gnuplot, one look.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// Sizes of letters in figures of Sheet::kWidth: 7.5 (6 in an index) and 6 points, printed 3.5
/// inches wide, one column of a journal. Nothing is smaller.
inline constexpr int kFont = 15, kSmallFont = 12;

/// A figure as gnuplot draws it: its size in points of the screen, and the script without terminal.
struct Figure {
  int width = 0, height = 0;
  std::string commands;
  int font = 12;  // its size
};

/// What the file of a figure says of it, in its metadata.
struct AboutFigure {
  std::string title;    // in a line
  std::string made_by;  // the program's command
};

/// A rectangle of a figure, in points from its left and its upper edge.
struct Box {
  double left, right, top, bottom;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
  /// The place for a bar of colours on its right.
  [[nodiscard]] Box beside(double gap = 12, double wide = 10) const {
    return {right + gap, right + gap + wide, top, bottom};
  }
};

/// A panel's axes, ticks outwards with their numbers close by; and of lines that only help to
/// read: thin, in the text's ink.
inline constexpr char kFrame[] =
    "unset key\nset border 3\nset tics out scale 0.5\nset xtics nomirror offset 0,0.5\nset "
    "ytics nomirror offset 0.4,0\n";
inline constexpr char kThin[] = " lt -1 lw 0.2";

/// The paper of a figure.
struct Sheet {
  static constexpr int kWidth = 504;
  int height = 0;

  /// Where the next panel is drawn.
  [[nodiscard]] std::string margins(const Box& box) const;
  /// "x,y" in gnuplot's measure of a whole figure.
  [[nodiscard]] std::string at(double left, double top) const;
};

/// Shares in %, from 0 to `most`, as colours by their square root: small ones can be told apart.
class RootScale {
 public:
  explicit RootScale(double most) : most_(most > 0.0 ? most : 1.0) {}
  [[nodiscard]] double most() const { return most_; }
  /// "'0' 0, '1' 1, '4' 2"
  [[nodiscard]] std::string tics() const;

 private:
  double most_;
};

/// What is written on sequential colours from 0 to `most`, column 3 of the data: black on light
/// ones, white on dark ones, for gnuplot's "rgb variable".
[[nodiscard]] std::string ink(double most);

/// A share of all with its 95 % interval (NaN: none), for a horizontal bar.
struct ShareBar {
  std::string name;
  double share;
  std::array<double, 2> interval;
};
/// Height that so many bars want.
[[nodiscard]] constexpr double height_of_bars(std::size_t bars) {
  return 24.0 * static_cast<double>(bars);
}

/// The sequential colours (viridis), dark to light; and one colour for bars and first curves.
inline constexpr char kSequential[] =
    "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', "
    "5 '#4ac16d', 6 '#a0da39', 7 '#fde725')\n";
/// Colours of bars and curves, told apart on white and on dark paper (Okabe and Ito's, but the
/// fifth), and from one sign of a difference to the other.
inline constexpr char kFirstColour[] = "#0072b2", kSecondColour[] = "#d55e00",
                      kThirdColour[] = "#009e73", kFourthColour[] = "#cc79a7",
                      kFifthColour[] = "#8c6d1f";
inline constexpr char kDiverging[] =
    "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')\n";

/// Text for titles and labels of gnuplot, with nothing in it that gnuplot would understand.
[[nodiscard]] std::string literal(std::string_view text);

/// "name << EOD ... EOD", the rows of a table that `plot` can read as name.
[[nodiscard]] std::string data_block(std::string_view name, const std::string& rows);

/// Tics of a logarithmic axis from low to high, so many points long: 1, 2 and 5 times the powers of
/// ten, with numbers at these alone, or at some of them, where more would touch.
[[nodiscard]] std::string tics_1_2_5(double low, double high, double length);

/// 1, 2 or 5 times a power of ten that cuts `span` into about `parts`.
[[nodiscard]] double tic_step(double span, double parts);

/// The next lower number of one digit: 0.0271 is "0.02".
[[nodiscard]] std::string short_number(double x);

}  // namespace gatewalk::cli
