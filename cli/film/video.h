// SPDX-License-Identifier: MIT
#pragma once
/// A single run as a film that plays everywhere.

#include <optional>
#include <string>

#include "cli/film/encoder.h"
#include "cli/film/film.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {

struct VideoOptions {
  std::optional<double> speed =
      std::nullopt;  // seconds of the run in a second of the film; none: the unit of time
  std::optional<double> frames_per_second = std::nullopt;  // none: 50, of a GIF 10
  bool labels = true;  // words, numbers and the rule; without them scenes alike look the same
};

/// Writes the first run of a film, drawn by cairo, packed by ffmpeg: as MP4 (H.264, yuv420p,
/// 1280 x 720) or as GIF (800 x 450, repeats for ever), by the ending of `path`. The last picture
/// stands for a second. `path` is replaced as a whole or left as it was. Throws
/// std::invalid_argument for a film, a name or options that make no sense, std::runtime_error when
/// ffmpeg is missing or fails or the file cannot be written; `work` is told of every picture and
/// may stop it.
void write_video(const std::string& path, const Film& film, const VideoOptions& options = {},
                 const dynamics::Work& work = {});

/// Its picture at `time` (s of the run): 720 rows of 1280 points of blue, green, red and an unused
/// byte. Throws as write_video does for a film or options that make no sense.
[[nodiscard]] std::string video_frame(const Film& film, double time,
                                      const VideoOptions& options = {});

}  // namespace gatewalk::cli
