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

/// Reads a table row by row. Commas, semicolons or tabs separate fields, which may be quoted (RFC
/// 4180); numbers may have decimal commas. Blank rows and comments (#) are skipped. remarks() tells
/// what differs from plain CSV. All members throw std::invalid_argument naming file and line.
class Table {
 public:
  using Names = std::vector<std::string>;
  /// Returns whether a line names the columns of the wanted table.
  using IsHeader = std::function<bool(const Names&)>;

  /// The header is the first of the first 200 lines that `is_header` accepts; if there is none, the
  /// first line.
  Table(const std::string& path, const IsHeader& is_header);

  [[nodiscard]] const Names& columns() const { return columns_; }
  /// False if `is_header` accepted no line, so that columns() is the first line.
  [[nodiscard]] bool has_header() const { return has_header_; }
  [[nodiscard]] std::int64_t header_line() const { return header_line_; }
  /// The columns as text for messages: `body, frame, x, y`, and what seems wrong with them.
  [[nodiscard]] std::string column_words() const;
  /// Index of the column `name`; an exact match goes before one that differs in case.
  /// Two columns of one name must have the same content in every row.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name);
  /// Index of `name` in any list of column names; nullopt if it is missing.
  [[nodiscard]] static std::optional<std::size_t> column_in(const Names& names,
                                                            std::string_view name);
  /// True for names that programs give to an index column: empty, or "Unnamed: 0".
  [[nodiscard]] static bool is_index(std::string_view name);

  /// Reads the next row. Returns false after the last row.
  [[nodiscard]] bool next();
  /// The fields of the current row, one per column; valid until the next row.
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  [[nodiscard]] std::string_view operator[](std::size_t column) const { return fields_[column]; }
  [[nodiscard]] std::int64_t line() const { return line_; }
  [[nodiscard]] const Lines& lines() const { return lines_; }
  [[nodiscard]] char separator() const { return separator_; }

  /// The number in a field: NaN if the field is missing or infinite, nullopt if it is no number.
  [[nodiscard]] std::optional<double> number(std::string_view field);
  /// A whole number, possibly with a decimal 0 as pandas writes: "12.0".
  [[nodiscard]] static std::optional<std::int64_t> whole(std::string_view field);

  [[noreturn]] void refuse(const std::string& what) const { refuse(line_, what); }
  [[noreturn]] void refuse(std::int64_t line, const std::string& what) const;

  /// How the file was read, where it is not plain CSV; one sentence each.
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
  std::deque<std::string> held_;  // lines read ahead
  std::int64_t held_line_ = 0;    // number of the first of held_
  std::int64_t line_ = 0, header_line_ = 0, before_header_ = 0;
  bool has_header_ = false, is_first_row_ = true, begins_quoted_ = false;
  char separator_ = ',', decimal_ = '\0';
  std::int64_t decimal_line_ = 0, headers_ = 0, comments_ = 0;
  /// Of the previous row, if a column without a name has row numbers.
  std::optional<std::int64_t> row_number_;
  std::string record_, unquoted_;  // a row over several lines; fields in quotation marks
  Names columns_;
  std::vector<std::string_view> fields_;
  std::unordered_map<std::string, std::vector<std::size_t>> places_;  // of columns, by name
  std::vector<std::pair<std::size_t, std::size_t>> same_;  // pairs of columns of one name
};

}  // namespace gatewalk::lattice
