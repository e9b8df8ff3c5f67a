// SPDX-License-Identifier: MIT
#pragma once
/// Files inside the program, so that it works from anywhere: the pages of cli/web, the scenes.

#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// An embedded file, byte for byte: "report.js", "scenes/fig8.toml". Throws std::logic_error for an
/// unknown name.
[[nodiscard]] std::string_view carried_file(std::string_view name);

/// The names of all embedded files, in alphabetical order.
[[nodiscard]] std::vector<std::string> carried_files();

/// Whether the pages are embedded. Programs built with GATEWALK_PAGES=OFF have the scenes only.
[[nodiscard]] bool has_pages();

}  // namespace gatewalk::cli
