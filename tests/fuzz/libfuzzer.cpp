// SPDX-License-Identifier: MIT
// One target as libFuzzer calls it; GATEWALK_FUZZED is its name.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  gatewalk::fuzz::GATEWALK_FUZZED({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
