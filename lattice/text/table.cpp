// SPDX-License-Identifier: MIT
#include "lattice/text/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lattice/text/csv.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kMostBefore = 200;        // lines searched for the header
constexpr std::size_t kMostLinesOfHeader = 16;  // if column names contain line ends

/// Words that programs write for a missing number, although a body may have such a name.
bool is_no_number(std::string_view field) {
  constexpr std::array<std::string_view, 5> kWords{".", "nat", "n.a.", "1.#inf", "-1.#inf"};
  return std::find(kWords.begin(), kWords.end(), in_small_letters(field)) != kWords.end();
}

template <class Number>
bool is_all_of(std::string_view text, Number& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

}  // namespace

Table::Table(const std::string& path, const IsHeader& is_header) : lines_(path) {
  find_header(is_header);
  if (!has_header_) take_first_line();
}

void Table::find_header(const IsHeader& is_header) {
  std::string open;  // lines of a header with an open quotation mark
  std::size_t open_lines = 0;
  std::string_view line;
  while (held_.size() < kMostBefore && lines_.next(line)) {
    held_.emplace_back(line);
    std::size_t in_lines = 1;
    bool found = false;
    if (open_lines > 0) {
      open.append("\n").append(line);
      in_lines = ++open_lines;
      found = is_header_line(open, is_header);
    }
    if (!found) {
      in_lines = 1;
      found = is_header_line(line, is_header);
    }
    if (found) {
      has_header_ = true;
      header_line_ = lines_.number() - static_cast<std::int64_t>(in_lines) + 1;
      held_.resize(held_.size() - in_lines);
      before_header_ = std::count_if(held_.begin(), held_.end(),
                                     [](const std::string& text) { return !has_no_fields(text); });
      held_.clear();
      return;
    }
    if (open_lines > kMostLinesOfHeader) open_lines = 0;
    if (open_lines == 0 && std::count(line.begin(), line.end(), '"') % 2 == 1) {
      open = line;
      open_lines = 1;
    }
  }
  held_line_ = 1;
}

bool Table::is_header_line(std::string_view line, const IsHeader& is_header) {
  // numpy and MATLAB write the column names as a comment.
  const std::size_t first = line.find_first_not_of(" \t#%");
  const std::string_view bare = line.substr(std::min(first, line.size()));
  for (const std::string_view text : {line, bare})
    for (const char separator : kSeparators) {
      if (text.empty() || split_fields(text, separator, fields_, unquoted_) != LineState::fields)
        continue;
      const Names names(fields_.begin(), fields_.end());
      if (!is_header(names)) continue;
      separator_ = separator;
      columns_ = names;
      return true;
    }
  return false;
}

/// Takes the first line as the columns, for messages, because no line is a header.
void Table::take_first_line() {
  std::string_view line;
  while (next_line(line)) {
    if (has_no_fields(line)) continue;
    separator_ = separator_in(line);
    header_line_ = line_;
    split_row(line);
    columns_.assign(fields_.begin(), fields_.end());
    return;
  }
}

bool Table::next_line(std::string_view& line) {
  if (held_.empty()) {
    if (!lines_.next(line)) return false;
    line_ = lines_.number();
    return true;
  }
  record_ = std::move(held_.front());
  held_.pop_front();
  line = record_;
  line_ = held_line_++;
  return true;
}

void Table::split_row(std::string_view line) {
  begins_quoted_ = line.starts_with('"');
  const std::int64_t first = line_;
  LineState state = split_fields(line, separator_, fields_, unquoted_);
  if (state == LineState::open) {
    std::string all(line);
    for (std::string_view more; state == LineState::open;) {
      if (all.size() > Lines::kMostBytes || !next_line(more))
        refuse(first, "a quotation mark is not closed");
      const bool may_close = std::count(more.begin(), more.end(), '"') % 2 == 1;
      all.append("\n").append(more);
      if (may_close) state = split_fields(all, separator_, fields_, unquoted_);
    }
    record_ = std::move(all);
    line = record_;
    (void)split_fields(record_, separator_, fields_, unquoted_);
    line_ = first;
  } else if (line.find('\r') != line.npos && line.find('"') == line.npos) {
    refuse("a carriage return within a line: lines must end in \\n or \\r\\n, or all in \\r");
  }
  if (state == LineState::wrong)
    refuse(std::string("a quotation mark is not closed, or not at a field's end") +
           (line.find(separator_) == line.npos
                ? "; fields must be set apart by commas, semicolons or tabs, not by blanks"
                : ""));
}

