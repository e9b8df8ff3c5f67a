#pragma once
/// Counts on disk: one NetCDF-4 (HDF5) file that MATLAB, Python, R and Octave open as it is.

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// A named table of numbers that travels with the counts (bin edges, for example).
struct NamedArray {
  std::string name;  // a legal NetCDF name
  std::string unit;
  std::string meaning;
  std::vector<double> values;
};

/// What a file holds. `text` are string attributes (scene, seed, version, command line, ...).
struct CountsFile {
  Counts counts;                       // (n_in x n_out)
  std::vector<std::int64_t> trials;    // (n_in) runs per row; the row's counts must add up to it
  std::vector<std::int64_t> clamped;   // (n_in) of these, crossings outside every bin
  std::vector<Exit> exits;             // (n_out)
  std::vector<NamedArray> arrays;
  std::map<std::string, std::string> text;
};

/// The file is damaged, is not ours, or does not add up. what() names the file and, where there is
/// one, the row (counted from 1, as in the paper's I_1 ... I_87).
class BadFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes to a temporary name beside `path`, syncs, renames. On failure throws std::runtime_error
/// naming the file and the reason; an old file at `path` stays as it was.
void write_counts(const std::string& path, const CountsFile& file);

/// Throws BadFile when anything is missing, truncated, altered (checksum) or does not add up.
[[nodiscard]] CountsFile read_counts(const std::string& path);

}  // namespace gatewalk::markov
