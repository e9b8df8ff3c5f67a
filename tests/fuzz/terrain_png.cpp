// SPDX-License-Identifier: MIT
// A map of terrain as a picture. The checksums of its chunks are put right, behind which libpng
// would stop looking.
#include <zlib.h>

#include <cstdint>

#include "lattice/scene/grey_picture.h"
#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

std::string with_checksums(std::string png) {
  constexpr std::size_t kSignature = 8, kAround = 12;  // bytes of a chunk besides its content
  for (std::size_t at = kSignature; at + kAround <= png.size();) {
    const std::size_t length = number_at(png, at);
    if (length > png.size() - at - kAround) break;
    const auto crc = ::crc32_z(0, reinterpret_cast<const Bytef*>(png.data() + at + 4), length + 4);
    for (std::size_t i = 0; i < 4; ++i)
      png[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
    at += kAround + length;
  }
  return png;
}

}  // namespace

void terrain_png(std::string_view bytes) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;
  const std::string png = with_checksums(std::string(bytes));
  int columns = 4, rows = 3;
  if (png.size() >= kHeightAt + 4 && number_at(png, kWidthAt) <= 100 &&
      number_at(png, kHeightAt) <= 100) {
    columns = static_cast<int>(number_at(png, kWidthAt));
    rows = static_cast<int>(number_at(png, kHeightAt));
  }
  const std::string path = file_of(png, ".png");
  const auto picture = accepted([&] { return lattice::read_grey_png(path, columns, rows); });
  if (picture)
    require(std::ssize(picture->grey) == std::int64_t{columns} * rows, "every gate has a grey");
}

}  // namespace gatewalk::fuzz
