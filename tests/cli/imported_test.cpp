// SPDX-License-Identifier: MIT
// Chains from elsewhere whose counts no matrix can hold.
#include "cli/exchange/imported.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

TEST(Imported, RefusesCountsWhoseSumIsNoCount) {
  constexpr int kStates = 70;
  std::vector<ForeignState> states;
  for (int s = 0; s < kStates; ++s) states.push_back({std::to_string(s), "ahead", 0, 1});
  const auto read = [&](int rows) {
    const std::string path = testing::TempDir() + "imported_counts.csv";
    std::ofstream file(path);
    file << "from,to,count\n";
    for (int from = 0; from < rows; ++from)
      for (int to = 0; to < kStates; ++to) file << from << ',' << to << ",1e15\n";
    file.close();
    return read_foreign(path, states).table.entries.size();
  };
  EXPECT_EQ(read(60), 60U * kStates);                     // 4.2e18
  EXPECT_THROW((void)read(kStates), std::runtime_error);  // 4.9e18, and 2^62 is 4.6e18
}

}  // namespace
}  // namespace gatewalk::cli
