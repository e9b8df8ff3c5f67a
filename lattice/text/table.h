// SPDX-License-Identifier: MIT
#pragma once
/// Tables in text files, as spreadsheets and other programs write them.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lattice/text/lines.h"

namespace gatewalk::lattice {

/// Reads a table row by row. Fields are set apart by commas, semicolons or tabs and may stand in
/// quotation marks (RFC 4180); numbers may have decimal commas. Blank rows and comments (#) are no
/// rows. What is not plain CSV is in remarks(). All members throw std::invalid_argument naming file
/// and line.
class Table {
 public:
  using Names = std::vector<std::string>;
  /// Whether a line names the columns of the table that is wanted.
  using IsHeader = std::function<bool(const Names&)>;

  /// The columns are named by the first of the first 200 lines that `is_header` accepts; if there
  /// is none, by the first line.
  Table(const std::string& path, const IsHeader& is_header);

  [[nodiscard]] const Names& columns() const { return columns_; }
  /// False: no line is accepted, so that columns() are what the first line has.
  [[nodiscard]] bool has_header() const { return has_header_; }
  [[nodiscard]] std::int64_t header_line() const { return header_line_; }
  /// The columns in words: `body, frame, x, y`, and what seems to be wrong with them.
  [[nodiscard]] std::string column_words() const;
  /// Where `name` stands in columns(), whatever its capitals if none is the same; two of one name
  /// must have the same content in every row.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name);
  /// The same for the names of any line.
  [[nodiscard]] static std::optional<std::size_t> column_in(const Names& names,
                                                            std::string_view name);
  /// Whether a name is what programs give to an index: nothing, or "Unnamed: 0".
  [[nodiscard]] static bool is_index(std::string_view name);

  /// The next row. False: there is none.
  [[nodiscard]] bool next();
  /// Of the row, as many as columns; valid until the next one.
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  [[nodiscard]] std::string_view operator[](std::size_t column) const { return fields_[column]; }
  [[nodiscard]] std::int64_t line() const { return line_; }
  [[nodiscard]] const Lines& lines() const { return lines_; }
  [[nodiscard]] char separator() const { return separator_; }

  /// The number in a field: NaN where it says nothing or is infinite, none where it is no number.
  [[nodiscard]] std::optional<double> number(std::string_view field);
  /// A whole number, which may be written with a decimal 0, as pandas does: "12.0".
  [[nodiscard]] static std::optional<std::int64_t> whole(std::string_view field);

  [[noreturn]] void refuse(const std::string& what) const { refuse(line_, what); }
  [[noreturn]] void refuse(std::int64_t line, const std::string& what) const;

  /// What was understood of the file, where it is not plain CSV.
  [[nodiscard]] std::vector<std::string> remarks() const;

 private:
  void find_header(const IsHeader& is_header);
  [[nodiscard]] bool is_header_line(std::string_view line, const IsHeader& is_header);
  void take_first_line();
  [[nodiscard]] bool next_line(std::string_view& line);
  void split_row(std::string_view line);
  void fit_to_columns();
  void require_same_content();
  void note_decimal(char mark, std::string_view field);

  Lines lines_;
  std::deque<std::string> held_;  // lines that were read ahead, ...
  std::int64_t held_line_ = 0;    // ... and the number of the first of them
  std::int64_t line_ = 0, header_line_ = 0, before_header_ = 0;
  bool has_header_ = false, is_first_row_ = true, begins_quoted_ = false;
  char separator_ = ',', decimal_ = '\0';
  std::int64_t decimal_line_ = 0, headers_ = 0, comments_ = 0;
  std::optional<std::int64_t> row_number_;  // of the row before, where a nameless column has them
  std::string record_, unquoted_;           // a row in several lines; fields in quotation marks
  Names columns_;
  std::vector<std::string_view> fields_;
  std::unordered_map<std::string, std::vector<std::size_t>> places_;  // of columns, by name
  std::vector<std::pair<std::size_t, std::size_t>> same_;             // columns of one name
};

}  // namespace gatewalk::lattice
