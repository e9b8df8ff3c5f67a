#include "lattice/scene/grey_picture.h"

#include <png.h>

#include <stdexcept>

namespace gatewalk::lattice {

bool is_png(const std::string& path) { return path.ends_with(".png") || path.ends_with(".PNG"); }

GreyPicture read_grey_png(const std::string& path, int columns, int rows) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  struct Freed {
    png_image& image;
    ~Freed() { png_image_free(&image); }
  } const freed{image};
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0)
    throw std::runtime_error(std::string("cannot be read: ") + image.message);
  if (image.width != static_cast<png_uint_32>(columns) ||
      image.height != static_cast<png_uint_32>(rows))
    throw std::runtime_error("is " + std::to_string(image.width) + " pixels wide and " +
                             std::to_string(image.height) + " high, the field has " +
                             std::to_string(columns) + " columns and " + std::to_string(rows) +
                             " rows: a pixel is a gate");
  if ((image.format & PNG_FORMAT_FLAG_LINEAR) != 0)
    throw std::runtime_error("has 16 bits a pixel: must have 8 or fewer");
  image.format = PNG_FORMAT_RGBA;
  std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("cannot be read: ") + image.message);
  GreyPicture picture{columns, rows, {}};
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const png_byte* const p = pixels.data() + i;
    const auto refuse = [&](const std::string& what) {
      const auto pixel = static_cast<int>(i / 4);
      throw std::runtime_error("row " + std::to_string(pixel / columns + 1) + ", column " +
                               std::to_string(pixel % columns + 1) + " " + what);
    };
    if (p[3] != 255) refuse("is not opaque");
    if (p[0] != p[1] || p[1] != p[2])
      refuse("has the colour " + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " +
             std::to_string(p[2]) + " (red, green, blue): must be grey");
    picture.grey.push_back(p[0]);
  }
  return picture;
}

}  // namespace gatewalk::lattice
