// SPDX-License-Identifier: MIT
#pragma once
/// Numbers as little-endian bytes on every machine, as numpy, UMB and pages read them.

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

namespace gatewalk::cli {

template <class Number>
using BytesOf = std::array<char, sizeof(Number)>;

/// The bytes, reversed on a big-endian machine; its own inverse.
template <class Number>
[[nodiscard]] BytesOf<Number> ordered(BytesOf<Number> bytes) {
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

template <class Number>
[[nodiscard]] BytesOf<Number> little_endian(Number number) {
  return ordered<Number>(std::bit_cast<BytesOf<Number>>(number));
}

template <class Number>
[[nodiscard]] Number from_little_endian(const BytesOf<Number>& bytes) {
  return std::bit_cast<Number>(ordered<Number>(bytes));
}

/// The bytes of all numbers, one after the other.
template <class Number>
[[nodiscard]] std::string all_little_endian(const std::vector<Number>& numbers) {
  std::string all;
  all.reserve(numbers.size() * sizeof(Number));
  for (const Number number : numbers) {
    const BytesOf<Number> bytes = little_endian(number);
    all.append(bytes.data(), bytes.size());
  }
  return all;
}

}  // namespace gatewalk::cli