bool Table::next() {
  for (std::string_view line; next_line(line);) {
    if (has_no_fields(line)) {
      const auto separators = std::count(line.begin(), line.end(), separator_);
      comments_ += !line.empty() && separators > 0 && separators + 1 == std::ssize(columns_);
      continue;
    }
    split_row(line);
    // Spreadsheets write rows of separators below a table.
    if (std::all_of(fields_.begin(), fields_.end(), [](auto field) { return field.empty(); }))
      continue;
    fit_to_columns();
    if (std::equal(fields_.begin(), fields_.end(), columns_.begin(), columns_.end())) {
      ++headers_;  // the header of a further file in a concatenated one
      continue;
    }
    if (!same_.empty()) require_same_content();
    return true;
  }
  return false;
}

/// Removes the extra field of a row: a row number as R writes it, or an empty field after a final
/// separator.
void Table::fit_to_columns() {
  const std::size_t wanted = columns_.size();
  const bool has_more = fields_.size() == wanted + 1;
  // R quotes row names. If the first field is not quoted, the extra field may be the last one.
  if (std::exchange(is_first_row_, false) && has_more && begins_quoted_)
    if (const auto number = whole(fields_.front()); number && (*number == 0 || *number == 1)) {
      if (fields_.back().empty())
        refuse("has a field more than columns are named (line " + std::to_string(header_line_) +
               "), and the last is empty: does the first number the rows, or does the line end in "
               "a separator? Name that column too");
      row_number_ = *number - 1;
    }
  if (row_number_ && has_more && whole(fields_.front()) == *row_number_ + 1) {
    ++*row_number_;
    fields_.erase(fields_.begin());
  } else if (!row_number_ && has_more && fields_.back().empty()) {
    fields_.pop_back();
  }
  if (fields_.size() != wanted)
    refuse("has " + std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") +
           ", the line of the columns (line " + std::to_string(header_line_) + ") has " +
           std::to_string(wanted) +
           (row_number_ ? " behind the number of the row"
            : has_more  ? " (are there names of rows? Name their column, or write none)"
                        : ""));
}

void Table::require_same_content() {
  const auto are_the_same = [&](std::string_view a, std::string_view b) {
    if (a == b) return true;
    const auto x = number(a), y = number(b);
    return x && y && (*x == *y || (std::isnan(*x) && std::isnan(*y)));
  };
  for (const auto& [a, b] : same_)
    if (!are_the_same(fields_[a], fields_[b]))
      refuse("columns " + std::to_string(a + 1) + " and " + std::to_string(b + 1) +
             " are both named \"" + printable(columns_[a]) + "\" and differ: \"" +
             printable(fields_[a]) + "\", \"" + printable(fields_[b]) +
             "\": give one of them another name");
}

std::string Table::column_words() const {
  constexpr std::size_t kMostShown = 200;
  std::string words;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (words.size() > kMostShown) {
      words += ", ... (" + std::to_string(columns_.size()) + " in all)";
      break;
    }
    const std::string name = printable(columns_[i]);
    words +=
        (i > 0 ? ", " : "") + name.substr(0, kMostShown) + (name.size() > kMostShown ? "..." : "");
  }
  const auto is_number = [](const std::string& name) {
    double value = 0.0;
    return is_all_of(name, value);
  };
  if (columns_.size() == 1 && columns_[0].find(' ') != std::string::npos)
    return words + " (fields must be set apart by commas, semicolons or tabs, not by blanks)";
  if (!columns_.empty() && std::all_of(columns_.begin(), columns_.end(), is_number))
    return words + " (these are numbers: the first line must name the columns)";
  return words;
}

std::optional<std::size_t> Table::column_in(const Names& names, std::string_view name) {
  const auto same = std::find(names.begin(), names.end(), name);
  if (same != names.end()) return static_cast<std::size_t>(same - names.begin());
  const auto is_like = [small = in_small_letters(name)](const std::string& other) {
    return other.size() == small.size() && in_small_letters(other) == small;
  };
  const auto like = std::find_if(names.begin(), names.end(), is_like);
  if (like == names.end() || std::find_if(like + 1, names.end(), is_like) != names.end()) return {};
  return static_cast<std::size_t>(like - names.begin());
}

