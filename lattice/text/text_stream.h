// SPDX-License-Identifier: MIT
#pragma once
/// Streams that say what goes wrong.

#include <locale>
#include <sstream>

namespace gatewalk::lattice {

/// Writes into a text, and throws where memory for it is missing. Other streams then leave out the
/// rest without a word, and write whole numbers in groups where the process's locale has some.
/// Others than whole numbers are written by fmt.
struct TextStream : std::ostringstream {
  TextStream() {
    imbue(std::locale::classic());
    exceptions(std::ios_base::badbit);
  }
};

}  // namespace gatewalk::lattice
