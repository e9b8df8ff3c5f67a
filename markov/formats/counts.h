// SPDX-License-Identifier: MIT
#pragma once
/// Counts on disk: one NetCDF-4 (HDF5) file, which MATLAB, Python, R and Octave open directly.
///
/// Dimensions: input_state, output_state, nonzero. Variables: count_row, count_column (from 0) and
/// count (nonzero); trials and clamped (input_state); exit_next_input, exit_di_x, exit_di_y and
/// state_name (output_state; characters); each NamedArray under its name. Cells of another type
/// have a group type_NAME with its own nonzero, count_row, count_column, count, trials and clamped.
/// Global attributes: format, format_version, checksum and `text`. Files of version 1 can be read
/// too; they have no state_name, and only arrays of numbers with a dimension each. Files of chains
/// with words have version 3, so that older programs refuse them.
///
/// checksum = "crc64-xz:" + 16 hexadecimal digits: CRC-64/XZ of the whole file, in which these
/// digits are read as zeros. The mark "crc64-xz:" may occur nowhere else in the file. The same
/// content gives the same bytes. NetCDF is not thread-safe: make one call at a time.

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// The text that says which words a chain remembers (dynamics/cells/words.h).
inline constexpr const char* kWordsText = "words";

/// The largest size of a text. An HDF5 attribute must be smaller than 64 KB.
inline constexpr std::size_t kMostTextBytes = 60'000;

/// A named table of numbers stored beside the counts (bin edges, for example).
struct NamedArray {
  std::string name;  // letters, digits and _, a letter first
  std::string unit;  // in the notation of UDUNITS; empty: none
  std::string meaning;
  std::vector<double> values;
  /// Name of the dimension, shared by all arrays with the same one; input_state, output_state and
  /// nonzero are those of the counts. Empty: a dimension of its own, name + "_length".
  std::string dimension{};
  bool whole = false;                // written as 32-bit integers
  std::vector<std::string> codes{};  // words without blanks, for 0, 1, ...
};

/// The counts of one type of cell.
struct RowCounts {
  Counts counts;                      // (n_in x n_out)
  std::vector<std::int64_t> trials;   // (n_in) runs per row: the sum of its counts
  std::vector<std::int64_t> clamped;  // (n_in) runs that crossed outside every bin
};

/// The content of a counts file. `text` holds string attributes (scene, seed, version, command
/// line, ...).
struct CountsFile : RowCounts {
  std::map<std::string, RowCounts> types;   // counts of the other types of cells, by name
  std::vector<Exit> exits;                  // (n_out)
  std::vector<NamedArray> arrays;           // unique names; read back sorted by name
  std::vector<std::string> state_names{};   // (n_out) different names; or empty
  std::map<std::string, std::string> text;  // by name, as of arrays; up to 60 000 bytes each
};

/// Thrown for a file that is damaged, of another format or inconsistent. what() names the file and,
/// where there is one, the row (counted from 0: the paper's I_1 is row 0).
class BadFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown for a file whose checksum does not match its bytes: the file is damaged or was changed by
/// another program.
class BadChecksum : public BadFile {
 public:
  using BadFile::BadFile;
};

/// Writes a counts file; an existing file at `path` is replaced as a whole (replace_file). Throws
/// std::invalid_argument for inconsistent content and std::runtime_error for a failure, naming the
/// file and the reason; the old file then stays. (The one exception: if syncing the folder fails,
/// the last step, the new file is in place already.)
void write_counts(const std::string& path, const CountsFile& file);

/// Reads a counts file. Throws BadFile if anything is missing, truncated or inconsistent,
/// BadChecksum if the file was altered. The checksum is computed in constant memory before HDF5
/// reads the file. Files above 1 GiB are refused.
[[nodiscard]] CountsFile read_counts(const std::string& path);

/// Explains in words what is wrong with a file of a bad checksum: "row 12 (counted from 0): counts
/// add up to ...", or that its content is consistent all the same. Returns an empty string if
/// nothing can be read. A child process reads the file, because HDF5 may crash or hang on damaged
/// bytes.
[[nodiscard]] std::string diagnose_counts(const std::string& path);

}  // namespace gatewalk::markov
