// SPDX-License-Identifier: MIT
// Tables of any columns, of which one is called a. What was read is written again.
#include "lattice/text/table.h"

#include <cmath>

#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

using Rows = std::vector<std::vector<std::string>>;

bool has_a(const lattice::Table::Names& names) {
  return lattice::Table::column_in(names, "a").has_value();
}

Rows rows_of(const std::string& path) {
  lattice::Table table(path, has_a);
  Rows rows{table.columns()};
  const auto a = table.column("a");
  while (table.next()) {
    require(table.fields().size() == table.columns().size(), "a row has a field for each column");
    rows.emplace_back(table.fields().begin(), table.fields().end());
    if (a) (void)table.number(table[*a]);
    require(table.line() > table.header_line(), "rows are below the names");
  }
  (void)table.remarks();
  (void)table.column_words();
  return table.has_header() ? rows : Rows{};
}

std::string quoted(const std::string& field) {
  std::string text = "\"";
  for (const char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace

void table(std::string_view bytes) {
  const auto rows = accepted([&] { return rows_of(file_of(bytes, ".csv")); });
  if (!rows || rows->empty()) return;
  std::string text;
  for (const auto& row : *rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      text += quoted(row[i]) + (i + 1 < row.size() ? ";" : "\n");  // 1,016 then means no thousands
  const auto again = accepted([&] { return rows_of(file_of(text, ".again.csv")); });
  require(again == rows,
          "a table written with quotation marks and semicolons and read is the same");
}

}  // namespace gatewalk::fuzz
