// SPDX-License-Identifier: MIT
#pragma once
/// Writes a single run as a video file.

#include <optional>
#include <string>

#include "cli/film/encoder.h"
#include "cli/film/film.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {

struct VideoOptions {
  std::optional<double> speed =
      std::nullopt;  // seconds of the run in a second of the video; none: the scene's unit of time
  std::optional<double> frames_per_second = std::nullopt;  // none: 50, or 10 for a GIF
  bool labels = true;                                      // words, numbers and the scale bar
};

/// Writes the first run of a film, drawn by cairo and encoded by ffmpeg, as MP4 (H.264, yuv420p,
/// 1280 x 720) or GIF (800 x 450, repeats for ever), by the ending of `path`. The film ends
/// with one second of its last picture. An old file is replaced as a whole or stays. `work` hears
/// of every picture and may stop the film. Throws std::invalid_argument for an unusable film, name
/// or options, and std::runtime_error when ffmpeg is missing or fails or the file cannot be
/// written.
void write_video(const std::string& path, const Film& film, const VideoOptions& options = {},
                 const dynamics::Work& work = {});

/// The picture of the first run at `time` (s of the run), in 720 rows of 1280 points, each blue,
/// green, red and an unused byte. Throws as write_video() for an unusable film or options.
[[nodiscard]] std::string video_frame(const Film& film, double time,
                                      const VideoOptions& options = {});

}  // namespace gatewalk::cli
