// SPDX-License-Identifier: MIT
#pragma once
/// Progress messages of long work, and stopping it between two pieces.

#include <chrono>
#include <cstdint>
#include <iostream>
#include <string>
#include <utility>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// Reports how far long work is. At a terminal: one line on standard error, redrawn in place at
/// most 5 times a second. In a log or a batch job: separate lines. Once a part has worked for a
/// thirtieth of `every`, a line says how long the part takes, if that is longer than `every`; then
/// one line each `every`. Reports nothing unless `enabled`. Not thread-safe.
class Progress {
 public:
  /// How progress is reported when standard error is no terminal.
  struct Lines {
    std::ostream* out = &std::cerr;
    std::chrono::milliseconds every = std::chrono::minutes(1);
  };
  Progress(std::string label, std::int64_t total, bool enabled, const Lines& lines);
  Progress(std::string label, std::int64_t total, bool enabled)
      : Progress(std::move(label), total, enabled, Lines{}) {}
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins another part of the work; its time counts from now on.
  void begin(std::string label, std::int64_t total);
  /// Names the part that is worked at from now on.
  void name(std::string label) { label_ = std::move(label); }
  void update(std::int64_t done);
  /// update() with a new total.
  void update(std::int64_t done, std::int64_t total) {
    total_ = total;
    update(done);
  }
  /// Clears the progress line of a terminal. The destructor does the same.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void redraw(std::int64_t done, Clock::time_point now);
  void write_line(std::int64_t done, Clock::time_point now);
  std::string label_;
  std::int64_t total_;
  bool enabled_, at_terminal_;
  Lines lines_;
  bool drawn_ = false, estimated_ = false;
  Clock::time_point start_;       // of the part
  Clock::time_point last_drawn_;  // the line of a terminal
  Clock::time_point last_line_;
};

/// Work that reports its progress if wanted. A part that begins again is "round 2", "round 3" of
/// that part, so that an estimate that starts anew does not look like a hang. After a first signal,
/// Interrupted is thrown before the next piece, if `stops`.
[[nodiscard]] dynamics::Work watched_work(bool show_progress, const Progress::Lines& lines = {},
                                          bool stops = true);

}  // namespace gatewalk::cli
