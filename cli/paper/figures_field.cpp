// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/paper/figures.h"
#include "cli/render/provenance.h"
#include "cli/render/quantity.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

namespace {

/// A final gate.
struct Cell {
  double i_x, i_y;
  std::int64_t trials;     // trials that ended there
  double dynamics, chain;  // shares of all trials
  double departed_dynamics,
      departed_chain;  // shares of all trials that left the field from this gate
};

/// The final gates of a start, row by row.
std::vector<Cell> cells_of(const ValidatedStart& start, std::int64_t trials) {
  const auto n = static_cast<double>(trials);
  std::vector<Cell> cells;
  for (std::size_t y = 0; y < start.counts.size(); ++y)
    for (std::size_t x = 0; x < start.counts[y].size(); ++x)
      cells.push_back({static_cast<double>(x) - static_cast<double>(start.counts[y].size() / 2),
                       static_cast<double>(y), std::llround(start.counts[y][x]),
                       start.counts[y][x] / n, start.chain[y][x], start.departed_counts[y][x] / n,
                       start.departed_chain[y][x]});
  return cells;
}

Figure drawn_fig11(const std::string& start, std::vector<Cell> cells, std::int64_t trials) {
  Panels out = paper_panels();
  Rows* const maps[] = {&out.data("$dynamics"), &out.data("$chain"), &out.data("$difference")};
  Rows& pairs = out.data("$pairs");
  double most = 0.0, largest = 1e-6, highest = 0.0;  // %, percentage points, square root of %
  for (const Cell& c : cells) {
    most = std::max({most, 100.0 * c.chain, 100.0 * c.dynamics});
    largest = std::max(largest, 100.0 * std::abs(c.dynamics - c.chain));
    const auto add = [&](int i, double shown, double share, double departed) {
      maps[i]->add(c.i_x, c.i_y, shown, departed > 0.5 * share ? 1 : 0);
    };
    add(0, root_percent(c.dynamics), c.dynamics, c.departed_dynamics);
    add(1, root_percent(c.chain), c.chain, c.departed_chain);
    add(2, 100.0 * (c.dynamics - c.chain), 0.0, 0.0);
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.dynamics > b.dynamics; });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [low, high] = dynamics::share_interval(cells[i].trials, trials);
    highest = std::max({highest, root_percent(high), root_percent(cells[i].chain)});
    pairs.add(i + 1, root_percent(low), root_percent(high), root_percent(cells[i].chain));
  }
  constexpr double kLeft = 58, kWide = 132, kGap = 12, kTop = 66;
  const double bottom = kTop + kWide, bar = bottom + 54;
  const auto left_of = [](int i) { return kLeft + i * (kWide + kGap); };
  const RootScale scale(most);
  const std::string tic = short_number(0.7 * largest);
  const char* const heads[] = {"A  dynamics, %", "chain, %", "dynamics − chain, points"};
  out.say(as_printed(fmt::format("final gates, n = {}; start {}", trials, start)), 8, 18);
  for (int i = 0; i < 3; ++i) {
    Panel& map = add_panel(out, {left_of(i), left_of(i) + kWide, kTop, bottom},
                           i == 1 ? "column i_x" : "", i == 0 ? "row i_y" : "");
    map.tics_font = kSmallFont;
    map.border = 15;
    map.x = {"", -4.5, 4.5, "4"};
    map.y = {"", -0.5, 8.5, "4", "", i == 0};
    // A colour bar below the maps of shares, and one below the map of differences.
    const auto bar_with = [&](int first, int last, const std::string& tics) {
      map.colours->bar = {left_of(first), left_of(last) + kWide, bar, bar + 10};
      map.colours->tics = tics + " font ',12' scale 0.5 offset 0,0.4";
    };
    map.colours = i < 2 ? Colours{0, std::sqrt(scale.most())} : Colours{-largest, largest};
    if (i == 1) {
      bar_with(0, 1, fmt::format("({})", scale.tics()));
      map.say(as_printed("root scale; circle: most of those departed from this gate"), left_of(0),
              bar + 46, kSmallFont);
    }
    if (i == 2) {
      map.colours->palette = kDiverging;
      bar_with(2, 2, fmt::format("('−{}' -{}, '0' 0, '+{}' {})", tic, tic, tic, tic));
    }
    map.say(as_printed(heads[i]), left_of(i), kTop - 11, kSmallFont);
    map.draw_cells(*maps[i]);
    if (i < 2)
      map.draw_again("1:($4 > 0 ? $2 : NaN):" + ink(std::sqrt(most)), "points",
                     {.colour = kOwnColour, .mark = 6, .size = 0.5});
  }
  const Box below{66, 488, bottom + 200, bottom + 364};
  Panel& panel =
      add_panel(out, below, "gates, as the dynamics rank them", "% of trials (root scale)", 52);
  panel.say(as_printed("B  gate by gate"), 8, below.top - 62);
  panel.grid = std::string("ytics") + kGrid;
  panel.x = {"", 0, static_cast<double>(cells.size() + 1), "10"};
  panel.y = {"", -0.05, 1.03 * highest, fmt::format("({})", scale.tics())};
  panel.key = {"left center horizontal Left reverse samplen 1.5", below.left, below.top - 20};
  panel.draw(pairs, "1:2:($1-0.5):($1+0.5):2:3", kBars, {kFirstColour}, "dynamics, 95 % intervals");
  panel.layers.push_back(
      {"''", "1:4", "points", {.colour = kInk, .mark = 7, .size = 0.4}, "chain"});
  return out.figure(static_cast<int>(below.bottom + 60));
}

}  // namespace

