// SPDX-License-Identifier: MIT
#pragma once
/// Pictures packed into a video by ffmpeg.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "cli/terminal/child.h"

namespace gatewalk::cli {

enum class VideoFormat : std::uint8_t { mp4, gif };

/// By the ending of a file's name, .mp4 or .gif. Throws std::invalid_argument for any other.
[[nodiscard]] VideoFormat video_format(const std::string& path);

/// Pictures from all over the film that go ahead of a GIF: its 64 colours are chosen from them.
inline constexpr std::int64_t kPaletteFrames = 32;

class Encoder {
 public:
  /// Starts ffmpeg. Throws std::runtime_error when it is missing.
  Encoder(VideoFormat format, const std::string& title, double frames_per_second);

  /// The next picture, as Picture draws it. False when ffmpeg reads no more. Throws Interrupted
  /// after a signal.
  [[nodiscard]] bool send(std::string_view picture) const { return sockets_.send(picture); }

  /// No more pictures: the video. Throws std::runtime_error with ffmpeg's words when it failed,
  /// Interrupted after a signal.
  [[nodiscard]] std::string finish();

 private:
  /// Pictures on their way to ffmpeg. A pair of sockets and no pipe: when ffmpeg has gone away,
  /// writing is an error without a signal, and one that does not read leaves time to look at
  /// ctrl-C.
  class Sockets {
   public:
    Sockets();
    ~Sockets();
    Sockets(const Sockets&) = delete;
    Sockets& operator=(const Sockets&) = delete;

    [[nodiscard]] int exit() const { return ends_[1]; }
    void close_exit() { close(ends_[1]); }  // once ffmpeg holds it
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
