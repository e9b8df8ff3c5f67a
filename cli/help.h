// SPDX-License-Identifier: MIT
#pragma once
/// Manual pages and completion for shells, of the commands' own help.

#include <string>

namespace gatewalk::cli {

/// Writes into `share`, as packages install them: man/man1/gatewalk*.1, completions for bash, zsh
/// and fish. Pages are of the day that SOURCE_DATE_EPOCH says, else of today. Throws
/// std::runtime_error.
void write_help(const std::string& share);

}  // namespace gatewalk::cli
