// SPDX-License-Identifier: MIT
#include "cli/render/recorded.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

RecordedCounts counts_of(const lattice::RunPool& pool) {
  RecordedCounts counts{pool.bodies(), pool.trials(), pool.gate_runs()};
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

std::string table_of(const lattice::RunPool& pool) { return table_of(counts_of(pool)); }

std::string table_of(const RecordedCounts& counts) {
  return fmt::format(
      "Recorded: {} bodies, {} trials, {} passages; {} left their cell, {} were trapped, {} "
      "lost.\n",
      counts.bodies, counts.trials, counts.passages, counts.left, counts.trapped, counts.lost);
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

}  // namespace gatewalk::cli
