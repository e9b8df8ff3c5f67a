// SPDX-License-Identifier: MIT
#pragma once
/// What was seen of a passage, to be compared. Not part of the installed headers.

#include <string>

#include "dynamics/cells/cell.h"

namespace gatewalk::dynamics {

/// What a passage said, and how the body then was.
struct SeenPassage {
  Passage passage;
  Entry body;

  /// To the last bit.
  [[nodiscard]] bool same_as(const SeenPassage& other) const;
  /// "left by S (s = 0.1), time_s = 2"
  [[nodiscard]] std::string words(const Section& section) const;
};

/// "S (s = 0.1, vx = 2)"
[[nodiscard]] std::string words_of(const Section& section, const Entry& entry);

}  // namespace gatewalk::dynamics
