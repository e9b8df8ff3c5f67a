// SPDX-License-Identifier: MIT
#pragma once
/// Other programs that work for this one: gnuplot, ffmpeg.

#include <sys/types.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gatewalk::cli {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file without a name, in memory: nothing to clean up, and unlike a pipe it never blocks or
/// breaks. Throws std::runtime_error when there can be none.
[[nodiscard]] File scratch_file();

/// A program that runs beside this one, without a shell and in a process group of its own, so that
/// ctrl-C ends it only through us. It reads `in`; what it writes and what it complains of go to
/// files without names. One that still runs at the end of the object's life is killed.
class Child {
 public:
  /// arguments[0] is looked up in PATH; `missing` is what to say when it is not there. Throws
  /// std::runtime_error when it cannot be started.
  Child(std::vector<std::string> arguments, int in, const std::string& missing);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool runs();
  /// Waits for its end: what it has written to standard output. Throws std::runtime_error with its
  /// own words when it failed.
  [[nodiscard]] std::string output();

 private:
  [[noreturn]] void fail(const std::string& what, int error) const;
  void collect(int options);  // its status, if it has ended

  std::string name_;
  File out_, errors_;
  pid_t id_ = 0;  // 0: ended
  int status_ = 0;
};

}  // namespace gatewalk::cli
