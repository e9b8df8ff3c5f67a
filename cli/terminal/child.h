// SPDX-License-Identifier: MIT
#pragma once
/// Runs other programs that this one needs: gnuplot, ffmpeg.

#include <sys/types.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gatewalk::cli {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A temporary file in memory, without a name. It needs no cleaning up, and unlike a pipe it never
/// blocks or breaks. Throws std::runtime_error when none can be made.
[[nodiscard]] File scratch_file();

/// A program that runs beside this one, without a shell. It has its own process group, so that
/// ctrl-C does not end it directly. It reads `in` and writes into temporary files. The destructor
/// kills a program that still runs.
class Child {
 public:
  /// arguments[0] is looked up in PATH; `missing` is the message if it is not there. Throws
  /// std::runtime_error when the program cannot be started.
  Child(std::vector<std::string> arguments, int in, const std::string& missing);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool runs();
  /// Waits until the program ends, and returns its standard output. Throws std::runtime_error with
  /// the program's error messages when it failed.
  [[nodiscard]] std::string output();

 private:
  [[noreturn]] void fail(const std::string& what, int error) const;
  void collect(int options);  // takes the exit status of an ended program

  std::string name_;
  File out_, errors_;
  pid_t id_ = 0;  // 0: ended
  int status_ = 0;
};

}  // namespace gatewalk::cli
