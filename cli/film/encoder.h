// SPDX-License-Identifier: MIT
#pragma once
/// Encodes pictures as a video with ffmpeg.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "cli/terminal/child.h"

namespace gatewalk::cli {

enum class VideoFormat : std::uint8_t { mp4, gif };

/// The format by the ending of a file's name, .mp4 or .gif. Throws std::invalid_argument for
/// others.
[[nodiscard]] VideoFormat video_format(const std::string& path);

/// Pictures from all parts of the film that precede a GIF; its 64 colours are chosen from them.
inline constexpr std::int64_t kPaletteFrames = 32;

class Encoder {
 public:
  /// Starts ffmpeg. Throws std::runtime_error when it is missing.
  Encoder(VideoFormat format, const std::string& title, double frames_per_second);

  /// Sends the next picture, as Picture draws it. Returns false when ffmpeg reads no more. Throws
  /// Interrupted after a signal.
  [[nodiscard]] bool send(std::string_view picture) const { return sockets_.send(picture); }

  /// Ends the pictures and returns the video. Throws std::runtime_error with ffmpeg's messages when
  /// ffmpeg failed, and Interrupted after a signal.
  [[nodiscard]] std::string finish();

 private:
  /// Sends pictures to ffmpeg through a pair of sockets. Unlike a pipe, sockets report an ffmpeg
  /// that has ended as an error without a signal, and let us check for ctrl-C while ffmpeg does not
  /// read.
  class Sockets {
   public:
    Sockets();
    ~Sockets();
    Sockets(const Sockets&) = delete;
    Sockets& operator=(const Sockets&) = delete;

    [[nodiscard]] int exit() const { return ends_[1]; }
    void close_exit() { close(ends_[1]); }  // closed once ffmpeg holds it
    void close_entry() { close(ends_[0]); }
    [[nodiscard]] bool send(std::string_view bytes) const;

   private:
    static void close(int& fd);
    std::array<int, 2> ends_{-1, -1};
  };

  Sockets sockets_;
  Child ffmpeg_;
};

}  // namespace gatewalk::cli
