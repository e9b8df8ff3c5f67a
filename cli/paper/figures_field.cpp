#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "cli/web/html.h"

namespace gatewalk::cli {

namespace {

struct Cell {
  double i_x, i_y, dynamics, chain;  // shares of the trials
};

/// The final gates of a start, row by row.
std::vector<Cell> cells_of(const ValidatedStart& start, std::int64_t trials) {
  std::vector<Cell> cells;
  for (std::size_t y = 0; y < start.counts.size(); ++y)
    for (std::size_t x = 0; x < start.counts[y].size(); ++x)
      cells.push_back({static_cast<double>(x) - static_cast<double>(start.counts[y].size() / 2),
                       static_cast<double>(y), start.counts[y][x] / static_cast<double>(trials),
                       start.chain[y][x]});
  return cells;
}

/// Rows of `columns` shares each.
Json rows_of(const std::vector<Cell>& cells, std::size_t columns, double Cell::*share) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i % columns == 0) rows.push_back(Json::array());
    rows.back().push_back(rounded(cells[i].*share, 1e-6));
  }
  return rows;
}

void draw_fig11(std::vector<Cell> cells) {
  std::string maps[2], pairs;
  double most = 0.0;
  for (const Cell& c : cells) {
    most = std::max({most, c.chain, c.dynamics});
    maps[0] += line_of({c.i_x, c.i_y, 100 * c.chain});
    maps[1] += line_of({c.i_x, c.i_y, 100 * c.dynamics});
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.dynamics > b.dynamics; });
  for (std::size_t i = 0; i < cells.size(); ++i)
    pairs += std::to_string(i + 1) + " " + line_of({100 * cells[i].dynamics, 100 * cells[i].chain});
  draw("fig11", 1150, 900,
       data_block("$chain", maps[0]) + data_block("$dynamics", maps[1]) +
           data_block("$pairs", pairs) + kSequential +
           filled(R"(
set multiplot
set size 0.5,0.56
set origin 0,0.44
set size ratio -1
unset key
set xlabel 'i_x'
set ylabel 'i_y'
set xrange [-4.5:4.5]
set yrange [-0.5:8.5]
set xtics 1
set ytics 1
set cblabel '% of trials'
set cbrange [0:{{most}}]
set title 'A  Markov chain (exact)'
plot $chain using 1:2:3 with image pixels
set origin 0.5,0.44
set title 'full dynamics'
plot $dynamics using 1:2:3 with image pixels
set origin 0,0
set size noratio
set size 1,0.42
set title 'B  the same gate by gate, sorted'
set xlabel 'gates in the order of the dynamics'
set ylabel '% of trials'
set xrange [0:82]
set yrange [0:*]
set xtics 10
set ytics auto
set key top right
set grid y
set style fill solid 0.7
plot $pairs using 1:2 with boxes lc rgb '#9ecae1' title 'full dynamics', \
     $pairs using 1:3 with points pt 7 ps 0.6 lc rgb '#d55e00' title 'chain'
unset multiplot
)",
                  {{"most", digits(100 * most)}}));
}

}  // namespace

Section fig11(const Findings& f) {
  Json starts = Json::array();
  Csv csv("start,i_x,i_y,dynamics,chain");
  for (const ValidatedStart& start : f.field.starts) {
    const std::vector<Cell> cells = cells_of(start, f.field.trials);
    const std::size_t columns = start.counts.front().size();
    for (const Cell& c : cells) csv.row(start.label(), c.i_x, c.i_y, c.dynamics, c.chain);
    if (starts.empty()) draw_fig11(cells);  // the figure shows the first start
    starts.push_back({{"label", start.label()},
                      {"dynamics", rows_of(cells, columns, &Cell::dynamics)},
                      {"chain", rows_of(cells, columns, &Cell::chain)},
                      {"corrcoef", start.corrcoef},
                      {"rmse", start.rmse}});
  }
  write_text_atomically("fig11.csv", csv.text());
  return {"fig11",
          "Fig. 11: where bodies end in the field",
          {"9 x 9 gates, " + std::to_string(f.field.trials) +
           " trials of the full dynamics for each start of Table IV, beside what infinitely many "
           "walks of the 87 x 88 chain would give. The paper prints neither force; 7 N and 50 N "
           "fit its Table IV best (results/field_scan)."},
          "Two maps of nine by nine gates side by side, chain and dynamics, much alike; below, "
          "bars and dots gate by gate.",
          {"field"},
          "final_gates",
          {{"starts", starts}}};
}

