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

constexpr std::string_view kBefore = "Next: ";  // in front of a line

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

}  // namespace

NextCommands& NextCommands::add(const std::string& command, const std::string& more,
                                const std::string& why) {
  std::string line = "gatewalk " + command;
  for (const std::string& word : options_.words().shaping) {
    const std::string_view option = option_of(word);
    if (option.empty() || std::ranges::count(kOfScene, option) > 0) line += " " + written(word);
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
  const std::string option = "--" + name + " " + value;
  line += " " + option;
  if (kBefore.size() + line.size() > kScreenColumns)
    lines_.push_back(option + " " + why);
  else
    put(line, why);
  return *this;
}

NextCommands& NextCommands::run(const std::string& words, const std::string& why) {
  put("gatewalk " + words, why);
  return *this;
}

void NextCommands::put(const std::string& command, const std::string& why) {
  if (std::ranges::count(options_.words().shaping, "-") > 0) return;
  if (kBefore.size() + command.size() > kScreenColumns) return;
  const std::string line = command + "  # " + why;
  lines_.push_back(kBefore.size() + line.size() > kScreenColumns ? command : line);
}

}  // namespace gatewalk::cli
