// SPDX-License-Identifier: MIT
#include "markov/formats/counts.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "markov/formats/file.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::markov {
namespace {

using namespace netcdf;

constexpr const char* kFormat = "gatewalk transition counts";
constexpr int kVersionWithoutWords = 2, kFormatVersion = 3, kFirstVersion = 1;
const std::set<std::string> kOwnVariables = {
    "count_row",       "count_column", "count",      "trials",      "clamped",
    "exit_next_input", "exit_di_x",    "exit_di_y",  "input_state", "nonzero",
    "output_state",    "state_name",   "name_length"};
const std::set<std::string> kOwnDimensions = {"input_state", "output_state", "nonzero"};
// Enough for a matrix of 10 000 states and 10^8 nonzeros.
constexpr std::size_t kMostFileBytes = std::size_t{1} << 30;
const std::string kTypeGroup = "type_";
constexpr const char *kCodeValues = "flag_values", *kCodeWords = "flag_meanings";
const std::set<std::string> kOwnAttributes = {"format", "format_version", "checksum",
                                              "Conventions"};

[[noreturn]] void refuse_counts(const std::string& what) { throw std::invalid_argument(what); }

std::string named_row(std::int64_t row) {
  return "row " + std::to_string(row) + " (counted from 0)";
}

// The dimension of an array. No variable may have its name, because netCDF 4.9 fails on some such
// files.
std::string dimension_of(const NamedArray& array) {
  return array.dimension.empty() ? array.name + "_length" : array.dimension;
}

// ---- Content: the same rules for writing and reading ----

// Accepts letters, digits and underscores: legal for NetCDF, and a variable name in MATLAB, R and
// Python.
void check_name(const std::string& name, const std::set<std::string>& taken) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  bool legal = !name.empty() && name.size() < 128 && is_letter(name.front());
  for (const char c : name) legal = legal && (is_letter(c) || is_digit(c) || c == '_');
  if (!legal) {
    refuse_counts("name \"" + name + "\": must be letters, digits and _, and begin with a letter");
  }
  if (taken.contains(name)) refuse_counts("name \"" + name + "\" is taken");
}

void check_text(const std::string& name, const std::string& text) {
  if (text.size() > kMostTextBytes) {
    refuse_counts("text of \"" + name + "\" has " + std::to_string(text.size()) +
                  " bytes, more than " + std::to_string(kMostTextBytes));
  }
  if (text.find('\0') != std::string::npos)
    refuse_counts("text of \"" + name + "\" holds a zero byte");
}

void check_codes(const NamedArray& array) {
  if (!array.whole && !array.codes.empty())
    refuse_counts("array " + array.name + ": only whole numbers have codes");
  for (const std::string& code : array.codes)
    if (code.empty() || code.find_first_of(" \t\n") != code.npos || code.size() > kMostTextBytes)
      refuse_counts("array " + array.name + ": code \"" + code + "\" is no word");
  if (!array.whole) return;
  for (const double x : array.values)
    if (!(std::abs(x) <= std::numeric_limits<std::int32_t>::max() && x == std::floor(x)))
      refuse_counts("array " + array.name + ": " + fmt::format("{:f}", x) + " is no whole number");
}

void check_state_names(const CountsFile& file) {
  if (file.state_names.empty()) return;
  const std::set<std::string> different(file.state_names.begin(), file.state_names.end());
  if (file.state_names.size() != file.exits.size() || different.size() != file.exits.size())
    refuse_counts("state_name: every output must have one of its own");
  for (const std::string& name : file.state_names) {
    check_text("state_name", name);
    if (name.empty() || name.back() == ' ') refuse_counts("state_name \"" + name + "\" is no name");
  }
}

