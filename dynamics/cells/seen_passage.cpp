// SPDX-License-Identifier: MIT
#include "dynamics/cells/seen_passage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace gatewalk::dynamics {
namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string equation(const std::string& name, double x) {
  std::array<char, 32> digits{};
  return name + " = " +
         std::string(digits.data(),
                     std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
}

}  // namespace

bool SeenPassage::same_as(const SeenPassage& o) const {
  const auto same = [](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(), same_bits);
  };
  return passage.fate == o.passage.fate && passage.next.face == o.passage.next.face &&
         body.face == o.body.face && same(passage.next.at, o.passage.next.at) &&
         same(body.at, o.body.at) && same(passage.costs, o.passage.costs);
}

std::string SeenPassage::words(const Section& section) const {
  if (passage.fate == Fate::broken) return "broke";
  std::string text =
      passage.fate == Fate::left ? "left by " + words_of(section, passage.next) : "was trapped";
  for (std::size_t c = 0; c < section.costs.size(); ++c)
    text += ", " + equation(section.costs[c].key, passage.costs[c]);
  return text;
}

std::string words_of(const Section& section, const Entry& entry) {
  const bool is_known = entry.face >= 0 && entry.face < std::ssize(section.faces);
  std::string text = is_known ? section.faces[static_cast<std::size_t>(entry.face)].name
                              : "face number " + std::to_string(entry.face);
  for (std::size_t k = 0; k < section.coordinates.size(); ++k)
    text += (k == 0 ? " (" : ", ") + equation(section.coordinates[k].name, entry.at[k]);
  return text + ")";
}

}  // namespace gatewalk::dynamics
