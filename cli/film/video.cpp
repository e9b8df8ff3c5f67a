// SPDX-License-Identifier: MIT
#include "cli/film/video.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/film/picture.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {
namespace {

/// Units of the scene's time in a second of the film. Throws std::invalid_argument for a wrong
/// speed or frame rate.
double pace_of(const Film& film, const VideoOptions& options) {
  if (options.speed && (!(*options.speed > 0.0) || !std::isfinite(*options.speed)))
    throw std::invalid_argument("a video's speed must be above 0");
  if (const double rate = options.frames_per_second.value_or(50.0); !(rate >= 1.0 && rate <= 240.0))
    throw std::invalid_argument("a video has 1 to 240 frames a second");
  return options.speed ? *options.speed / dynamics::scale_of(film.gate).time : 1.0;
}

const FilmRun& first_run(const Film& film) {
  if (film.runs.empty()) throw std::invalid_argument("film: without runs");
  return film.runs.front();
}

}  // namespace

std::string video_frame(const Film& film, double time, const VideoOptions& options) {
  Picture picture(film, first_run(film), pace_of(film, options), options.labels);
  return std::string(
      picture.draw(std::clamp(time, picture.playback().start(), picture.playback().end())));
}

void write_video(const std::string& path, const Film& film, const VideoOptions& options,
                 const dynamics::Work& work) {
  const double pace = pace_of(film, options);
  const FilmRun& run = first_run(film);
  Picture picture(film, run, pace, options.labels);
  const VideoFormat format = video_format(path);
  const double frames_per_second =
      options.frames_per_second.value_or(format == VideoFormat::gif ? 10.0 : 50.0);
  require_writable(path);
  Encoder encoder(format, film.title + ": " + run.label, frames_per_second);

  const double start = picture.playback().start(), end = picture.playback().end(),
               step = pace * dynamics::scale_of(film.gate).time / frames_per_second;
  const auto frames = static_cast<std::int64_t>(std::ceil((end - start) / step - 1e-9)) + 1 +
                      static_cast<std::int64_t>(frames_per_second);  // the last one stands
  bool reads = true;
  if (format == VideoFormat::gif)
    for (std::int64_t k = 0; k < kPaletteFrames && reads; ++k)
      reads = encoder.send(picture.draw(start + static_cast<double>(k) * (end - start) /
                                                    static_cast<double>(kPaletteFrames - 1)));
  work.in_pieces("video, frames", frames, [&](dynamics::TrialRange range) {
    for (std::int64_t k = range.first; k < range.first + range.count && reads; ++k)
      reads = encoder.send(picture.draw(std::min(end, start + static_cast<double>(k) * step)));
  });
  const std::string video = encoder.finish();
  if (!reads) throw std::runtime_error("ffmpeg stopped reading before the end");
  write_text_atomically(path, video);
}

}  // namespace gatewalk::cli