namespace {

/// Points with bars, floors and the paper's, from column `first` of $rows on.
std::string table4_panel(const std::string& title, int first) {
  return filled(R"(
set title '{{title}}'
plot $rows using ($1-0.12):{{mean}}:{{sd}} with yerrorbars pt 7 lc rgb '#0072b2' title 'here, 100 trials, one sd', \
     $rows using 1:{{floor}} with points pt 2 ps 1.2 lw 2 lc rgb '#999999' title 'floor: chance alone', \
     $rows using ($1+0.12):{{paper}} with points pt 9 ps 1.2 lc rgb '#d55e00' title 'paper'
)",
                {{"title", title},
                 {"mean", std::to_string(first)},
                 {"sd", std::to_string(first + 1)},
                 {"floor", std::to_string(first + 2)},
                 {"paper", std::to_string(first + 3)}});
}

}  // namespace

Section table4(const Findings& f) {
  Json rows = Json::array();
  Csv csv(
      "start,paper_corrcoef,corrcoef,corrcoef_sd,corrcoef_floor,paper_rmse,rmse,rmse_sd,rmse_floor,"
      "corrcoef_all,rmse_all,total_variation,total_variation_floor");
  std::string lines;
  for (const ValidatedStart& s : f.field.starts) {
    const auto& [corrcoef, rmse, corrcoef_floor, rmse_floor] = s.exact;
    rows.push_back({{"start", s.label()},
                    {"paper_corrcoef", s.paper_corrcoef},
                    {"corrcoef", corrcoef.mean},
                    {"corrcoef_sd", corrcoef.sd},
                    {"corrcoef_floor", corrcoef_floor},
                    {"paper_rmse", s.paper_rmse},
                    {"rmse", rmse.mean},
                    {"rmse_sd", rmse.sd},
                    {"rmse_floor", rmse_floor},
                    {"corrcoef_all", s.corrcoef},
                    {"rmse_all", s.rmse},
                    {"tv", s.total_variation},
                    {"tv_floor", s.total_variation_floor}});
    csv.row(s.label(), s.paper_corrcoef, corrcoef.mean, corrcoef.sd, corrcoef_floor, s.paper_rmse,
            rmse.mean, rmse.sd, rmse_floor, s.corrcoef, s.rmse, s.total_variation,
            s.total_variation_floor);
    lines += std::to_string(rows.size()) + " " +
             line_of({corrcoef.mean, corrcoef.sd, corrcoef_floor, s.paper_corrcoef, rmse.mean,
                      rmse.sd, rmse_floor, s.paper_rmse});
  }
  write_text_atomically("table4.csv", csv.text());
  draw("table4", 1000, 460,
       data_block("$rows", lines) + R"(
set multiplot layout 1,2
set xrange [0.5:4.5]
set xtics ('0, 0, 15' 1, '23, -11, 16' 2, '4, 5, 10' 3, '-17, 13, 12' 4)
set xlabel 'start: d (m), vx, vy (m/s)'
set grid y
set key bottom left
)" + table4_panel("corrcoef", 2) +
           "set key top left\n" + table4_panel("RMSE, trials per 100", 6) + "unset multiplot\n");
  return {"table4",
          "Table IV: prediction against dynamics, beside what chance allows",
          {"With 100 trials of the dynamics even a perfect chain would not reach corrcoef 1 and "
           "RMSE 0: that is the floor. Shown is the exact chain against 100 trials. The paper says "
           "that it compared 100 trials with 100 walks, whose floor is worse (0.75 and 1.5); its "
           "figures lie on the floor of an exact prediction."},
          "Correlation and RMSE of the four starts: here, the floor by chance, and the paper's, "
          "within each other's reach but for the third start.",
          {"field", "field_paper_method"},
          "table4",
          {{"rows", rows}}};
}

