// SPDX-License-Identifier: MIT
#pragma once
/// Figures as data: panels with axes, colours, texts and layers, written for gnuplot.
///
///   Panels out;
///   Rows& chain = out.data("$chain");
///   for (...) chain.add(row, chance);
///   Panel& p = out.add(Box{84, 490, 44, 272});
///   p.x.name = "row";
///   p.y.name = "chance";
///   p.say("How likely a body gets so far", 8, 18);
///   p.draw(chain, "1:2", "lines", {.colour = kSecondColour, .width = 2}, "chain");
///   return out.figure(330);
///
/// Each panel is complete: its settings do not affect the next panel.

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

/// A block of data, rows of numbers and words, which layers read by its name ("$chain").
class Rows {
 public:
  explicit Rows(std::string name) : name_(std::move(name)) {}

  /// Adds a row: numbers as digits() or std::to_string write them, both ends of an interval, words
  /// as they stand.
  template <class... Values>
  void add(const Values&... values) {
    std::string row;
    ((row += (row.empty() ? "" : " ") + word(values)), ...);
    text_ += row + "\n";
  }
  /// Adds an empty line: a gap in curves, the next line of images.
  void gap() { text_ += "\n"; }

  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }

  /// gnuplot commands after the data that derive other data from it.
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

/// A text of a figure, drawn as it stands. The text of markup() may hold gnuplot's "_", "^" and
/// "{/:Italic ...}".
struct Caption {
  std::string text;
  enum class Kind { plain, verbatim, marked_up } kind = Kind::plain;

  Caption() = default;
  Caption(std::string words) : text(std::move(words)) {}
  Caption(const char* words) : text(words) {}
  /// The text in gnuplot's quotes. Plain texts are marked "noenhanced" where necessary, verbatim
  /// texts always; the picture is the same, but an SVG has other elements.
  [[nodiscard]] std::string quoted() const;
};
[[nodiscard]] Caption markup(std::string text);
[[nodiscard]] Caption verbatim(std::string text);

/// The look of lines, marks and areas. For 0 and null gnuplot's default applies.
struct Pen {
  const char* colour = nullptr;  // "#0072b2", or one of those below
  double width = 0.0;            // of lines
  int mark = 0;                  // gnuplot's number of a symbol
  double size = 0.0;             // of symbols
  int dashes = 0;                // gnuplot's number of a pattern
};
/// Colours of a Pen: the text's colour, which follows the reader's light or dark mode; the last
/// column of the data as a number 0xrrggbb; the last column by the panel's palette.
inline constexpr char kInk[] = "ink", kOwnColour[] = "rgb variable", kByPalette[] = "palette";

/// Data in a panel. `with` is gnuplot's word for the kind:
///   map     boxxyerror (cells of any size), image (of a grid)
///   curve   lines, linespoints, yerrorlines, filledcurves
///   bars    boxxyerror, boxes, vectors
///   points  points, xerrorbars, yerrorbars, labels, circles
struct Layer {
  std::string data;     // name of a block, or a function of x such as "0.5"
  std::string columns;  // gnuplot's "using": "1:2", "($2/2):1"; or empty
  std::string with;
  Pen pen = {};
  Caption title = {};  // in the key; empty: none
};

/// A number that gnuplot chooses.
inline constexpr double kFree = std::numeric_limits<double>::quiet_NaN();
/// Axis::tics of an axis without tics.
inline constexpr char kNoTics[] = "none";

/// Layer::with for bars in the columns "x:y:half_width:half_height".
inline constexpr char kBars[] = "boxxyerror fs solid noborder";
/// Layer::with for intervals in the columns "x:y:dx:dy". gnuplot's own error bars have a white disc
/// in the middle in a PNG.
inline constexpr char kIntervals[] = "vectors heads size screen 0.006,90";
inline constexpr Pen kIntervalPen{.colour = kInk, .width = 1.2};

struct Axis {
  Caption name = {};
  double low = kFree, high = kFree;  // low above high reverses the axis
  std::string tics = {};    // "5", "0,25" or tics_of(...), with their look; kNoTics; or empty
  std::string format = {};  // of the tics' numbers, "%g"
  bool numbers = true;      // whether tics have numbers
  bool logarithmic = false;
  std::string name_look = {};  // gnuplot's place of the name, "offset 0.2,0"; or empty
};

