// SPDX-License-Identifier: MIT
#pragma once
/// Manual pages, shell completion, and descriptions of results and scenes, generated from the
/// commands themselves.

#include <string>

namespace gatewalk::cli {

/// Writes into `share` the files that packages install: man/man1/gatewalk*.1, completions for bash,
/// zsh and fish, the schemas of results (gatewalk/schemas), and tables of the keys of results and
/// of scenes (doc/gatewalk/results.md and scene.md). Pages carry the date of SOURCE_DATE_EPOCH, or
/// today's. Throws std::runtime_error.
void write_help(const std::string& share);

}  // namespace gatewalk::cli
