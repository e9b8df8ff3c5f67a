// SPDX-License-Identifier: MIT
#pragma once
/// Pictures that are maps of gates: one pixel per gate, whose grey value stands for its type.

#include <cstdint>
#include <string>
#include <vector>

namespace gatewalk::lattice {

/// The grey values of a picture.
struct GreyPicture {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> grey;  // (rows x columns), the upper row first; 0: black, 255: white
};

/// Reads a PNG of at most 8 bits per pixel; RGB and palettes are accepted if all colours are grey.
/// Throws std::runtime_error for a file that cannot be read or has another size, a colour, a pixel
/// that is not opaque, or a pixel beyond the end of its palette.
[[nodiscard]] GreyPicture read_grey_png(const std::string& path, int columns, int rows);

}  // namespace gatewalk::lattice
