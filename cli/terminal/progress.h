// SPDX-License-Identifier: MIT
#pragma once
/// Long work in pieces: lines that say how far it is, and a place to stop between pieces.

#include <chrono>
#include <cstdint>
#include <iostream>
#include <string>
#include <utility>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// How far long work is. At a terminal one line on standard error, redrawn in place at most 5 times
/// a second. Elsewhere (a log, a batch job) lines: once a part has worked for a thirtieth of
/// `every`, how long it takes if that is longer than `every`; then, each `every`, how far it is.
/// Nothing unless `enabled`. Not for several threads at once.
class Progress {
 public:
  /// Elsewhere than at a terminal.
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

  /// Another part of the work, timed from now on.
  void begin(std::string label, std::int64_t total);
  /// What is worked at from now on.
  void name(std::string label) { label_ = std::move(label); }
  void update(std::int64_t done);
  /// The same where the total has changed.
  void update(std::int64_t done, std::int64_t total) {
    total_ = total;
    update(done);
  }
  /// Clears the line of a terminal, if there is one. The destructor does the same.
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

/// Work whose progress is shown, if wanted, and that a first signal stops: Interrupted is thrown
/// before the next piece.
[[nodiscard]] dynamics::Work watched_work(bool show_progress, const Progress::Lines& lines = {},
                                          bool stops = true);

}  // namespace gatewalk::cli
