// SPDX-License-Identifier: MIT
#pragma once
/// The first line that a cell program writes, which describes its cell
/// (cli/site/reference/cell_program.md).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::cli {

inline constexpr int kProgramProtocol = 1, kMostNoise = 10'000;

struct Hello {
  struct Parameter {
    dynamics::Cell::Number number;
    double low, high;  // permitted range
    [[nodiscard]] bool permits(double value) const { return low <= value && value <= high; }
    [[nodiscard]] std::string range() const;  // in words: "a number from 0 to 1"
  };
  dynamics::Section section;
  bool symmetric = false;
  int normals = 0, uniforms = 0;  // random numbers of a passage; one is 0
  std::vector<Parameter> parameters;
  std::vector<dynamics::Cell::Remembered> remembered;  // with which numbers a body's memory begins
};

/// Draws the noise of a passage, number by number, into `take`, and returns the passage's seed. The
/// noise is drawn before the seed, so that a trial's first passage gets the same noise as in other
/// cells.
template <class Take>
std::uint64_t draw_noise(const Hello& hello, dynamics::Random& random, Take take) {
  dynamics::Random::Normals normals;
  for (int i = 0; i < hello.normals; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) % normals.size();
    if (at == 0) random.normals(normals);
    take(normals[at]);
  }
  for (int i = 0; i < hello.uniforms; ++i) take(random.uniform());
  return random.word();
}

/// Reads the first line. Throws std::invalid_argument naming the key and what is allowed.
[[nodiscard]] Hello read_hello(std::string_view line);

}  // namespace gatewalk::cli
