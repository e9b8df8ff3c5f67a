#pragma once
/// Every command as a function (commands.def); its arguments are the words behind its name, what it
/// returns is the exit status.

#include "cli/command.h"

namespace gatewalk::cli {

#define COMMAND(name, run, summary) int run(const Arguments& arguments);
#include "cli/commands.def"
#undef COMMAND

}  // namespace gatewalk::cli
