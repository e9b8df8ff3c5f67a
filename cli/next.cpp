// SPDX-License-Identifier: MIT
#include "cli/next.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "cli/fields/text.h"

namespace gatewalk::cli {
namespace {

/// Options that belong to the scene, so that a proposed command takes them over.
constexpr std::array<std::string_view, 4> kOfScene{"set", "start", "cell-program", "cell-timeout"};

/// The columns that a line has behind "Next: ".
constexpr std::size_t kColumns = kScreenColumns - 6;

/// "force" of "--force" and of "--force=2"; empty for a file.
std::string_view option_of(std::string_view word) {
  if (!word.starts_with("--")) return {};
  word.remove_prefix(2);
  return word.substr(0, word.find('='));
}

/// The option as a person writes it: "--set forces.random_N=2", but with = where the value looks
/// like an option.
std::string written(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (option_of(word).empty() || equals == word.npos) return shell_quoted(word);
  const std::string value = word.substr(equals + 1);
  const char* const between = value.starts_with('-') ? "=" : " ";
  return word.substr(0, equals) + between + shell_quoted(value);
}

/// The words of a shell command, each option with its value: "--set a=1".
std::vector<std::string> parts_of(const std::string& command) {
  std::vector<std::string> parts(1);
  bool quoted = false;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (!quoted && std::string_view(command).substr(i).starts_with(" --")) {
      parts.emplace_back();
      continue;
    }
    if (command[i] == '\'') quoted = !quoted;
    parts.back() += command[i];
    if (command[i] == '\\' && !quoted) parts.back() += command[++i];  // \' of shell_quoted()
  }
  return parts;
}

/// The command and its comment in as few lines as fit the screen. A line that goes on ends with a
/// backslash. A part that is longer than a line stays whole, and then has no comment.
std::string in_lines(const std::string& command, const std::string& comment) {
  const std::vector<std::string> parts = parts_of(command);
  std::string text, line;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string behind = k + 1 == parts.size() ? comment : " \\";
    if (k > 0 && line.size() + 1 + parts[k].size() + behind.size() > kColumns) {
      text += line + " \\\n";
      line = "   ";
    }
    line += (k > 0 ? " " : "") + parts[k];
  }
  return text + line + (line.size() + comment.size() <= kColumns ? comment : "");
}

}  // namespace

NextCommands& NextCommands::add(const std::string& command, const std::string& more,
                                const std::string& why) {
  std::string line = "gatewalk " + command;
  for (const std::string& word : options_.words().shaping) {
    const std::string_view option = option_of(word);
    if (option.empty() || std::ranges::count(kOfScene, option) > 0 ||
        std::ranges::count(kept_, option) > 0)
      line += " " + written(word);
  }
  put(line + (more.empty() ? "" : " " + more), why);
  return *this;
}

NextCommands& NextCommands::of(const std::string& file, const std::string& command,
                               const std::string& why) {
  std::string line = "gatewalk " + command + " " + shell_quoted(file);
  for (const std::string& word : options_.words().shaping)
    if (std::ranges::count(kOfScene, option_of(word)) > 0) line += " " + written(word);
  put(line, why);
  return *this;
}

NextCommands& NextCommands::again(const std::string& name, const std::string& value,
                                  const std::string& why) {
  const auto is_same = [&](const std::string& word) { return option_of(word) == name; };
  if (std::ranges::any_of(options_.words().outputs, is_same)) return *this;  // it is written now
  std::string line = "gatewalk " + options_.words().command;
  for (const std::string& word : options_.words().shaping)
    if (!is_same(word)) line += " " + written(word);
  put(line + " --" + name + " " + value, why);
  return *this;
}

NextCommands& NextCommands::run(const std::string& words, const std::string& why) {
  put("gatewalk " + words, why);
  return *this;
}

void NextCommands::put(const std::string& command, const std::string& why) {
  if (std::ranges::count(options_.words().shaping, "-") > 0) return;
  lines_.push_back(in_lines(command, "  # " + why));
}

}  // namespace gatewalk::cli
