// SPDX-License-Identifier: MIT
#pragma once
/// Streams that say what goes wrong.

#include <sstream>

namespace gatewalk::lattice {

/// Writes into a text, and throws where memory for it is missing. Other streams then leave out the
/// rest without a word.
struct TextStream : std::ostringstream {
  TextStream() { exceptions(std::ios_base::badbit); }
};

}  // namespace gatewalk::lattice
