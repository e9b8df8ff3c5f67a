// SPDX-License-Identifier: MIT
#include "cli/terminal/progress.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>

#include "cli/terminal/interrupt.h"

namespace gatewalk::cli {
namespace {

constexpr std::chrono::milliseconds kRedraw{200};

double seconds_between(std::chrono::steady_clock::time_point a,
                       std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

/// A time in minutes or hours: "0:07", "12:34", "1:02:03".
std::string clock_text(double seconds) {
  constexpr double kDay = 86400.0;
  if (!(seconds < 100.0 * kDay)) return "over 100 days";
  const auto whole = static_cast<int>(seconds);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

/// A rough time: "some 40 s", "some 3 min", "some 5 h".
std::string rough_duration(double seconds) {
  constexpr double kMinute = 60.0, kHour = 3600.0, kDay = 24.0 * kHour;
  if (!(seconds < 100.0 * kDay)) return "over 100 days";
  const auto some = [&](double unit, const char* name) {
    return fmt::format("some {}{}", std::llround(seconds / unit), name);
  };
  if (seconds >= 100.0 * kMinute) return some(kHour, " h");
  return seconds >= 100.0 ? some(kMinute, " min") : some(1.0, " s");
}

int whole_percent(std::int64_t done, std::int64_t total) {
  return static_cast<int>(100.0 * static_cast<double>(done) / static_cast<double>(total));
}

/// Columns of the terminal. The progress line is cut to fit, because a wrapped line could not be
/// redrawn in place.
std::size_t terminal_columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total, bool enabled, const Lines& lines)
    : label_(std::move(label)),
      total_(total),
      enabled_(enabled),
      at_terminal_(::isatty(STDERR_FILENO) == 1),
      lines_(lines),
      start_(Clock::now()),
      last_drawn_(start_),
      last_line_(start_) {}

void Progress::begin(std::string label, std::int64_t total) {
  label_ = std::move(label);
  total_ = total;
  estimated_ = false;
  start_ = last_drawn_ = Clock::now();
}

void Progress::update(std::int64_t done) {
  if (!enabled_ || total_ <= 0) return;
  if (at_terminal_)
    redraw(done, Clock::now());
  else
    write_line(done, Clock::now());
}

void Progress::redraw(std::int64_t done, Clock::time_point now) {
  if (now - last_drawn_ < kRedraw) return;
  last_drawn_ = now;
  drawn_ = true;

  const double elapsed = seconds_between(start_, now);
  const double rate = static_cast<double>(done) / elapsed;
  const double left = static_cast<double>(total_ - done) / rate;  // infinite while nothing is done
  std::string line =
      fmt::format("{} {:3}%  {:.3g}/s  {} elapsed, {} left", label_, whole_percent(done, total_),
                  rate, clock_text(elapsed), clock_text(left));
  line.resize(std::min(line.size(), terminal_columns() - 1));
  line = "\r" + line + "\x1b[K";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void Progress::write_line(std::int64_t done, Clock::time_point now) {
  const double elapsed = seconds_between(start_, now);
  const double left =
      elapsed * static_cast<double>(total_ - done) / static_cast<double>(done);  // infinite at
                                                                                 // first
  if (!estimated_ && done > 0 && 30 * (now - start_) >= lines_.every) {
    estimated_ = true;
    if (elapsed + left > std::chrono::duration<double>(lines_.every).count()) {
      *lines_.out << "gatewalk: " << label_ << ": " << rough_duration(elapsed + left) << std::endl;
      last_line_ = now;
      return;
    }
  }
  if (now - last_line_ < lines_.every) return;
  last_line_ = now;
  *lines_.out << "gatewalk: " << label_ << ": " << whole_percent(done, total_) << " %";
  if (done > 0) *lines_.out << ", " << rough_duration(left) << " left";
  *lines_.out << std::endl;
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

dynamics::Work watched_work(bool show_progress, const Progress::Lines& lines, bool stops) {
  struct Watched {
    Progress progress;
    std::string what;                                  // the current part; empty: none
    std::int64_t most = 0;                             // items done; later checks may be lower
    std::map<std::string, int, std::less<>> rounds{};  // how often each part has begun
  };
  const std::shared_ptr<Watched> watched(new Watched{{"", 0, show_progress, lines}, {}});
  return {[watched, stops](std::string_view what, std::int64_t done, std::int64_t total) {
    if (done >= total) {
      watched->progress.finish();
      watched->what.clear();
      return;
    }
    if (stops && interrupted()) throw Interrupted{};
    if (what != watched->what) {
      watched->what = what;
      const int round = ++watched->rounds[watched->what];
      watched->progress.begin(round == 1 ? watched->what : fmt::format("{}, round {}", what, round),
                              total);
      watched->most = 0;
    }
    watched->progress.update(watched->most = std::max(watched->most, done), total);
  }};
}

}  // namespace gatewalk::cli
