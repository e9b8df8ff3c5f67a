// SPDX-License-Identifier: MIT
#include "cli/terminal/gnuplot.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace gatewalk::cli {
namespace {

/// The message that `work` throws; empty if none.
template <class Work>
std::string complaint_of(Work work) {
  try {
    work();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

TEST(Figure, DrawnGivesTheFigure) {
  const std::string svg = drawn("set terminal svg\n$d << EOD\n1 2\n3 4\nEOD\nplot $d with lines\n");
  EXPECT_NE(svg.find("<svg"), svg.npos);
  EXPECT_NE(svg.find("</svg>"), svg.npos);
}

// More than a pipe holds, in both directions.
TEST(Figure, LargeScriptsAndFigures) {
  std::string script = "set terminal svg\n$d << EOD\n";
  for (int i = 0; i < 30'000; ++i) script += std::to_string(i) + " " + std::to_string(i % 7) + "\n";
  const std::string svg = drawn(script + "EOD\nplot $d with points\n");
  EXPECT_GT(script.size(), 200'000U);
  EXPECT_GT(svg.size(), 200'000U);
}

TEST(Figure, FailuresCarryGnuplotsWords) {
  const std::string words =
      complaint_of([] { (void)drawn("set terminal svg\n\nplot nonsense nowhere\n"); });
  EXPECT_NE(words.find("gnuplot failed"), words.npos) << words;
  EXPECT_NE(words.find("nonsense"), words.npos) << words;
  EXPECT_NE(words.find("line 3"), words.npos) << words;
}

TEST(Figure, MissingGnuplotIsSaid) {
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", "/nonexistent", 1);
  const std::string words = complaint_of([] { (void)drawn("plot sin(x)\n"); });
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_NE(words.find("gnuplot was not found"), words.npos) << words;
}

}  // namespace
}  // namespace gatewalk::cli
