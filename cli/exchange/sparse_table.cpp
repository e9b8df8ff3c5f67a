// SPDX-License-Identifier: MIT
#include "cli/exchange/sparse_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "cli/exchange/npz.h"
#include "cli/fields/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/lines.h"
#include "lattice/text/table.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

using lattice::printable;
using lattice::shortest;

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& what) {
  throw std::runtime_error(fmt::format("{}:{}: {}", path, line, what));
}

std::vector<std::string> lines_of_file(const std::string& path) {
  try {
    return lattice::lines_of(path);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(e.what());
  }
}

constexpr double kMostWhole = 9007199254740992.0;  // doubles hold all whole numbers up to here

/// Reads the whole text as a number.
bool read_number(const std::string& text, double& value) {
  std::string_view rest = text;
  const auto read = lattice::take_number(rest);
  value = read.value_or(0.0);
  return read && rest.empty();
}

/// Reads the whole text as an integer, which may be written as 3, +3, 3.0 or 3e0.
bool read_number(const std::string& text, std::int64_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc() && read.ptr == text.data() + text.size()) return true;
  double real = 0.0;
  if (!read_number(text, real) || real != std::floor(real) || std::abs(real) > kMostWhole)
    return false;
  value = static_cast<std::int64_t>(real);
  return true;
}

/// The digits and decimals of a number's text.
SparseTable::Precision precision_of(std::string_view text) {
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  const std::string_view mantissa = text.substr(0, e);
  SparseTable::Precision precision;
  bool behind_point = false;
  for (const char c : mantissa) {
    if (c == '.') behind_point = true;
    if (c < '0' || c > '9') continue;
    precision.decimals += behind_point ? 1 : 0;
    precision.digits += c != '0' || precision.digits > 0 ? 1 : 0;
  }
  std::string_view exponent = text.substr(std::min(e + 1, text.size()));
  constexpr double kMost = 400.0;  // no double has a larger exponent
  precision.decimals -=
      static_cast<int>(std::clamp(lattice::take_number(exponent).value_or(0.0), -kMost, kMost));
  return precision;
}

void note_precision(std::string_view number, SparseTable& table) {
  const SparseTable::Precision precision = precision_of(number);
  table.precision.digits = std::max(table.precision.digits, precision.digits);
  table.precision.decimals = std::max(table.precision.decimals, precision.decimals);
}

/// Reads a number of the table and notes its precision; returns false if the text is no number.
bool read_value(const std::string& text, SparseTable& table, double& value) {
  if (!read_number(text, value)) return false;
  note_precision(text, table);
  return true;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Sorts the entries. Entries at the same place are added, or refused if `line_of` names their
/// lines.
void put_in_order(const std::string& path, SparseTable& table,
                  const std::vector<std::size_t>& line_of = {}) {
  std::vector<std::size_t> order(table.entries.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto place = [&](std::size_t k) {
    return std::pair(table.entries[k].row, table.entries[k].column);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  std::vector<SparseTable::Entry> sorted;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || place(order[k]) != place(order[k - 1])) {
      sorted.push_back(table.entries[order[k]]);
      continue;
    }
    if (!line_of.empty())
      refuse(path, line_of[order[k]],
             fmt::format("has the same row and column as line {}", line_of[order[k - 1]]));
    sorted.back().value += table.entries[order[k]].value;
  }
  if (const std::size_t added = table.entries.size() - sorted.size(); added > 0)
    table.understood.push_back(fmt::format(
        "entries with the row and column of another are added to it, as scipy does: {}", added));
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

/// The words of a Matrix Market file's first line, in lower case. Throws, with advice, for numbers
/// that cannot belong to a chain.
std::vector<std::string> market_head(const std::string& path, const std::string& line) {
  std::vector<std::string> head = words_of(line);
  for (std::string& word : head) word = lattice::in_small_letters(word);
  const auto is = [&](std::size_t at, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), head[at]) != words.end();
  };
  if (head.size() != 5 || head[0] != "%%matrixmarket" || head[1] != "matrix" ||
      !is(2, {"coordinate", "array"}))
    refuse(path, 1,
           "must be \"%%MatrixMarket matrix coordinate real general\", array for coordinate, "
           "integer or unsigned-integer for real, symmetric for general");
  if (!is(3, {"real", "integer", "unsigned-integer"}))
    refuse(
        path, 1,
        fmt::format("\"{}\" are no counts or probabilities{}: write real or integer "
                    "(scipy.io.mmwrite(FILE, matrix, field=\"real\"))",
                    printable(head[3]), head[3] == "pattern" ? ": the numbers are left out" : ""));
  if (!is(4, {"general", "symmetric"}))
    refuse(path, 1,
           fmt::format("\"{}\" are no counts or probabilities: write general or symmetric "
                       "(scipy.io.mmwrite(FILE, matrix, symmetry=\"general\"))",
                       printable(head[4])));
  return head;
}

}  // namespace

