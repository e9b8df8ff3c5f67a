#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "cli/web/html.h"

namespace gatewalk::cli {

namespace {

/// A heat map and a plot of curves for one damping.
std::string fig8_panels(const std::string& damping, const std::string& title) {
  return filled(R"(
set title '{{title}}'
set xlabel 'F_{prop} (N)'
set ylabel 'Rm (N)'
set xrange [3.5:9.5]
set yrange [-5:65]
set xtics 1
set ytics 10
set cbrange [0:100]
set cblabel 'traversed (%)'
unset key
unset grid
unset nonlinear y
plot $map{{damping}} using 1:2:3 with image pixels, \
     '' using 1:2:(sprintf('%.1f', $3)):($3 > 60 ? 0x000000 : 0xffffff) with labels tc rgb variable font ',9'
set xlabel 'F_{prop} (N)'
set ylabel 'traversed (%)'
set yrange [0:100]
set nonlinear y via sqrt(y) inverse y*y
set ytics (0, 1, 2, 5, 10, 20, 50, 100)
set grid
set key top left title 'Rm (N)'
plot for [i=0:6] $series{{damping}} index i using ($1 + 0.03 * (i - 3)):3:4:5 \
  with yerrorlines pt 7 ps 0.5 lc i+1 title sprintf('%d', 10 * i)
)",
                {{"title", title}, {"damping", damping}});
}

}  // namespace

Section fig8(const Findings& f) {
  Json rows = Json::array();
  Csv csv("damping_Nms_per_rad,propulsion_N,random_N,trials,traversed,low,high,exited,trapped");
  std::string map[2], series[2];
  for (const int damping : {50, 10}) {
    for (int random = 0; random <= 60; random += 10) {
      for (int force = 4; force <= 9; ++force) {
        const SweepPoint& p =
            f.fig8.at({{kDamping, damping}, {kPropulsion, force}, {kRandom, random}});
        const Share s = p.traversed_share();
        const auto n = static_cast<double>(p.trials);
        const double exited = static_cast<double>(p.exited_left + p.exited_right) / n,
                     trapped = static_cast<double>(p.trapped) / n;
        rows.push_back({{"damping", damping},
                        {"propulsion", force},
                        {"random", random},
                        {"traversed", s.value},
                        {"low", s.low},
                        {"high", s.high},
                        {"exited", exited},
                        {"trapped", trapped},
                        {"trials", s.whole}});
        csv.row(damping, force, random, n, s.value, s.low, s.high, exited, trapped);
        const std::string place = std::to_string(force) + " " + std::to_string(random) + " ";
        map[damping == 10] += place + line_of({100 * s.value});
        series[damping == 10] += place + line_of({100 * s.value, 100 * s.low, 100 * s.high});
      }
      series[damping == 10] += "\n\n";
    }
  }
  write_text_atomically("fig8.csv", csv.text());
  draw("fig8", 1200, 950,
       data_block("$map50", map[0]) + data_block("$map10", map[1]) +
           data_block("$series50", series[0]) + data_block("$series10", series[1]) + kSequential +
           "set multiplot layout 2,2\n" + fig8_panels("50", "d = 50, as printed") +
           fig8_panels("10", "d = 10") + "unset multiplot\n");
  return {"fig8",
          "Fig. 8: traversal of equal beams",
          {"k = 400 N m/rad, from rest, " + std::to_string(f.fig8.points[0].trials) +
               " trials a point (paper: 100), Table I's grid and two more columns of random force. "
               "Where propulsion alone is enough everybody gets through and random force only "
               "hinders; below that a few do, and only with random force. At Rm = 0 all trials are "
               "the same run, so those shares are 0 or 1 without an interval.",
           "Below that threshold traversal need not rise step by step with the propulsion: see the "
           "claims."},
          "Heat maps and curves of the traversal probability: near zero below 8 or 9 newton of "
          "propulsion, near one above it without random force, falling with random force there.",
          {"fig8"},
          "outcomes",
          {{"rows", rows}}};
}

