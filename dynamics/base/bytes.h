// SPDX-License-Identifier: MIT
#pragma once
/// Serialisation of results to bytes and back, for the same program on the same machine: numbers
/// are stored as they are in memory.

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gatewalk::dynamics {

/// Base of the archives: archive(part, ...) writes or reads the parts one after the other. A type
/// that is not trivially copyable has a function each_part(archive, object), which calls
/// archive(part, ...) and serves both writing and reading.
template <class Archive>
class PartByPart {
 public:
  template <class... Parts>
  void operator()(Parts&... parts) {
    (one(parts), ...);
  }

 private:
  [[nodiscard]] Archive& self() { return static_cast<Archive&>(*this); }
  template <class T>
  void one(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>)
      self().raw(&value, sizeof value);
    else
      each_part(self(), value);
  }
  template <class T>
  void one(std::vector<T>& values) {
    auto size = static_cast<std::uint64_t>(values.size());
    one(size);
    if constexpr (Archive::reads) {
      self().require(size);
      values.resize(static_cast<std::size_t>(size));
    }
    if constexpr (std::is_trivially_copyable_v<T>)
      self().raw(values.data(), values.size() * sizeof(T));
    else
      for (T& value : values) one(value);
  }
};

class WriteBytes : public PartByPart<WriteBytes> {
 public:
  static constexpr bool reads = false;
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  friend PartByPart<WriteBytes>;
  void raw(const void* from, std::size_t size) {
    bytes_.append(static_cast<const char*>(from), size);
  }

  std::string bytes_;
};

/// Reads parts from bytes. Throws std::runtime_error if there are too few or too many bytes.
class ReadBytes : public PartByPart<ReadBytes> {
 public:
  static constexpr bool reads = true;
  explicit ReadBytes(std::string_view bytes) : left_(bytes) {}
  void end() const {
    if (!left_.empty()) throw std::runtime_error("a kept piece has bytes too many");
  }

 private:
  friend PartByPart<ReadBytes>;
  void require(std::uint64_t bytes) const {
    if (bytes > left_.size()) throw std::runtime_error("a kept piece ends too early");
  }
  void raw(void* to, std::size_t size) {
    require(size);
    if (size > 0) std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }

  std::string_view left_;
};

template <class T>
[[nodiscard]] std::string bytes_of(const T& value) {
  WriteBytes write;
  write(const_cast<T&>(value));  // WriteBytes only reads it
  return write.take();
}
/// Reads `value`, a newly made object, from its bytes.
template <class T>
void read_bytes(std::string_view bytes, T& value) {
  ReadBytes read(bytes);
  read(value);
  read.end();
}

}  // namespace gatewalk::dynamics