std::string matrix_market_of(const SparseTable& table, std::string comment) {
  for (char& c : comment)  // names of files may hold any character
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  std::string text = fmt::format("%%MatrixMarket matrix coordinate {} general\n% {}\n{} {} {}\n",
                                 table.whole ? "integer" : "real", comment, table.rows,
                                 table.columns, table.entries.size());
  for (const SparseTable::Entry& e : table.entries)
    text += fmt::format("{} {} {}\n", e.row + 1, e.column + 1, value_text(table, e.value));
  return text;
}

std::string csv_of(const SparseTable& table, const std::vector<std::string>& rows,
                   const std::vector<std::string>& columns, const std::string& value) {
  std::string text = fmt::format("from,to,{}\n", value);
  for (const SparseTable::Entry& e : table.entries)
    text += fmt::format("{},{},{}\n", csv_text(rows[static_cast<std::size_t>(e.row)]),
                        csv_text(columns[static_cast<std::size_t>(e.column)]),
                        value_text(table, e.value));
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
  const std::vector<std::string> head = market_head(path, lines.empty() ? "" : lines.front());
  const bool dense = head[2] == "array", symmetric = head[4] == "symmetric";
  const std::size_t sizes = dense ? 2 : 3;
  SparseTable table;
  table.whole = head[3] != "real";
  std::int64_t promised = -1, seen = 0, row = 0, column = 0;  // row, column: next in an array
  for (std::size_t k = 1; k < lines.size(); ++k) {
    if (lines[k].starts_with('%')) continue;
    const std::vector<std::string> words = words_of(lines[k]);
    if (words.empty()) continue;
    if (promised < 0) {
      promised = 0;
      constexpr std::int64_t kMostRows = std::int64_t{1} << 31;
      if (words.size() != sizes || !read_number(words[0], table.rows) ||
          !read_number(words[1], table.columns) || table.rows < 1 || table.columns < 1 ||
          table.rows > kMostRows || table.columns > kMostRows ||
          (!dense && !read_number(words[2], promised)) || promised < 0)
        refuse(path, k + 1,
               std::string("must be the numbers of rows") +
                   (dense ? " and columns" : ", columns and entries"));
      if (symmetric && table.rows != table.columns)
        refuse(path, k + 1, "a symmetric matrix has as many rows as columns");
      if (dense)
        promised = symmetric ? table.rows * (table.rows + 1) / 2 : table.rows * table.columns;
      continue;
    }
    if (++seen > promised) continue;  // refused after the loop
    SparseTable::Entry e{row, column, 0.0};
    if (dense) {
      if (words.size() != 1 || !read_value(words[0], table, e.value))
        refuse(path, k + 1, "must be a number, those of a column one after the other");
      if (++row == table.rows) {
        ++column;
        row = symmetric ? column : 0;
      }
    } else {
      if (words.size() != 3 || !read_number(words[0], e.row) || !read_number(words[1], e.column) ||
          !read_value(words[2], table, e.value))
        refuse(path, k + 1, "must be a row, a column and a number, such as 1 2 0.25");
      if (e.row < 1 || e.row > table.rows || e.column < 1 || e.column > table.columns)
        refuse(path, k + 1,
               fmt::format("row and column must lie in 1 to {} and 1 to {}", table.rows,
                           table.columns));
      if (symmetric && e.column > e.row)
        refuse(path, k + 1, "lies above the diagonal: a symmetric file has the entries up to it");
      e = {e.row - 1, e.column - 1, e.value};
    }
    table.entries.push_back(e);
    if (symmetric && e.row != e.column) table.entries.push_back({e.column, e.row, e.value});
  }
  if (promised < 0) throw std::runtime_error(path + ": holds no numbers of rows and columns");
  if (promised != seen)
    throw std::runtime_error(
        fmt::format("{}: has {} entries, not {} as it says", path, seen, promised));
  if (dense) std::erase_if(table.entries, [](const auto& e) { return e.value == 0.0; });
  if (symmetric)
    table.understood.emplace_back("symmetric: what is below the diagonal is above it too");
  put_in_order(path, table);
  return table;
}

