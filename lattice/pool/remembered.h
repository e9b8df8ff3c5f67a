// SPDX-License-Identifier: MIT
#pragma once
/// Chains that remember: the last turns of a body, or the faces by which it entered the cells
/// before, as a part of its state (dynamics/cells/words.h).

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "dynamics/cells/words.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// The largest order of a chain.
inline constexpr int kMostOrder = 8;

/// The letters of the passages of these cells.
///
/// Turns are left, straight, right and back, by the moves of both faces; where a face's move is no
/// step to a neighbouring cell, a turn is the pair of faces. A turn counts where cells of this type
/// have at least three open sides, which are those that a run of the pool came or went by; turning
/// back counts everywhere. `states`: the chain without words, for LettersOf::states.
[[nodiscard]] dynamics::Letters letters_of(
    dynamics::LettersOf of, const dynamics::CellMap& map, const RunPool& pool,
    std::shared_ptr<const dynamics::StateSpace> states = nullptr);

struct ChosenWords {
  std::shared_ptr<const dynamics::Words> words;
  std::int64_t left_out = 0;  // number of words beyond Words::kMostLabels, the rarest
};
/// The words with at most `order` letters that at least 2 `per_leaf` entries of the pool have.
[[nodiscard]] ChosenWords words_of(dynamics::Letters letters, const RunPool& pool, int order,
                                   int per_leaf);

/// The map with a face for each label. Without mirror images if words have none.
[[nodiscard]] dynamics::CellMap with_words(dynamics::CellMap map,
                                           std::shared_ptr<const dynamics::Words> words);
/// The pool with the labels of its runs. A body has the empty word where a trial begins.
[[nodiscard]] RunPool with_words(const RunPool& pool, const dynamics::CellMap& labelled);
/// The pool without words.
[[nodiscard]] RunPool without_words(const RunPool& pool, const dynamics::Section& labelled);

/// The words of a section's letters as text, and back. LettersOf::states has no text. words_in
/// throws std::invalid_argument for text that is damaged.
[[nodiscard]] std::string text_of(const dynamics::Words& words);
[[nodiscard]] std::shared_ptr<const dynamics::Words> words_in(std::string_view text,
                                                              const dynamics::CellMap& plain);

/// "turns", "faces" or "states".
[[nodiscard]] std::string_view name_of(dynamics::LettersOf of);

}  // namespace gatewalk::lattice