void check_rows(const RowCounts& file) {
  const std::int64_t n_in = file.counts.rows();
  if (static_cast<std::int64_t>(file.trials.size()) != n_in ||
      static_cast<std::int64_t>(file.clamped.size()) != n_in) {
    refuse_counts("trials and clamped must have one number for each of the " +
                  std::to_string(n_in) + " rows");
  }
  for (std::int64_t row = 0; row < n_in; ++row) {
    std::int64_t sum = 0;
    for (Counts::InnerIterator it(file.counts, row); it; ++it) {
      if (it.value() < 0) refuse_counts(named_row(row) + ": a count is negative");
      if (__builtin_add_overflow(sum, it.value(), &sum)) {
        refuse_counts(named_row(row) + ": the sum of counts overflows");
      }
    }
    const std::int64_t trials = file.trials[static_cast<std::size_t>(row)];
    const std::int64_t clamped = file.clamped[static_cast<std::size_t>(row)];
    if (sum != trials) {
      refuse_counts(named_row(row) + ": counts add up to " + std::to_string(sum) + ", trials are " +
                    std::to_string(trials));
    }
    if (clamped < 0 || clamped > trials) {
      refuse_counts(named_row(row) + ": " + std::to_string(clamped) + " clamped of " +
                    std::to_string(trials) + " trials");
    }
  }
}

void check_content(const CountsFile& file) {
  validate(file.exits, file.counts.rows(), file.counts.cols());
  check_rows(file);
  std::set<std::string> taken = kOwnVariables;
  std::size_t nonzero = 0;
  for (std::int64_t row = 0; row < file.counts.rows(); ++row)
    for (Counts::InnerIterator it(file.counts, row); it; ++it) nonzero += it.value() != 0;
  std::map<std::string, std::size_t> lengths{{"input_state", file.trials.size()},
                                             {"output_state", file.exits.size()},
                                             {"nonzero", nonzero}};
  for (const NamedArray& array : file.arrays) {
    check_name(array.name, taken);
    taken.insert(array.name);
    check_text(array.name, array.unit);
    check_text(array.name, array.meaning);
    check_codes(array);
  }
  for (const NamedArray& array : file.arrays) {
    const std::string dimension = dimension_of(array);
    if (!kOwnDimensions.contains(dimension)) check_name(dimension, taken);
    const auto [at, is_new] = lengths.emplace(dimension, array.values.size());
    if (at->second != array.values.size() || (!is_new && array.dimension.empty()))
      refuse_counts("array " + array.name + " has " + std::to_string(array.values.size()) +
                    " numbers, its dimension " + dimension + " " + std::to_string(at->second));
  }
  check_state_names(file);
  for (const auto& [key, value] : file.text) {
    check_name(key, kOwnAttributes);
    check_text(key, value);
  }
  for (const auto& [name, rows] : file.types) {
    check_name(kTypeGroup + name, taken);
    if (rows.counts.rows() != file.counts.rows() || rows.counts.cols() != file.counts.cols())
      refuse_counts("type " + name + ": its counts are of another size than the others");
    try {
      check_rows(rows);
    } catch (const std::invalid_argument& error) {
      refuse_counts("type " + name + ": " + error.what());
    }
  }
}

// ---- The checksum: over every byte of the file, its own digits read as zeros ----
// The checksum is tested before HDF5 reads the file: HDF5 1.10 crashes or hangs on some damaged
// bytes.

constexpr std::string_view kChecksumMark = "crc64-xz:";
constexpr std::string_view kNoChecksum = "0000000000000000";

using Crc64 = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, ~0ULL, ~0ULL, true, true>;

std::string hex(const Crc64& crc) {
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) {
    text += "0123456789abcdef"[(crc.checksum() >> shift) & 15];
  }
  return text;
}

[[noreturn]] void refuse_no_checksum() {
  throw std::runtime_error("holds no checksum: truncated, or not written by this program");
}

[[noreturn]] void refuse_second_checksum() {
  throw std::runtime_error("holds \"" + std::string(kChecksumMark) + "\" more than once");
}

// Writes the checksum into an image that has zeros in its place.
void seal(std::vector<char>& image) {
  const std::string_view bytes(image.data(), image.size());
  const std::size_t mark = bytes.find(kChecksumMark);
  const std::size_t at = mark + kChecksumMark.size();
  if (mark == bytes.npos || at + kNoChecksum.size() > bytes.size()) refuse_no_checksum();
  if (bytes.find(kChecksumMark, at) != bytes.npos) refuse_second_checksum();
  Crc64 crc;
  crc.process_bytes(image.data(), image.size());
  const std::string digits = hex(crc);
  std::copy(digits.begin(), digits.end(), image.begin() + static_cast<std::ptrdiff_t>(at));
}

