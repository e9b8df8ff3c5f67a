// SPDX-License-Identifier: MIT
#pragma once
/// What is wrong with a text that is no TOML, in the words of a scene file.

#include <cstddef>
#include <string>
#include <string_view>

namespace gatewalk::lattice {

/// Row `line` (from 1) of `text`, for a message.
[[nodiscard]] std::string text_row(std::string_view text, std::size_t line);

/// Why `text` cannot be read, if the parser stopped in `line`, and what is allowed there: "a number
/// has a decimal point, as in 0.25".
[[nodiscard]] std::string toml_mistake(std::string_view text, std::size_t line);

}  // namespace gatewalk::lattice