Section fig11(const Findings& f) {
  Csv csv("start,i_x,i_y,dynamics,chain");
  for (const ValidatedStart& start : f.field.starts)
    for (const Cell& c : cells_of(start, f.field.trials))
      csv.row(start.label(), c.i_x, c.i_y, c.dynamics, c.chain);
  const ValidatedStart& first = f.field.starts.front();
  return {"fig11",
          "Fig. 11: where bodies end in the field",
          {fmt::format("9 x 9 gates, {} trials of the full dynamics for each start of Table IV, "
                       "beside what infinitely many walks of the 87 x 88 chain would give; shown "
                       "is the paper's start, fig11.csv has all. The paper prints neither force; 7 "
                       "N and 50 N fit its Table IV best (results/field_scan).",
                       f.field.trials),
           "The final gate is the last one that a body was in, however it ended: most are trapped "
           "there, but in the columns and the row at the edge many departed from it (circles: "
           "more than half did). B has all gates with the intervals of the trials."},
          "Three maps of nine by nine gates side by side: dynamics and chain, much alike, with "
          "circles in most gates of the outer columns, and their difference. Below, gate by gate, "
          "the shares of the dynamics with 95 % bars, falling, and those of the chain, some beside "
          "the bars.",
          {"field"},
          csv.text(),
          drawn_fig11(first.label(), cells_of(first, f.field.trials), f.field.trials)};
}

namespace {

/// A whole number, with gnuplot's minus sign if it is negative.
std::string with_minus(double x) { return (x < 0 ? "−" : "") + fixed(std::abs(x), 0); }

/// Draws the four starts: means with bars, floors and the paper's values, from column `first` on.
void draw_table4(Panel& panel, const Rows& rows, int first) {
  const auto column = [&](int i) { return std::to_string(first + i); };
  panel.draw(rows, fmt::format("($1-0.12):{}:{}", column(0), column(1)), "yerrorlines",
             {kFirstColour, 1.5, 7, 0.8}, "here, 100 trials: mean, one sd");
  panel.draw(rows, "($1+0.12):" + column(3), "points",
             {.colour = kSecondColour, .mark = 5, .size = 0.9}, "paper");
  panel.draw(rows, fmt::format("($1-0.3):{}:(0.6):(0)", column(2)), "vectors nohead", {kInk, 2},
             "floor: a perfect chain, by chance alone");
}

/// The range of numbers, ignoring NaN.
struct AxisRange {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void see(double x) {
    low = std::fmin(low, x);
    high = std::fmax(high, x);
  }
  [[nodiscard]] std::string text(int decimals) const {
    return fixed(low, decimals) + " to " + fixed(high, decimals);
  }
};
/// Counts starts that have a property.
struct Among {
  int part = 0, whole = 0;
  void see(bool one) {
    part += one;
    ++whole;
  }
  [[nodiscard]] std::string text() const { return fmt::format("{} of {} starts", part, whole); }
};

}  // namespace

