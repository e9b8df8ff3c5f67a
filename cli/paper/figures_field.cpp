// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/render/csv.h"
#include "cli/render/provenance.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

namespace {

/// A final gate.
struct Cell {
  double i_x, i_y;
  std::int64_t trials;                       // that ended there
  double dynamics, chain;                    // shares
  double departed_dynamics, departed_chain;  // of these shares: left the field from there
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

/// The colours below maps, with these tics.
std::string bar_below(const Sheet& sheet, double left, double right, double top,
                      const std::string& tics) {
  return "set cbtics " + tics + " font ',12' scale 0.5 offset 0,0.4\n" +
         cli::bar_below(sheet, left, right, top);
}

Figure drawn_fig11(const std::string& start, std::vector<Cell> cells, std::int64_t trials) {
  std::string maps[3], pairs;
  double most = 0.0, largest = 1e-6, highest = 0.0;  // %, points, root of %
  for (const Cell& c : cells) {
    most = std::max({most, 100.0 * c.chain, 100.0 * c.dynamics});
    largest = std::max(largest, 100.0 * std::abs(c.dynamics - c.chain));
    const auto row = [&](double shown, double share, double departed) {
      return line_of({c.i_x, c.i_y, shown, departed > 0.5 * share ? 1.0 : 0.0});
    };
    maps[0] += row(root_percent(c.dynamics), c.dynamics, c.departed_dynamics);
    maps[1] += row(root_percent(c.chain), c.chain, c.departed_chain);
    maps[2] += row(100.0 * (c.dynamics - c.chain), 0.0, 0.0);
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.dynamics > b.dynamics; });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [low, high] = dynamics::share_interval(cells[i].trials, trials);
    highest = std::max({highest, root_percent(high), root_percent(cells[i].chain)});
    pairs += std::to_string(i + 1) + " " +
             line_of({root_percent(low), root_percent(high), root_percent(cells[i].chain)});
  }
  constexpr double kLeft = 58, kWide = 132, kGap = 12, kTop = 66;
  const double bottom = kTop + kWide;
  const auto left_of = [](int i) { return kLeft + i * (kWide + kGap); };
  const Box below{66, 488, bottom + 200, bottom + 364};
  const Sheet sheet{static_cast<int>(below.bottom + 60)};
  const RootScale scale(most);
  const auto map = [&](int i, const char* name, const std::string& head) {
    return frame(sheet, {left_of(i), left_of(i) + kWide, kTop, bottom}, i == 1 ? "column i_x" : "",
                 i == 0 ? "row i_y" : "") +
           words(sheet, head, left_of(i), kTop - 11, kSmallFont) + "plot " + name + cli::cells() +
           (i < 2 ? ", '' using 1:($4 > 0 ? $2 : NaN):" + ink(std::sqrt(most)) +
                        " with points pt 6 ps 0.5 lc rgb variable"
                  : "") +
           "\nunset label\n";
  };
  const std::string tic = short_number(0.7 * largest);
  const double bar = bottom + 54;
  return figure_of(
      sheet,
      data_block("$dynamics", maps[0]) + data_block("$chain", maps[1]) +
          data_block("$difference", maps[2]) + data_block("$pairs", pairs),
      words(sheet, "final gates, n = " + std::to_string(trials) + "; start " + start, 8, 18) +
          kSmallTics +
          "set border 15\nset xrange [-4.5:4.5]\nset yrange [-0.5:8.5]\nset xtics 4\nset ytics "
          "4\n" +
          kSequential + "set cbrange " + scale.range() + "\nunset colorbox\n" +
          map(0, "$dynamics", "A  dynamics, %") +
          bar_below(sheet, left_of(0), left_of(1) + kWide, bar, "(" + scale.tics() + ")") +
          words(sheet, "root scale; circle: most of those departed from this gate", left_of(0),
                bar + 46, kSmallFont) +
          map(1, "$chain", "chain, %") + kDiverging + "set cbrange [" + digits(-largest) + ":" +
          digits(largest) + "]\n" +
          bar_below(sheet, left_of(2), left_of(2) + kWide, bar,
                    "('−" + tic + "' -" + tic + ", '0' 0, '+" + tic + "' " + tic + ")") +
          map(2, "$difference", "dynamics − chain, points") +
          frame(sheet, below, "gates, as the dynamics rank them", "% of trials (root scale)", 52) +
          words(sheet, "B  gate by gate", 8, below.top - 62) +
          "set border 3\nset xtics 10 font ',15'\nset grid ytics" + kGrid +
          "\nset xrange [0:" + std::to_string(cells.size() + 1) +
          "]\nset yrange [-0.05:" + digits(1.03 * highest) + "]\nset ytics (" + scale.tics() +
          ") font ',15'\n" + "set key at screen " + sheet.at(below.left, below.top - 20) +
          " left center horizontal Left reverse samplen 1.5\nset style fill solid noborder\n"
          "plot $pairs using 1:2:($1-0.5):($1+0.5):2:3 with boxxyerror lc rgb '" +
          kFirstColour +
          "' title 'dynamics, 95 % intervals', '' using 1:4 with points lt -1 pt 7 ps 0.4 title "
          "'chain'\n");
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
          {"9 x 9 gates, " + std::to_string(f.field.trials) +
               " trials of the full dynamics for each start of Table IV, beside what infinitely "
               "many walks of the 87 x 88 chain would give; shown is the paper's start, fig11.csv "
               "has all. The paper prints neither force; 7 N and 50 N fit its Table IV best "
               "(results/field_scan).",
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

/// A whole number, negative ones as gnuplot sets them.
std::string with_minus(double x) { return (x < 0 ? "−" : "") + fixed(std::abs(x), 0); }

/// Four starts: means with bars, floors and the paper's, from column `first` of $rows on.
std::string table4_panel(int first) {
  const auto column = [&](int i) { return std::to_string(first + i); };
  return std::string("plot $rows using ($1-0.12):") + column(0) + ":" + column(1) +
         " with yerrorlines lw 1.5 pt 7 ps 0.8 lc rgb '" + kFirstColour +
         "' title 'here, 100 trials: mean, one sd', $rows using ($1+0.12):" + column(3) +
         " with points pt 5 ps 0.9 lc rgb '" + kSecondColour +
         "' title 'paper', $rows using ($1-0.3):" + column(2) +
         ":(0.6):(0) with vectors nohead lt -1 lw 2 title 'floor: a perfect chain, by chance "
         "alone'\n";
}

/// From the least to the largest of some numbers, NaN aside.
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
/// How many of the starts.
struct Among {
  int part = 0, whole = 0;
  void see(bool one) {
    part += one;
    ++whole;
  }
  [[nodiscard]] std::string text() const {
    return std::to_string(part) + " of " + std::to_string(whole) + " starts";
  }
};

}  // namespace

Section table4(const Findings& f) {
  Csv csv(
      "start,paper_corrcoef,corrcoef,corrcoef_sd,corrcoef_floor,paper_rmse,rmse,rmse_sd,rmse_floor,"
      "corrcoef_all,rmse_all,total_variation,total_variation_floor");
  std::string lines, starts;
  int at = 0;
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
    starts += (at ? ", '" : "('") + with_minus(s.d) + ", " + with_minus(s.vx) + ", " +
              with_minus(s.vy) + "' " + std::to_string(at);
    lines += std::to_string(at++) + " " +
             line_of({corrcoef.mean, corrcoef.sd, corrcoef_floor, s.paper_corrcoef, rmse.mean,
                      rmse.sd, rmse_floor, s.paper_rmse}) +
             "\n";  // nothing joins two starts
  }
  const Sheet sheet{556};
  const Box upper{78, 488, 96, 276}, lower{78, 488, 318, 498};
  return {
      "table4",
      "Table IV: prediction against dynamics, beside what chance allows",
      {"With 100 trials of the dynamics even a perfect chain would not reach corrcoef 1 and "
       "RMSE 0: that is the floor. Shown is the exact chain against 100 trials. The paper says "
       "that it compared 100 trials with 100 walks: the floor of that is corrcoef " +
       corrcoef_walks.text(2) + " and RMSE " + rmse_walks.text(2) + ", of an exact prediction " +
       corrcoef_exact.text(2) + " and " + rmse_exact.text(2) +
       ". Both printed values lie within one standard deviation of the exact prediction's "
       "floor at " +
       on_exact.text() + ", of the walks' floor at " + on_walks.text() + "."},
      "Correlation and, below, RMSE of the four starts: here with bars of one standard deviation, "
      "the paper's, and the floor by chance as a line. Both of the paper's lie within the bars "
      "at " +
          within.text() + ".",
      {"field"},
      csv.text(),
      figure_of(sheet, data_block("$rows", lines),
                "set border 3\nset grid ytics" + std::string(kGrid) +
                    "\nset xrange [-0.5:" + digits(at - 0.5) + "]\nset xtics 0,1\n" +
                    frame(sheet, upper, "", "corrcoef", 56) +
                    "set format x ''\nset format y '%.1f'\nset yrange [*:" + digits(upper_end) +
                    "]\nset ytics 0.1\n"
                    "set key at screen " +
                    sheet.at(upper.left, 8) + " left top Left reverse samplen 2\n" +
                    words(sheet, "higher is better", upper.left + 6, upper.top - 10, kSmallFont) +
                    table4_panel(2) + "unset label\nunset key\n" +
                    frame(sheet, lower, "start: {/:Italic d} (m), v_x, v_y (m/s)",
                          "RMSE (trials per 100)", 56) +
                    words(sheet, "lower is better", lower.left + 6, lower.top - 10, kSmallFont) +

                    "set xtics " + starts +
                    ")\nset format y '%.1f'\nset yrange [0:*]\nset ytics 0.5\n" + table4_panel(6))};
}