SparseTable read_csv(const std::string& path, std::int64_t rows,
                     const std::vector<std::string>& columns) {
  SparseTable table{rows, std::ssize(columns), {}, false};
  std::map<std::string, std::int64_t> number_of;
  for (std::size_t c = 0; c < columns.size(); ++c)
    number_of[columns[c]] = static_cast<std::int64_t>(c);
  lattice::Table file(path, [](const lattice::Table::Names& names) {
    const auto has = [&](const char* n) { return lattice::Table::column_in(names, n).has_value(); };
    return has("from") && has("to") && (has("count") || has("probability"));
  });
  const auto state = [&](std::size_t column, std::int64_t end) {
    const std::string text(file[column]);
    const auto named = number_of.find(text);
    std::int64_t s = named == number_of.end() ? -1 : named->second, number = -1;
    const bool plain = text.find_first_not_of("0123456789") == text.npos;
    if ((plain || named == number_of.end()) && read_number(text, number)) {
      if (named != number_of.end() && s != number)
        file.refuse(
            fmt::format("\"{}\" is the name of state {} and the number of another: give states "
                        "names that are no numbers",
                        printable(text), s));
      s = number;
    }
    if (s < 0 || s >= end)
      file.refuse(fmt::format("there is no state \"{}\"{}", printable(text),
                              named == number_of.end() ? "" : " to start from"));
    return s;
  };
  const auto from = file.column("from"), to = file.column("to"), count = file.column("count"),
             probability = file.column("probability");
  if (!from || !to || count.has_value() == probability.has_value())
    file.refuse(std::max<std::int64_t>(1, file.header_line()),
                "must name the columns from,to,count or from,to,probability; there are " +
                    file.column_words());
  table.whole = count.has_value();
  table.probabilities = probability.has_value();
  const std::size_t value = count ? *count : *probability;
  std::vector<std::size_t> line_of;
  while (file.next()) {
    const auto number = file.number(file[value]);
    if (!number || std::isnan(*number))
      file.refuse(fmt::format("\"{}\" is no number", printable(file[value])));
    std::string text(file[value]);
    std::replace(text.begin(), text.end(), ',', '.');
    if (count && file.separator() != ',' && text.ends_with(".000"))
      file.refuse(fmt::format("\"{}\" may be thousands: write counts without marks",
                              printable(file[value])));
    note_precision(text, table);
    table.entries.push_back({state(*from, rows), state(*to, table.columns), *number});
    line_of.push_back(static_cast<std::size_t>(file.line()));
  }
  for (std::string& remark : file.remarks()) table.understood.push_back(std::move(remark));
  put_in_order(path, table, line_of);
  return table;
}

