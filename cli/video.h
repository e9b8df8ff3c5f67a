#pragma once
/// A single run as a film that plays everywhere.

#include <string>

#include "cli/command.h"

namespace gatewalk::cli {

struct VideoOptions {
  double speed = 1.0;              // seconds of the run in a second of the film
  double frames_per_second = 50.0;
  bool show_progress = false;
};

/// Writes run number `run` of a film (replay.h) as MP4: H.264, yuv420p, 1280 x 720, drawn by cairo,
/// packed by ffmpeg. The last picture stands for a second. `path` is replaced as a whole or left as it was.
/// Throws std::invalid_argument for a film or options that make no sense, std::runtime_error when
/// ffmpeg is missing or fails or the file cannot be written, Interrupted after a signal.
void write_video(const std::string& path, const Json& film, int run, const VideoOptions& options = {});

}  // namespace gatewalk::cli