Section crossings(const Findings& f) {
  struct Scene {
    std::string force, more;
    const Crossings& crossings;
  };
  const Scene scenes[] = {{"10 N", "", f.field_random.at(10)},
                          {"20 N", "", f.field_random.at(20)},
                          {"40 N", "", f.field_random.at(40)},
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
    const std::string label = "Rm = " + force + ", n = " + std::to_string(sides.whole);
    above.rows.push_back({label, {sides}});
    outside.rows.push_back({label, {clamped}});
  }
  return {"crossings",
          "Crossings between gates: side entries and velocities",
          {"The paper says that fewer than 4 % of the inputs come through the sides above the "
           "joints (RT, LT) and that velocities stay in the range of Table III. Both depend on the "
           "forces, which it does not print.",
           "A body crosses several times, one crossing much like the next. So the intervals are "
           "those of as many trials as there are bodies (or crossings, if fewer)."},
          std::string("Shares of crossings through RT or LT, for four random forces, ") +
              (all_above ? "all above " : "beside ") +
              "a dashed line at the paper's four percent; and of those outside the bins of Table "
              "III.",
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
  std::string lines, who, list;
  std::vector<std::string> labels;
  double least = times[0].seconds;
  for (const Time& t : times) {
    csv.row(t.who + ": " + t.what, t.seconds);
    list += (list.empty() ? "" : "; ") + t.who + ": " + t.what + ", " + t.text;
    if (t.who != who) labels.push_back(bold(who = t.who));
    lines += digits(t.seconds) + " " + std::to_string(labels.size()) + " \"" + t.text + "\"\n";
    labels.push_back(t.what);
    least = std::min(least, t.seconds);
  }
  const Box box{250, 432, 20, 20 + 22.0 * static_cast<double>(labels.size())};
  const Sheet sheet{static_cast<int>(box.bottom + 62)};
  return {
      "speed",
      "Time: dynamics against chain",
      {"The paper's factor is 100 h of dynamics over 10 s of walks. The matrix costs more than "
       "the 100 trials of one start, and serves all starts. Measured once on " +
       machine() + ", all cores; tests/bench/run.sh measures with care."},
      "Times on a logarithmic axis, with their numbers. " + list + ".",
      {"field", "field_paper_method"},
      csv.text(),
      figure_of(sheet, data_block("$times", lines),
                frame(sheet, box, "time (s, log scale)", "") + row_tics(labels) +
                    "set border 1\nset logscale x\nset xrange [" + digits(0.3 * least) +
                    ":1e6]\nset format x '10^{/=12 %T}'\nset xtics 1000\nset grid xtics" + kGrid +
                    "\n"
                    "unset mxtics\nplot $times using 1:2 with points pt 7 ps 0.9 lc rgb '" +
                    kFirstColour +
                    "', '' using (1e6):2:3 with labels left offset 0.6,0 font ',12'\n")};
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
