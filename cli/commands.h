// SPDX-License-Identifier: MIT
#pragma once
/// Every command as a function (commands.def). Its arguments are the words after the command's
/// name; it returns the exit status.

#include <iterator>
#include <string_view>
#include <vector>

#include "cli/command.h"

namespace gatewalk::cli {

#define GROUP(name)
#define COMMAND(name, run, summary) int run(const Arguments& arguments);
#include "cli/commands.def"
#undef COMMAND
#undef GROUP

/// A command, whose name has one word or two (chart field). Without a function: the heading of the
/// group of commands that follows.
struct Command {
  const char *name, *summary;
  int (*run)(const Arguments& arguments);
};
inline constexpr Command kCommandsAndGroups[] = {
#define GROUP(name) {name, "", nullptr},
#define COMMAND(name, run, summary) {name, summary, run},
#include "cli/commands.def"
#undef COMMAND
#undef GROUP
};
[[nodiscard]] inline std::vector<Command> commands() {
  std::vector<Command> all(std::begin(kCommandsAndGroups), std::end(kCommandsAndGroups));
  std::erase_if(all, [](const Command& c) { return !c.run; });
  return all;
}
/// The command of that name; null if there is none.
[[nodiscard]] inline const Command* command_named(std::string_view name) {
  for (const Command& c : kCommandsAndGroups)
    if (c.run && name == c.name) return &c;
  return nullptr;
}

}  // namespace gatewalk::cli
