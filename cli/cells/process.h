// SPDX-License-Identifier: MIT
#pragma once
/// Another program that is spoken to line by line: pipes to it, from it and for what it complains
/// of.

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gatewalk::cli {

/// A file descriptor, closed at the end of the object's life.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  [[nodiscard]] int get() const { return number_; }  // -1: closed
  void close();

 private:
  int number_;
};

/// `/bin/sh -c COMMAND` and all that it starts, in a process group of its own. The group is killed
/// at the end of the object's life, when the program fails, and when this program ends, however it
/// does: a second shell in the group waits for that. Not for several threads at once.
class Process {
 public:
  /// `timeout_s`: how long a line is waited for. Throws std::runtime_error when it cannot be
  /// started.
  Process(std::string command, double timeout_s);
  /// It may end by itself within half a second.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// The longest line that it may write.
  static constexpr std::size_t kMostLine = std::size_t{1} << 16;

  /// What it has not read yet; to be added to.
  [[nodiscard]] std::string& out() { return out_; }
  /// The time in which it must write a line begins now, as it does with each that it writes.
  void begin_to_wait() { waits_since_ = Clock::now(); }
  /// Waits until it has written something or has read all of out(). Throws as fail() when it has
  /// ended, closed its input or output, or has not written a line in time.
  void exchange();
  /// The next whole line that it has written, without its end: good until the next exchange().
  /// None: there is no more. Throws as fail() for one that is too long.
  [[nodiscard]] std::optional<std::string_view> line();
  /// The same, waiting for it.
  [[nodiscard]] std::string_view wait_for_line();

  /// Ends it and throws std::runtime_error: the command, what is wrong, its last lines on standard
  /// error.
  [[noreturn]] void fail(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  void write_some();
  /// Appends what is there to `text`; false at the end of the file.
  bool read_some(Descriptor& from, std::string& text);
  void read_complaints();
  /// How the program itself has ended, in words; none: it runs. Its status is left to be collected.
  [[nodiscard]] std::optional<std::string> ended() const;
  /// Reads on until it has ended by itself, but not for longer. As ended().
  std::optional<std::string> let_end(double seconds);
  /// For one that hung up: says how it ended, if it does.
  [[noreturn]] void fail_as_ended(const std::string& else_it);
  /// Kills what is left of the group and collects its two shells.
  void kill();

  std::string command_;
  double timeout_s_;
  Descriptor in_, output_, errors_;  // our ends of its pipes
  Descriptor life_;                  // its other end is at its end when this program is
  pid_t watcher_ = 0, program_ = 0;  // 0: collected; the watcher leads the group
  std::string out_;
  std::string text_;        // what it wrote
  std::size_t taken_ = 0;   // of text_, by line()
  std::string complaints_;  // the last ones
  Clock::time_point waits_since_ = Clock::now();
};

/// Words of others in a message: the first `most` bytes, nothing that a terminal would obey.
[[nodiscard]] std::string excerpt(std::string_view text, std::size_t most = 200);

}  // namespace gatewalk::cli
