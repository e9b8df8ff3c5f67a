// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/render/matrix.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

using dynamics::StateSpace;
using dynamics::Transitions;

/// States of one boundary, the starts, or the column of the trapped, with their place in the
/// picture.
struct StateGroup {
  std::string name;
  int first, states, blocks;
  double from = 0.0, size = 0.0;  // px

  [[nodiscard]] double edge(int block) const { return from + size * block / blocks; }
};

constexpr double kSide = 330.0, kGap = 3.0, kLeast = 18.0;
constexpr int kMostBlocks = 120;  // about, each way

/// Widths in proportion to the blocks, but none less than kLeast.
void place(std::vector<StateGroup>& groups) {
  const double room = kSide - kGap * static_cast<double>(groups.size() - 1);
  const auto taken = [&](double each) {
    double sum = 0.0;
    for (const StateGroup& g : groups) sum += std::max(kLeast, each * g.blocks);
    return sum;
  };
  double low = 0.0, high = room;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (taken(middle) < room ? low : high) = middle;
  }
  double at = 0.0;
  for (StateGroup& g : groups) {
    g.from = at;
    g.size = std::max(kLeast, low * g.blocks);
    at += g.size + kGap;
  }
}

std::vector<StateGroup> groups_of(const StateSpace& space, int per_block, bool with_trapped) {
  std::vector<StateGroup> groups;
  const auto add = [&](const std::string& name, int first, int states) {
    if (states > 0) groups.push_back({name, first, states, (states + per_block - 1) / per_block});
  };
  const int starts = static_cast<int>(space.points().size()), all = space.size();
  const auto faces = static_cast<int>(space.section().faces.size());
  for (int face = 0; face < faces; ++face) {
    const int first = space.first(face);
    const int next = face + 1 < faces ? space.first(face + 1) : all - starts;
    add(space.section().faces[face].name, first, next - first);
  }
  add(starts == 1 ? "start" : "starts", all - starts, starts);
  if (with_trapped) add("trapped", space.trapped(), 1);
  place(groups);
  return groups;
}

/// Chances, in %, of the blocks of a group of rows to those of a group of columns; below zero where
/// no row has runs.
std::vector<std::vector<double>> chances(const Transitions& t, const StateGroup& rows,
                                         const StateGroup& columns, int per_block) {
  std::vector<std::vector<double>> all(static_cast<std::size_t>(rows.blocks));
  for (int i = 0; i < rows.blocks; ++i) {
    std::vector<double>& sums = all[static_cast<std::size_t>(i)];
    sums.assign(static_cast<std::size_t>(columns.blocks), 0.0);
    int sampled = 0;
    for (int row = i * per_block; row < std::min(rows.states, (i + 1) * per_block); ++row) {
      const auto at = static_cast<std::size_t>(rows.first + row);
      std::int64_t runs = 0;
      for (const auto& [column, count] : t.rows[at]) runs += count;
      if (runs == 0) continue;
      ++sampled;
      for (auto it = t.rows[at].lower_bound(columns.first);
           it != t.rows[at].end() && it->first < columns.first + columns.states; ++it)
        sums[static_cast<std::size_t>((it->first - columns.first) / per_block)] +=
            100.0 * static_cast<double>(it->second) / static_cast<double>(runs);
    }
    for (double& s : sums) s = sampled == 0 ? -1.0 : s / sampled;
  }
  return all;
}

}  // namespace

Figure figure_of(const Transitions& t) {
  const int per_block = (t.space.size() - 1) / kMostBlocks + 1;
  const auto rows = groups_of(t.space, per_block, false),
             columns = groups_of(t.space, per_block, true);
  constexpr double kLeft = 84, kTop = 44;
  Panels out("unset key\n");
  Rows& cells = out.data("$cells");
  Panel& panel = out.add({kLeft, kLeft + kSide, kTop, kTop + kSide});
  double most = 0.0;
  int object = 0;
  const auto rectangle = [&](const StateGroup& r, int begin, int end, const StateGroup& c,
                             const char* colour) {
    panel.more += fmt::format(
        "set object {} rectangle from {},{} to {},{} behind fillcolor rgb '{}' fillstyle solid "
        "noborder\n",
        ++object, digits(c.from), digits(r.edge(begin)), digits(c.from + c.size),
        digits(r.edge(end)), colour);
  };
  for (const StateGroup& r : rows)
    for (const StateGroup& c : columns) {
      rectangle(r, 0, r.blocks, c, "#e4e4e4");
      const auto shares = chances(t, r, c, per_block);
      for (int i = 0; i < r.blocks; ++i)
        for (int k = 0; k < c.blocks; ++k) {
          const double share = shares[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
          if (share < 0.0 && k == 0) rectangle(r, i, i + 1, c, "#ffffff");
          if (share <= 0.0) continue;
          most = std::max(most, share);
          cells.add(0.5 * (c.edge(k) + c.edge(k + 1)), 0.5 * (r.edge(i) + r.edge(i + 1)), c.edge(k),
                    c.edge(k + 1), r.edge(i), r.edge(i + 1), std::sqrt(share));
        }
    }
  const auto name = [&](const std::string& text, double x, double y, const char* how) {
    panel.texts.push_back({text, x, y, kSmallFont, how, true});
  };
  for (const StateGroup& r : rows)
    name(r.name + (r.states > 1 ? fmt::format(" {}", r.states) : ""), -6, r.from + 0.5 * r.size,
         "right");
  for (const StateGroup& c : columns)
    name(c.name, c.from + 0.5 * c.size, kSide + 8,
         c.size > 8.0 * static_cast<double>(c.name.size()) ? "center offset 0,-0.3"
                                                           : "right rotate by 90");
  panel.say(
      fmt::format("transition matrix: {} states, {} counts{}", t.space.size(), t.totals().runs,
                  per_block > 1 ? fmt::format(", blocks of {}", per_block) : ""),
      8, 18);
  panel.say("down: how a gate is entered; across: how the next one is, or trapped", 8,
            panel.box.bottom + 76, kSmallFont);
  panel.say("grey: no run ended here; white: none began here", 8, panel.box.bottom + 96,
            kSmallFont);
  panel.border = 0;
  panel.x = {"", 0, kSide, kNoTics};
  panel.y = {"", kSide, 0, kNoTics};
  add_colours(panel, RootScale(most), panel.box.beside(14, 12));
  panel.draw(cells, "1:2:3:4:5:6:7", kBars, {kByPalette});
  return out.figure(static_cast<int>(panel.box.bottom + 112));
}

}  // namespace gatewalk::cli
