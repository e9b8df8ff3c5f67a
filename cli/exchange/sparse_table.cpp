// SPDX-License-Identifier: MIT
#include "cli/exchange/sparse_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "cli/exchange/npz.h"
#include "cli/render/csv.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/lines.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

using lattice::printable;
using lattice::shortest;

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& what) {
  throw std::runtime_error(path + ":" + std::to_string(line) + ": " + what);
}

std::vector<std::string> lines_of_file(const std::string& path) {
  try {
    return lattice::lines_of(path);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(e.what());
  }
}

/// The whole text as a number.
template <class T>
bool read_number(const std::string& text, T& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// In order, and no place twice. `line_of`: of each entry as read.
void put_in_order(const std::string& path, SparseTable& table, std::vector<std::size_t> line_of) {
  std::vector<std::size_t> order(table.entries.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto place = [&](std::size_t k) {
    return std::pair(table.entries[k].row, table.entries[k].column);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  std::vector<SparseTable::Entry> sorted;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && place(order[k]) == place(order[k - 1]))
      refuse(path, line_of[order[k]],
             "has the same row and column as line " + std::to_string(line_of[order[k - 1]]));
    sorted.push_back(table.entries[order[k]]);
  }
  table.entries = std::move(sorted);
}

std::string value_text(const SparseTable& table, double value) {
  return table.whole ? std::to_string(static_cast<std::int64_t>(value)) : shortest(value);
}

const NumpyArray* find(const std::vector<NumpyArray>& arrays, const std::string& name) {
  for (const NumpyArray& array : arrays)
    if (array.name == name) return &array;
  return nullptr;
}

constexpr double kMostWhole = 9007199254740992.0;  // doubles hold all whole numbers up to it

}  // namespace

std::string matrix_market_of(const SparseTable& table, std::string comment) {
  for (char& c : comment)  // names of files may have anything
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  std::string text = std::string("%%MatrixMarket matrix coordinate ") +
                     (table.whole ? "integer" : "real") + " general\n% " + comment + "\n" +
                     std::to_string(table.rows) + " " + std::to_string(table.columns) + " " +
                     std::to_string(table.entries.size()) + "\n";
  for (const SparseTable::Entry& e : table.entries)
    text += std::to_string(e.row + 1) + " " + std::to_string(e.column + 1) + " " +
            value_text(table, e.value) + "\n";
  return text;
}

std::string csv_of(const SparseTable& table, const std::vector<std::string>& rows,
                   const std::vector<std::string>& columns, const std::string& value) {
  std::string text = "from,to," + value + "\n";
  for (const SparseTable::Entry& e : table.entries)
    text += csv_text(rows[static_cast<std::size_t>(e.row)]) + "," +
            csv_text(columns[static_cast<std::size_t>(e.column)]) + "," +
            value_text(table, e.value) + "\n";
  return text;
}

std::string npz_of(const SparseTable& table) {
  std::vector<std::int64_t> first(static_cast<std::size_t>(table.rows) + 1), column, whole;
  std::vector<double> real;
  for (const SparseTable::Entry& e : table.entries) {
    ++first[static_cast<std::size_t>(e.row) + 1];
    column.push_back(e.column);
    if (table.whole)
      whole.push_back(static_cast<std::int64_t>(e.value));
    else
      real.push_back(e.value);
  }
  for (std::size_t r = 1; r < first.size(); ++r) first[r] += first[r - 1];
  const auto n = static_cast<std::int64_t>(table.entries.size());
  NumpyArray data{"data", {n}, std::move(real)};
  if (table.whole) data.values = std::move(whole);
  return npz_of({{"indices", {n}, std::move(column)},
                 {"indptr", {table.rows + 1}, std::move(first)},
                 {"format", {}, "csr"},
                 {"shape", {2}, std::vector<std::int64_t>{table.rows, table.columns}},
                 std::move(data)});
}

