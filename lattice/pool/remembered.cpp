// SPDX-License-Identifier: MIT
#include "lattice/pool/remembered.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lattice/pool/kernel.h"
#include "lattice/pool/relabelled.h"
#include "lattice/text/json_text.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::array<std::string_view, 3> kNamesOfLetters{"turns", "faces", "states"};
enum Turn : int { kTurnLeft, kStraight, kTurnRight, kBack };

bool are_turns(const Section& section) {
  return std::ranges::all_of(section.faces, [](const Face& face) {
    return std::abs(face.di_x) + std::abs(face.di_y) == 1;
  });
}

int turn_of(const Face& in, const Face& out) {
  if (in.di_x * out.di_x + in.di_y * out.di_y != 0)
    return in.di_x == out.di_x && in.di_y == out.di_y ? kStraight : kBack;
  return in.di_x * out.di_y - in.di_y * out.di_x > 0 ? kTurnLeft : kTurnRight;
}

bool is_back(const Face& in, const Face& out) {
  return in.di_x == -out.di_x && in.di_y == -out.di_y;
}

/// Names and mirror images of the letters, which have none if no cell is symmetric; the table is
/// empty.
Letters named_letters(LettersOf of, const CellMap& map) {
  const Section& section = map.section;
  const auto faces = static_cast<int>(section.faces.size());
  Letters letters{.of = of, .names = {}, .mirrors = {}, .faces = faces};
  const auto mirror = [&](int face) {
    return section.faces[static_cast<std::size_t>(face)].mirror;
  };
  const auto name = [&](int face) { return section.faces[static_cast<std::size_t>(face)].name; };
  if (of == LettersOf::states) return letters;
  if (of == LettersOf::turns && are_turns(section)) {
    letters.names = {"l", "s", "r", "b"};
    letters.mirrors = {kTurnRight, kStraight, kTurnLeft, kBack};
  } else if (of == LettersOf::faces) {
    for (int f = 0; f < faces; ++f) {
      letters.names.push_back(name(f));
      letters.mirrors.push_back(mirror(f) == kNoMirror ? kNoLetter : mirror(f));
    }
  } else {
    for (int in = 0; in < faces; ++in)
      for (int out = 0; out < faces; ++out) {
        letters.names.push_back(name(in) + "+" + name(out));
        letters.mirrors.push_back(mirror(in) == kNoMirror || mirror(out) == kNoMirror
                                      ? kNoLetter
                                      : mirror(in) * faces + mirror(out));
      }
  }
  if (std::ranges::none_of(map.types, &CellMap::Type::symmetric))
    std::ranges::fill(letters.mirrors, kNoLetter);
  return letters;
}

/// Calls use(type, entry, passage) for all runs that ended in another cell.
template <class Use>
void each_move(const RunPool& pool, Use use) {
  const auto of = [&](const FieldTrials& trials, const auto& start_of) {
    for (std::size_t i = 0; i < trials.passed.size(); ++i) {
      Entry entry = start_of(i);
      for (const CellPassage passage : trials.of_trial(i)) {
        if (passage.fate == Fate::left) use(passage.type, entry, passage);
        entry = passage.entry;
      }
    }
  };
  for (const OwnRuns& s : pool.starts)
    for (const FieldTrials* trials : {&s.full, &s.first})
      of(*trials, [&](std::size_t) { return s.start; });
  of(pool.scattered.each, [&](std::size_t i) { return pool.scattered.starts[i]; });
}

/// By type: the number of sides by which bodies came or went.
std::vector<int> open_sides(const CellMap& map, const RunPool& pool) {
  std::vector<std::set<std::pair<int, int>>> sides(map.types.size());
  each_move(pool, [&](int type, const Entry& entry, const CellPassage& passage) {
    const Face &in = map.section.faces[static_cast<std::size_t>(entry.face)],
               &out = map.section.faces[static_cast<std::size_t>(passage.entry.face)];
    auto& of = sides[static_cast<std::size_t>(type)];
    for (const int image : map.types[static_cast<std::size_t>(type)].symmetric ? std::vector{1, -1}
                                                                               : std::vector{1}) {
      of.insert({-image * in.di_x, -in.di_y});
      of.insert({image * out.di_x, out.di_y});
    }
  });
  std::vector<int> counts;
  for (const auto& of : sides) counts.push_back(static_cast<int>(of.size()));
  return counts;
}

