// SPDX-License-Identifier: MIT
#pragma once
/// Fuzz targets. Each hands bytes to a reader, as a file from elsewhere would. A reader may refuse
/// them, by an exception that it documents, with a message. For accepted bytes a property is
/// checked in a second way. Everything else ends the process.

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gatewalk::fuzz {

/// Whether readers document the exception: exactly std::invalid_argument, std::runtime_error or one
/// of the project's own classes, not a class derived from these such as std::system_error. The
/// message must not be empty and must not contain control characters.
[[nodiscard]] bool is_refusal(const std::exception& error);

/// The result of `read()`; nullopt if it refuses. Passes on other exceptions.
template <class Read>
auto accepted(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const std::exception& error) {
    if (!is_refusal(error)) throw;
    return {};
  }
}

/// Ends the process, naming `what`, unless `holds`.
void require(bool holds, const char* what);

/// Writes a file with these bytes, whose name ends in `ending`; valid until the next call with this
/// ending.
[[nodiscard]] std::string file_of(std::string_view bytes, const std::string& ending);
/// The bytes of a file.
[[nodiscard]] std::string bytes_of(const std::string& path);

/// The part before the first line "---", and the rest.
[[nodiscard]] std::pair<std::string_view, std::string_view> parted(std::string_view bytes);
/// Takes the first line off `bytes`, and returns it without its end.
[[nodiscard]] std::string_view take_line(std::string_view& bytes);

/// The targets, by name.
#define GATEWALK_FUZZ_TARGET(name) void name(std::string_view bytes);
#include "tests/fuzz/targets.def"
#undef GATEWALK_FUZZ_TARGET

}  // namespace gatewalk::fuzz
