#pragma once
/// Every command as a function (commands.def); its arguments are the words behind its name, what it
/// returns is the exit status.

#include <string_view>

#include "cli/command.h"

namespace gatewalk::cli {

#define COMMAND(name, run, summary) int run(const Arguments& arguments);
#include "cli/commands.def"
#undef COMMAND

struct Command {
  const char *name, *summary;
  int (*run)(const Arguments& arguments);
};
inline constexpr Command kCommands[] = {
#define COMMAND(name, run, summary) {name, summary, run},
#include "cli/commands.def"
#undef COMMAND
};
/// The command of that name, if there is one.
[[nodiscard]] inline const Command* command_named(std::string_view name) {
  for (const Command& c : kCommands)
    if (name == c.name) return &c;
  return nullptr;
}

}  // namespace gatewalk::cli
