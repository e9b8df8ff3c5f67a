// SPDX-License-Identifier: MIT
#pragma once
/// Files packed into one, by libarchive.

#include <cstddef>
#include <string>
#include <vector>

namespace gatewalk::cli {

struct PackedFile {
  std::string name, bytes;
};

enum class Packing { tar, zip };  // ustar; zip without compression
/// The same files, the same bytes: they have no owner and no time. Throws std::runtime_error.
[[nodiscard]] std::string pack(Packing how, const std::vector<PackedFile>& files);

/// The files in a zip. Throws std::runtime_error naming `path` for anything else, and for more than
/// `most_bytes` in all.
[[nodiscard]] std::vector<PackedFile> unpack(const std::string& path, std::size_t most_bytes);

}  // namespace gatewalk::cli