std::optional<std::size_t> Table::column(std::string_view name) {
  if (places_.empty())
    for (std::size_t i = 0; i < columns_.size(); ++i) places_[columns_[i]].push_back(i);
  const auto same = places_.find(std::string(name));
  const auto found =
      same != places_.end() ? std::optional(same->second.front()) : column_in(columns_, name);
  if (!found) return {};
  std::vector<std::size_t>& all = places_[columns_[*found]];
  for (std::size_t k = 1; k < all.size(); ++k) same_.emplace_back(*found, all[k]);
  all.resize(1);  // handled now
  return found;
}

bool Table::is_index(std::string_view name) {
  return name.empty() || name.starts_with("Unnamed: ");
}

std::optional<double> Table::number(std::string_view field) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  if (!is_all_of(field, value)) {
    if (says_nothing(field) || is_no_number(field)) return kNone;
    const std::size_t comma = field.find(',');
    if (comma == field.npos || field.find('.') != field.npos) return {};
    std::string with_point(field);
    with_point[comma] = '.';
    if (!is_all_of(std::string_view(with_point), value)) return {};
    if (separator_ == ',' && field.size() - comma == 4 && std::abs(value) >= 1.0)
      refuse("\"" + printable(field) +
             "\" may be thousands or have a decimal comma: write numbers "
             "without marks of thousands, or set fields apart by semicolons");
    note_decimal(',', field);
  } else if (field.find('.') != field.npos) {
    note_decimal('.', field);
  }
  return std::isfinite(value) ? value : kNone;
}

/// Notes the decimal mark of a number. A table with both marks may use one for thousands.
void Table::note_decimal(char mark, std::string_view field) {
  if (decimal_ == '\0') {
    decimal_ = mark;
    decimal_line_ = line_;
  }
  if (decimal_ == mark) return;
  refuse("\"" + printable(field) + "\" has a decimal " + (mark == ',' ? "comma" : "point") +
         ", line " + std::to_string(decimal_line_) + " a decimal " +
         (mark == ',' ? "point" : "comma") + ": a table must have one of both");
}

std::optional<std::int64_t> Table::whole(std::string_view field) {
  if (field.ends_with(".0")) field.remove_suffix(2);
  std::int64_t value = 0;
  if (is_all_of(field, value)) return value;
  constexpr double kMost = 9007199254740992.0;  // doubles hold all whole numbers up to here
  double real = 0.0;                            // R writes 100000 as 1e+05
  const bool has_exponent = field.find_first_of("eE") != field.npos;
  if (!has_exponent || field.find('.') != field.npos || !is_all_of(field, real) ||
      real != std::floor(real) || !(std::abs(real) <= kMost))
    return {};
  return static_cast<std::int64_t>(real);
}

void Table::refuse(std::int64_t line, const std::string& what) const {
  throw std::invalid_argument(lines_.name() + ":" + std::to_string(line) + ": " + what);
}

std::vector<std::string> Table::remarks() const {
  std::vector<std::string> all;
  if (separator_ != ',')
    all.push_back(std::string("fields are set apart by ") +
                  (separator_ == ';' ? "semicolons" : "tabs"));
  if (decimal_ == ',') all.emplace_back("numbers have decimal commas");
  if (lines_.end_in_cr()) all.emplace_back("lines end in CR alone");
  if (before_header_ > 0)
    all.push_back("the columns are named in line " + std::to_string(header_line_) + "; " +
                  std::to_string(before_header_) + (before_header_ == 1 ? " line" : " lines") +
                  " before it left out");
  if (headers_ > 0)
    all.push_back(std::to_string(headers_) +
                  (headers_ == 1 ? " more line names" : " more lines name") +
                  " the columns: left out");
  if (comments_ > 0)
    all.push_back(std::to_string(comments_) +
                  (comments_ == 1 ? " line that begins" : " lines that begin") +
                  " with # and may be a row: left out");
  if (row_number_) all.emplace_back("the first column has no name and numbers the rows: left out");
  for (const auto& [a, b] : same_)
    all.push_back("columns " + std::to_string(a + 1) + " and " + std::to_string(b + 1) +
                  " are both named " + printable(columns_[a]) + ", with the same content");
  return all;
}

}  // namespace gatewalk::lattice
