// SPDX-License-Identifier: MIT
#include "cli/film/encoder.h"

#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "cli/film/picture.h"
#include "cli/terminal/interrupt.h"

namespace gatewalk::cli {
namespace {

std::vector<std::string> ffmpeg_command(VideoFormat format, const std::string& title,
                                        double frames_per_second) {
  std::vector<std::string> command{"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
                                   "-xerror",  // else a failed write has status 0
                                   // Raw pictures as cairo stores them, without a header.
                                   "-f", "rawvideo", "-pixel_format", "bgr0", "-video_size",
                                   fmt::format("{}x{}", kPictureWidth, kPictureHeight),
                                   "-framerate", fmt::format("{:f}", frames_per_second), "-i",
                                   "pipe:0", "-an"};
  const std::vector<std::string> mp4{
      "-c:v", "libx264", "-preset", "veryfast", "-crf", "20",
      // Players assume BT.709 colours for HD pictures.
      "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
      "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv", "-metadata",
      "title=" + title,
      // ffmpeg's standard output is a file here, so that the index can be moved to the front.
      "-movflags", "+faststart", "-f", "mp4", "file:/dev/stdout"};
  const std::string ahead = std::to_string(kPaletteFrames);
  const std::vector<std::string> gif{
      "-filter_complex",
      // The colours are chosen before the film begins, so that ffmpeg need not keep the film in
      // memory. Without dither, parts that do not move stay the same and need no bytes.
      "[0:v]scale=800:-1:flags=area,split[a][b];[a]trim=end_frame=" + ahead +
          ",palettegen=max_colors=64[colours];[b]trim=start_frame=" + ahead +
          ",setpts=PTS-STARTPTS[film];[film][colours]paletteuse=dither=none:diff_mode=rectangle",
      "-loop", "0", "-f", "gif", "file:/dev/stdout"};
  const auto& packing = format == VideoFormat::gif ? gif : mp4;
  command.insert(command.end(), packing.begin(), packing.end());
  return command;
}

}  // namespace

VideoFormat video_format(const std::string& path) {
  if (path.ends_with(".mp4")) return VideoFormat::mp4;
  if (path.ends_with(".gif")) return VideoFormat::gif;
  throw std::invalid_argument(path + ": a video is FILE.mp4 or FILE.gif");
}

Encoder::Encoder(VideoFormat format, const std::string& title, double frames_per_second)
    : ffmpeg_(ffmpeg_command(format, title, frames_per_second), sockets_.exit(),
              "ffmpeg was not found; it packs the video (Debian: ffmpeg)") {
  sockets_.close_exit();
}

std::string Encoder::finish() {
  sockets_.close_entry();
  while (ffmpeg_.runs()) {
    if (interrupted()) throw Interrupted{};
    ::usleep(5'000);
  }
  return ffmpeg_.output();
}

Encoder::Sockets::Sockets() {
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()) != 0)
    throw std::runtime_error(std::string("ffmpeg cannot be run: no sockets: ") +
                             std::strerror(errno));
  const timeval patience{0, 100'000};
  ::setsockopt(ends_[0], SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
}

Encoder::Sockets::~Sockets() {
  close(ends_[0]);
  close(ends_[1]);
}

bool Encoder::Sockets::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(ends_[0], bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
      continue;
    }
    if (interrupted()) throw Interrupted{};
    if (sent < 0 && errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) return false;
  }
  return true;
}

void Encoder::Sockets::close(int& fd) {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

}  // namespace gatewalk::cli
