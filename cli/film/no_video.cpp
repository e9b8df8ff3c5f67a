// SPDX-License-Identifier: MIT
// Built in place of video.cpp and what it needs by -DGATEWALK_VIDEO=OFF.

#include <stdexcept>

#include "cli/film/video.h"

namespace gatewalk::cli {
namespace {

[[noreturn]] void refuse() {
  throw std::invalid_argument("needs films: this gatewalk was built without (GATEWALK_VIDEO=OFF)");
}

}  // namespace

VideoFormat video_format(const std::string&) { refuse(); }

void write_video(const std::string&, const Film&, const VideoOptions&, const dynamics::Work&) {
  refuse();
}

std::string video_frame(const Film&, double, const VideoOptions&) { refuse(); }

}  // namespace gatewalk::cli