SparseTable read_matrix_market(const std::string& path) {
  const std::vector<std::string> lines = lines_of_file(path);
  SparseTable table;
  std::vector<std::string> head = words_of(lines.empty() ? "" : lines.front());
  for (std::string& word : head)
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return std::tolower(c); });
  if (head.size() != 5 || head[0] != "%%matrixmarket" || head[1] != "matrix" ||
      head[2] != "coordinate" || (head[3] != "real" && head[3] != "integer") ||
      head[4] != "general")
    refuse(path, 1,
           "must be \"%%MatrixMarket matrix coordinate real general\", or integer for real");
  table.whole = head[3] == "integer";
  std::int64_t promised = -1;
  std::vector<std::size_t> line_of;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    if (lines[k].starts_with('%')) continue;
    const std::vector<std::string> words = words_of(lines[k]);
    if (words.empty()) continue;
    if (promised < 0) {
      if (words.size() != 3 || !read_number(words[0], table.rows) ||
          !read_number(words[1], table.columns) || !read_number(words[2], promised) ||
          table.rows < 1 || table.columns < 1 || promised < 0)
        refuse(path, k + 1, "must be the numbers of rows, columns and entries");
      continue;
    }
    SparseTable::Entry e;
    if (words.size() != 3 || !read_number(words[0], e.row) || !read_number(words[1], e.column) ||
        !read_number(words[2], e.value))
      refuse(path, k + 1, "must be a row, a column and a number, such as 1 2 0.25");
    if (e.row < 1 || e.row > table.rows || e.column < 1 || e.column > table.columns)
      refuse(path, k + 1,
             "row and column must lie in 1 to " + std::to_string(table.rows) + " and 1 to " +
                 std::to_string(table.columns));
    table.entries.push_back({e.row - 1, e.column - 1, e.value});
    line_of.push_back(k + 1);
  }
  if (promised < 0) throw std::runtime_error(path + ": holds no numbers of rows and columns");
  if (promised != std::ssize(table.entries))
    throw std::runtime_error(path + ": has " + std::to_string(table.entries.size()) +
                             " entries, not " + std::to_string(promised) + " as it says");
  put_in_order(path, table, line_of);
  return table;
}

SparseTable read_csv(const std::string& path, std::int64_t rows,
                     const std::vector<std::string>& columns) {
  SparseTable table{rows, std::ssize(columns), {}, false};
  std::map<std::string, std::int64_t> number_of;
  for (std::size_t c = 0; c < columns.size(); ++c)
    number_of[columns[c]] = static_cast<std::int64_t>(c);
  const auto state = [&](const std::string& text, std::int64_t end, std::size_t line) {
    const auto named = number_of.find(text);
    std::int64_t s = named == number_of.end() ? -1 : named->second, number = -1;
    if (read_number(text, number)) {
      if (named != number_of.end() && s != number)
        refuse(path, line,
               "\"" + printable(text) + "\" is the name of state " + std::to_string(s) +
                   " and the number of another: give states names that are no numbers");
      s = number;
    }
    if (s < 0 || s >= end)
      refuse(path, line,
             "there is no state \"" + printable(text) + "\"" +
                 (named == number_of.end() ? "" : " to start from"));
    return s;
  };
  const std::vector<std::string> lines = lines_of_file(path);
  std::vector<std::size_t> line_of;
  std::size_t columns_given = 0;
  int from = -1, to = -1, value = -1;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].empty() || lines[k].starts_with('#')) continue;
    const auto fields = lattice::csv_fields(lines[k]);
    if (!fields) refuse(path, k + 1, "has a quotation mark that is not closed");
    if (from < 0) {
      for (std::size_t f = 0; f < fields->size(); ++f) {
        const std::string& name = (*fields)[f];
        const bool is_count = name == "count";
        if (name == "from") from = static_cast<int>(f);
        if (name == "to") to = static_cast<int>(f);
        if (is_count || name == "probability") value = static_cast<int>(f);
        table.whole = table.whole || is_count;
      }
      const auto times = [&](const char* name) {
        return std::count(fields->begin(), fields->end(), name);
      };
      if (times("from") != 1 || times("to") != 1 || times("count") + times("probability") != 1)
        refuse(path, k + 1,
               "must name the columns, each once: from,to,count or from,to,probability");
      columns_given = fields->size();
      continue;
    }
    if (fields->size() != columns_given)
      refuse(path, k + 1,
             "has " + std::to_string(fields->size()) + " fields, not " +
                 std::to_string(columns_given));
    const auto field = [&](int at) -> const std::string& {
      return (*fields)[static_cast<std::size_t>(at)];
    };
    SparseTable::Entry e{state(field(from), rows, k + 1), state(field(to), table.columns, k + 1),
                         0.0};
    if (!read_number(field(value), e.value))
      refuse(path, k + 1, "\"" + printable(field(value)) + "\" is no number");
    table.entries.push_back(e);
    line_of.push_back(k + 1);
  }
  put_in_order(path, table, line_of);
  return table;
}

