// SPDX-License-Identifier: MIT
#pragma once
/// Text tables: columns are declared once, rows are values.

#include <concepts>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gatewalk::cli {

/// A width for TextColumn: as wide as the column's widest line. kFit aligns text on the right,
/// -kFit on the left.
constexpr int kFit = std::numeric_limits<int>::max();

/// A column of a TextTable.
struct TextColumn {
  std::string heading = {};
  /// Width in characters: positive aligns text on the right, negative on the left, 0 does not
  /// align. Longer text is not cut and moves the rest of its line.
  int width = 0;
  int decimals = 0;         ///< decimals of floating-point numbers
  std::string unit = {};    ///< follows each floating-point number
  std::string before = {};  ///< precedes the column in each line, including the heading
};

/// What a cell of a table shows: words, an integer, or a number with its column's decimals.
class TextCell {
 public:
  TextCell(std::string words) : content_(std::move(words)) {}
  TextCell(std::string_view words) : content_(std::string(words)) {}
  TextCell(const char* words) : content_(words) {}
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool> && !std::same_as<Integer, char>) TextCell(Integer n)
      : content_(std::to_string(n)) {}
  template <std::floating_point Number>
  TextCell(Number x) : content_(static_cast<double>(x)) {}

  /// The cell's text in this column, without the blanks that align it.
  [[nodiscard]] std::string text_in(const TextColumn& column) const;

 private:
  std::variant<std::string, double> content_;
};

/// Lines of columns. Example:
///   TextTable table({{"row", 4}, {"share", 10, 1, "%"}, {"interval", 16}});
///   table.row({r + 1, 100.0 * share, "[2.0, 3.5]"});
///   out += table.text();
class TextTable {
 public:
  explicit TextTable(std::vector<TextColumn> columns) : columns_(std::move(columns)) {}

  /// Adds a line. A line with fewer cells than columns ends after its last cell.
  void row(const std::vector<TextCell>& cells);

  /// The line of headings; empty if no column has a heading.
  [[nodiscard]] std::string header() const;
  /// The lines that were added.
  [[nodiscard]] std::string rows() const;
  /// Headings and lines.
  [[nodiscard]] std::string text() const { return header() + rows(); }

 private:
  using Line = std::vector<std::string>;
  [[nodiscard]] Line headings() const;
  [[nodiscard]] std::string text_of(const Line& line) const;
  /// The width of a column; negative: text is aligned on the left.
  [[nodiscard]] int width_of(std::size_t column) const;

  std::vector<TextColumn> columns_;
  std::vector<Line> lines_;
};

}  // namespace gatewalk::cli
