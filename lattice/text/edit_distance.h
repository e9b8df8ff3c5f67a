// SPDX-License-Identifier: MIT
#pragma once
/// How much two words differ, to suggest the known word that was meant.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gatewalk::lattice {

/// Number of letters to insert, remove or replace to turn one word into the other (Levenshtein
/// 1966).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// The name that `word` probably means: a name that begins with `word`, or differs in at most every
/// third letter. Empty if there is none.
[[nodiscard]] inline std::string meant_name(std::string_view word,
                                            const std::vector<std::string>& names) {
  word = word.substr(0, 100);
  std::string nearest;
  std::size_t least = (std::max(word.size(), std::size_t{3}) + 1) / 3 + 1;
  for (const std::string& name : names) {
    if (word.size() > 1 && name.starts_with(word)) return name;
    const std::size_t wrong = edit_distance(word, name);
    if (wrong < least) {
      least = wrong;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace gatewalk::lattice
