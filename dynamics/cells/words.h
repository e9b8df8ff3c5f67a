// SPDX-License-Identifier: MIT
#pragma once
/// Words: what a chain remembers of the cells that a body has passed. Each passage adds a letter (a
/// turn, or the face by which the cell was entered); a word is the last letters, the latest one at
/// its end. A chain with words has a face for each pair of a face of the cell and a word, and is
/// otherwise a chain like any other. The words are a context tree (Buehlmann and Wyner, Ann. Stat.
/// 27, 1999): a body has the longest word of the tree that its passages end with.

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// What a letter is: the turn in a cell, the face of entry into a cell, or the state of the chain
/// without words in which a body entered a cell.
enum class LettersOf : std::uint8_t { turns, faces, states };

inline constexpr int kNoLetter = -1;

/// The letters of the passages through cells of one section.
struct Letters {
  LettersOf of = LettersOf::turns;
  std::vector<std::string> names;
  std::vector<int> mirrors;  // by letter: that of the mirror image; kNoLetter: there is none
  int faces = 0;             // of a cell
  /// (types x faces x faces) by type of the cell, face of the entry into it and face of the entry
  /// into the next cell; kNoLetter: such a passage adds nothing. Empty for states.
  std::vector<int> table{};
  std::vector<int> open_sides{};               // by type, from which the table follows
  std::shared_ptr<const StateSpace> states{};  // for states

  /// The letter of a passage from `entry`, by a face of the cell, to the face `next`.
  [[nodiscard]] int of_passage(int type, const Entry& entry, int next) const;
};

/// A set of words, which holds every part of each of its words.
class Words {
 public:
  /// A word: its letters, the latest one at the end.
  using Word = std::vector<int>;

  /// `words`: any words with at most `order` letters; closed() adds what is missing. Throws
  /// std::invalid_argument for unknown letters, longer words, and more than kMostLabels pairs of
  /// face and word.
  Words(Letters letters, int order, const std::vector<Word>& words);

  /// These words with all their parts, the empty word, and mirror images if all letters have one.
  [[nodiscard]] static std::set<Word> closed(const Letters& letters,
                                             const std::vector<Word>& words);

  [[nodiscard]] const Letters& letters() const { return letters_; }
  [[nodiscard]] int order() const { return order_; }
  [[nodiscard]] int size() const { return static_cast<int>(words_.size()); }
  [[nodiscard]] const Word& word(int w) const { return words_[static_cast<std::size_t>(w)]; }
  /// The word of a body that had word w, after this letter (kNoLetter: the same).
  [[nodiscard]] int next(int w, int letter) const {
    return letter == kNoLetter ? w : next_[at(w) * letters_.names.size() + at(letter)];
  }
  /// The word without its earliest letter; kNone for the empty word.
  [[nodiscard]] int shorter(int w) const { return shorter_[at(w)]; }
  [[nodiscard]] int mirror(int w) const { return mirror_[at(w)]; }
  static constexpr int kNone = -1;

  // A label is a pair of a face and a word; the empty word comes first, so that its labels are the
  // numbers of the faces.
  [[nodiscard]] int labels() const { return letters_.faces * size(); }
  [[nodiscard]] int label(int face, int w) const { return w * letters_.faces + face; }
  [[nodiscard]] int face_of(int label) const { return label % letters_.faces; }
  [[nodiscard]] int word_of(int label) const { return label / letters_.faces; }
  /// The label of the entry into the next cell by `face`, after a passage from `from`, whose face
  /// is a label too.
  [[nodiscard]] int next_label(int type, const Entry& from, int face) const;

  /// The same words where the types of cells have other numbers: before[t] is the number so far of
  /// the type that gets number t.
  [[nodiscard]] std::shared_ptr<const Words> of_types(const std::vector<int>& before) const;

  /// The section with a face for each label: "S", and "S.lb" for the face S after a turn to the
  /// left and then a turn back. With mirror images only for symmetric cells.
  [[nodiscard]] static Section labelled(const Section& section, std::shared_ptr<const Words> words,
                                        bool symmetric);
  /// The section without words.
  [[nodiscard]] static Section plain(const Section& section);

  static constexpr int kMostLabels = 4096;

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  /// The longest word that these letters end with.
  [[nodiscard]] int longest(Word letters) const;

  Letters letters_;
  int order_;
  std::vector<Word> words_;
  std::map<Word, int> number_;
  std::vector<int> next_;  // (words x letters)
  std::vector<int> shorter_, mirror_;
};

}  // namespace gatewalk::dynamics
