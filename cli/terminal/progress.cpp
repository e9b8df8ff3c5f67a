#include "cli/terminal/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/terminal/interrupt.h"

namespace gatewalk::cli {
namespace {

constexpr std::chrono::milliseconds kRedraw{200};

double seconds_between(std::chrono::steady_clock::time_point a,
                       std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

/// "0:07", "12:34", "1:02:03".
std::string clock_text(double seconds) {
  constexpr double kDay = 86400.0;
  if (!(seconds < 100.0 * kDay)) return "over 100 days";
  const auto whole = static_cast<int>(seconds);
  char text[32];
  if (whole < 3600) {
    std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return text;
}

/// Columns of the terminal, so that the line never wraps and leaves a trail.
std::size_t terminal_columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      visible_(enabled && total > 0 && ::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_drawn_(start_) {}

void Progress::update(std::int64_t done) {
  if (!visible_) return;
  const auto now = Clock::now();
  if (now - last_drawn_ < kRedraw) return;
  last_drawn_ = now;
  drawn_ = true;

  const double elapsed = seconds_between(start_, now);
  const double rate = static_cast<double>(done) / elapsed;
  const double left = static_cast<double>(total_ - done) / rate;  // inf while nothing is done
  char figures[48];
  std::snprintf(figures, sizeof figures, " %3d%%  %.3g/s  ",
                static_cast<int>(100.0 * static_cast<double>(done) / static_cast<double>(total_)),
                rate);
  std::string line =
      label_ + figures + clock_text(elapsed) + " elapsed, " + clock_text(left) + " left";
  line.resize(std::min(line.size(), terminal_columns() - 1));
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

dynamics::Work watched_work(bool show_progress) {
  struct Line {
    std::string what;
    std::int64_t most = 0;  // done; checks at the end of a part begin at its start again
    std::optional<Progress> progress;
  };
  const auto line = std::make_shared<Line>();
  return {[line, show_progress](std::string_view what, std::int64_t done, std::int64_t total) {
    if (done >= total) {
      line->progress.reset();
      return;
    }
    if (interrupted()) throw Interrupted{};
    if (!line->progress || what != line->what) {
      line->progress.emplace(line->what = what, total, show_progress);
      line->most = 0;
    }
    line->progress->update(line->most = std::max(line->most, done));
  }};
}

}  // namespace gatewalk::cli
