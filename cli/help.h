// SPDX-License-Identifier: MIT
#pragma once
/// Manual pages, completion for shells and the description of results, of what commands say of
/// themselves.

#include <string>

namespace gatewalk::cli {

/// Writes into `share`, as packages install them: man/man1/gatewalk*.1, completions for bash, zsh
/// and fish, the schemas of results (gatewalk/schemas), and tables of the keys of results and of
/// scenes (doc/gatewalk/results.md and scene.md). Pages are of the day that SOURCE_DATE_EPOCH says,
/// else of today.
/// Throws std::runtime_error.
void write_help(const std::string& share);

}  // namespace gatewalk::cli
