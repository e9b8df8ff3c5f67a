// SPDX-License-Identifier: MIT
#pragma once
/// Arrays of numpy in one file (.npz), as numpy.savez and scipy.sparse.save_npz write them.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace gatewalk::cli {

struct NumpyArray {
  std::string name;
  std::vector<std::int64_t> shape;  // none: a single value
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::string> values;
  std::string type{};  // numpy's, of one that was read: "f4", "b1"
};

/// Little-endian, version 1 of numpy's format. Throws std::runtime_error.
[[nodiscard]] std::string npz_of(const std::vector<NumpyArray>& arrays);

/// Whole numbers and yes or no become std::int64_t, others double, bytes and characters a string.
/// Throws std::runtime_error naming the file and the array for anything else, Fortran's order among
/// it, and above 2^27 numbers or 1 GiB.
[[nodiscard]] std::vector<NumpyArray> read_npz(const std::string& path);

}  // namespace gatewalk::cli
