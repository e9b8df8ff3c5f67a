// SPDX-License-Identifier: MIT
#pragma once
/// The full counts of the requirements take minutes; GATEWALK_LONG=1 enables them:
///     GATEWALK_LONG=1 build/tests/dynamics_tests --gtest_filter='*HeldContacts*'

#include <cstdlib>
#include <string_view>

namespace gatewalk::test {

inline int usual_or_full(int usual, int full) {
  const char* const wanted = std::getenv("GATEWALK_LONG");
  return wanted != nullptr && std::string_view(wanted) == "1" ? full : usual;
}

}  // namespace gatewalk::test
