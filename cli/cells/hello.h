#pragma once
/// The first line that a cell program writes: what its cell looks like (PROGRAM.md).

#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::cli {

inline constexpr int kProgramProtocol = 1, kMostNoise = 10'000;

struct Hello {
  struct Parameter {
    dynamics::Cell::Number number;
    double low, high;  // what is permitted
    [[nodiscard]] bool permits(double value) const { return low <= value && value <= high; }
    [[nodiscard]] std::string range() const;  // "a number from 0 to 1"
  };
  dynamics::Section section;
  bool symmetric = false;
  int normals = 0, uniforms = 0;  // that a passage gets; one of both is 0
  std::vector<Parameter> parameters;
};

/// Throws std::invalid_argument naming the key and what is allowed.
[[nodiscard]] Hello read_hello(std::string_view line);

}  // namespace gatewalk::cli
