// SPDX-License-Identifier: MIT
#include "cli/web/embedded.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = fs::path(__FILE__).parent_path() / ".." / "..";

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(WebFiles, CarriesEverySceneByteForByte) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(kRoot / "scenes")) {
    if (entry.is_directory()) continue;  // skips a folder: example programs
    const std::string name = "scenes/" + entry.path().filename().string();
    EXPECT_TRUE(carried_file(name) == bytes_of(entry.path())) << name;
    ++scenes;
  }
  EXPECT_GT(scenes, 0);
}

TEST(WebFiles, UnknownNameThrows) {
  EXPECT_THROW((void)carried_file("scenes/none.toml"), std::logic_error);
  EXPECT_THROW((void)carried_file(""), std::logic_error);
}

}  // namespace
}  // namespace gatewalk::cli
