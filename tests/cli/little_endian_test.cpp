// SPDX-License-Identifier: MIT
#include "cli/render/little_endian.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace gatewalk::cli {
namespace {

// Holds on machines of either byte order.
TEST(LittleEndian, BytesAreAsFilesHaveThem) {
  EXPECT_EQ(all_little_endian(std::vector<std::uint16_t>{0x0102, 3}), std::string("\2\1\3\0", 4));
  EXPECT_EQ(all_little_endian(std::vector<std::int64_t>{-2}), "\xfe\xff\xff\xff\xff\xff\xff\xff");
  EXPECT_EQ(all_little_endian(std::vector<double>{1.5}), std::string("\0\0\0\0\0\0\xf8\x3f", 8));
}

TEST(LittleEndian, AreReadAgain) {
  EXPECT_EQ(from_little_endian<std::int32_t>(little_endian(std::int32_t{-70000})), -70000);
  EXPECT_EQ(from_little_endian<double>(little_endian(-1e-300)), -1e-300);
}

}  // namespace
}  // namespace gatewalk::cli