/// The letters of the passages of these cells; `open`: the number of open sides, by type.
Letters letters_with(LettersOf of, const CellMap& map, const std::vector<int>& open) {
  constexpr int kFork = 3;
  const Section& section = map.section;
  const bool turns = are_turns(section);
  Letters letters = named_letters(of, map);
  letters.open_sides = open;
  for (std::size_t type = 0; type < map.types.size(); ++type)
    for (int in = 0; in < letters.faces; ++in)
      for (int out = 0; out < letters.faces; ++out) {
        const Face &from = section.faces[static_cast<std::size_t>(in)],
                   &to = section.faces[static_cast<std::size_t>(out)];
        letters.table.push_back(of == LettersOf::faces                     ? in
                                : open[type] < kFork && !is_back(from, to) ? kNoLetter
                                : turns                                    ? turn_of(from, to)
                                        : in * letters.faces + out);
      }
  return letters;
}

/// Gives each face its label.
class WithWords {
 public:
  explicit WithWords(const Words& words) : words_(words) {}
  [[nodiscard]] Entry begin(Entry start) {
    from_ = start;
    return start;  // the label of the empty word
  }
  [[nodiscard]] CellPassage next(CellPassage passage) {
    if (passage.fate != Fate::left) return passage;
    passage.entry.face = words_.next_label(passage.type, from_, passage.entry.face);
    from_ = passage.entry;
    return passage;
  }

 private:
  const Words& words_;
  Entry from_{};
};

/// Gives each label its face.
struct WithoutWords {
  const Words& words;
  [[nodiscard]] Entry begin(Entry start) const {
    start.face = words.face_of(start.face);
    return start;
  }
  [[nodiscard]] CellPassage next(CellPassage passage) const {
    passage.entry.face = words.face_of(passage.entry.face);
    return passage;
  }
};

}  // namespace

Letters letters_of(LettersOf of, const CellMap& map, const RunPool& pool,
                   std::shared_ptr<const StateSpace> states) {
  if (of != LettersOf::states) return letters_with(of, map, open_sides(map, pool));
  Letters letters = named_letters(of, map);
  for (int s = 0; s < states->size(); ++s) letters.names.push_back(std::to_string(s));
  letters.mirrors.assign(letters.names.size(), kNoLetter);
  letters.states = std::move(states);
  return letters;
}

