// SPDX-License-Identifier: MIT
#include "cli/exchange/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/core.h>

#include <memory>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

void check(struct archive* archive, int rc, const std::string& what) {
  if (rc == ARCHIVE_OK) return;
  const char* reason = archive_error_string(archive);
  throw std::runtime_error(what + ": " + (reason ? reason : "unknown error"));
}

using Archive = std::unique_ptr<struct archive, int (*)(struct archive*)>;

la_ssize_t append(struct archive*, void* to, const void* bytes, std::size_t count) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), count);
  return static_cast<la_ssize_t>(count);
}

}  // namespace

std::string pack(Packing how, const std::vector<PackedFile>& files) {
  const Archive archive(archive_write_new(), archive_write_free);
  if (!archive) throw std::bad_alloc();
  const auto ok = [&](int rc) { check(archive.get(), rc, "cannot pack"); };
  if (how == Packing::tar) {
    ok(archive_write_set_format_ustar(archive.get()));
  } else {
    ok(archive_write_set_format_zip(archive.get()));
    ok(archive_write_zip_set_compression_store(archive.get()));
  }
  std::string packed;
  ok(archive_write_set_bytes_per_block(archive.get(), 0));
  ok(archive_write_open(archive.get(), &packed, nullptr, append, nullptr));
  const std::unique_ptr<struct archive_entry, void (*)(struct archive_entry*)> entry(
      archive_entry_new(), archive_entry_free);
  if (!entry) throw std::bad_alloc();
  for (const PackedFile& file : files) {
    archive_entry_clear(entry.get());
    archive_entry_set_pathname(entry.get(), file.name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(file.bytes.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    archive_entry_set_mtime(entry.get(), 0, 0);
    ok(archive_write_header(archive.get(), entry.get()));
    if (archive_write_data(archive.get(), file.bytes.data(), file.bytes.size()) !=
        static_cast<la_ssize_t>(file.bytes.size()))
      ok(ARCHIVE_FATAL);
  }
  ok(archive_write_close(archive.get()));
  return packed;
}

std::vector<PackedFile> unpack(const std::string& path, std::size_t most_bytes) {
  const Archive archive(archive_read_new(), archive_read_free);
  if (!archive) throw std::bad_alloc();
  constexpr std::size_t kBlock = 1 << 16;
  check(archive.get(), archive_read_support_format_zip(archive.get()), path);
  check(archive.get(), archive_read_open_filename(archive.get(), path.c_str(), kBlock), path);
  std::vector<PackedFile> files;
  std::size_t bytes = 0;
  struct archive_entry* entry = nullptr;
  for (int rc = 0; (rc = archive_read_next_header(archive.get(), &entry)) != ARCHIVE_EOF;) {
    check(archive.get(), rc, path);
    const char* const name = archive_entry_pathname(entry);
    PackedFile& file = files.emplace_back(PackedFile{name ? name : "", ""});
    std::vector<char> block(kBlock);
    for (la_ssize_t got = 0;
         (got = archive_read_data(archive.get(), block.data(), block.size())) != 0;) {
      if (got < 0) check(archive.get(), static_cast<int>(got), path);
      bytes += static_cast<std::size_t>(got);
      if (bytes > most_bytes)
        throw std::runtime_error(fmt::format("{}: holds more than {} bytes", path, most_bytes));
      file.bytes.append(block.data(), static_cast<std::size_t>(got));
    }
  }
  return files;
}

}  // namespace gatewalk::cli