/// The colours of a map, and the bar that explains them.
struct Colours {
  double low = kFree, high = kFree;
  std::optional<Box> bar = {};  // upright, or below maps
  std::string tics = {};        // as Axis::tics
  Caption name = {};
  std::string name_look = {};
  std::string palette = kSequential;
};

/// A text, vertically centred at `middle`: in points on the sheet, or at a place on the panel's
/// axes.
struct Text {
  Caption text = {};
  double left = 0.0, middle = 0.0;
  int font = kFont;
  std::string how = "left";  // or "right", "center rotate by 90" and more
  bool on_axes = false;
  Pen mark = {};  // drawn at that place
};

/// A key: gnuplot's "on bottom left ...", or a place on the sheet.
struct Legend {
  std::string how;
  double left = kFree, top = kFree;
};

/// A vertical line over the panel's whole height at x.
struct Upright {
  double x;
  Pen pen;
  bool in_front = false;  // of the data
};

struct Panel {
  Box box;
  Axis x = {}, y = {};
  int border = 3;         // sum of its sides: 1 below, 2 left, 4 above, 8 right
  int tics_font = 0;      // of the tics' numbers; 0: the figure's
  std::string grid = {};  // gnuplot's grid, "ytics lt -1 lw 0.2"; empty: none
  std::optional<Legend> key = {};
  std::optional<Colours> colours = {};
  std::vector<Text> texts = {};
  std::vector<Upright> uprights = {};
  std::vector<Layer> layers = {};
  std::string more = {};  // further gnuplot commands, such as objects

  explicit Panel(const Box& place) : box(place) {}

  void say(Caption text, double left, double middle, int font = kFont) {
    texts.push_back({std::move(text), left, middle, font});
  }
  /// Adds a layer on top of the earlier ones; does nothing without rows.
  void draw(const Rows& rows, std::string columns, std::string with, Pen pen = {},
            Caption title = {});
  /// Adds another layer with the data of the last one.
  void draw_again(std::string columns, std::string with, Pen pen = {});
  /// Adds a map of rectangles centred at columns 1 and 2, with these half widths, coloured by
  /// column 3. gnuplot's images would need at least four of them.
  void draw_cells(const Rows& rows, double half_x = 0.5, double half_y = 0.5);
  /// Writes column 4 of the last layer into its cells, in black or white; `most` has the lightest
  /// colour.
  void draw_numbers(double most);
  /// Adds a horizontal line.
  void draw_level(double at, Pen pen) { layers.push_back({digits(at), "", "lines", pen}); }
  /// Draws the data with a wide pen and over it with a narrow one, so that it is visible on any
  /// colour.
  void draw_outlined(const Rows& rows, const std::string& columns, const std::string& with,
                     const Pen& below, const Pen& above);
};

/// A figure made of panels, in the order in which they are drawn.
class Panels {
 public:
  /// `frame`: gnuplot's settings for the axes of all panels.
  explicit Panels(std::string frame = kFrame) : frame_(std::move(frame)) {}

  /// A new block of data. References to blocks and panels stay valid as long as this object.
  Rows& data(std::string name) { return data(Rows(std::move(name))); }
  Rows& data(Rows rows) { return data_.emplace_back(std::move(rows)); }
  Panel& add(const Box& box) { return add(Panel(box)); }
  Panel& add(Panel panel);
  /// A text that is drawn with the next panel, before its own texts.
  void say(Caption text, double left, double middle, int font = kFont) {
    texts_.push_back({std::move(text), left, middle, font});
  }
  /// A key of its own, with its upper left corner here. Of `entries` only the look and the titles
  /// count.
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

/// Tics with texts in place of numbers: anywhere, or for names at 0, 1, 2, ...
struct Tic {
  std::string text;
  double at;
};
[[nodiscard]] std::string tics_of(const std::vector<Tic>& tics);
[[nodiscard]] std::string tics_of(const std::vector<std::string>& names);

/// Sets the colours of a panel whose cells have square roots of shares, with a colour bar.
void add_colours(Panel& panel, const RootScale& scale, const Box& bar);

/// A panel of horizontal bars of shares, each with its interval and its number.
Panel& add_share_bars(Panels& out, const Box& box, const std::string& data,
                      const std::vector<ShareBar>& bars);

}  // namespace gatewalk::cli