ChosenWords words_of(Letters letters, const RunPool& pool, int order, int per_leaf) {
  std::map<Words::Word, std::int64_t> entries;  // by word
  const auto count = [&](const FieldTrials& trials, const auto& start_of) {
    for (std::size_t i = 0; i < trials.passed.size(); ++i) {
      Words::Word word;
      Entry entry = start_of(i);
      for (const CellPassage passage : trials.of_trial(i)) {
        if (passage.fate != Fate::left) break;
        if (const int letter = letters.of_passage(passage.type, entry, passage.entry.face);
            letter != kNoLetter)
          word.push_back(letter);
        if (std::ssize(word) > order) word.erase(word.begin());
        ++entries[word];
        entry = passage.entry;
      }
    }
  };
  for (const OwnRuns& s : pool.starts) count(s.full, [&](std::size_t) { return s.start; });
  count(pool.scattered.each, [&](std::size_t i) { return pool.scattered.starts[i]; });
  std::map<Words::Word, std::int64_t> all;  // by the end of a word
  for (const auto& [word, n] : entries)
    for (auto from = word.begin(); from != word.end(); ++from)
      all[Words::Word(from, word.end())] += n;
  std::vector<std::pair<std::int64_t, Words::Word>> by_entries;  // the most frequent first
  for (const auto& [word, n] : all)
    if (n >= 2 * per_leaf) by_entries.emplace_back(-n, word);
  std::sort(by_entries.begin(), by_entries.end());
  const auto first = [&](std::size_t number) {
    std::vector<Words::Word> words;
    for (std::size_t i = 0; i < number; ++i) words.push_back(by_entries[i].second);
    return words;
  };
  const auto fits = [&](std::size_t number) {
    const std::set<Words::Word> closed = Words::closed(letters, first(number));
    std::size_t characters = 0;
    for (const Words::Word& word : closed)
      for (const int letter : word)
        characters += letters.names[static_cast<std::size_t>(letter)].size() + 1;
    // A file has the names of all labels in one attribute.
    constexpr std::size_t kMostCharacters = 50'000;
    const auto faces = static_cast<std::size_t>(letters.faces);
    return faces * closed.size() <= Words::kMostLabels && faces * characters <= kMostCharacters;
  };
  std::size_t fitting = 0;
  for (std::size_t most = by_entries.size(); fitting < most;) {
    const std::size_t middle = (fitting + most + 1) / 2;
    if (fits(middle))
      fitting = middle;
    else
      most = middle - 1;
  }
  return {std::make_shared<const Words>(letters, order, first(fitting)),
          std::ssize(by_entries) - static_cast<std::int64_t>(fitting)};
}

CellMap with_words(CellMap map, std::shared_ptr<const Words> words) {
  const bool images = words->letters().of != LettersOf::states;
  bool symmetric = false;
  for (CellMap::Type& type : map.types) symmetric = (type.symmetric &= images) || symmetric;
  map.section = Words::labelled(map.section, std::move(words), symmetric);
  return map;
}

RunPool with_words(const RunPool& pool, const CellMap& labelled) {
  return relabelled(pool, labelled.section, WithWords(*labelled.section.words));
}

RunPool without_words(const RunPool& pool, const Section& labelled) {
  return relabelled(pool, labelled, WithoutWords{*labelled.words});
}

std::string text_of(const Words& words) {
  std::vector<std::string> all;
  for (int w = 0; w < words.size(); ++w)
    all.push_back(fmt::format("[{}]", fmt::join(words.word(w), ",")));
  return fmt::format(R"({{"of":"{}","order":{},"open_sides":[{}],"words":[{}]}})",
                     name_of(words.letters().of), words.order(),
                     fmt::join(words.letters().open_sides, ","), fmt::join(all, ","));
}

std::shared_ptr<const Words> words_in(std::string_view text, const CellMap& plain) {
  const JsonObject json(text);
  const auto refuse = [] { throw std::invalid_argument("its words are damaged"); };
  const auto* const of = std::ranges::find(kNamesOfLetters, json_text(json.at("of")));
  if (of == kNamesOfLetters.end() ||
      static_cast<LettersOf>(of - kNamesOfLetters.begin()) == LettersOf::states)
    refuse();
  const auto numbers = [&](std::string_view list) {
    std::vector<int> all;
    for (const std::string_view number : json_elements(list)) {
      const double x = json_number(number);
      if (!(x >= 0.0 && x <= Words::kMostLabels && x == std::floor(x))) refuse();
      all.push_back(static_cast<int>(x));
    }
    return all;
  };
  const std::vector<int> open = numbers(json.at("open_sides"));
  if (open.size() != plain.types.size()) refuse();
  std::vector<Words::Word> words;
  for (const std::string_view word : json_elements(json.at("words")))
    words.push_back(numbers(word));
  const auto order = json.count<int>("order");
  if (order > kMostOrder) refuse();
  return std::make_shared<const Words>(
      letters_with(static_cast<LettersOf>(of - kNamesOfLetters.begin()), plain, open), order,
      words);
}

std::string_view name_of(LettersOf of) { return kNamesOfLetters[static_cast<std::size_t>(of)]; }

}  // namespace gatewalk::lattice
