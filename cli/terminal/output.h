// SPDX-License-Identifier: MIT
#pragma once
/// Writing results so that a reader never sees half of one.

#include <string>
#include <string_view>

namespace gatewalk::cli {

/// Replaces `path` with `text`, or leaves it as it was (markov/formats/file.h). "-" is standard
/// output. A pipe whose reader went away takes no more text, which is no error (`| head -1`).
/// Throws std::runtime_error naming the file and the reason; no temporary file stays behind.
void write_text_atomically(const std::string& path, std::string_view text);

/// Whether the reader of a pipe went away while text was written to it.
[[nodiscard]] bool reader_went_away();

/// Throws std::runtime_error, as write_text_atomically would, when `path` cannot be written to: to
/// be asked before long work, not after it.
void require_writable(const std::string& path);

/// Throws std::runtime_error when `name` is no folder that files can be made in, and could not be
/// made one. Makes none.
void require_possible_folder(const std::string& name);

/// The folder for a command's files, made if need be. Throws std::runtime_error when `name` is no
/// folder that can be written to.
void require_folder(const std::string& name);

}  // namespace gatewalk::cli
