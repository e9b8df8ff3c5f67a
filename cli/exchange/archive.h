// SPDX-License-Identifier: MIT
#pragma once
/// Packs files into an archive and unpacks them, with libarchive.

#include <cstddef>
#include <string>
#include <vector>

namespace gatewalk::cli {

struct PackedFile {
  std::string name, bytes;
};

enum class Packing { tar, zip };  // ustar; zip without compression
/// Packs files. The same files give the same bytes, because owners and times are left out. Throws
/// std::runtime_error.
[[nodiscard]] std::string pack(Packing how, const std::vector<PackedFile>& files);

/// The files in a zip archive. Throws std::runtime_error naming `path` if the file is no zip
/// archive or holds more than `most_bytes` in all.
[[nodiscard]] std::vector<PackedFile> unpack(const std::string& path, std::size_t most_bytes);

}  // namespace gatewalk::cli