SparseTable table_of(const std::string& path, const std::vector<NumpyArray>& arrays) {
  const auto whole = [&](const char* name) -> const std::vector<std::int64_t>& {
    const NumpyArray* const array = find(arrays, name);
    const auto* const values =
        array ? std::get_if<std::vector<std::int64_t>>(&array->values) : nullptr;
    if (!values)
      throw std::runtime_error(path + ": has no whole numbers \"" + name +
                               "\": it must be as scipy.sparse.save_npz writes compressed rows");
    return *values;
  };
  const NumpyArray* const format = find(arrays, "format");
  const auto* const kind = format ? std::get_if<std::string>(&format->values) : nullptr;
  if (!kind || *kind != "csr")
    throw std::runtime_error(path + ": its format must be csr (scipy: matrix.tocsr())");
  const auto &shape = whole("shape"), &first = whole("indptr"), &column = whole("indices");
  const NumpyArray* const data = find(arrays, "data");
  if (!data || std::holds_alternative<std::string>(data->values))
    throw std::runtime_error(path + ": has no numbers \"data\"");
  SparseTable table;
  table.whole = std::holds_alternative<std::vector<std::int64_t>>(data->values);
  std::vector<double> values;
  if (table.whole) {
    const auto& counts = std::get<std::vector<std::int64_t>>(data->values);
    values.assign(counts.begin(), counts.end());
  } else {
    values = std::get<std::vector<double>>(data->values);
  }
  if (shape.size() != 2 || shape[0] < 1 || shape[1] < 1 || std::ssize(first) != shape[0] + 1 ||
      values.size() != column.size() || first.front() != 0 || first.back() != std::ssize(column))
    throw std::runtime_error(path + ": its arrays do not fit each other");
  table.rows = shape[0];
  table.columns = shape[1];
  std::vector<std::size_t> entry_of;
  for (std::size_t row = 0; row + 1 < first.size(); ++row) {
    if (first[row + 1] < first[row])
      throw std::runtime_error(path + ": indptr goes down at row " + std::to_string(row));
    for (std::int64_t k = first[row]; k < first[row + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (column[at] < 0 || column[at] >= table.columns)
        throw std::runtime_error(path + ": row " + std::to_string(row) + " has a column " +
                                 std::to_string(column[at]));
      table.entries.push_back({static_cast<std::int64_t>(row), column[at], values[at]});
      entry_of.push_back(at + 1);
    }
  }
  put_in_order(path, table, entry_of);
  return table;
}

std::string text_of(const Trajectories& all) {
  std::string text;
  for (const auto& one : all) {
    for (std::size_t k = 0; k < one.size(); ++k)
      text += (k > 0 ? " " : "") + std::to_string(one[k]);
    text += "\n";
  }
  return text;
}

std::string npz_of(const Trajectories& all) {
  std::vector<NumpyArray> arrays;
  for (std::size_t k = 0; k < all.size(); ++k)
    arrays.push_back({"arr_" + std::to_string(k), {std::ssize(all[k])}, all[k]});
  return npz_of(arrays);
}

bool hold_trajectories(const std::vector<NumpyArray>& arrays) { return !find(arrays, "indptr"); }

Trajectories trajectories_of(const std::string& path, std::vector<NumpyArray> arrays) {
  Trajectories all;
  for (NumpyArray& array : arrays) {
    auto* const values = std::get_if<std::vector<std::int64_t>>(&array.values);
    if (!values || array.shape.size() != 1)
      throw std::runtime_error(path + ": array " + printable(array.name) +
                               ": a trajectory is one row of whole numbers");
    all.push_back(std::move(*values));
  }
  return all;
}

Trajectories read_trajectories(const std::string& path) {
  Trajectories all;
  const std::vector<std::string> lines = lines_of_file(path);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].starts_with('#')) continue;
    const std::vector<std::string> words = words_of(lines[k]);
    if (words.empty()) continue;
    auto& one = all.emplace_back();
    for (const std::string& word : words)
      if (!read_number(word, one.emplace_back()))
        refuse(path, k + 1,
               "\"" + printable(word) +
                   "\" is no whole number: a line is the states of a "
                   "trajectory, between blanks");
  }
  return all;
}

}  // namespace gatewalk::cli
