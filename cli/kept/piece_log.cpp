// SPDX-License-Identifier: MIT
#include "cli/kept/piece_log.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <utility>

#include "markov/formats/counts.h"
#include "markov/formats/file.h"

namespace gatewalk::cli {
namespace {

// A file begins with two lines: this name followed by the length and CRC-32 of the second line,
// which is the head. Then records: a RecordHead, as it is in memory, and the bytes.
constexpr char kFirstLine[] = "gatewalk pieces 1 ";
constexpr char kByteOrder = std::endian::native == std::endian::little ? 'l' : 'b';

struct RecordHead {
  std::uint32_t mark, stage;
  std::int64_t first, count;
  std::uint64_t bytes;
  std::uint32_t check, own_check;  // CRC-32 of the bytes; of this head before own_check
};
static_assert(sizeof(RecordHead) == 40);
constexpr std::uint32_t kMark = 0x43454950;

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string_view checked_part(const RecordHead& head) {
  return {reinterpret_cast<const char*>(&head), offsetof(RecordHead, own_check)};
}

std::string first_line(std::string_view head) {
  return fmt::format("{}{} {} {:08x}\n", kFirstLine, kByteOrder, head.size(), crc_of(head));
}

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

/// What `read` reads from the file. Throws std::runtime_error for a read error, which is neither
/// the end of the file nor damage.
template <class Read>
auto read_from(const std::string& path, Read read) try {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be read: " + std::strerror(errno));
  in.exceptions(std::ios_base::badbit);
  return read(in);
} catch (const std::ios_base::failure&) {
  throw std::runtime_error(path + ": cannot be read on: " + std::strerror(EIO));
}

}  // namespace

bool PieceFile::is_one(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;  // a pipe can be read only once
  std::ifstream in(path, std::ios::binary);
  std::string start(sizeof kFirstLine - 1, '\0');
  return in.read(start.data(), static_cast<std::streamsize>(start.size())) && begins(start);
}

bool PieceFile::begins(std::string_view bytes) { return bytes.starts_with(kFirstLine); }

std::string piece_head(const std::string& path) {
  if (!std::ifstream(path, std::ios::binary))
    throw markov::BadFile(path + ": cannot be read: " + std::strerror(errno));
  if (std::filesystem::is_directory(path))
    throw markov::BadFile(path + ": is a folder, and holds no pieces of a run");
  std::string first, head;
  read_from(path, [&](std::istream& in) {
    if (!std::getline(in, first) || !first.starts_with(kFirstLine))
      throw markov::BadFile(
          path + ": holds no pieces of a run (--part and --checkpoint write such files)");
    std::getline(in, head);
  });
  if (first + "\n" != first_line(head))
    throw markov::BadFile(path + ": its first lines are damaged, or of another kind of machine");
  return head;
}

PieceFile::PieceFile(const std::string& path) : path_(path), head_(piece_head(path)) {
  read_from(path, [&](std::istream& in) { read_records(in); });
  // After a power failure the last records may be incomplete or zeros; they are dropped.
  while (!records_.empty()) {
    try {
      (void)bytes_of(records_.back());
      break;
    } catch (const markov::BadFile&) {
      end_ = records_.back().at - sizeof(RecordHead);
      records_.pop_back();
    }
  }
}

void PieceFile::read_records(std::istream& in) {
  end_ = first_line(head_).size() + head_.size() + 1;
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in.tellg());
  for (RecordHead head{};;) {
    in.clear();
    in.seekg(static_cast<std::streamoff>(end_));
    if (!in.read(reinterpret_cast<char*>(&head), sizeof head)) break;
    if (head.mark != kMark || head.own_check != crc_of(checked_part(head))) break;
    const std::uint64_t at = end_ + sizeof head;
    if (head.bytes > size - at) break;
    if (head.first < 0 || head.count < 0 ||
        head.first > std::numeric_limits<std::int64_t>::max() - head.count)
      throw markov::BadFile(
          fmt::format("{}: has items that there are not, at byte {}", path_, end_));
    records_.push_back({head.stage, {head.first, head.count}, at, head.bytes, head.check});
    end_ = at + head.bytes;
  }
}

bool PieceFile::is_finished() const {
  return !records_.empty() && records_.back().stage == kEndStage;
}

std::string PieceFile::bytes_of(const PieceRecord& record) const {
  std::string bytes(record.bytes, '\0');
  read_from(path_, [&](std::istream& in) {
    in.seekg(static_cast<std::streamoff>(record.at));
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) ||
        crc_of(bytes) != record.check)
      throw markov::BadFile(fmt::format("{}: is damaged at byte {}", path_, record.at));
  });
  return bytes;
}

PieceWriter::PieceWriter(const std::string& path, std::string_view head) : path_(path) {
  if (PieceFile::is_one(path)) {  // throws if another process writes the file to be replaced
    open();
    ::close(std::exchange(file_, -1));
  }
  // The file appears as a whole, so that none is without its head.
  markov::replace_file(path, first_line(head) + std::string(head) + "\n");
  open();
}

PieceWriter::PieceWriter(const PieceFile& file) : path_(file.path()) {
  open();
  if (::ftruncate(file_, static_cast<off_t>(file.end())) != 0) fail(path_);
}

PieceWriter::~PieceWriter() {
  if (file_ < 0) return;
  (void)::fdatasync(file_);
  (void)::close(file_);
}

void PieceWriter::open() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) fail(path_);
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    ::close(file_);
    file_ = -1;
    throw std::runtime_error(path_ + ": another gatewalk writes it");
  }
}

void PieceWriter::add(std::uint32_t stage, dynamics::TrialRange items, std::string_view bytes) {
  RecordHead head{kMark, stage, items.first, items.count, bytes.size(), crc_of(bytes), 0};
  head.own_check = crc_of(checked_part(head));
  const std::string record =
      std::string(reinterpret_cast<const char*>(&head), sizeof head).append(bytes);
  if (!markov::write_all(file_, record)) fail(path_);
  is_synced_ = false;
  if (since_sync_.seconds() >= 1.0) sync();
}

bool PieceWriter::is_at_its_path() const {
  struct stat own = {}, there = {};
  return ::fstat(file_, &own) == 0 && ::stat(path_.c_str(), &there) == 0 &&
         own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

void PieceWriter::sync() {
  if (!is_synced_ && ::fdatasync(file_) != 0) fail(path_);
  is_synced_ = true;
  since_sync_ = {};
}

}  // namespace gatewalk::cli
