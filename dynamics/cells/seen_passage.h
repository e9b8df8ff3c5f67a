// SPDX-License-Identifier: MIT
#pragma once
/// An observed passage, for comparing repeated passages. Not part of the installed headers.

#include <string>

#include "dynamics/cells/cell.h"

namespace gatewalk::dynamics {

/// A passage as the cell returned it, with the body's entry afterwards.
struct SeenPassage {
  Passage passage;
  Entry body;

  /// Whether both passages are equal to the last bit.
  [[nodiscard]] bool same_as(const SeenPassage& other) const;
  /// The passage in words: "left by S (s = 0.1), time_s = 2".
  [[nodiscard]] std::string words(const Section& section) const;
};

/// The entry in words: "S (s = 0.1, vx = 2)".
[[nodiscard]] std::string words_of(const Section& section, const Entry& entry);

}  // namespace gatewalk::dynamics
