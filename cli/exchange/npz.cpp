// SPDX-License-Identifier: MIT
#include "cli/exchange/npz.h"

#include <fmt/core.h>

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "cli/exchange/archive.h"
#include "cli/render/little_endian.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostBytes = std::size_t{1} << 30, kMostNumbers = kMostBytes / 8,
                      kPrefix = 10;

std::string npy_of(const NumpyArray& array) {
  std::string type = "<f8", data;
  if (const auto* real = std::get_if<std::vector<double>>(&array.values)) {
    data = all_little_endian(*real);
  } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&array.values)) {
    type = "<i8";
    data = all_little_endian(*whole);
  } else {
    data = std::get<std::string>(array.values);
    type = fmt::format("|S{}", data.size());
  }
  std::string shape;
  for (const std::int64_t n : array.shape) shape += fmt::format("{}, ", n);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  constexpr std::size_t kAligned = 64;
  header.append(kAligned - (kPrefix + header.size() + 1) % kAligned, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  return std::string(kMagic) + std::string("\x01\x00", 2) + static_cast<char>(length & 255) +
         static_cast<char>(length >> 8) + header + data;
}

template <class From, class To>
void convert(std::string_view bytes, std::vector<To>& values) {
  values.reserve(bytes.size() / sizeof(From));
  for (std::size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From)) {
    BytesOf<From> one;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), one.size(), one.begin());
    values.push_back(static_cast<To>(from_little_endian<From>(one)));
  }
}

/// Reads an array's numbers of this type; returns false for a type that is not supported.
bool put_numbers(const std::string& type, std::string_view bytes, NumpyArray& array) {
  std::vector<std::int64_t> whole;
  std::vector<double> real;
  if (type == "f8")
    convert<double>(bytes, real);
  else if (type == "f4")
    convert<float>(bytes, real);
  else if (type == "i8")
    convert<std::int64_t>(bytes, whole);
  else if (type == "i4")
    convert<std::int32_t>(bytes, whole);
  else if (type == "i2")
    convert<std::int16_t>(bytes, whole);
  else if (type == "i1")
    convert<std::int8_t>(bytes, whole);
  else if (type == "u8")
    convert<std::uint64_t>(bytes, whole);  // numbers above 2^63 - 1 become negative
  else if (type == "u4")
    convert<std::uint32_t>(bytes, whole);
  else if (type == "u2")
    convert<std::uint16_t>(bytes, whole);
  else if (type == "u1" || type == "b1")
    convert<std::uint8_t>(bytes, whole);
  else
    return false;
  if (type[0] == 'f')
    array.values = std::move(real);
  else
    array.values = std::move(whole);
  return true;
}

NumpyArray array_of(const PackedFile& file, const std::string& path) {
  const std::string name = file.name.substr(0, file.name.rfind(".npy"));
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: array {}: {}", path, lattice::printable(name), why));
  };
  const std::string_view bytes = file.bytes;
  if (!bytes.starts_with(kMagic) || bytes.size() < kPrefix + 2) refuse("is none of numpy");
  const bool is_long = bytes[kMagic.size()] != '\x01';  // versions 2 and 3: four bytes of length
  const auto byte = [&](std::size_t at) {
    return std::size_t{static_cast<unsigned char>(bytes[at])};
  };
  std::size_t length = byte(8) | byte(9) << 8, begin = kPrefix;
  if (is_long) {
    length |= byte(10) << 16 | byte(11) << 24;
    begin += 2;
  }
  if (begin + length > bytes.size()) refuse("is cut short");
  const std::string header(bytes.substr(begin, length));
  static const std::regex pattern(
      R"re(\{\s*'descr':\s*'([<|=])([a-zA-Z])(\d+)',\s*'fortran_order':\s*(True|False),\s*'shape':\s*\(([\d,\s]*)\),?\s*\}\s*)re");
  std::smatch found;
  if (length > 1000 || !std::regex_match(header, found, pattern))
    refuse(
        "is of a kind that is not read: little-endian numbers and texts are (numpy: "
        "array.astype(\"<i8\") or \"<f8\")");
  NumpyArray array{name, {}, {}};
  std::size_t count = 1;
  const std::string shape = found[5];
  static const std::regex number(R"(\d+)");
  for (auto at = std::sregex_iterator(shape.begin(), shape.end(), number);
       at != std::sregex_iterator(); ++at) {
    if (at->str().size() > 10) refuse("is too large");
    array.shape.push_back(std::stoll(at->str()));
    count *= static_cast<std::size_t>(array.shape.back());
    if (count > kMostNumbers) refuse("is too large");
  }
  if (found[4] == "True" && array.shape.size() > 1)
    refuse("is in Fortran's order (numpy.ascontiguousarray makes another)");
  if (found[3].length() > 9) refuse("is too large");
  const std::string kind = found[2], type = kind + found[3].str();
  const std::string_view data = bytes.substr(begin + length);
  const std::size_t size = std::stoul(found[3]) * (kind == "U" ? 4 : 1);
  if (data.size() != count * size)
    refuse(fmt::format("has {} bytes, not {}", data.size(), count * size));
  if (kind == "S" || kind == "U") {
    std::string text;
    for (const char c : data)
      if (c != '\0') text += c;
    array.values = std::move(text);
  } else if (!put_numbers(type, data, array)) {
    refuse(fmt::format("holds {}: whole numbers, f4 and f8 are read (numpy: array.astype(float))",
                       type));
  } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&array.values);
             type == "u8" &&
             std::any_of(whole->begin(), whole->end(), [](auto n) { return n < 0; })) {
    refuse("has a number above 2^63 - 1");
  }
  array.type = type;
  return array;
}

}  // namespace

std::string npz_of(const std::vector<NumpyArray>& arrays) {
  std::vector<PackedFile> files;
  for (const NumpyArray& array : arrays) files.push_back({array.name + ".npy", npy_of(array)});
  return pack(Packing::zip, files);
}

std::vector<NumpyArray> read_npz(const std::string& path) {
  std::vector<NumpyArray> arrays;
  std::size_t numbers = 0;  // numbers take 8 bytes each, in any file
  for (const PackedFile& file : unpack(path, kMostBytes)) {
    arrays.push_back(array_of(file, path));
    std::size_t count = 1;
    for (const std::int64_t n : arrays.back().shape) count *= static_cast<std::size_t>(n);
    if ((numbers += count) > kMostNumbers)
      throw std::runtime_error(fmt::format("{}: holds more than {} numbers", path, kMostNumbers));
  }
  return arrays;
}

}  // namespace gatewalk::cli
