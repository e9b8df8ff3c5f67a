// SPDX-License-Identifier: MIT
#include "dynamics/cells/words.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace gatewalk::dynamics {

int Letters::of_passage(int type, const Entry& entry, int next) const {
  if (states) return states->index_of(entry).state;
  return table.at(static_cast<std::size_t>((type * faces + entry.face) * faces + next));
}

std::set<Words::Word> Words::closed(const Letters& letters, const std::vector<Word>& words) {
  const bool images = std::none_of(letters.mirrors.begin(), letters.mirrors.end(),
                                   [](int letter) { return letter == kNoLetter; });
  std::set<Word> all{{}};
  for (const Word& word : words)
    for (auto from = word.begin(); from != word.end(); ++from)
      for (auto to = from + 1; to <= word.end(); ++to) {
        Word part(from, to);
        all.insert(part);
        for (int& letter : part) letter = letters.mirrors[at(letter)];
        if (images) all.insert(std::move(part));
      }
  return all;
}

Words::Words(Letters letters, int order, const std::vector<Word>& words)
    : letters_(std::move(letters)), order_(order) {
  const auto count = static_cast<int>(letters_.names.size());
  for (const Word& word : words) {
    if (std::ssize(word) > order) throw std::invalid_argument("words: one has too many letters");
    for (const int letter : word)
      if (letter < 0 || letter >= count) throw std::invalid_argument("words: no such letter");
  }
  for (const Word& word : closed(letters_, words)) words_.push_back(word);
  if (static_cast<std::size_t>(letters_.faces) * words_.size() > kMostLabels)
    throw std::invalid_argument("words: there are too many");
  std::stable_sort(words_.begin(), words_.end(),
                   [](const Word& a, const Word& b) { return a.size() < b.size(); });
  for (int w = 0; w < size(); ++w) number_[word(w)] = w;
  for (const Word& word : words_) {
    shorter_.push_back(word.empty() ? kNone : number_.at(Word(word.begin() + 1, word.end())));
    Word image = word;
    for (int& letter : image) letter = letters_.mirrors[at(letter)];
    const auto mirror = number_.find(image);
    mirror_.push_back(mirror == number_.end() ? kNone : mirror->second);
    for (int letter = 0; letter < count; ++letter) {
      Word longer = word;
      longer.push_back(letter);
      next_.push_back(longest(std::move(longer)));
    }
  }
}

int Words::longest(Word letters) const {
  for (;; letters.erase(letters.begin()))
    if (const auto found = number_.find(letters); found != number_.end()) return found->second;
}

int Words::next_label(int type, const Entry& from, int face) const {
  Entry plain = from;
  plain.face = face_of(from.face);
  return label(face, next(word_of(from.face), letters_.of_passage(type, plain, face)));
}

std::shared_ptr<const Words> Words::of_types(const std::vector<int>& before) const {
  auto renumbered = std::make_shared<Words>(*this);
  std::vector<int>& table = renumbered->letters_.table;
  table.clear();
  const auto pairs = static_cast<std::ptrdiff_t>(letters_.faces) * letters_.faces;
  for (const int type : before) {
    if (letters_.table.empty()) break;  // of states
    const auto begin = letters_.table.begin() + type * pairs;
    table.insert(table.end(), begin, begin + pairs);
  }
  return renumbered;
}

Section Words::labelled(const Section& section, std::shared_ptr<const Words> words,
                        bool symmetric) {
  Section all = section;
  all.named.clear();
  all.faces.clear();
  for (int w = 0; w < words->size(); ++w) {
    std::string behind;
    for (const int letter : words->word(w)) {
      const std::string& name = words->letters_.names[at(letter)];
      behind += (behind.empty() ? "." : name.size() > 1 ? "-" : "") + name;
    }
    for (const Face& plain : section.faces) {
      Face& face = all.faces.emplace_back(plain);
      face.name += behind;
      if (face.mirror != kNoMirror && (symmetric || w > 0))  // plain() needs those of faces
        face.mirror = symmetric && words->mirror(w) != kNone
                          ? words->label(face.mirror, words->mirror(w))
                          : kNoMirror;
    }
  }
  all.words = std::move(words);
  return all;
}

Section Words::plain(const Section& section) {
  Section plain = section;
  if (!section.words) return plain;
  plain.faces.resize(static_cast<std::size_t>(section.words->letters().faces));
  plain.words = nullptr;
  return plain;
}

}  // namespace gatewalk::dynamics
