// SPDX-License-Identifier: MIT
#pragma once
/// Commands that a screen proposes to run next.

#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"

namespace gatewalk::cli {

/// Collects lines for Screen::next. Each line is a shell command followed by a comment: "gatewalk
/// predict walker.toml --accuracy 0.01  # halves the intervals". A command that is too long for
/// the screen goes on in further lines, after a backslash as a shell takes it. If the scene came
/// on standard input, another command cannot read it again, so there are no lines.
class NextCommands {
 public:
  explicit NextCommands(const Options& options) : options_(options) {}

  /// Says that add() takes over these options too: options that the other command has with the
  /// same meaning, so that both give the same prediction.
  NextCommands& keeping(std::vector<std::string> options) {
    kept_ = std::move(options);
    return *this;
  }

  /// Proposes another command on the same scene or matrix. The files, --set, --start and
  /// --cell-program are those of this command, so the other command must have these options too;
  /// `more` follows them.
  NextCommands& add(const std::string& command, const std::string& more, const std::string& why);
  /// Proposes the same command again with the option --`name` set to `value`.
  NextCommands& again(const std::string& name, const std::string& value, const std::string& why);

  /// Proposes another command on `file`, with --set and --start of this command.
  NextCommands& of(const std::string& file, const std::string& command, const std::string& why);
  /// Proposes a command by all its words behind "gatewalk".
  NextCommands& run(const std::string& words, const std::string& why);

  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  const Options& options_;
  std::vector<std::string> kept_{}, lines_{};

  void put(const std::string& command, const std::string& why);
};

}  // namespace gatewalk::cli
