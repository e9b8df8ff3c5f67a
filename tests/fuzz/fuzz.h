// SPDX-License-Identifier: MIT
#pragma once
/// Targets: each hands bytes to a reader, as a file of somebody else's would. A reader may refuse
/// them, by the errors that it documents and with a message; of what it accepts a property is held
/// against a second route. Everything else ends the process.

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gatewalk::fuzz {

/// Whether the exception is one that readers document: std::invalid_argument, std::runtime_error
/// or one of the project's own, and none of their kin such as std::system_error; and whether its
/// message says something, without bytes that a terminal would obey.
[[nodiscard]] bool is_refusal(const std::exception& error);

/// What `read()` returns; none where it refuses. Other exceptions are passed on.
template <class Read>
auto accepted(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const std::exception& error) {
    if (!is_refusal(error)) throw;
    return {};
  }
}

/// Ends the process, naming `what`, unless it holds.
void require(bool holds, const char* what);

/// A file with these bytes, its name ending in `ending`; good until the next one of that ending.
[[nodiscard]] std::string file_of(std::string_view bytes, const std::string& ending);
/// What a file holds.
[[nodiscard]] std::string bytes_of(const std::string& path);

/// The first of the parts that lines "---" separate, and the rest.
[[nodiscard]] std::pair<std::string_view, std::string_view> parted(std::string_view bytes);
/// A line without its end, taken off the front of `bytes`.
[[nodiscard]] std::string_view take_line(std::string_view& bytes);

/// The targets, by name.
#define GATEWALK_FUZZ_TARGET(name) void name(std::string_view bytes);
#include "tests/fuzz/targets.def"
#undef GATEWALK_FUZZ_TARGET

}  // namespace gatewalk::fuzz