// Writes the counts of one type into the file or into a group of the file.
void put_counts(int group, int input, const RowCounts& rows) {
  std::vector<std::int32_t> of_row, of_column;
  std::vector<std::int64_t> counts;
  for (Eigen::Index row = 0; row < rows.counts.rows(); ++row) {
    for (Counts::InnerIterator it(rows.counts, row); it; ++it) {
      if (it.value() == 0) continue;
      of_row.push_back(static_cast<std::int32_t>(row));
      of_column.push_back(static_cast<std::int32_t>(it.col()));
      counts.push_back(it.value());
    }
  }
  const int nonzero = define_dimension(group, "nonzero", counts.size());
  put_variable(group, "count_row", nonzero, of_row, "1", "input state of a count, from 0");
  put_variable(group, "count_column", nonzero, of_column, "1", "output state of a count, from 0");
  put_variable(group, "count", nonzero, counts, "1", "trials that went from input to output");
  put_variable(group, "trials", input, rows.trials, "1", "trials of an input state");
  put_variable(group, "clamped", input, rows.clamped, "1",
               "of these, trials that crossed outside every bin");
}

void put_array(int nc, int dimension, const NamedArray& array) {
  if (!array.whole) {
    put_variable(nc, array.name, dimension, array.values, array.unit, array.meaning);
    return;
  }
  const std::vector<std::int32_t> values(array.values.begin(), array.values.end());
  const int variable = put_variable(nc, array.name, dimension, values, array.unit, array.meaning);
  if (array.codes.empty()) return;
  std::vector<std::int32_t> codes(array.codes.size());
  std::iota(codes.begin(), codes.end(), 0);
  check(nc_put_att_int(nc, variable, kCodeValues, NC_INT, codes.size(), codes.data()), kCodeValues);
  std::string words;
  for (const std::string& code : array.codes) words += (words.empty() ? "" : " ") + code;
  put_text(nc, variable, kCodeWords, words);
}

// Writes text as characters padded with blanks, because Octave cannot read NetCDF-4 strings.
void put_state_names(int nc, int output, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::size_t length = 0;
  for (const std::string& name : names) length = std::max(length, name.size());
  std::string all;
  for (const std::string& name : names) all += name + std::string(length - name.size(), ' ');
  const std::array<int, 2> dimensions{output, define_dimension(nc, "name_length", length)};
  int variable = -1;
  check(nc_def_var(nc, "state_name", NC_CHAR, 2, dimensions.data(), &variable), "state_name");
  put_text(nc, variable, "long_name", "name of each state, blanks behind it");
  check(nc_put_var_text(nc, variable, all.data()), "state_name");
}

std::vector<char> encode(const CountsFile& file) {
  std::vector<std::int32_t> next_input, di_x, di_y;
  for (const Exit& exit : file.exits) {
    next_input.push_back(exit.next_input);
    di_x.push_back(exit.di_x);
    di_y.push_back(exit.di_y);
  }

  Image nc;
  nc.create();
  put_text(nc, NC_GLOBAL, "format", kFormat);
  put_conventions(nc);
  const int version = file.text.contains(kWordsText) ? kFormatVersion : kVersionWithoutWords;
  check(nc_put_att_int(nc, NC_GLOBAL, "format_version", NC_INT, 1, &version), "format_version");
  put_text(nc, NC_GLOBAL, "checksum", std::string(kChecksumMark) + std::string(kNoChecksum));
  for (const auto& [key, value] : file.text) put_text(nc, NC_GLOBAL, key, value);

  const int input = define_dimension(nc, "input_state", file.trials.size());
  const int output = define_dimension(nc, "output_state", file.exits.size());
  put_counts(nc, input, file);
  put_variable(nc, "exit_next_input", output, next_input, "1",
               "input state of the next cell, from 0; -1: trapped");
  put_variable(nc, "exit_di_x", output, di_x, "1", "columns to the next cell");
  put_variable(nc, "exit_di_y", output, di_y, "1", "rows to the next cell");
  put_state_names(nc, output, file.state_names);
  std::map<std::string, int> dimensions{{"input_state", input}, {"output_state", output}};
  check(nc_inq_dimid(nc, "nonzero", &dimensions["nonzero"]), "nonzero");
  for (const NamedArray& array : file.arrays) {
    const std::string dimension = dimension_of(array);
    if (!dimensions.contains(dimension))
      dimensions[dimension] = define_dimension(nc, dimension, array.values.size());
    put_array(nc, dimensions[dimension], array);
  }
  for (const auto& [name, rows] : file.types) {
    int group = -1;
    check(nc_def_grp(nc, (kTypeGroup + name).c_str(), &group), "group of type " + name);
    put_counts(group, input, rows);
  }
  std::vector<char> image = nc.close_image();
  seal(image);
  return image;
}

