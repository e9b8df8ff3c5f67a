// SPDX-License-Identifier: MIT
#pragma once
/// Pictures that are maps: a pixel is a gate, its grey value says of which type.

#include <cstdint>
#include <string>
#include <vector>

namespace gatewalk::lattice {

struct GreyPicture {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> grey;  // (rows x columns), the upper row first; 0 black, 255 white
};

/// Of 8 bits a pixel or fewer; RGB and palettes will do where all colours are grey. Throws
/// std::runtime_error saying what is wrong: it cannot be read, is of another size, has a colour,
/// a pixel that is not opaque, or one beyond the end of its palette.
[[nodiscard]] GreyPicture read_grey_png(const std::string& path, int columns, int rows);

}  // namespace gatewalk::lattice
