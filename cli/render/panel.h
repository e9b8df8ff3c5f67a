// SPDX-License-Identifier: MIT
#pragma once
/// Figures as data: panels with axes, colours, texts and layers, and one writer of them for
/// gnuplot.
///
///   Panels out;
///   Rows& chain = out.data("$chain");
///   for (...) chain.add(row, chance);
///   Panel& p = out.add({.box = {84, 490, 44, 272}, .x = {.name = "row"}, .y = {.name =
///   "chance"}}); p.say("How likely a body gets so far", 8, 18); p.draw(chain, "1:2", "lines",
///   {.colour = kSecondColour, .width = 2}, "chain"); return out.figure(330);
///
/// Each panel is complete: nothing that one sets holds in the next.

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/fields/text.h"
#include "cli/render/figure.h"

namespace gatewalk::cli {

/// A block of data that layers read by its name, "$chain": rows of numbers and words.
class Rows {
 public:
  explicit Rows(std::string name) : name_(std::move(name)) {}

  /// A row: numbers as digits() and std::to_string write them, both ends of an interval, words as
  /// they stand.
  template <class... Values>
  void add(const Values&... values) {
    std::string row;
    ((row += (row.empty() ? "" : " ") + word(values)), ...);
    text_ += row + "\n";
  }
  /// An empty line: curves have a gap there, and images begin their next line.
  void gap() { text_ += "\n"; }

  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }

  /// gnuplot's commands that make other data of these, written behind them.
  std::string derived;

 private:
  [[nodiscard]] static std::string word(double x) { return digits(x); }
  [[nodiscard]] static std::string word(std::integral auto n) { return std::to_string(n); }
  [[nodiscard]] static std::string word(const std::array<double, 2>& ends) {
    return digits(ends[0]) + " " + digits(ends[1]);
  }
  [[nodiscard]] static std::string word(std::string text) { return text; }

  std::string name_, text_;
};

/// A text of a figure, drawn as it stands; of markup() with gnuplot's "_", "^" and "{/:Italic
/// ...}".
struct Caption {
  std::string text;
  enum class Kind { plain, verbatim, marked_up } kind = Kind::plain;

  Caption() = default;
  Caption(std::string words) : text(std::move(words)) {}
  Caption(const char* words) : text(words) {}
  /// In gnuplot's quotes. Plain texts are "noenhanced" where they must be, verbatim ones always:
  /// the picture is the same, an SVG has other elements.
  [[nodiscard]] std::string quoted() const;
};
[[nodiscard]] Caption markup(std::string text);
[[nodiscard]] Caption verbatim(std::string text);

/// How lines, marks and areas look; what is 0 or null is as gnuplot has it.
struct Pen {
  const char* colour = nullptr;  // "#0072b2", or one of those below
  double width = 0.0;            // of lines
  int mark = 0;                  // gnuplot's number of a symbol
  double size = 0.0;             // of symbols
  int dashes = 0;                // gnuplot's number of a pattern
};
/// The ink of texts, light or dark as the reader's screen is; a colour that the last column of the
/// data gives, as a number 0xrrggbb or by the panel's palette.
inline constexpr char kInk[] = "ink", kOwnColour[] = "rgb variable", kByPalette[] = "palette";

/// Data in a panel. `with` is gnuplot's word for the kind:
///   map     boxxyerror (cells of any size), image (of a grid)
///   curve   lines, linespoints, yerrorlines, filledcurves
///   bars    boxxyerror, boxes, vectors
///   points  points, xerrorbars, yerrorbars, labels, circles
struct Layer {
  std::string data;     // name of a block, or a function of x such as "0.5"
  std::string columns;  // of the data, as gnuplot's "using" has them: "1:2", "($2/2):1"; or empty
  std::string with;
  Pen pen = {};
  Caption title = {};  // in the key; empty: none
};

/// Of a number that a figure leaves to gnuplot.
inline constexpr double kFree = std::numeric_limits<double>::quiet_NaN();
/// Of an axis without tics.
inline constexpr char kNoTics[] = "none";

/// Columns "x:y:half_width:half_height" as bars.
inline constexpr char kBars[] = "boxxyerror fs solid noborder";
/// Columns "x:y:dx:dy" as intervals with bars across (gnuplot's own error bars have a white disc in
/// the middle in a PNG).
inline constexpr char kIntervals[] = "vectors heads size screen 0.006,90";
inline constexpr Pen kIntervalPen{.colour = kInk, .width = 1.2};

struct Axis {
  Caption name = {};
  double low = kFree, high = kFree;  // low may be above high: the axis is turned round
  std::string tics = {};  // "5", "0,25", tics_of(...) and how they look; kNoTics; or gnuplot's own
  std::string format = {};  // of their numbers, "%g"
  bool numbers = true;      // without them tics stand alone
  bool logarithmic = false;
  std::string name_look = {};  // where the name stands, "offset 0.2,0"; or as of axes of two digits
};

