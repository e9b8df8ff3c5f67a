// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/render/final_gates.h"
#include "cli/render/observed.h"
#include "cli/render/panel.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {
namespace {

/// A share as it is drawn; without an interval low and high are the share.
struct DrawnShare {
  double share, low, high;
};
/// What is counted in one row, as it was observed, by the dynamics, by the chain.
struct ComparedShare {
  std::string name;
  std::array<DrawnShare, 3> shares;
};
constexpr std::array<const char*, 3> kCompared{"observed", "dynamics", "chain"};
constexpr std::array<const char*, 3> kInks{kSecondColour, kFirstColour, kThirdColour};
constexpr std::array<int, 3> kSymbols{7, 6, 4};  // a dot, a ring, a square

DrawnShare drawn_share(double share, const std::array<double, 2>& interval) {
  if (std::isnan(interval[0])) return {share, share, share};
  return {share, interval[0], interval[1]};
}
DrawnShare drawn_share(std::int64_t count, std::int64_t trials) {
  return drawn_share(static_cast<double>(count) / static_cast<double>(trials),
                     dynamics::share_interval(count, trials));
}

std::vector<ComparedShare> compared_endings(const lattice::ObservedComparison& c,
                                            const lattice::StartValidation& v) {
  std::vector<ComparedShare> rows;
  for (const EndingName& e : kEndingNames) {
    if (c.endings.rules_out(e.ending)) continue;
    const auto of = [&](const lattice::EndingShares& all) {
      const auto at = static_cast<std::size_t>(e.ending);
      return drawn_share(all.share[at], all.interval[at]);
    };
    rows.push_back({e.name, {of(c.endings), of(v.dynamics_endings), of(v.exact_endings)}});
  }
  return rows;
}

/// The gates in which most end, by any of the three; the others together.
std::vector<ComparedShare> compared_gates(const lattice::ObservedComparison& c,
                                          const lattice::StartValidation& v,
                                          const lattice::FieldParams& field) {
  constexpr std::size_t kMostRows = 20;
  const markov::CellCounts &seen = c.seen.final_gates, &trials = v.dynamics.final_cells;
  const auto columns = static_cast<Eigen::Index>(field.columns);
  const std::int64_t n = seen.sum(), m = trials.sum();
  struct Gate {
    Eigen::Index row, column;
    double most;
  };
  std::vector<Gate> gates;
  for (Eigen::Index row = 0; row < seen.rows(); ++row)
    for (Eigen::Index column = 0; column < columns; ++column) {
      const double most =
          std::max({static_cast<double>(seen(row, column)) / static_cast<double>(n),
                    static_cast<double>(trials(row, column)) / static_cast<double>(m),
                    v.exact.final_cells(row, column)});
      if (most > 0.0) gates.push_back({row, column, most});
    }
  std::stable_sort(gates.begin(), gates.end(),
                   [](const Gate& a, const Gate& b) { return a.most > b.most; });
  std::vector<ComparedShare> rows;
  std::int64_t other_seen = n, other_trials = m;
  double other_chain = v.exact.final_cells.sum();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [row, column, most] : gates) {
    if (rows.size() == kMostRows) break;
    const double chain = v.exact.final_cells(row, column);
    other_seen -= seen(row, column);
    other_trials -= trials(row, column);
    other_chain -= chain;
    rows.push_back({fmt::format("{}, {}", column - field.start_column(), row),
                    {drawn_share(seen(row, column), n), drawn_share(trials(row, column), m),
                     drawn_share(chain, {kNone, kNone})}});
  }
  if (rows.size() < gates.size())
    rows.push_back({"others",
                    {drawn_share(other_seen, n), drawn_share(other_trials, m),
                     drawn_share(std::max(0.0, other_chain), {kNone, kNone})}});
  return rows;
}

/// A panel with three marks in each row, from `top` on; where the next one begins.
double add_compared(Panels& out, double top, const std::string& title, const std::string& kind,
                    double row_height, const std::vector<ComparedShare>& rows) {
  const auto count = static_cast<double>(rows.size());
  Panel& panel = out.add({110, 372, top + 36, top + 36 + row_height * count});
  std::vector<Layer> key;
  double most = 0.0;
  for (std::size_t k = 0; k < kCompared.size(); ++k) {
    Rows& data = out.data(fmt::format("${}_{}", kCompared[k], kind));
    bool has_intervals = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const DrawnShare& s = rows[i].shares[k];
      most = std::max(most, 100.0 * s.high);
      has_intervals = has_intervals || s.low < s.high;
      // One below the other, so that they do not hide each other.
      const double at = static_cast<double>(i) + 0.25 * (static_cast<double>(k) - 1.0);
      data.add(100.0 * s.share, at, 100.0 * s.low, 100.0 * s.high);
    }
    const Pen pen{kInks[k], 1.2, kSymbols[k], 0.6};
    panel.draw(data, has_intervals ? "1:2:3:4" : "1:2", has_intervals ? "xerrorbars" : "points",
               pen);
    key.push_back(entry("points", pen, kCompared[k]));
  }
  std::vector<std::string> names;
  for (const ComparedShare& row : rows) names.push_back(row.name);
  most = most > 0.0 ? std::min(100.0, 1.05 * most) : 100.0;
  panel.say(title, 8, top + 18);
  panel.x = {"% of trials, 95 %", 0, most, digits(tic_step(most, 5))};
  panel.y = {"", count - 0.5, -0.5, tics_of(names) + " scale 0 font ',12'"};
  const Box box = panel.box;
  out.add_key(388, box.top, std::move(key));
  return box.bottom + 54;
}

}  // namespace

Figure figure_of(const lattice::ObservedComparison& c, const lattice::StartValidation& v,
                 const lattice::FieldParams& field) {
  Panels out;
  out.say(fmt::format("{} trials observed, {} of the dynamics", c.seen.trials(), v.dynamics.trials),
          8, 16);
  out.say(fmt::format("against the dynamics {}, against the chain {}",
                      p_words(c.against_dynamics.p), p_words(c.against_chain.p)),
          8, 36, kSmallFont);
  double end = 46.0;
  if (c.seen.has_endings())
    end = add_compared(out, end, "endings", "endings", 28.0, compared_endings(c, v));
  if (c.seen.has_gates())
    end = add_compared(out, end, "final gates: column i_x, row i_y", "gates", 22.0,
                       compared_gates(c, v, field));
  return out.figure(static_cast<int>(std::ceil(end)));
}

}  // namespace gatewalk::cli
