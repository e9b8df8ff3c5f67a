// SPDX-License-Identifier: MIT
#pragma once
/// A line that a cell program writes to say how a passage ended
/// (cli/site/reference/cell_program.md).

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::cli {

/// The memory that a body carries from cell to cell, in the program's own words.
struct CarriedWords {
  std::uint16_t length;
  char text[480];
  [[nodiscard]] std::string_view words() const { return {text, length}; }
};
[[nodiscard]] CarriedWords carried_words(std::string_view words);

/// The words of a line, up to the number that an answer can have.
struct AnswerWords {
  static constexpr std::size_t kMost = 4 + dynamics::kMostCoordinates + dynamics::kMostCosts;
  std::array<std::string_view, kMost> word;
  std::size_t count = 0;  // of all words of the line
};
[[nodiscard]] AnswerWords answer_words(std::string_view line);

/// Reads the whole word as a number; returns false if the word is not one.
template <class Number>
[[nodiscard]] bool number_in(std::string_view word, Number& x) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size();
}

/// What is wrong with a line that is not a valid answer.
struct WrongAnswer {
  std::string what;
};

/// The numbers with which a body's memory begins, separated by commas. Throws WrongAnswer if one
/// is missing or not finite.
[[nodiscard]] std::vector<dynamics::Cell::Remembered> numbers_in_memory(
    std::string_view memory, std::vector<dynamics::Cell::Remembered> numbers);

/// Moves the body as an answer says, and returns the passage. The answer's first word is the
/// passage's id, which the caller reads. Throws WrongAnswer.
[[nodiscard]] dynamics::Passage read_answer(const AnswerWords& words,
                                            const dynamics::Section& section, dynamics::Body& body);

}  // namespace gatewalk::cli
