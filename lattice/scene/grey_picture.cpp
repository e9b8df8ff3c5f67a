// SPDX-License-Identifier: MIT
#include "lattice/scene/grey_picture.h"

#include <png.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace gatewalk::lattice {

namespace {

/// True if a PNG has a gamma of its own, by which libpng would change its values: a gAMA chunk
/// before the picture's first, with another value than sRGB's.
bool has_gamma(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.ignore(8);
  for (std::array<unsigned char, 12> chunk{};;) {  // length, name, first four bytes of the content
    if (!file.read(reinterpret_cast<char*>(chunk.data()), chunk.size())) return false;
    const auto number = [&](std::size_t at) {
      return std::uint32_t{chunk[at]} << 24 | std::uint32_t{chunk[at + 1]} << 16 |
             std::uint32_t{chunk[at + 2]} << 8 | std::uint32_t{chunk[at + 3]};
    };
    const std::string_view name(reinterpret_cast<const char*>(chunk.data()) + 4, 4);
    constexpr std::uint32_t kOfSrgb = 45455;
    if (name == "gAMA") return number(8) != kOfSrgb;
    if (name == "IDAT") return false;
    // 4 bytes of the content are read, 4 belong to the checksum
    file.seekg(std::int64_t{number(0)}, std::ios::cur);
  }
}

}  // namespace

GreyPicture read_grey_png(const std::string& path, int columns, int rows) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  struct Freed {
    png_image& image;
    ~Freed() { png_image_free(&image); }
  } const freed{image};
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0)
    throw std::runtime_error(std::ifstream(path)
                                 ? "cannot be read as a PNG: it is none, or damaged"
                                 : std::string("cannot be read: ") + std::strerror(errno));
  if (has_gamma(path))
    throw std::runtime_error(
        "has a gamma of its own (chunk gAMA), which changes its grey values: "
        "must be written without");
  if (image.width != static_cast<png_uint_32>(columns) ||
      image.height != static_cast<png_uint_32>(rows))
    throw std::runtime_error("is " + std::to_string(image.width) + " pixels wide and " +
                             std::to_string(image.height) + " high, the field has " +
                             std::to_string(columns) + " columns and " + std::to_string(rows) +
                             " rows: a pixel is a gate");
  if ((image.format & PNG_FORMAT_FLAG_LINEAR) != 0)
    throw std::runtime_error("has 16 bits a pixel: must have 8 or fewer");
  // Pixels of a palette are read unchanged: libpng turns those beyond its end black.
  const bool has_palette = (image.format & PNG_FORMAT_FLAG_COLORMAP) != 0;
  image.format = has_palette ? PNG_FORMAT_RGBA_COLORMAP : PNG_FORMAT_RGBA;
  std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
  std::array<png_byte, std::size_t{256} * 4> palette{};
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, palette.data()) == 0)
    throw std::runtime_error("cannot be read as a PNG: it is cut short or damaged");
  GreyPicture picture{columns, rows, {}};
  const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  for (std::size_t i = 0; i < count; ++i) {
    const auto refuse = [&](const std::string& what) {
      const auto pixel = static_cast<int>(i);
      throw std::runtime_error("row " + std::to_string(pixel / columns + 1) + ", column " +
                               std::to_string(pixel % columns + 1) + " " + what);
    };
    if (has_palette && pixels[i] >= image.colormap_entries)
      refuse("has colour " + std::to_string(pixels[i]) + " of a palette of " +
             std::to_string(image.colormap_entries) + ", counted from 0");
    const png_byte* const p = has_palette ? &palette[std::size_t{4} * pixels[i]] : &pixels[4 * i];
    if (p[3] != 255) refuse("is not opaque");
    if (p[0] != p[1] || p[1] != p[2])
      refuse("has the colour " + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " +
             std::to_string(p[2]) + " (red, green, blue): must be grey");
    picture.grey.push_back(p[0]);
  }
  return picture;
}

}  // namespace gatewalk::lattice