SparseTable table_of(const std::string& path, const std::vector<NumpyArray>& arrays) {
  constexpr const char* kSaved = "scipy.sparse.save_npz(FILE, matrix.tocsr())";
  const auto whole = [&](const char* name) -> const std::vector<std::int64_t>& {
    const NumpyArray* const array = find(arrays, name);
    const auto* const values =
        array ? std::get_if<std::vector<std::int64_t>>(&array->values) : nullptr;
    if (!values)
      throw std::runtime_error(
          fmt::format("{}: has no whole numbers \"{}\": it must be as of {}", path, name, kSaved));
    return *values;
  };
  const NumpyArray* const format = find(arrays, "format");
  const auto* const kind = format ? std::get_if<std::string>(&format->values) : nullptr;
  if (!kind || (*kind != "csr" && *kind != "csc" && *kind != "coo"))
    throw std::runtime_error(fmt::format("{}: its format must be csr, csc or coo{}: {}", path,
                                         kind ? ", not " + printable(*kind) : "", kSaved));
  const auto& shape = whole("shape");
  const NumpyArray* const data = find(arrays, "data");
  if (!data || std::holds_alternative<std::string>(data->values))
    throw std::runtime_error(path + ": has no numbers \"data\"");
  if (data->type == "b1")
    throw std::runtime_error(path +
                             ": its data are true and false, and no counts: "
                             "matrix.astype(int) has 1 for true");
  SparseTable table;
  std::vector<double> values;
  if (const auto* counts = std::get_if<std::vector<std::int64_t>>(&data->values)) {
    table.whole = true;
    values.assign(counts->begin(), counts->end());
  } else {
    values = std::get<std::vector<double>>(data->values);
    const int digits = data->type == "f4" ? std::numeric_limits<float>::max_digits10
                                          : std::numeric_limits<double>::max_digits10;
    table.precision = {digits, digits};
  }
  const auto unfit = [&] {
    return std::runtime_error(path + ": its arrays do not fit each other");
  };
  if (shape.size() != 2 || shape[0] < 1 || shape[1] < 1) throw unfit();
  table.rows = shape[0];
  table.columns = shape[1];
  // Compressed lines are rows in csr and columns in csc.
  const bool by_column = *kind == "csc";
  std::vector<std::int64_t> line;
  if (*kind != "coo") {
    const auto& first = whole("indptr");
    if (std::ssize(first) != shape[by_column ? 1 : 0] + 1 || first.front() != 0 ||
        first.back() != std::ssize(values))
      throw unfit();
    for (std::size_t l = 0; l + 1 < first.size(); ++l) {
      if (first[l + 1] < first[l] || first[l + 1] > first.back())
        throw std::runtime_error(fmt::format("{}: indptr goes down at {}", path, l));
      line.insert(line.end(), static_cast<std::size_t>(first[l + 1] - first[l]),
                  static_cast<std::int64_t>(l));
    }
  }
  const auto& rows = *kind == "coo" ? whole("row") : by_column ? whole("indices") : line;
  const auto& columns = *kind == "coo" ? whole("col") : by_column ? line : whole("indices");
  if (rows.size() != values.size() || columns.size() != values.size()) throw unfit();
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (rows[k] < 0 || rows[k] >= table.rows || columns[k] < 0 || columns[k] >= table.columns)
      throw std::runtime_error(
          fmt::format("{}: has a row {} and column {}", path, rows[k], columns[k]));
    table.entries.push_back({rows[k], columns[k], values[k]});
  }
  put_in_order(path, table);
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
    arrays.push_back({fmt::format("arr_{}", k), {std::ssize(all[k])}, all[k]});
  return npz_of(arrays);
}

bool hold_trajectories(const std::vector<NumpyArray>& arrays) {
  return !find(arrays, "format") && !find(arrays, "indptr");
}

Trajectories trajectories_of(const std::string& path, std::vector<NumpyArray> arrays) {
  Trajectories all;
  for (NumpyArray& array : arrays) {
    const auto refuse = [&](const std::string& what) {
      throw std::runtime_error(fmt::format("{}: array {}: {}", path, printable(array.name), what));
    };
    if (array.shape.size() == 2)
      refuse(
          "has two dimensions: of a matrix scipy.sparse.save_npz(FILE, "
          "scipy.sparse.csr_matrix(matrix)) makes the file, a trajectory is an array of its own");
    if (array.shape.size() != 1 || array.type == "b1" ||
        std::holds_alternative<std::string>(array.values))
      refuse("a trajectory is one row of whole numbers");
    if (const auto* real = std::get_if<std::vector<double>>(&array.values)) {
      std::vector<std::int64_t> states;
      for (const double x : *real) {
        if (!(std::abs(x) <= kMostWhole) || x != std::floor(x))
          refuse(shortest(x) + " is no whole number");
        states.push_back(static_cast<std::int64_t>(x));
      }
      all.push_back(std::move(states));
      continue;
    }
    all.push_back(std::get<std::vector<std::int64_t>>(std::move(array.values)));
  }
  return all;
}

Trajectories read_trajectories(const std::string& path) {
  Trajectories all;
  std::vector<std::string> lines = lines_of_file(path);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].starts_with('#')) continue;
    std::replace_if(
        lines[k].begin(), lines[k].end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    const std::vector<std::string> words = words_of(lines[k]);
    if (words.empty()) continue;
    auto& one = all.emplace_back();
    for (const std::string& word : words)
      if (!read_number(word, one.emplace_back()))
        refuse(path, k + 1,
               fmt::format("\"{}\" is no whole number: a line is the states of a trajectory, "
                           "between blanks or commas",
                           printable(word)));
  }
  return all;
}

}  // namespace gatewalk::cli
