// SPDX-License-Identifier: MIT
#pragma once
/// Runs another program and exchanges lines with it through pipes to its standard input, output and
/// error.

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gatewalk::cli {

/// A file descriptor, closed by the destructor.
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

/// Runs `/bin/sh -c COMMAND` and all that it starts in a process group of its own. The group is
/// killed by the destructor, when the program fails, and whenever this program ends: a second shell
/// in the group waits for that. Not thread-safe.
class Process {
 public:
  /// `timeout_s`: the longest wait for a line (s). Throws std::runtime_error when the program
  /// cannot be started.
  Process(std::string command, double timeout_s);
  /// Gives the program half a second to end by itself, then kills it.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// The longest line that the program may write, in bytes.
  static constexpr std::size_t kMostLine = std::size_t{1} << 16;

  /// The text that the program has not read yet. The caller appends to it.
  [[nodiscard]] std::string& out() { return out_; }
  /// Starts the timeout for the program's next line. Each line that the program writes restarts it.
  void begin_to_wait() { waits_since_ = Clock::now(); }
  /// Waits until the program has written something, or has read all of out(). Throws as fail() if
  /// the program has ended, has closed its input or output, or has not written a line in time.
  void exchange();
  /// The next whole line of the program's output, without its line end; valid until the next
  /// exchange(). nullopt: no whole line is there. Throws as fail() for a line that is too long.
  [[nodiscard]] std::optional<std::string_view> line();
  /// The next whole line of the program's output. Waits for it with exchange().
  [[nodiscard]] std::string_view wait_for_line();

  /// Kills the program and throws std::runtime_error with the command, `what`, and the program's
  /// last lines on standard error.
  [[noreturn]] void fail(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  void write_some();
  /// Appends what can be read to `text`; returns false at the end of the file.
  bool read_some(Descriptor& from, std::string& text);
  void read_complaints();
  /// How the program has ended, in words; nullopt if it runs. Does not collect its exit status.
  [[nodiscard]] std::optional<std::string> ended() const;
  /// Reads on until the program has ended by itself, at most for `seconds`. Returns what ended()
  /// returns.
  std::optional<std::string> let_end(double seconds);
  /// Calls fail() for a program that has closed a pipe: says how it ended if it does, else
  /// `else_it`.
  [[noreturn]] void fail_as_ended(const std::string& else_it);
  /// Kills the process group and collects the exit status of both shells.
  void kill();

  std::string command_;
  double timeout_s_;
  Descriptor in_, output_, errors_;  // our ends of the program's pipes
  Descriptor life_;                  // the watcher sees its other end close when this program ends
  pid_t watcher_ = 0, program_ = 0;  // 0: collected; the watcher leads the group
  std::string out_;
  std::string text_;        // the program's output
  std::size_t taken_ = 0;   // bytes of text_ that line() has returned
  std::string complaints_;  // the last bytes of the program's standard error
  Clock::time_point waits_since_ = Clock::now();
};

/// Text of another program for a message: its first `most` bytes, without control characters.
[[nodiscard]] std::string excerpt(std::string_view text, std::size_t most = 200);

}  // namespace gatewalk::cli
