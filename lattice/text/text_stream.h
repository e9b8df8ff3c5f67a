// SPDX-License-Identifier: MIT
#pragma once
/// A text stream that reports errors.

#include <locale>
#include <sstream>

namespace gatewalk::lattice {

/// A stream into a text that throws if memory runs out, and that ignores the process's locale. (A
/// std::ostringstream would drop the rest silently, and may group digits.) Numbers other than whole
/// numbers are written by fmt.
struct TextStream : std::ostringstream {
  TextStream() {
    imbue(std::locale::classic());
    exceptions(std::ios_base::badbit);
  }
};

}  // namespace gatewalk::lattice