Section table4(const Findings& f) {
  Csv csv(
      "start,paper_corrcoef,corrcoef,corrcoef_sd,corrcoef_floor,paper_rmse,rmse,rmse_sd,rmse_floor,"
      "corrcoef_all,rmse_all,total_variation,total_variation_floor");
  Panels out = paper_panels();
  Rows& rows = out.data("$rows");
  std::vector<std::string> starts;
  double upper_end = 1.0;
  AxisRange corrcoef_exact, corrcoef_walks, rmse_exact, rmse_walks;
  Among within, on_exact, on_walks;
  for (const ValidatedStart& s : f.field.starts) {
    const auto& [corrcoef, rmse, corrcoef_floor, rmse_floor] = s.exact;
    upper_end = std::fmax(upper_end, corrcoef.mean + corrcoef.sd);
    corrcoef_exact.see(corrcoef_floor);
    rmse_exact.see(rmse_floor);
    corrcoef_walks.see(s.walks.corrcoef_floor);
    rmse_walks.see(s.walks.rmse_floor);
    const auto near = [&](const Repeats& r, double at_corrcoef, double at_rmse) {
      return std::abs(s.paper_corrcoef - at_corrcoef) <= r.corrcoef.sd &&
             std::abs(s.paper_rmse - at_rmse) <= r.rmse.sd;
    };
    within.see(near(s.exact, corrcoef.mean, rmse.mean));
    on_exact.see(near(s.exact, corrcoef_floor, rmse_floor));
    on_walks.see(near(s.walks, s.walks.corrcoef_floor, s.walks.rmse_floor));
    csv.row(s.label(), s.paper_corrcoef, corrcoef.mean, corrcoef.sd, corrcoef_floor, s.paper_rmse,
            rmse.mean, rmse.sd, rmse_floor, s.corrcoef, s.rmse, s.total_variation,
            s.total_variation_floor);
    rows.add(starts.size(), corrcoef.mean, corrcoef.sd, corrcoef_floor, s.paper_corrcoef, rmse.mean,
             rmse.sd, rmse_floor, s.paper_rmse);
    rows.gap();  // a gap, so that no line joins two starts
    starts.push_back(
        fmt::format("{}, {}, {}", with_minus(s.d), with_minus(s.vx), with_minus(s.vy)));
  }
  const double last = static_cast<double>(starts.size()) - 0.5;
  const Box above{78, 488, 96, 276}, below{78, 488, 318, 498};
  Panel& upper = add_panel(out, above, "", "corrcoef", 56);
  upper.say(as_printed("higher is better"), above.left + 6, above.top - 10, kSmallFont);
  upper.x = {"", -0.5, last, "0,1", "", false};
  upper.y = {"", kFree, upper_end, "0.1", "%.1f"};
  upper.key = {"left top Left reverse samplen 2", above.left, 8};
  Panel& lower =
      add_panel(out, below, "start: {/:Italic d} (m), v_x, v_y (m/s)", "RMSE (trials per 100)", 56);
  lower.say(as_printed("lower is better"), below.left + 6, below.top - 10, kSmallFont);
  lower.x = {"", -0.5, last, tics_of(starts), "", false};
  lower.y = {"", 0, kFree, "0.5", "%.1f"};
  for (Panel* panel : {&upper, &lower}) panel->grid = std::string("ytics") + kGrid;
  draw_table4(upper, rows, 2);
  draw_table4(lower, rows, 6);
  return {
      kTable4,
      "Table IV: prediction against dynamics, beside what chance allows",
      {fmt::format(
          "With 100 trials of the dynamics even a perfect chain would not reach corrcoef 1 and "
          "RMSE 0: that is the floor. Shown is the exact chain against 100 trials. The paper says "
          "that it compared 100 trials with 100 walks: the floor of that is corrcoef {} and RMSE "
          "{}, of an exact prediction {} and {}. Both printed values lie within one standard "
          "deviation of the exact prediction's floor at {}, of the walks' floor at {}.",
          corrcoef_walks.text(2), rmse_walks.text(2), corrcoef_exact.text(2), rmse_exact.text(2),
          on_exact.text(), on_walks.text())},
      fmt::format("Correlation and, below, RMSE of the four starts: here with bars of one standard "
                  "deviation, the paper's, and the floor by chance as a line. Both of the paper's "
                  "lie within the bars at {}.",
                  within.text()),
      {"field"},
      csv.text(),
      out.figure(556)};
}

