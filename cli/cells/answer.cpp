// SPDX-License-Identifier: MIT
#include "cli/cells/answer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/cells/process.h"

namespace gatewalk::cli {

using namespace dynamics;

namespace {

double finite(std::string_view word, const std::string& name) {
  double x = 0.0;
  if (!number_in(word, x) || !std::isfinite(x))
    throw WrongAnswer{fmt::format("{} '{}' is not a finite number", name, excerpt(word, 40))};
  return x;
}

/// The words that an answer of this fate must have, for a message.
std::string form_of(const Section& section, std::string_view fate) {
  std::string form = "ID " + std::string(fate);
  if (fate == "left") {
    form += " FACE";
    for (const Coordinate& c : section.coordinates) form += ' ' + c.name;
  }
  for (const CostInfo& c : section.costs) form += ' ' + c.key;
  return fate == "left" ? form + " MEMORY" : form;
}

void require_count(const AnswerWords& words, std::size_t count, const Section& section,
                   std::string_view fate) {
  if (words.count == count) return;
  throw WrongAnswer{
      fmt::format("it has {} words, not {}: {}", words.count, count, form_of(section, fate))};
}

Costs read_costs(const AnswerWords& words, std::size_t at, const Section& section) {
  Costs costs{};
  for (std::size_t c = 0; c < section.costs.size(); ++c)
    costs[c] = finite(words.word[at + c], section.costs[c].key);
  if (costs[0] < 0.0) throw WrongAnswer{section.costs[0].key + " is negative"};
  return costs;
}

}  // namespace

CarriedWords carried_words(std::string_view words) {
  CarriedWords memory{static_cast<std::uint16_t>(words.size()), {}};
  std::copy(words.begin(), words.end(), memory.text);
  return memory;
}

AnswerWords answer_words(std::string_view line) {
  AnswerWords words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    if (words.count < AnswerWords::kMost) words.word[words.count] = line.substr(at, end - at);
    ++words.count;
    at = end;
  }
  return words;
}

std::vector<Cell::Remembered> numbers_in_memory(std::string_view memory,
                                                std::vector<Cell::Remembered> numbers) {
  for (Cell::Remembered& number : numbers) {
    const std::size_t end = std::min(memory.find(','), memory.size());
    number.value = finite(memory.substr(0, end), "memory: " + number.key);
    memory.remove_prefix(std::min(end + 1, memory.size()));
  }
  return numbers;
}

Passage read_answer(const AnswerWords& words, const Section& section, Body& body) {
  const std::string_view fate = words.word[1];
  const std::size_t coordinates = section.coordinates.size(), costs = section.costs.size();
  if (fate == "broken") {
    if (words.count != 2) throw WrongAnswer{"a broken passage has no more words: ID broken"};
    return {Fate::broken, {}, {}};
  }
  if (fate == "trapped") {
    require_count(words, 2 + costs, section, fate);
    return {Fate::trapped, {}, read_costs(words, 2, section)};
  }
  if (fate != "left") throw WrongAnswer{"its second word must be left, trapped or broken"};
  require_count(words, 4 + coordinates + costs, section, fate);
  Passage passage{Fate::left, {}, {}};
  const auto face = std::find_if(section.faces.begin(), section.faces.end(),
                                 [&](const Face& f) { return f.name == words.word[2]; });
  if (face == section.faces.end())
    throw WrongAnswer{fmt::format("there is no face '{}' to enter the next cell by, but {}",
                                  excerpt(words.word[2], 40), names_of(section.faces))};
  passage.next.face = static_cast<int>(face - section.faces.begin());
  for (std::size_t k = 0; k < coordinates; ++k)
    passage.next.at[k] = finite(words.word[3 + k], section.coordinates[k].name);
  passage.costs = read_costs(words, 3 + coordinates, section);
  const std::string_view memory = words.word[3 + coordinates + costs];
  if (memory.size() > sizeof CarriedWords::text)
    throw WrongAnswer{fmt::format("its memory has {} bytes; at most {} are carried", memory.size(),
                                  sizeof CarriedWords::text)};
  body.entry = passage.next;
  body.carried.put(carried_words(memory));
  return passage;
}

}  // namespace gatewalk::cli
