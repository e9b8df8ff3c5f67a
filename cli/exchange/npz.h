// SPDX-License-Identifier: MIT
#pragma once
/// Files of numpy arrays (.npz), as numpy.savez and scipy.sparse.save_npz write them.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace gatewalk::cli {

struct NumpyArray {
  std::string name;
  std::vector<std::int64_t> shape;  // empty: a single value
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::string> values;
  std::string type{};  // numpy's type in the file read: "f4", "b1"
};

/// Writes little-endian arrays in version 1 of numpy's format. Throws std::runtime_error.
[[nodiscard]] std::string npz_of(const std::vector<NumpyArray>& arrays);

/// Reads a file. Integers and booleans become std::int64_t, other numbers double, bytes and
/// characters a string. Throws std::runtime_error naming the file and the array for any other type,
/// for arrays in Fortran order, and above 2^27 numbers or 1 GiB.
[[nodiscard]] std::vector<NumpyArray> read_npz(const std::string& path);

}  // namespace gatewalk::cli
