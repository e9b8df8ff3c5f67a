// SPDX-License-Identifier: MIT
#pragma once
/// The lines of a text file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::lattice {

/// Reads the lines of a file one by one, in blocks. Lines end in LF or CRLF, or in CR alone if the
/// file begins so; a UTF-8 byte-order mark is skipped. All members throw std::invalid_argument
/// naming the file if it cannot be read, or if its first bytes show that it is not UTF-8 text
/// (UTF-16, .xlsx, gzip, XML, HDF5, ...).
class Lines {
 public:
  /// `path`: "-" is standard input. Reading throws for a line longer than `most_bytes`.
  explicit Lines(const std::string& path, std::size_t most_bytes = kMostBytes);
  ~Lines();
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  static constexpr std::size_t kMostBytes = 1 << 20;

  /// The next line, without its end; valid until the next call. Returns false after the last line.
  [[nodiscard]] bool next(std::string_view& line);
  /// Number of the current line, from 1.
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool end_in_cr() const { return end_ == '\r'; }
  /// Size of a regular file in bytes; else 0.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }
  /// Bytes of the lines returned so far.
  [[nodiscard]] std::int64_t bytes_read() const {
    return read_ - static_cast<std::int64_t>(rest());
  }

 private:
  [[nodiscard]] const char* at() const { return buffer_.data() + begin_; }
  [[nodiscard]] std::size_t rest() const { return filled_ - begin_; }
  [[noreturn]] void fail() const;
  bool fill();
  void begin_text();

  std::string name_;
  int file_ = -1;
  std::size_t most_bytes_;
  std::int64_t bytes_ = 0, read_ = 0, number_ = 0;
  char end_ = '\n';
  std::vector<char> buffer_;
  std::size_t begin_ = 0, filled_ = 0;  // of the unread part of buffer_
};

/// What a file is by its first bytes, and how to get UTF-8 text from it: "is packed by gzip: unpack
/// it (gunzip)". Empty if it may be UTF-8 text.
[[nodiscard]] std::string no_text(std::string_view first_bytes);

/// Throws std::invalid_argument if two paths name the same file.
void require_different(const std::vector<std::string>& paths);

/// All lines of a file, of any length. Throws as Lines.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& path);

}  // namespace gatewalk::lattice
