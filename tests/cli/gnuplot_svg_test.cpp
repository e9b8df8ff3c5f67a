// SPDX-License-Identifier: MIT
#include "cli/terminal/gnuplot.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

struct DrawSvg : ::testing::Test {
  fs::path folder = fs::temp_directory_path() / ("gatewalk-drawing-" + std::to_string(::getpid()));
  std::string figure = (folder / "figure.svg").string();
  void SetUp() override {
    fs::create_directory(folder);
    std::ofstream(figure) << "old";
  }
  void TearDown() override { fs::remove_all(folder); }
  [[nodiscard]] std::string text() const {
    std::ifstream in(figure);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

// gnuplot looks into the folder while it draws: a kill then leaves only the old figure there.
TEST_F(DrawSvg, NothingLiesInTheFolderWhileItDraws) {
  const std::string listing = "system('ls -A " + folder.string() + " | tr \"\\n\" \" \"')";
  draw(figure,
       Figure{300, 200,
              "set label 1 'seen:'.(" + listing +
                  ").':end' at graph 0, graph 0.5 noenhanced\nplot sin(x)\n"},
       {});
  EXPECT_NE(text().find("seen:figure.svg :end"), std::string::npos) << text();
  EXPECT_NE(text().find("</svg>"), std::string::npos);
}

TEST_F(DrawSvg, KeepsPermissions) {
  fs::permissions(figure, fs::perms::owner_read | fs::perms::owner_write);
  draw(figure, Figure{300, 200, "plot sin(x)\n"}, {});
  EXPECT_EQ(fs::status(figure).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(DrawSvg, FailureKeepsTheOldFigure) {
  EXPECT_THROW(draw(figure, Figure{300, 200, "plot nonsense nowhere\n"}, {}), std::runtime_error);
  EXPECT_EQ(text(), "old");
}

}  // namespace
}  // namespace gatewalk::cli