Section crossings(const Findings& f) {
  struct Scene {
    std::string force, more;
    const Crossings& crossings;
  };
  const Scene scenes[] = {{"10 N", "", f.field_random.at(10).crossings},
                          {"20 N", "", f.field_random.at(20).crossings},
                          {"40 N", "", f.field_random.at(40).crossings},
                          {"50 N", " (scenes/field.toml)", f.field.crossings}};
  constexpr double kPaperSays = 4.0;  // %
  bool all_above = true;
  Csv csv(
      "scene,RT_and_LT_share,RT_and_LT_low,RT_and_LT_high,outside_bins_share,outside_bins_low,"
      "outside_bins_high,crossings,bodies");
  RateGroup above{"through RT or LT", {}, kPaperSays, "paper: fewer than 4 %"},
      outside{"outside Table III's bins", {}, std::nan(""), ""};
  for (const auto& [force, more, c] : scenes) {
    const Share sides = c.rt_and_lt_share(), clamped = c.clamped_share();
    csv.row("7 N, Rm " + force + more, sides.value, sides.low, sides.high, clamped.value,
            clamped.low, clamped.high, c.between_gates, c.bodies);
    all_above = all_above && sides.low > 0.01 * kPaperSays;
    const std::string label = fmt::format("Rm = {}, n = {}", force, sides.whole);
    above.rows.push_back({label, {sides}});
    outside.rows.push_back({label, {clamped}});
  }
  return {
      "crossings",
      "Crossings between gates: side entries and velocities",
      {"The paper says that fewer than 4 % of the inputs come through the sides above the "
       "joints (RT, LT) and that velocities stay in the range of Table III. Both depend on the "
       "forces, which it does not print.",
       "A body crosses several times, one crossing much like the next. So the intervals are "
       "those of as many trials as there are bodies (or crossings, if fewer)."},
      fmt::format("Shares of crossings through RT or LT, for four random forces, {}a dashed line "
                  "at the paper's four percent; and of those outside the bins of Table III.",
                  all_above ? "all above " : "beside "),
      {"field_random_10", "field_random_20", "field_random_40", "field", "field_no_drag"},
      csv.text(),
      rates({"crossings between gates; F_prop = 7 N",
             "95 % intervals, n: bodies, or crossings if fewer"},
            {{"", kFirstColour, 7}}, {above, outside}, "% of crossings (root scale)")};
}

Section speed(const Findings& f) {
  double exact = 0;
  for (const ValidatedStart& s : f.field.starts)
    exact += s.exact_seconds / static_cast<double>(f.field.starts.size());
  struct Time {
    std::string who, what;
    double seconds;
    std::string text = quantity(seconds, "s", 2);
  };
  const Time times[] = {{"paper", "100 trials of the dynamics", 360000.0, "100 h"},
                        {"paper", "100 walks", 10.0},
                        {"here", "100 trials by the paper's Euler scheme",
                         100 * f.field_paper_method.seconds_per_trial()},
                        {"here", "100 trials, method stable", 100 * f.field.seconds_per_trial()},
                        {"here", "the matrix, 87 x 100 gate runs", f.field.matrix_seconds},
                        {"here", "100 walks", 100 * f.field.seconds_per_walk()},
                        {"here", "one exact prediction", exact}};
  Csv csv("what,seconds");
  Panels out = paper_panels();
  Rows& rows = out.data("$times");
  std::string who, list;
  std::vector<std::string> labels;
  double least = times[0].seconds;
  for (const Time& t : times) {
    csv.row(t.who + ": " + t.what, t.seconds);
    list += fmt::format("{}{}: {}, {}", list.empty() ? "" : "; ", t.who, t.what, t.text);
    if (t.who != who) labels.push_back(bold(who = t.who));
    rows.add(t.seconds, labels.size(), fmt::format("\"{}\"", t.text));
    labels.push_back(t.what);
    least = std::min(least, t.seconds);
  }
  Panel& panel = add_panel(out, {250, 432, 20, 20 + 22.0 * static_cast<double>(labels.size())},
                           "time (s, log scale)", "");
  panel.border = 1;
  panel.x = {"", 0.3 * least, 1e6, "1000", "10^{/=12 %T}", true, true};
  panel.y = row_axis(labels);
  panel.grid = std::string("xtics") + kGrid;
  panel.more = "unset mxtics\n";
  panel.draw(rows, "1:2", "points", {.colour = kFirstColour, .mark = 7, .size = 0.9});
  panel.draw_again("(1e6):2:3", "labels left offset 0.6,0 font ',12'");
  return {"speed",
          "Time: dynamics against chain",
          {fmt::format("The paper's factor is 100 h of dynamics over 10 s of walks. The matrix "
                       "costs more than the 100 trials of one start, and serves all starts. "
                       "Measured once on {}, all cores; tests/bench/run.sh measures with care.",
                       machine())},
          fmt::format("Times on a logarithmic axis, with their numbers. {}.", list),
          {"field", "field_paper_method"},
          csv.text(),
          out.figure(static_cast<int>(panel.box.bottom + 62))};
}

Section replay(const Findings& f) {
  Json film = f.crossing;
  for (const char* key : {"recorded", "trials", "status", "made_by"}) film.erase(key);
  for (Json& run : film["runs"])
    for (const char* key : {"trial", "hits", "potential_J", "elastic_left_J", "elastic_right_J",
                            "landscape_J", "landscape_left_J", "landscape_right_J"})
      run.erase(key);
  return {"replay",
          "Bodies in the field, step by step",
          {"Three trials through the 9 x 9 field, every step of the method. gatewalk trace records "
           "and plays any other run: --seed, --trial, --replay FILE.html, --video FILE.mp4."},
          "An animation of the disc among the beams with play, pause and a time slider; energies "
          "beside it.",
          {"crossing"},
          "",
          {},
          std::move(film)};
}
}  // namespace gatewalk::cli
