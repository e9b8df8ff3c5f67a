#pragma once
/// Long work in pieces: one line that says how far it is, and a place to stop between pieces.

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "dynamics/work.h"

namespace gatewalk::cli {

/// One line on standard error, redrawn in place at most 5 times a second. Draws nothing unless
/// `enabled` and standard error is a terminal. Not for several threads at once.
class Progress {
 public:
  Progress(std::string label, std::int64_t total, bool enabled);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is worked at from now on.
  void name(std::string label) { label_ = std::move(label); }
  void update(std::int64_t done);
  /// Clears the line, if there is one. The destructor does the same.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::int64_t total_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
};

/// Work that is shown as a progress line, if wanted, and that a first signal stops: Interrupted is
/// thrown before the next piece.
[[nodiscard]] dynamics::Work watched_work(bool show_progress);

}  // namespace gatewalk::cli
