// SPDX-License-Identifier: MIT
#pragma once
/// Writes results so that a reader never sees half a file.

#include <string>
#include <string_view>

namespace gatewalk::cli {

/// Replaces `path` with `text`, or leaves it as it was (markov/formats/file.h). "-" is standard
/// output. A pipe whose reader went away takes no more text, which is no error (`| head -1`).
/// Throws std::runtime_error naming the file and the reason; no temporary file stays behind.
void write_text_atomically(const std::string& path, std::string_view text);

/// Whether the reader of a pipe went away while text was written to it.
[[nodiscard]] bool reader_went_away();

/// Throws std::runtime_error, as write_text_atomically would, when `path` cannot be written. To be
/// called before long work.
void require_writable(const std::string& path);

/// Throws std::runtime_error when `name` is neither a folder that files can be written into nor the
/// name of a folder that could be made. Makes none.
void require_possible_folder(const std::string& name);

/// Makes the folder `name` for a command's files if there is none. Throws std::runtime_error when
/// files cannot be written into it.
void require_folder(const std::string& name);

}  // namespace gatewalk::cli
