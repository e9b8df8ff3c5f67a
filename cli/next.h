// SPDX-License-Identifier: MIT
#pragma once
/// Commands that a screen proposes to run next.

#include <string>
#include <vector>

#include "cli/command.h"

namespace gatewalk::cli {

/// Collects lines for Screen::next, each a command as a shell reads it with a comment behind it:
/// "gatewalk predict walker.toml --accuracy 0.01  # halves the intervals". The comment is left out
/// where it would make the line too long, and so is a command that is too long itself. A scene that
/// came on standard input is gone: then there are no lines.
class NextCommands {
 public:
  explicit NextCommands(const Options& options) : options_(options) {}

  /// Another command on the same scene or matrix: the files, --set, --start and --cell-program are
  /// those of this command, so the other command must know those that are given; `more` follows
  /// them.
  NextCommands& add(const std::string& command, const std::string& more, const std::string& why);
  /// The same command once more with the option --`name` set to `value`; the option alone, "--name
  /// value why", where the command would make the line too long.
  NextCommands& again(const std::string& name, const std::string& value, const std::string& why);

  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  const Options& options_;
  std::vector<std::string> lines_{};

  void put(const std::string& command, const std::string& why);
};

}  // namespace gatewalk::cli