// ---- Reading: every size is compared with the file's length before memory is allocated ----

class Reader {
 public:
  explicit Reader(std::vector<char>& image) : file_bytes_(image.size()) { nc_.open(image); }

  [[nodiscard]] CountsFile read() {
    check_format();
    const std::size_t n_in = dimension("input_state");
    const std::size_t n_out = dimension("output_state");

    CountsFile file;
    static_cast<RowCounts&>(file) = row_counts(nc_, n_in, n_out);
    file.types = types(n_in, n_out);
    file.exits = exits();
    file.arrays = arrays();
    file.state_names = state_names(n_out);
    file.text = text();
    check_content(file);
    return file;
  }

 private:
  void check_format() {
    if (attribute(NC_GLOBAL, "format") != kFormat) {
      throw std::runtime_error(std::string("format is not \"") + kFormat + "\"");
    }
    nc_type type = NC_NAT;
    std::size_t length = 0;
    check(nc_inq_att(nc_, NC_GLOBAL, "format_version", &type, &length), "format_version");
    int version = 0;
    if (type != NC_INT || length != 1) throw std::runtime_error("format_version is not a number");
    check(nc_get_att_int(nc_, NC_GLOBAL, "format_version", &version), "format_version");
    if (version < kFirstVersion || version > kFormatVersion) {
      throw std::runtime_error("format_version is " + std::to_string(version) +
                               ", this program reads " + std::to_string(kFirstVersion) + " to " +
                               std::to_string(kFormatVersion));
    }
  }

