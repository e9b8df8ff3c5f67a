// SPDX-License-Identifier: MIT
#pragma once
/// Finished pieces of a command's work in a file that only grows: whoever dies while writing leaves
/// all that was written before.

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// A piece in a file.
struct PieceRecord {
  std::uint32_t stage = 0;  // of the command, from 1
  dynamics::TrialRange items;
  std::uint64_t at = 0, bytes = 0;  // where it stands, behind its own head
  std::uint32_t check = 0;          // CRC-32 of the bytes
};
/// Pieces without items: the name of a stage, which its pieces follow; the end of all.
[[nodiscard]] inline bool is_name(const PieceRecord& r) { return r.items.count == 0; }
inline constexpr std::uint32_t kEndStage = 0xffffffff;

/// What the command was, as JSON: the second line of a file of pieces. Throws markov::BadFile.
[[nodiscard]] std::string piece_head(const std::string& path);

/// A file of pieces as it was found. Of one that is still written to, or was cut short, what is
/// whole.
class PieceFile {
 public:
  /// Reads the records, not their bytes. Throws markov::BadFile when it is no file of pieces.
  explicit PieceFile(const std::string& path);
  [[nodiscard]] static bool is_one(const std::string& path);
  /// Whether a file that begins so is one.
  [[nodiscard]] static bool begins(std::string_view bytes);

  [[nodiscard]] const std::string& path() const { return path_; }
  /// As piece_head.
  [[nodiscard]] const std::string& head() const { return head_; }
  [[nodiscard]] const std::vector<PieceRecord>& records() const { return records_; }
  /// Behind the last whole record.
  [[nodiscard]] std::uint64_t end() const { return end_; }
  /// All pieces that were to be done are there.
  [[nodiscard]] bool is_finished() const;
  /// Throws markov::BadFile when the bytes are not what was written.
  [[nodiscard]] std::string bytes_of(const PieceRecord& record) const;

 private:
  void read_records(std::istream& in);

  std::string path_, head_;
  std::vector<PieceRecord> records_;
  std::uint64_t end_ = 0;
};

/// Appends to a file of pieces, which nobody else does meanwhile. Bytes are with the system at
/// once, and on the disk after a second at most, and at the end.
class PieceWriter {
 public:
  /// A new file. Throws std::runtime_error when it cannot be written, and where one is there that
  /// somebody writes.
  PieceWriter(const std::string& path, std::string_view head);
  /// Goes on behind the last whole record; what follows is cut off.
  explicit PieceWriter(const PieceFile& file);
  ~PieceWriter();
  PieceWriter(const PieceWriter&) = delete;
  PieceWriter& operator=(const PieceWriter&) = delete;

  void add(std::uint32_t stage, dynamics::TrialRange items, std::string_view bytes);
  void sync();
  /// Nobody has put another file there.
  [[nodiscard]] bool is_at_its_path() const;

 private:
  void open();

  std::string path_;
  int file_ = -1;
  bool is_synced_ = true;
  dynamics::Stopwatch since_sync_;
};

}  // namespace gatewalk::cli
