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
    const std::string name = "scenes/" + entry.path().filename().string();
    EXPECT_TRUE(carried_file(name) == bytes_of(entry.path())) << name;
    ++scenes;
  }
  EXPECT_GT(scenes, 0);
}

TEST(WebFiles, CarriesLibrariesWithTheirLicences) {
  const fs::path npm = kRoot / "cli" / "web" / "node_modules";
  EXPECT_TRUE(carried_file("vega.min.js") == bytes_of(npm / "vega" / "build" / "vega.min.js"));
  EXPECT_TRUE(carried_file("plotly-gl3d.min.js") ==
              bytes_of(npm / "plotly.js-gl3d-dist-min" / "plotly-gl3d.min.js"));
  for (const char* name :
       {"vega.LICENSE", "vega-lite.LICENSE", "vega-embed.LICENSE", "plotly.LICENSE"}) {
    EXPECT_NE(carried_file(name).find("Copyright"), std::string_view::npos) << name;
  }
}

TEST(WebFiles, UnknownNameThrows) {
  EXPECT_THROW((void)carried_file("scenes/none.toml"), std::logic_error);
  EXPECT_THROW((void)carried_file(""), std::logic_error);
}

}  // namespace
}  // namespace gatewalk::cli
