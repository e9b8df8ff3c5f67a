// SPDX-License-Identifier: MIT
#include "lattice/text/lines.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kBlock = 1 << 20;  // bytes read at once
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct FileKind {
  std::string_view first, words;
};
using namespace std::string_view_literals;  // some signatures contain zero bytes
constexpr std::array<FileKind, 19> kKinds{{
    {"\xFF\xFE"sv, "is text in UTF-16: save it as UTF-8 (Excel: CSV UTF-8)"},
    {"\xFE\xFF"sv, "is text in UTF-16: save it as UTF-8 (Excel: CSV UTF-8)"},
    {"PK\x03\x04"sv, "is packed by zip, as .xlsx, .ods and .npz are: save the sheet as CSV"},
    {"\xD0\xCF\x11\xE0"sv, "is an old file of Excel (.xls): save the sheet as CSV"},
    {"\x1F\x8B"sv, "is packed by gzip: unpack it (gunzip)"},
    {"BZh"sv, "is packed by bzip2: unpack it (bunzip2)"},
    {"\xFD"
     "7zXZ"sv,
     "is packed by xz: unpack it (unxz)"},
    {"\x28\xB5\x2F\xFD"sv, "is packed by zstd: unpack it (unzstd)"},
    {"\x89HDF"sv, "is HDF5 or NetCDF, no text: export a table (CSV) of it"},
    {"CDF\x01"sv, "is NetCDF, no text: export a table (CSV) of it"},
    {"CDF\x02"sv, "is NetCDF, no text: export a table (CSV) of it"},
    {"CDF\x05"sv, "is NetCDF, no text: export a table (CSV) of it"},
    {"\x93NUMPY"sv, "is an array of numpy: write it with numpy.savetxt"},
    {"MATLAB 5.0 MAT-file"sv, "is a file of MATLAB: write the table with writetable(T, \"x.csv\")"},
    {"PAR1"sv, "is Parquet: write it with DataFrame.to_csv(\"x.csv\", index=False)"},
    {"ARROW1"sv, "is Arrow: write it with DataFrame.to_csv(\"x.csv\", index=False)"},
    {"SQLite format 3"sv, "is a data base of SQLite: export a table (CSV) of it"},
    {"%PDF"sv, "is a PDF: export a table (CSV) where it was made"},
    {"{"sv, "is JSON: export a table (CSV) of it"},
}};

}  // namespace

std::string no_text(std::string_view first) {
  const bool is_binary = std::any_of(first.begin(), first.end(),
                                     [](char c) { return static_cast<unsigned char>(c) < '\t'; });
  for (const FileKind& kind : kKinds) {
    // A column may have such a name.
    const bool is_word = kind.first == "PAR1" || kind.first == "ARROW1" || kind.first == "BZh";
    if (first.starts_with(kind.first) && (is_binary || !is_word)) return std::string(kind.words);
  }
  if (first.size() > 1 && first[0] == '\x80' && first[1] >= 2 && first[1] <= 5)
    return "is a pickle of Python: write it with DataFrame.to_csv(\"x.csv\", index=False)";
  if (first.find('\0') != first.npos)
    return "has bytes of 0, so it is no text in UTF-8: export a table (CSV) where it was made";
  if (first.starts_with(kByteOrderMark)) first.remove_prefix(kByteOrderMark.size());
  const std::size_t begin = first.find_first_not_of(" \t\r\n");
  if (begin != first.npos && first[begin] == '<')
    return "is XML or HTML: export a table (CSV) where it was made (TrackMate: Export to CSV)";
  return {};
}

Lines::Lines(const std::string& path, std::size_t most_bytes)
    : name_(path == "-" ? "standard input" : path), most_bytes_(most_bytes), buffer_(kBlock) {
  errno = 0;
  file_ = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat found = {};
  if (file_ < 0 || ::fstat(file_, &found) != 0) fail();
  if (S_ISREG(found.st_mode)) bytes_ = found.st_size;
}

Lines::~Lines() {
  if (file_ > STDIN_FILENO) ::close(file_);
}

bool Lines::next(std::string_view& line) {
  if (number_ == 0) begin_text();
  const char* end = nullptr;
  for (std::size_t looked = 0;
       !(end = static_cast<const char*>(std::memchr(at() + looked, end_, rest() - looked)));) {
    looked = rest();
    if (fill()) continue;
    if (rest() == 0) return false;
    end = at() + rest();
    break;
  }
  ++number_;
  line = {at(), static_cast<std::size_t>(end - at())};
  begin_ = std::min(filled_, begin_ + line.size() + 1);
  // Programs that write CRLF through a text-mode file produce CRCRLF.
  if (end_ == '\n')
    while (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

void Lines::begin_text() {
  while (rest() < kBlock && fill()) {
  }
  const std::string_view first(at(), rest());
  if (const std::string words = no_text(first.substr(0, 4096)); !words.empty())
    throw std::invalid_argument(name_ + ": " + words);
  if (first.starts_with(kByteOrderMark)) begin_ += kByteOrderMark.size();
  const std::size_t end = first.find_first_of("\r\n");
  if (end != first.npos && first[end] == '\r' && first.find('\n') == first.npos) end_ = '\r';
}

void Lines::fail() const {
  throw std::invalid_argument(name_ + ": cannot be read: " + std::strerror(errno));
}

/// Reads more bytes after the unread part. Returns false at the end of the file.
bool Lines::fill() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(filled_), buffer_.begin());
  filled_ -= std::exchange(begin_, 0);
  if (filled_ == buffer_.size()) {
    if (filled_ >= most_bytes_)
      throw std::invalid_argument(name_ + ":" + std::to_string(number_ + 1) + ": is longer than " +
                                  std::to_string(most_bytes_) + " bytes");
    buffer_.resize(std::min(most_bytes_, 2 * buffer_.size()));
  }
  ssize_t got = 0;
  while ((got = ::read(file_, buffer_.data() + filled_, buffer_.size() - filled_)) < 0)
    if (errno != EINTR) fail();
  filled_ += static_cast<std::size_t>(got);
  read_ += got;
  return got > 0;
}

void require_different(const std::vector<std::string>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code missing;  // the reader of the file reports a missing file
      if (paths[i] == paths[j] || std::filesystem::equivalent(paths[i], paths[j], missing))
        throw std::invalid_argument(paths[i] + ": is given twice" +
                                    (paths[i] == paths[j] ? "" : " (" + paths[j] + ")"));
    }
}

std::vector<std::string> lines_of(const std::string& path) {
  Lines lines(path, std::numeric_limits<std::size_t>::max());
  std::vector<std::string> all;
  for (std::string_view line; lines.next(line);) all.emplace_back(line);
  return all;
}

}  // namespace gatewalk::lattice