/// What a map's colours say, and the bar that shows it.
struct Colours {
  double low = kFree, high = kFree;
  std::optional<Box> bar = {};  // upright, or below maps
  std::string tics = {};        // as those of an axis
  Caption name = {};
  std::string name_look = {};
  std::string palette = kSequential;
};

/// A text on the sheet, its middle at this height, in points; or at a place of the panel's axes.
struct Text {
  Caption text = {};
  double left = 0.0, middle = 0.0;
  int font = kFont;
  std::string how = "left";  // or "right", "center rotate by 90" and more
  bool on_axes = false;
  Pen mark = {};  // a point at that place
};

/// A key, "on bottom left ...", or with its place on the sheet.
struct Legend {
  std::string how;
  double left = kFree, top = kFree;
};

/// A line over the panel's whole height at a place of the x axis.
struct Upright {
  double x;
  Pen pen;
  bool in_front = false;  // of the data
};

struct Panel {
  Box box;
  Axis x = {}, y = {};
  int border = 3;         // sum of its sides: 1 below, 2 left, 4 above, 8 right
  int tics_font = 0;      // of their numbers; 0: the figure's
  std::string grid = {};  // of which tics and how, "ytics lt -1 lw 0.2"; empty: none
  std::optional<Legend> key = {};
  std::optional<Colours> colours = {};
  std::vector<Text> texts = {};
  std::vector<Upright> uprights = {};
  std::vector<Layer> layers = {};
  std::string more = {};  // other commands of gnuplot, such as objects

  explicit Panel(const Box& place) : box(place) {}

  void say(Caption text, double left, double middle, int font = kFont) {
    texts.push_back({std::move(text), left, middle, font});
  }
  /// A layer behind the others; none where there are no rows.
  void draw(const Rows& rows, std::string columns, std::string with, Pen pen = {},
            Caption title = {});
  /// Another one of the last one's data.
  void draw_again(std::string columns, std::string with, Pen pen = {});
  /// A map of rectangles at columns 1 and 2, of these halves, coloured by column 3 (gnuplot's
  /// images need four of them at least).
  void draw_cells(const Rows& rows, double half_x = 0.5, double half_y = 0.5);
  /// Column 4 of the last layer on its cells, black or white: `most` has the lightest colour.
  void draw_numbers(double most);
  /// A horizontal line.
  void draw_level(double at, Pen pen) { layers.push_back({digits(at), "", "lines", pen}); }
  /// The same data with a wide pen and, above it, with another: seen on every colour.
  void draw_outlined(const Rows& rows, const std::string& columns, const std::string& with,
                     const Pen& below, const Pen& above);
};

/// A figure of panels, in the order in which they are drawn.
class Panels {
 public:
  /// `frame`: what holds for the axes of all panels.
  explicit Panels(std::string frame = kFrame) : frame_(std::move(frame)) {}

  /// A new block of data. References to it and to panels hold as long as this.
  Rows& data(std::string name) { return data(Rows(std::move(name))); }
  Rows& data(Rows rows) { return data_.emplace_back(std::move(rows)); }
  Panel& add(const Box& box) { return add(Panel(box)); }
  Panel& add(Panel panel);
  /// A text that the next panel shows before its own.
  void say(Caption text, double left, double middle, int font = kFont) {
    texts_.push_back({std::move(text), left, middle, font});
  }
  /// A column of a key by itself, with this corner; of `entries` only how they look and their
  /// titles count.
  void add_key(double left, double top, std::vector<Layer> entries);

  [[nodiscard]] Figure figure(int height, int font = kFont) const;

 private:
  std::string frame_;
  std::deque<Rows> data_;
  std::deque<Panel> panels_;
  std::vector<Text> texts_;
};

/// An entry of Panels::add_key.
[[nodiscard]] inline Layer entry(std::string with, Pen pen, Caption title) {
  return {"NaN", "", std::move(with), pen, std::move(title)};
}

/// Tics with texts in place of numbers, in gnuplot's words: names at 0, 1, 2 ...; or anywhere.
struct Tic {
  std::string text;
  double at;
};
[[nodiscard]] std::string tics_of(const std::vector<Tic>& tics);
[[nodiscard]] std::string tics_of(const std::vector<std::string>& names);

/// The colours of a panel whose cells have roots of shares, with their bar and what it shows.
void add_colours(Panel& panel, const RootScale& scale, const Box& bar);

/// Horizontal bars of shares of all, each with its interval and its number.
Panel& add_share_bars(Panels& out, const Box& box, const std::string& data,
                      const std::vector<ShareBar>& bars);

}  // namespace gatewalk::cli
