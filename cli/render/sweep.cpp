// SPDX-License-Identifier: MIT
#include "cli/render/sweep.h"

#include <fmt/core.h>

#include "cli/render/choice.h"
#include "cli/render/csv.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/render/text_table.h"
#include "dynamics/base/share.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {
namespace {

using dynamics::Outcome;
using dynamics::share_interval;
using lattice::SweepAxis;
using lattice::SweepPoint;

/// What a share is of, and how many of those. Right of those that pushed more past one beam than
/// past the other: the paper's Fig. 12.
struct Part {
  const char* name;
  std::int64_t part, whole;
};
std::vector<Part> shares_of(const dynamics::GateTally& t) {
  return {{"traversed", t.traversed(), t.trials},
          {"traversed_left", t[Outcome::traversed_left], t.trials},
          {"traversed_right", t[Outcome::traversed_right], t.trials},
          {"exited", t.exited(), t.trials},
          {"trapped", t[Outcome::trapped], t.trials},
          {"right_of_traversed", t[Outcome::traversed_right],
           t[Outcome::traversed_left] + t[Outcome::traversed_right]}};
}

/// "  5.1 [3.9, 6.6]    ", in %
std::string share_text(const Part& s) {
  if (s.whole == 0) return fmt::format("{:>6}{:16}", "-", "");
  const auto [low, high] = share_interval(s.part, s.whole);
  return fmt::format("{:>6}{:16}",
                     fixed(100.0 * static_cast<double>(s.part) / static_cast<double>(s.whole), 1),
                     fmt::format(" [{}, {}]", fixed(100.0 * low, 1), fixed(100.0 * high, 1)));
}

void describe(Fields& out, const std::vector<SweepAxis>& axes, const SweepPoint& p) {
  out.object({"at", "values of the varied keys at this point"}, [&](Fields& at) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      at.given(
          Field(axes[i].key, "its own", "value of this key of the scene; the key names the unit")
              .varying("<key>"),
          p.values[i]);
  });
  const Part right = shares_of(p.tally).back();
  describe(out, p.tally);
  out.optional(right.whole > 0, [&](Fields& f) {
    f.estimate({right.name, "1", "traversed_right / (traversed_left + traversed_right)"},
               static_cast<double>(right.part) / static_cast<double>(right.whole),
               share_interval(right.part, right.whole));
  });
  describe_method(out, p.settled);
  describe_status(out, p.tally.health);
}

}  // namespace

void describe(Fields& out, const SweepResult& result) {
  out.list({"vary", "the keys of the scene that are varied"}, result.axes,
           [](Fields& f, const SweepAxis& axis) {
             f.text({"key", "name of the varied key of the scene"}, axis.key);
             f.givens({"values", "its own",
                       "values of this key, in their order; the key names the unit"},
                      axis.values);
           });
  out.list({"points", "every combination of the values, the last key varying fastest"},
           result.points,
           [&](Fields& f, const SweepPoint& point) { describe(f, result.axes, point); });
  describe_made_by(out, result.made_by);
}

std::string csv_of(const SweepResult& result) {
  lattice::TextStream out;
  for (const SweepAxis& axis : result.axes) out << axis.key << ',';
  out << "method,trials";
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames) out << ',' << key << "_count";
  for (const Part& s : shares_of({}))
    out << ',' << s.name << ',' << s.name << "_low," << s.name << "_high";
  out << ",clean\n";
  for (const SweepPoint& p : result.points) {
    const dynamics::GateTally& t = p.tally;
    for (const std::string& value : p.values) out << csv_text(value) << ',';
    out << p.scene.gate.run.method << ',' << t.trials;
    for (const std::int64_t n : t.counts) out << ',' << n;
    for (const Part& s : shares_of(t)) {
      if (s.whole == 0) {
        out << ",,,";  // of none there is no share
        continue;
      }
      const auto [low, high] = share_interval(s.part, s.whole);
      for (const double x : {static_cast<double>(s.part) / static_cast<double>(s.whole), low, high})
        out << ',' << digits(x, 8);
    }
    out << ',' << t.health.clean() << '\n';
  }
  return out.str();
}

std::string table_of(const SweepResult& result, const lattice::Scene& scene) {
  std::vector<TextColumn> columns;
  for (const SweepAxis& axis : result.axes) columns.push_back({axis.key, kFit, 0, "", "  "});
  columns.push_back({"   traversed             right of those        exited   trapped"});
  TextTable table(columns);
  for (const SweepPoint& p : result.points) {
    std::vector<TextCell> cells(p.values.begin(), p.values.end());
    const auto shares = shares_of(p.tally);
    const auto share = [&](std::size_t i) {
      return percent(static_cast<double>(shares[i].part), static_cast<double>(shares[i].whole));
    };
    cells.emplace_back(fmt::format("    {}{}{:>8}{:>10}{}", share_text(shares[0]),
                                   share_text(shares[5]), share(3), share(4),
                                   p.tally.health.clean() ? "" : "  faults"));
    table.row(cells);
  }
  return fmt::format(
      "{}but for the keys varied. {} points of {} trials, all under the same noise; % of them with "
      "95 % intervals.\n\n{}",
      scene_line(scene), result.points.size(), result.points.front().tally.trials, table.text());
}

}  // namespace gatewalk::cli
