// SPDX-License-Identifier: MIT
#include "cli/render/recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/final_gates.h"
#include "lattice/pool/pooled_prediction.h"

namespace gatewalk::cli {
namespace {

void add(RecordedCounts& counts, const lattice::PassageTable& passages) {
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const dynamics::Fate fate = passages[i].fate;
    ++(fate == dynamics::Fate::left      ? counts.left
       : fate == dynamics::Fate::trapped ? counts.trapped
                                         : counts.lost);
  }
}

/// The number of bodies that were lost in at least one of their trials.
std::int64_t bodies_lost(const lattice::FieldTrials& each) {
  std::set<std::int32_t> lost;
  for (std::size_t i = 0; i < each.bodies.size(); ++i) {
    const auto begin = static_cast<std::size_t>(i == 0 ? 0 : each.passed[i - 1]),
               end = static_cast<std::size_t>(each.passed[i]);
    for (std::size_t k = begin; k < end; ++k)
      if (each.passages[k].fate == dynamics::Fate::broken) lost.insert(each.bodies[i]);
  }
  return std::ssize(lost);
}

}  // namespace

RecordedCounts counts_of(const lattice::RunPool& pool) {
  RecordedCounts counts{pool.bodies(), pool.trials(), pool.gate_runs()};
  counts.bodies_lost = bodies_lost(pool.scattered.each);
  add(counts, pool.scattered.each.passages);
  for (const lattice::OwnRuns& s : pool.starts) {
    add(counts, s.full.passages);
    add(counts, s.first.passages);
  }
  return counts;
}

void describe(Fields& out, const RecordedCounts& counts) {
  out.count({"bodies", "1", "number of different bodies"}, counts.bodies);
  out.count({"trials", "1", "number of trials: paths of a body through the field"}, counts.trials);
  out.count({"passages", "1", "number of passages of a body through one cell"}, counts.passages);
  out.count({"left", "1", "number of passages that left their cell"}, counts.left);
  out.count({"trapped", "1", "number of passages in which the body was trapped"}, counts.trapped);
  out.count({"lost", "1", "number of passages in which the body was lost from sight"}, counts.lost);
}

void describe_recorded(Fields& out, const RecordedCounts& counts) {
  out.object({"recorded", "the recorded runs behind the result"},
             [&](Fields& f) { describe(f, counts); });
}

namespace {

/// "30 of the 48 bodies"
std::string lost_of(const RecordedCounts& counts) {
  return fmt::format("{} of the {} bodies", counts.bodies_lost, counts.bodies);
}

}  // namespace

std::string table_of(const lattice::RunPool& pool) { return table_of(counts_of(pool)); }

std::string table_of(const RecordedCounts& counts) {
  return fmt::format(
      "Recorded: {} bodies, {} trials, {} passages; {} left their cell, {} were trapped, {} "
      "lost.\n{}",
      counts.bodies, counts.trials, counts.passages, counts.left, counts.trapped, counts.lost,
      counts.bodies_lost > 0 ? fmt::format("{} were lost from sight in a cell.\n", lost_of(counts))
                             : "");
}

void describe_lost_bounds(Fields& out, const lattice::LostBounds& bounds) {
  out.optional(bounds.lost > 0.0, [&](Fields& f) {
    f.object(
        {"lost_bounds", "endings if all bodies lost from sight had met one fate"}, [&](Fields& b) {
          b.number(
              {"lost_share", "1", "share of the passages in which the body was lost from sight"},
              bounds.lost);
          describe_endings(b,
                           {"if_trapped", "shares by ending if all lost bodies had been trapped"},
                           bounds.final[0].endings);
          describe_endings(b,
                           {"if_left", "shares by ending if all lost bodies had left their cell"},
                           bounds.final[1].endings);
        });
  });
}

std::string table_of(const lattice::LostBounds& bounds) {
  if (!(bounds.lost > 0.0)) return "";
  TextTable table({{"", -11}, {"all trapped", 11, 0, "", "  "}, {"all left", 11, 0, "", "  "}});
  for (const EndingName& e : kEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    table.row({e.name, percents(bounds.final[0].endings[at]) + " %",
               percents(bounds.final[1].endings[at]) + " %"});
  }
  return fmt::format(
      "{} of the passages were lost from sight and are left out; no interval counts them. The "
      "endings\nif all lost bodies had been trapped, and if all had left their cell:\n{}",
      percent(bounds.lost, 1.0, 2), table.text());
}

std::string beware_of_lost(const RecordedCounts& counts, const lattice::LostBounds& bounds,
                           const lattice::EndingShares& answer) {
  if (!(bounds.lost > 0.0)) return "";
  constexpr double kVisible = 0.0005;  // of an ending's share
  constexpr std::size_t kMostShown = 3;
  struct Moved {
    double by;
    std::string text;
  };
  std::vector<Moved> moved;
  for (const EndingName& e : kEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    const double trapped = bounds.final[0].endings[at], left = bounds.final[1].endings[at],
                 by = std::abs(left - trapped);
    const auto [low, high] = answer.interval[at];
    const bool inside = std::min(trapped, left) >= low && std::max(trapped, left) <= high;
    if (by < kVisible || (inside && by <= high - low)) continue;
    moved.push_back({by, fmt::format("{} {} or {} %", e.name, percents(trapped), percents(left))});
  }
  std::ranges::stable_sort(moved, std::ranges::greater(), &Moved::by);
  if (moved.size() > kMostShown) moved.resize(kMostShown);
  const std::string lost = fmt::format("Beware: {} were lost from sight, in {} of the passages",
                                       lost_of(counts), percent(bounds.lost, 1.0, 2));
  if (moved.empty())
    return lost +
           ".\nThe answer stays inside the intervals if all these bodies had been trapped, or all "
           "had left.\n";
  std::vector<std::string> texts;
  for (const Moved& m : moved) texts.push_back(m.text);
  return lost +
         ".\nNo interval counts this loss. If all these bodies had been trapped, or all had left "
         "their "
         "cell:\n" +
         wrapped(fmt::format("  {}.", fmt::join(texts, "; ")), "  ");
}

}  // namespace gatewalk::cli