  [[nodiscard]] std::string attribute(int variable, const std::string& name) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    check(nc_inq_att(nc_, variable, name.c_str(), &type, &length), "attribute " + name);
    if (type != NC_CHAR) throw std::runtime_error("attribute " + name + " is not text");
    if (length > file_bytes_) throw std::runtime_error("attribute " + name + " is absurdly long");
    std::string text(length, '\0');
    check(nc_get_att_text(nc_, variable, name.c_str(), text.data()), "attribute " + name);
    return text;
  }

  [[nodiscard]] std::size_t dimension(const std::string& name) {
    int id = -1;
    check(nc_inq_dimid(nc_, name.c_str(), &id), "dimension " + name);
    return dimension_length(nc_, id, name);
  }

  [[nodiscard]] std::size_t dimension_length(int group, int id, const std::string& name) {
    // Deflate compresses at most 1032-fold, and a number has at least 4 bytes.
    constexpr std::size_t kMostPerByte = 1032 / 4;
    std::size_t length = 0;
    check(nc_inq_dimlen(group, id, &length), "dimension " + name);
    if (length > kMostPerByte * file_bytes_ ||
        length > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw std::runtime_error("dimension " + name +
                               " is absurdly long: " + std::to_string(length));
    }
    return length;
  }

  template <class T>
  [[nodiscard]] std::vector<T> values(int group, const std::string& name,
                                      const std::string& dimension_name) {
    int variable = -1;
    check(nc_inq_varid(group, name.c_str(), &variable), "variable " + name);
    nc_type type = NC_NAT;
    int dimensions = 0;
    check(nc_inq_vartype(group, variable, &type), "variable " + name);
    check(nc_inq_varndims(group, variable, &dimensions), "variable " + name);
    std::vector<T> result;
    if (type != type_of(result)) throw std::runtime_error("variable " + name + ": wrong type");
    int wanted = -1, found = -1;
    check(nc_inq_dimid(group, dimension_name.c_str(), &wanted), "dimension " + dimension_name);
    if (dimensions == 1) check(nc_inq_vardimid(group, variable, &found), "variable " + name);
    if (found != wanted) {
      throw std::runtime_error("variable " + name + " does not have the one dimension " +
                               dimension_name);
    }
    const std::size_t first = 0;
    const std::size_t count = dimension_length(group, found, dimension_name);
    result.resize(count);
    if (count > 0) {
      check(nc_get_vara(group, variable, &first, &count, result.data()), "variable " + name);
    }
    return result;
  }

  [[nodiscard]] std::vector<Exit> exits() {
    const auto next_input = values<std::int32_t>(nc_, "exit_next_input", "output_state");
    const auto di_x = values<std::int32_t>(nc_, "exit_di_x", "output_state");
    const auto di_y = values<std::int32_t>(nc_, "exit_di_y", "output_state");
    std::vector<Exit> result;
    for (std::size_t j = 0; j < next_input.size(); ++j) {
      result.push_back({next_input[j], di_x[j], di_y[j]});
    }
    return result;
  }

  [[nodiscard]] RowCounts row_counts(int group, std::size_t n_in, std::size_t n_out) {
    return {counts(group, n_in, n_out), values<std::int64_t>(group, "trials", "input_state"),
            values<std::int64_t>(group, "clamped", "input_state")};
  }

  [[nodiscard]] std::map<std::string, RowCounts> types(std::size_t n_in, std::size_t n_out) {
    int groups = 0;
    check(nc_inq_grps(nc_, &groups, nullptr), "groups");
    std::vector<int> ids(static_cast<std::size_t>(groups));
    check(nc_inq_grps(nc_, &groups, ids.data()), "groups");
    std::map<std::string, RowCounts> found;
    for (const int group : ids) {
      char name[NC_MAX_NAME + 1] = "";
      check(nc_inq_grpname(group, name), "groups");
      if (!std::string_view(name).starts_with(kTypeGroup))
        throw std::runtime_error(std::string("group ") + name + " is not of a type");
      found.emplace(name + kTypeGroup.size(), row_counts(group, n_in, n_out));
    }
    return found;
  }

  [[nodiscard]] Counts counts(int group, std::size_t n_in, std::size_t n_out) {
    const auto row = values<std::int32_t>(group, "count_row", "nonzero");
    const auto column = values<std::int32_t>(group, "count_column", "nonzero");
    const auto count = values<std::int64_t>(group, "count", "nonzero");
    Counts result(static_cast<Eigen::Index>(n_in), static_cast<Eigen::Index>(n_out));
    result.reserve(static_cast<Eigen::Index>(count.size()));
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
      result.startVec(i);
      for (; k < count.size() && row[k] == i; ++k) {
        if (column[k] < 0 || column[k] >= result.cols()) {
          throw std::runtime_error(named_row(i) + ": column " + std::to_string(column[k]) +
                                   " is out of range");
        }
        if (k > 0 && row[k - 1] == row[k] && column[k - 1] >= column[k]) {
          throw std::runtime_error(named_row(i) + ": column " + std::to_string(column[k]) +
                                   " is repeated or out of order");
        }
        if (count[k] < 1) {
          throw std::runtime_error(named_row(i) + ": count " + std::to_string(count[k]) +
                                   " is not positive");
        }
        result.insertBack(i, column[k]) = count[k];
      }
    }
    if (k < count.size()) {
      throw std::runtime_error("count_row: entry " + std::to_string(k) + " (counted from 0), row " +
                               std::to_string(row[k]) + ", is out of range or out of order");
    }
    result.finalize();
    return result;
  }

  [[nodiscard]] std::vector<NamedArray> arrays() {
    int variables = 0;
    check(nc_inq_nvars(nc_, &variables), "variables");
    std::vector<NamedArray> result;
    for (int variable = 0; variable < variables; ++variable) {
      char name[NC_MAX_NAME + 1] = "";
      check(nc_inq_varname(nc_, variable, name), "variables");
      if (kOwnVariables.contains(name)) continue;
      result.push_back(array(variable, name));
    }
    std::sort(result.begin(), result.end(),
              [](const NamedArray& a, const NamedArray& b) { return a.name < b.name; });
    return result;
  }

  [[nodiscard]] bool has(int variable, const char* name) {
    return nc_inq_attid(nc_, variable, name, nullptr) == NC_NOERR;
  }

  [[nodiscard]] NamedArray array(int variable, const std::string& name) {
    NamedArray array{name,
                     has(variable, "units") ? attribute(variable, "units") : "",
                     attribute(variable, "long_name"),
                     {}};
    int dimensions = 0, dimension = -1;
    check(nc_inq_varndims(nc_, variable, &dimensions), "variable " + name);
    if (dimensions != 1) throw std::runtime_error("variable " + name + " has not one dimension");
    check(nc_inq_vardimid(nc_, variable, &dimension), "variable " + name);
    char of[NC_MAX_NAME + 1] = "";
    check(nc_inq_dimname(nc_, dimension, of), "variable " + name);
    if (of != dimension_of(array)) array.dimension = of;
    nc_type type = NC_NAT;
    check(nc_inq_vartype(nc_, variable, &type), "variable " + name);
    array.whole = type == NC_INT;
    if (!array.whole) {
      array.values = values<double>(nc_, name, of);
      return array;
    }
    const auto whole = values<std::int32_t>(nc_, name, of);
    array.values.assign(whole.begin(), whole.end());
    if (!has(variable, kCodeWords)) return array;
    std::istringstream words(attribute(variable, kCodeWords));
    array.codes.assign(std::istream_iterator<std::string>(words), {});
    return array;
  }

  [[nodiscard]] std::vector<std::string> state_names(std::size_t n_out) {
    int variable = -1;
    if (nc_inq_varid(nc_, "state_name", &variable) != NC_NOERR) return {};
    int dimensions = 0;
    nc_type type = NC_NAT;
    check(nc_inq_varndims(nc_, variable, &dimensions), "state_name");
    check(nc_inq_vartype(nc_, variable, &type), "state_name");
    std::array<int, 2> ids{};
    if (dimensions == 2) check(nc_inq_vardimid(nc_, variable, ids.data()), "state_name");
    const std::size_t length = dimension("name_length");
    if (type != NC_CHAR || dimensions != 2 ||
        dimension_length(nc_, ids[0], "of state_name") != n_out ||
        dimension_length(nc_, ids[1], "of state_name") != length || length > kMostTextBytes ||
        n_out * length > kMostFileBytes)
      throw std::runtime_error("variable state_name is not characters of output_state");
    std::string all(n_out * length, ' ');
    check(nc_get_var_text(nc_, variable, all.data()), "state_name");
    std::vector<std::string> names;
    for (std::size_t j = 0; j < n_out; ++j) {
      const std::string name = all.substr(j * length, length);
      names.push_back(name.substr(0, name.find_last_not_of(' ') + 1));
    }
    return names;
  }

  [[nodiscard]] std::map<std::string, std::string> text() {
    int attributes = 0;
    check(nc_inq_natts(nc_, &attributes), "attributes");
    std::map<std::string, std::string> result;
    for (int number = 0; number < attributes; ++number) {
      char name[NC_MAX_NAME + 1] = "";
      check(nc_inq_attname(nc_, NC_GLOBAL, number, name), "attributes");
      if (!kOwnAttributes.contains(name)) result[name] = attribute(NC_GLOBAL, name);
    }
    return result;
  }

  std::size_t file_bytes_;
  Image nc_;
};

