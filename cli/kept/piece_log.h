// SPDX-License-Identifier: MIT
#pragma once
/// Finished pieces of a command's work in a file that only grows, so that a run that dies while
/// writing leaves all earlier pieces whole.

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// A piece in a file.
struct PieceRecord {
  std::uint32_t stage = 0;  // number of the stage, from 1
  dynamics::TrialRange items;
  std::uint64_t at = 0, bytes = 0;  // position and size of the bytes, after the record's head
  std::uint32_t check = 0;          // CRC-32 of the bytes
};
/// Whether the record, which has no items, is the name of a stage; the stage's pieces follow it.
/// The record of kEndStage ends the file.
[[nodiscard]] inline bool is_name(const PieceRecord& r) { return r.items.count == 0; }
inline constexpr std::uint32_t kEndStage = 0xffffffff;

/// The command as JSON: the second line of a file of pieces. Throws markov::BadFile.
[[nodiscard]] std::string piece_head(const std::string& path);

/// A file of pieces as it was found. If the file is still being written or was cut short, its whole
/// records only.
class PieceFile {
 public:
  /// Reads the records, not their bytes. Throws markov::BadFile if the file holds no pieces.
  explicit PieceFile(const std::string& path);
  [[nodiscard]] static bool is_one(const std::string& path);
  /// Whether a file that begins with `bytes` holds pieces.
  [[nodiscard]] static bool begins(std::string_view bytes);

  [[nodiscard]] const std::string& path() const { return path_; }
  /// The command as JSON, as piece_head gives it.
  [[nodiscard]] const std::string& head() const { return head_; }
  [[nodiscard]] const std::vector<PieceRecord>& records() const { return records_; }
  /// Position after the last whole record.
  [[nodiscard]] std::uint64_t end() const { return end_; }
  /// Whether the file holds all pieces that its run was to do.
  [[nodiscard]] bool is_finished() const;
  /// Throws markov::BadFile if the bytes are not those that were written.
  [[nodiscard]] std::string bytes_of(const PieceRecord& record) const;

 private:
  void read_records(std::istream& in);

  std::string path_, head_;
  std::vector<PieceRecord> records_;
  std::uint64_t end_ = 0;
};

/// Appends to a file of pieces, which it locks. Each record goes to the system at once and to the
/// disk within a second while records come, and at the end.
class PieceWriter {
 public:
  /// Makes a new file. Throws std::runtime_error if it cannot be written, or if another process is
  /// writing it.
  PieceWriter(const std::string& path, std::string_view head);
  /// Continues after the last whole record, and cuts off what follows.
  explicit PieceWriter(const PieceFile& file);
  ~PieceWriter();
  PieceWriter(const PieceWriter&) = delete;
  PieceWriter& operator=(const PieceWriter&) = delete;

  void add(std::uint32_t stage, dynamics::TrialRange items, std::string_view bytes);
  void sync();
  /// Whether the path still names this file, and not one that another run put there.
  [[nodiscard]] bool is_at_its_path() const;

 private:
  void open();

  std::string path_;
  int file_ = -1;
  bool is_synced_ = true;
  dynamics::Stopwatch since_sync_;
};

}  // namespace gatewalk::cli
