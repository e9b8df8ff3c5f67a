// SPDX-License-Identifier: MIT
#pragma once
/// Files that the program carries inside, so that it works from anywhere: cli/web's pages, the
/// scenes.

#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// A carried file, byte for byte: "report.js", "scenes/fig8.toml". Throws
/// std::logic_error for a name that is not carried.
[[nodiscard]] std::string_view carried_file(std::string_view name);

/// The names of all, in the order of the alphabet.
[[nodiscard]] std::vector<std::string> carried_files();

/// False of a program built with GATEWALK_PAGES=OFF: it carries only the scenes.
[[nodiscard]] bool has_pages();

}  // namespace gatewalk::cli