Section fig12(const Findings& f) {
  constexpr std::int64_t kFew = 10;  // successes
  Json rows = Json::array();
  Csv csv(
      "damping_Nms_per_rad,propulsion_N,random_N,k_left_Nm_per_rad,trials,successes,right,low,"
      "high");
  std::string data, plots;
  for (const int damping : {50, 10})
    for (const int force : {7, 8}) {
      std::string map;
      for (int k = 100; k <= 500; k += 50)
        for (int random = 10; random <= 60; random += 10) {
          const SweepPoint& cell = f.fig12.at(
              {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k}});
          const Share s = cell.right_share();
          rows.push_back({{"damping", damping},
                          {"propulsion", force},
                          {"random", random},
                          {"k_left", k},
                          {"right", std::isfinite(s.value) ? Json(s.value) : Json(nullptr)},
                          {"low", s.low},
                          {"high", s.high},
                          {"successes", s.whole},
                          {"trials", cell.trials}});
          csv.row(damping, force, random, k, static_cast<double>(cell.trials),
                  static_cast<double>(s.whole), s.value, s.low, s.high);
          map += std::to_string(random) + " " + std::to_string(k) + " " +
                 (s.whole >= kFew ? digits(s.value) : "NaN") + " " + std::to_string(s.whole) + "\n";
        }
      const std::string name = "$d" + std::to_string(damping) + "f" + std::to_string(force);
      data += data_block(name, map);
      plots += filled(R"(
set title '{{letter}}  F_{prop} = {{force}} N, d = {{damping}}'
plot {{name}} using 1:2:3 with image pixels, \
     '' using 1:2:($4 < {{few}} ? sprintf('of %d', $4) : sprintf('%.2f', $3)):($4 < {{few}} || $3 > 0.3 ? 0x000000 : 0xffffff) with labels tc rgb variable font ',9'
)",
                      {{"letter", force == 7 ? "A" : "B"},
                       {"force", std::to_string(force)},
                       {"damping", std::to_string(damping)},
                       {"name", name},
                       {"few", std::to_string(kFew)}});
    }
  write_text_atomically("fig12.csv", csv.text());
  draw("fig12", 1200, 950,
       data + filled(R"(
set palette gray
set cbrange [0:0.6]
unset key
set xlabel 'Rm (N)'
set ylabel 'k_L (N m/rad)'
set xrange [5:65]
set yrange [75:525]
set xtics 10
set ytics 100
set cblabel 'right of successful'
set multiplot layout 2,2
{{plots}}
unset multiplot
)",
                     {{"plots", plots}}));
  return {"fig12",
          "Fig. 12: right trials of all successful ones",
          {"As in the paper, darker means fewer on the right: a softer left beam draws the body to "
           "the left. " +
           std::to_string(f.fig12.points[0].trials) +
           " trials a cell. Where fewer than 10 get through there is no share to speak of: those "
           "cells say how many do."},
          "Four grey maps of the share of right traversals over left stiffness and random force: "
          "dark at the soft end, about one half where both beams are alike.",
          {"fig12"},
          "right_share",
          {{"rows", rows}}};
}

Section thirteen_eight(const Findings& f) {
  std::vector<Rate> rates;
  Csv csv("group,setting,damping_Nms_per_rad,traversed,low,high,left,right,trials");
  const auto add = [&](const Sweep& study, const std::string& group, const char* key,
                       const std::string& unit) {
    for (const SweepPoint& p : study.points) {
      const std::string text = p.at(key).text + unit;
      const Share s = p.traversed_share();
      const auto n = static_cast<double>(p.trials);
      rates.push_back({text + ", d " + p.at(kDamping).text, group, s});
      csv.row(group, text, p.at(kDamping).number, s.value, s.low, s.high,
              static_cast<double>(p.traversed_left) / n, static_cast<double>(p.traversed_right) / n,
              n);
    }
  };
  add(f.tried_method, "method", "run.method", "");
  add(f.tried_step, "paper's Euler, step", "run.step_s", " s");
  add(f.tried_restitution, "restitution", "contact.restitution", "");
  add(f.tried_rate, "rate of the random force", "forces.random_rate_Hz", " Hz");
  add(f.tried_start, "starting speed", "start.vy_m_per_s", " m/s");
  add(f.tried_random, "random force", kRandom, " N");
  add(f.tried_propulsion, "propulsion", kPropulsion, " N");
  write_text_atomically("thirteen_eight.csv", csv.text());
  draw_rates("thirteen_eight", rates, 21, "paper: 13 + 8 %",
             "Traversal with k_L = k_R = 500 N m/rad, F_{prop} = 7 N, Rm = 10 N unless said", 100);
  const LandscapeStudy& landscape = f.barriers.at(500);
  return {"thirteen_eight",
          "The 13 % and 8 % of Fig. 9A",
          {"With k_L = k_R = 500 the paper sees 21 of 100 bodies traverse. Here hardly any does. "
           "The landscape's argument: on the paper's grid of 0.5 m the lowest way through rises " +
               fixed(landscape.coarse.above_start, 1) + " J above the start, on one of 0.05 m " +
               fixed(landscape.fine.above_start, 1) +
               " J; a body that has come to rest in the basin must climb " +
               fixed(landscape.fine.above_basin, 0) +
               " J. The start is at rest, so only the work of the random force could lift it, and "
               "hits and dampers take what it gives.",
           "Tried, " + std::to_string(rates.size()) +
               " settings: four methods, the paper's own Euler scheme among them, whose drifting "
               "constraints create energy; that at five steps; other dampings, restitutions, "
               "rates of the random force, starting speeds, random forces, and more propulsion. "
               "The rows show which makes as many traverse. The printed parameters do not give "
               "these two numbers in this model."},
          "Dots with 95 % bars of the traversal share for many settings, beside a line at the "
          "paper's 21 %, which only the largest propulsions reach.",
          {"tried_method", "tried_step", "tried_restitution", "tried_rate", "tried_start",
           "tried_random", "tried_propulsion", "paper_method", "barrier_500"},
          "rates",
          {{"rows", to_json(rates)},
           {"marks", {{{"label", "paper: 13 % + 8 %"}, {"value", 0.21}}}},
           {"unit", "share"}}};
}
}  // namespace gatewalk::cli
