// SPDX-License-Identifier: MIT
// Replaces grey_picture.cpp in builds with -DGATEWALK_VIDEO=OFF.

#include <stdexcept>

#include "lattice/scene/grey_picture.h"

namespace gatewalk::lattice {

GreyPicture read_grey_png(const std::string&, int, int) {
  throw std::runtime_error(
      "cannot be read: this gatewalk was built without pictures (GATEWALK_VIDEO=OFF); a map of "
      "letters can");
}

}  // namespace gatewalk::lattice
