#pragma once
/// Long work in pieces: one line that says how far it is, and a place to stop between pieces.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "dynamics/work.h"

namespace gatewalk::cli {

/// One line on standard error, redrawn in place at most 5 times a second. Draws nothing unless
/// `enabled` and standard error is a terminal. Not for several threads at once. One that is made
/// while another lives is a part of that one and draws nothing itself: commands that run commands.
class Progress {
 public:
  Progress(std::string label, std::int64_t total, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::int64_t done);
  /// What is made next counts for `size` of this one's total, under its own name.
  void begin_part(std::string label, std::int64_t size);
  /// Clears the line, if there is one. The destructor does the same.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double done);
  static inline Progress* innermost_ = nullptr;
  Progress* outer_;
  std::int64_t before_ = 0, part_ = 0;  // of the total: done before the part, the part
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

/// Calls run(first, count) for consecutive ranges that cover [0, total) exactly once, with a
/// progress line. Throws Interrupted between two batches after a first signal. The ranges depend
/// on the machine's speed, so results must not depend on how [0, total) is cut.
void run_in_batches(const std::string& label, std::int64_t total, bool show_progress,
                    const std::function<void(std::int64_t first, std::int64_t count)>& run);

/// The same as one part of longer work: when i items are done, `progress` is at before + i * each.
void run_in_batches(Progress& progress, double before, double each, std::int64_t total,
                    const std::function<void(std::int64_t first, std::int64_t count)>& run);

}  // namespace gatewalk::cli
