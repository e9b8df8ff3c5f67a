// SPDX-License-Identifier: MIT
#pragma once
/// Counts on disk: one NetCDF-4 (HDF5) file that MATLAB, Python, R and Octave open as it is.
///
/// Dimensions input_state, output_state, nonzero. Variables count_row, count_column (from 0), count
/// (nonzero); trials, clamped (input_state); exit_next_input, exit_di_x, exit_di_y, state_name
/// (output_state; characters); each NamedArray by its name. Version 1, which is read too, has no
/// state_name, and only arrays of numbers with a dimension each. Cells of another type have a group
/// type_NAME with its own nonzero, count_row, count_column, count, trials and clamped. Global
/// attributes format, format_version, checksum and `text`. checksum = "crc64-xz:" + 16 hexadecimal
/// digits: CRC-64/XZ of the whole file with these digits read as zeros. The mark "crc64-xz:" may
/// stand nowhere else in the file. Same content, same bytes. NetCDF is not thread-safe: one call at
/// a time.

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Of a text: an HDF5 attribute ends below 64 KB.
inline constexpr std::size_t kMostTextBytes = 60'000;

/// A named table of numbers that travels with the counts (bin edges, for example).
struct NamedArray {
  std::string name;  // letters, digits and _, a letter first
  std::string unit;  // as udunits has it; empty: none
  std::string meaning;
  std::vector<double> values;
  /// Shared by all arrays that name it; input_state, output_state and nonzero are those of the
  /// counts. Empty: its own, name + "_length".
  std::string dimension{};
  bool whole = false;                // written as 32-bit integers
  std::vector<std::string> codes{};  // of whole numbers: words without blanks, what 0, 1, ... mean
};

/// The counts of one type of cell.
struct RowCounts {
  Counts counts;                      // (n_in x n_out)
  std::vector<std::int64_t> trials;   // (n_in) runs per row, the sum of its counts
  std::vector<std::int64_t> clamped;  // (n_in) of these, crossings outside every bin
};

/// What a file holds. `text` are string attributes (scene, seed, version, command line, ...).
struct CountsFile : RowCounts {
  std::map<std::string, RowCounts> types;   // of other types of cells, by name
  std::vector<Exit> exits;                  // (n_out)
  std::vector<NamedArray> arrays;           // unique names; read back sorted by name
  std::vector<std::string> state_names{};   // (n_out), different ones; or none
  std::map<std::string, std::string> text;  // named as arrays are; up to 60 000 bytes each
};

/// The file is damaged, is not ours, or does not add up. what() names the file and, where there is
/// one, the row (counted from 0: the paper's I_1 is row 0).
class BadFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The bytes are not those that were written: damaged, or changed by another program.
class BadChecksum : public BadFile {
 public:
  using BadFile::BadFile;
};

/// Replaces the file at `path` (replace_file). Content that does not add up throws
/// std::invalid_argument, a failure std::runtime_error, both naming the file and the reason; an old
/// file at `path` stays as it was. (Only when the last act fails, syncing the folder, the new file
/// is in place already.)
void write_counts(const std::string& path, const CountsFile& file);

/// Throws BadFile when anything is missing, truncated or does not add up, BadChecksum when it was
/// altered. The checksum is taken in constant memory, before the file is read; one above 1 GiB is
/// refused.
[[nodiscard]] CountsFile read_counts(const std::string& path);

/// What is wrong with a file of a bad checksum, for people: "row 12 (counted from 0): counts add up
/// to ...", or that its content adds up all the same. Empty where nothing in it can be read. Looks
/// in a child process, because HDF5 may crash or hang on damaged bytes.
[[nodiscard]] std::string diagnose_counts(const std::string& path);

}  // namespace gatewalk::markov
