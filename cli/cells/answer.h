// SPDX-License-Identifier: MIT
#pragma once
/// A line that a cell program writes: how a passage ended (cli/site/reference/cell_program.md).

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "dynamics/cells/cell.h"

namespace gatewalk::cli {

/// What a body carries: the program's own words.
struct CarriedWords {
  std::uint16_t length;
  char text[480];
  [[nodiscard]] std::string_view words() const { return {text, length}; }
};
[[nodiscard]] CarriedWords carried_words(std::string_view words);

/// The words of a line, as far as an answer has any.
struct AnswerWords {
  static constexpr std::size_t kMost = 4 + dynamics::kMostCoordinates + dynamics::kMostCosts;
  std::array<std::string_view, kMost> word;
  std::size_t count = 0;  // of all
};
[[nodiscard]] AnswerWords answer_words(std::string_view line);

/// The whole word as a number; false where it is none.
template <class Number>
[[nodiscard]] bool number_in(std::string_view word, Number& x) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size();
}

/// An answer that is none: what is wrong with it.
struct WrongAnswer {
  std::string what;
};

/// Moves the body on, as all words but the first one say, which is the passage's. Throws
/// WrongAnswer.
[[nodiscard]] dynamics::Passage read_answer(const AnswerWords& words,
                                            const dynamics::Section& section, dynamics::Body& body);

}  // namespace gatewalk::cli
