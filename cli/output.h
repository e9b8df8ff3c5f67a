#pragma once
/// Writing results so that a reader never sees half of one.

#include <string>
#include <string_view>

namespace gatewalk::cli {

/// Replaces `path` with `text`, or leaves it as it was: a temporary file beside it is written,
/// synced and renamed, then the directory is synced. An existing target must be a writable regular
/// file (no link, no device) and keeps its permissions. "-" is standard output.
/// Throws std::runtime_error naming the file and the reason; no temporary file stays behind.
void write_text_atomically(const std::string& path, std::string_view text);

/// Throws std::runtime_error, as write_text_atomically would, when `path` cannot be written to: to be
/// asked before long work, not after it.
void require_writable(const std::string& path);

}  // namespace gatewalk::cli
