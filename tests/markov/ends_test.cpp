// SPDX-License-Identifier: MIT
#include "markov/ends.h"

#include <gtest/gtest.h>

namespace gatewalk::markov {
namespace {

using Counted = Ends<std::int64_t>;

/// A field of four cells; in cells that `mixed` does not list, all bodies are trapped.
Counted ends(const std::array<std::int64_t, 4>& final_cells,
             std::vector<CellEndings<std::int64_t>> mixed) {
  Counted e;
  e.final_cells = Eigen::Map<const CellCounts>(final_cells.data(), 2, 2);
  e.mixed_cells = std::move(mixed);
  const CellCounts trapped = trapped_cells(e);
  e.endings.front() = trapped.sum();
  for (const auto& c : e.mixed_cells)
    for (std::size_t i = 1; i < kEndings; ++i) e.endings[i] += c.by_ending[i];
  return e;
}

CellEndings<std::int64_t> cell(std::int64_t at, std::int64_t trapped, std::int64_t right,
                               std::int64_t cut_off) {
  CellEndings<std::int64_t> c{at};
  c[Ending::trapped] = trapped;
  c[Ending::right_edge] = right;
  c[Ending::cut_off] = cut_off;
  return c;
}

// Cells that are mixed in both, in one or in the other.
TEST(Ends, AddCellByCellAndByEnding) {
  Counted sum = ends({5, 3, 0, 7}, {cell(1, 1, 2, 0), cell(3, 4, 2, 1)});
  sum += ends({2, 2, 1, 4}, {cell(0, 0, 0, 2), cell(3, 1, 3, 0)});
  EXPECT_EQ(sum.mixed_cells, (std::vector{cell(0, 5, 0, 2), cell(1, 3, 2, 0), cell(3, 5, 5, 1)}));
  EXPECT_EQ(sum.final_cells.sum(), 24);
  EXPECT_EQ(sum.trapped(), 14);
  EXPECT_EQ(sum.left_field(), 7);
  EXPECT_EQ(sum.cut_off(), 3);
  EXPECT_EQ(sum.unsampled(), 0);
  EXPECT_EQ(trapped_cells(sum).sum(), sum.trapped());
  EXPECT_EQ(departed_cells(sum)(1, 1), 5);
  EXPECT_EQ(departed_cells(sum).sum(), sum.left_field());
}

// Ends of a field, or of walks without cells.
TEST(Ends, AddEndingsWithoutCells) {
  const Counted some = ends({5, 3, 0, 7}, {cell(1, 1, 2, 0)});
  Counted without;
  without.endings[static_cast<std::size_t>(Ending::trapped)] = 4;
  Counted before = without, behind = some;
  before += some;
  behind += without;
  for (const Counted& sum : {before, behind}) {
    EXPECT_EQ(sum.trapped(), some.trapped() + 4);
    EXPECT_EQ(sum.left_field(), 2);
    EXPECT_EQ(sum.final_cells.sum(), 15);
    EXPECT_EQ(sum.mixed_cells, some.mixed_cells);
  }
}

TEST(Ends, AreSharesOfAll) {
  const Counted counts = ends({5, 3, 0, 2}, {cell(1, 1, 2, 0)});
  const Ends<double> shares =
      shares_of(counts, [](std::int64_t n) { return 0.5 * static_cast<double>(n); });
  EXPECT_EQ(shares.final_cells(0, 1), 1.5);
  EXPECT_EQ(shares.trapped(), 4.0);
  EXPECT_EQ(shares.left_field(), 1.0);
  ASSERT_EQ(shares.mixed_cells.size(), 1U);
  EXPECT_EQ(shares.mixed_cells[0].cell, 1);
  EXPECT_EQ(shares.mixed_cells[0][Ending::right_edge], 1.0);
}

}  // namespace
}  // namespace gatewalk::markov