Section crossings(const Findings& f) {
  const std::pair<std::string, const Crossings&> scenes[] = {
      {"7 N, Rm 10 N", f.field_random.at(10)},
      {"7 N, Rm 20 N", f.field_random.at(20)},
      {"7 N, Rm 40 N", f.field_random.at(40)},
      {"7 N, Rm 50 N (scenes/field.toml)", f.field.crossings}};
  Csv csv("scene,RT_and_LT_share,outside_bins_share,crossings");
  std::vector<Rate> rates;
  for (const auto& [label, c] : scenes) {
    csv.row(label, c.rt_and_lt, c.clamped, static_cast<double>(c.between_gates));
    rates.push_back({label, "through RT or LT", c.rt_and_lt_share()});
  }
  for (const auto& [label, c] : scenes)
    rates.push_back({label, "outside Table III's bins", c.clamped_share()});
  write_text_atomically("crossings.csv", csv.text());
  draw_rates("crossings", rates, 4, "paper: RT and LT fewer than 4 %", "Crossings between gates",
             45);
  return {"crossings",
          "Crossings between gates: side entries and velocities",
          {"The paper says that fewer than 4 % of the inputs come through the sides above the "
           "joints (RT, LT) and that velocities stay in the range of Table III. Both depend on the "
           "forces, which it does not print."},
          "Shares of crossings through RT or LT and outside the bins of Table III for four random "
          "forces, beside a line at four percent.",
          {"field_random_10", "field_random_20", "field_random_40", "field"},
          "rates",
          {{"rows", to_json(rates)},
           {"marks", {{{"label", "paper: RT and LT < 4 %"}, {"value", 0.04}}}},
           {"unit", "share"}}};
}

Section speed(const Findings& f) {
  double exact = 0;
  for (const ValidatedStart& s : f.field.starts)
    exact += s.exact_seconds / static_cast<double>(f.field.starts.size());
  const std::vector<std::pair<std::string, double>> times{
      {"paper: 100 trials of the dynamics", 360000.0},
      {"paper: 100 walks", 10.0},
      {"here: 100 trials by the paper's Euler scheme",
       100 * f.field_paper_method.seconds_per_trial()},
      {"here: 100 trials, method stable", 100 * f.field.seconds_per_trial()},
      {"here: the matrix, 87 x 100 gate runs", f.field.matrix_seconds},
      {"here: 100 walks", 100 * f.field.seconds_per_walk()},
      {"here: one exact prediction", exact}};
  Json rows = Json::array();
  Csv csv("what,seconds");
  std::string lines;
  std::vector<std::string> names;
  for (const auto& [label, seconds] : times) {
    rows.push_back({{"label", label}, {"seconds", seconds}});
    csv.row(label, seconds);
    lines += std::to_string(names.size()) + " " + digits(seconds) + "\n";
    names.push_back(label);
  }
  write_text_atomically("speed.csv", csv.text());
  draw("speed", 1000, 360,
       data_block("$t", lines) +
           filled(R"(
set logscale x
set format x '10^{%T}'
set xlabel 'seconds'
set yrange [{{n}}:-1]
{{tics}}
set grid x
unset key
plot $t using 2:1 with points pt 7 ps 1.2 lc rgb '#0072b2'
)",
                  {{"n", std::to_string(names.size())}, {"tics", tics_of(names)}}));
  return {"speed",
          "Time: dynamics against chain",
          {"The paper's factor is 100 h of dynamics over 10 s of walks. The matrix costs more than "
           "the 100 trials of one start, and serves all starts. Measured once on " +
           machine() + ", all cores; tests/bench/run.sh measures with care."},
          "Seconds on a logarithmic axis: the paper's 100 trials 360 000, its walks 10; here "
          "milliseconds and microseconds.",
          {"field", "field_paper_method"},
          "speed",
          {{"rows", rows}}};
}

Section replay(const Findings& f) {
  Json film = f.crossing;
  for (const char* key : {"recorded", "trials", "status", "made_by"}) film.erase(key);
  for (Json& run : film["runs"])
    for (const char* key : {"trial", "hits", "potential_J", "elastic_left_J", "elastic_right_J",
                            "landscape_J", "landscape_left_J", "landscape_right_J"})
      run.erase(key);
  return {"replay",
          "A body crosses the field",
          {"Three trials through the 9 x 9 field, every step of the method. gatewalk trace records "
           "and plays any other run: --seed, --trial, --replay FILE.html, --video FILE.mp4."},
          "An animation of the disc among the beams with play, pause and a time slider; energies "
          "beside it.",
          {"crossing"},
          "replay",
          {{"film", film}},
          false};
}
}  // namespace gatewalk::cli
