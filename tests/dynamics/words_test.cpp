// SPDX-License-Identifier: MIT
// A body's word follows from its word before and the new letter alone, for any set of words.
#include "dynamics/cells/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "dynamics/base/random.h"

namespace gatewalk::dynamics {
namespace {

Letters three_letters(bool with_mirrors) {
  return {.of = LettersOf::turns,
          .names = {"a", "b", "c"},
          .mirrors = with_mirrors ? std::vector{1, 0, 2} : std::vector(3, kNoLetter),
          .faces = 2,
          .table = {0, 1, 2, kNoLetter}};
}

/// The longest word that this history ends with, found among all words.
int longest_end(const dynamics::Words& words, const dynamics::Words::Word& history) {
  int found = 0;
  for (int w = 0; w < words.size(); ++w) {
    const dynamics::Words::Word& word = words.word(w);
    if (word.size() <= history.size() && word.size() >= words.word(found).size() &&
        std::equal(word.rbegin(), word.rend(), history.rbegin()))
      found = w;
  }
  return found;
}

TEST(Words, FollowFromTheWordBeforeAndTheLetter) {
  Random random(Purpose::comparison, {1, 2, 3});
  for (int set = 0; set < 50; ++set) {
    std::vector<dynamics::Words::Word> some;
    for (int k = 0; k < 1 + set % 7; ++k) {
      dynamics::Words::Word& word = some.emplace_back();
      for (int i = 0; i < 1 + k % 4; ++i) word.push_back(static_cast<int>(random.below(3)));
    }
    const dynamics::Words words(three_letters(set % 2 == 0), 4, some);
    dynamics::Words::Word history;
    int w = 0;
    for (int step = 0; step < 200; ++step) {
      const auto letter = static_cast<int>(random.below(3));
      history.push_back(letter);
      w = words.next(w, letter);
      ASSERT_EQ(w, longest_end(words, history)) << "set " << set << " step " << step;
    }
  }
}

TEST(Words, HoldTheirPartsAndTheirMirrorImages) {
  const dynamics::Words words(three_letters(true), 3, {{0, 2, 1}});
  // Of "acb": a, c, b, ac, cb, acb; and of its mirror image "bca": bc, ca, bca; and the empty word.
  EXPECT_EQ(words.size(), 1 + 3 + 4 + 2);
  for (int w = 0; w < words.size(); ++w) {
    EXPECT_EQ(words.mirror(words.mirror(w)), w);
    if (w == 0) continue;
    EXPECT_EQ(words.word(words.shorter(w)).size(), words.word(w).size() - 1);
  }
  EXPECT_EQ(words.shorter(0), dynamics::Words::kNone);
  EXPECT_EQ(words.next(2, kNoLetter), 2);
}

TEST(Words, LabelsAreFacesOfASection) {
  Section section;
  section.faces = {{"S", 0, 1, 0, 0, ""}, {"W", 1, 0, kNoMirror, 0, ""}};
  section.coordinates = {{"s", "s_m", "m", "place", 1.0}};
  const auto words = std::make_shared<const dynamics::Words>(
      three_letters(false), 2, std::vector<dynamics::Words::Word>{{0, 1}});
  const Section labelled = dynamics::Words::labelled(section, words, false);
  EXPECT_EQ(names_of(labelled.faces), "S, W, S.a, W.a, S.b, W.b, S.ab, W.ab");
  labelled.validate();
  EXPECT_EQ(dynamics::Words::plain(labelled), section);
  // From S to W is letter b, from W to W is none.
  EXPECT_EQ(labelled.faces[static_cast<std::size_t>(words->next_label(0, {2, {}}, 1))].name,
            "W.ab");
  EXPECT_EQ(labelled.faces[static_cast<std::size_t>(words->next_label(0, {3, {}}, 1))].name, "W.a");
}

TEST(Words, FollowTheirTypesToOtherNumbers) {
  // In type 0 as above; in type 1 nothing counts.
  Letters letters = three_letters(false);
  letters.table.insert(letters.table.end(), 4, kNoLetter);
  const dynamics::Words words(letters, 1, {{0}, {1}, {2}});
  const auto renumbered = words.of_types({1, 0, 0});
  for (int in : {0, 1})
    for (int out : {0, 1}) {
      EXPECT_EQ(renumbered->next_label(0, {in, {}}, out), words.next_label(1, {in, {}}, out));
      for (const int type : {1, 2})
        EXPECT_EQ(renumbered->next_label(type, {in, {}}, out), words.next_label(0, {in, {}}, out));
    }
  EXPECT_NE(words.next_label(0, {0, {}}, 1), words.next_label(1, {0, {}}, 1));
}

TEST(Words, RefuseWhatCannotBe) {
  EXPECT_THROW(dynamics::Words(three_letters(false), 2, {{0, 1, 2}}), std::invalid_argument);
  EXPECT_THROW(dynamics::Words(three_letters(false), 2, {{3}}), std::invalid_argument);
  std::vector<dynamics::Words::Word> many;
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < 2187; ++i) {
      dynamics::Words::Word& word = many.emplace_back();
      for (int k = 0, rest = i; k < 7; ++k, rest /= 3) word.push_back(rest % 3);
      word.push_back(a);
    }
  EXPECT_THROW(dynamics::Words(three_letters(false), 8, many), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::dynamics
