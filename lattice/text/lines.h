// SPDX-License-Identifier: MIT
#pragma once
/// The lines of a text file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::lattice {

/// Hands out the lines of a file one by one, reading it in blocks. Lines end in LF or CRLF, or in
/// CR alone where the file begins so. A byte-order mark of UTF-8 is left out. All members throw
/// std::invalid_argument naming the file where it cannot be read, and where its first bytes show
/// that it is no text in UTF-8 (UTF-16, .xlsx, gzip, XML, HDF5, ...).
class Lines {
 public:
  /// `path`: "-" is standard input. Longer lines than `most_bytes` are refused.
  explicit Lines(const std::string& path, std::size_t most_bytes = kMostBytes);
  ~Lines();
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  static constexpr std::size_t kMostBytes = 1 << 20;

  /// Without its end; valid until the next call. False: there is none.
  [[nodiscard]] bool next(std::string_view& line);
  [[nodiscard]] std::int64_t number() const { return number_; }  // of that line, from 1
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool end_in_cr() const { return end_ == '\r'; }
  /// Of a regular file; else 0.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }
  /// Of the lines handed out so far.
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
  std::size_t begin_ = 0, filled_ = 0;  // of what is left in it
};

/// What a file is, by its first bytes, and what to do to get text in UTF-8 of it: "is packed by
/// gzip: unpack it (gunzip)". Empty: it may be such text.
[[nodiscard]] std::string no_text(std::string_view first_bytes);

/// Throws std::invalid_argument where two paths are of one file.
void require_different(const std::vector<std::string>& paths);

/// All lines of a file, however long. Throws as Lines.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& path);

}  // namespace gatewalk::lattice