// ---- Bytes on disk ----

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

// A regular file open for reading. Directories, pipes and devices are refused before they are
// opened (a pipe would block).
class InputFile {
 public:
  explicit InputFile(const std::string& path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) fail("cannot open");
    if (!S_ISREG(info.st_mode)) throw std::runtime_error("not a regular file");
    fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd_ < 0) fail("cannot open");
    size_ = static_cast<std::size_t>(info.st_size);
  }
  ~InputFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }
  // Fills `bytes` from `offset` on, up to the end of the file.
  void read(std::size_t offset, std::vector<char>& bytes) const {
    bytes.resize(std::min(bytes.size(), size_ - std::min(size_, offset)));
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t got =
          ::pread(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail("cannot read");
      if (got == 0) throw std::runtime_error("became shorter while it was read");
      done += static_cast<std::size_t>(got);
    }
  }

 private:
  int fd_ = -1;
  std::size_t size_ = 0;
};

void check_size(std::size_t bytes) {
  if (bytes > kMostFileBytes)
    throw std::runtime_error("has " + std::to_string(bytes) + " bytes, more than the " +
                             std::to_string(kMostFileBytes) + " that a matrix may have");
}

// Refuses a file that does not begin as NetCDF-4, or is larger than a matrix may be.
void check_kind(const InputFile& file) {
  constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";
  std::vector<char> begin(kHdf5Magic.size());
  file.read(0, begin);
  if (std::string_view(begin.data(), begin.size()) != kHdf5Magic)
    throw std::runtime_error("not a NetCDF-4 file");
  check_size(file.size());
}

constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes

// Finds the digits of the checksum. They are searched piece by piece, as the checksum is computed,
// so a large file of another kind is never in memory.
std::size_t place_of_checksum(const InputFile& file) {
  std::size_t place = 0, marks = 0;
  std::vector<char> piece;
  for (std::size_t begin = 0; begin < file.size(); begin += kPiece) {
    piece.resize(kPiece + kChecksumMark.size() - 1);  // a mark may cross two pieces
    file.read(begin, piece);
    const std::string_view bytes(piece.data(), piece.size());
    for (std::size_t at = 0; (at = bytes.find(kChecksumMark, at)) != bytes.npos; ++at) {
      place = begin + at + kChecksumMark.size();
      ++marks;
    }
  }
  if (marks > 1) refuse_second_checksum();
  if (marks == 0 || place + kNoChecksum.size() > file.size()) refuse_no_checksum();
  return place;
}

bool has_its_checksum(const InputFile& file) {
  const std::size_t place = place_of_checksum(file);
  std::vector<char> digits(kNoChecksum.size());
  file.read(place, digits);
  Crc64 crc;
  std::vector<char> piece;
  for (std::size_t begin = 0; begin < file.size(); begin += kPiece) {
    piece.resize(kPiece);
    file.read(begin, piece);
    for (std::size_t i = 0; i < kNoChecksum.size(); ++i)
      if (const std::size_t at = place + i; at >= begin && at < begin + piece.size())
        piece[at - begin] = kNoChecksum[i];
    crc.process_bytes(piece.data(), piece.size());
  }
  return hex(crc) == std::string_view(digits.data(), digits.size());
}

std::vector<char> image_of(const InputFile& file) {
  check_size(file.size());
  std::vector<char> image(file.size());
  file.read(0, image);
  return image;
}

}  // namespace

void write_counts(const std::string& path, const CountsFile& file) {
  std::vector<char> image;
  try {
    check_content(file);
    image = encode(file);
    check_size(image.size());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  replace_file(path, {image.data(), image.size()});
}

std::string diagnose_counts(const std::string& path) {
  constexpr unsigned kPatience = 5;  // seconds
  int ends[2];
  if (::pipe(ends) != 0) return "";
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(kPatience);
    std::string verdict = "yet its content adds up: another program may have rewritten it";
    try {
      std::vector<char> image = image_of(InputFile(path));
      [[maybe_unused]] const CountsFile file = Reader(image).read();
    } catch (const std::exception& error) {
      verdict = error.what();
      if (verdict == netcdf::kCannotOpen) verdict = "";
    }
    const ssize_t put = ::write(ends[1], verdict.data(), verdict.size());
    ::_exit(put == static_cast<ssize_t>(verdict.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string verdict;
  if (child > 0) {
    char bytes[4096];
    for (ssize_t got; (got = ::read(ends[0], bytes, sizeof bytes)) > 0;)
      verdict.append(bytes, static_cast<std::size_t>(got));
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) verdict = "";
  }
  ::close(ends[0]);
  return verdict;
}

CountsFile read_counts(const std::string& path) {
  const auto bad = [&path](const std::exception& error) {
    return BadFile(path + ": " + error.what());
  };
  try {
    const InputFile opened(path);
    check_kind(opened);
    if (!has_its_checksum(opened)) {
      throw BadChecksum(
          path + ": checksum does not match: cut short, damaged or altered since it was written");
    }
    std::vector<char> image = image_of(opened);
    return Reader(image).read();
  } catch (const BadChecksum&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw bad(error);
  } catch (const std::runtime_error& error) {
    throw bad(error);
  }
}

}  // namespace gatewalk::markov
