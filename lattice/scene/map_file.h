// SPDX-License-Identifier: MIT
#pragma once
/// What a scene reads beside itself.

#include <string>
#include <string_view>

namespace gatewalk::lattice {

/// The file that the text of a scene, or an override, names in terrain.map_file: its path, which
/// starts from `folder`. Empty when it names none, and for text that is no TOML.
[[nodiscard]] std::string map_file_in(std::string_view text, const std::string& folder);

}  // namespace gatewalk::lattice
