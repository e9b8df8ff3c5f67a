// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "cli/render/fidelity.h"
#include "cli/render/figure.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::FidelityRun;
using lattice::FidelityStudy;

/// Colour and marker of each variant.
constexpr std::array<const char*, 4> kLooks{"pt 7 lc rgb '#0072b2'", "pt 5 lc rgb '#d55e00'",
                                            "pt 9 lc rgb '#009e73'", "pt 13 lc rgb '#cc79a7'"};

/// What a key calls a variant.
std::string plain_name(const FidelityStudy& study, std::size_t v) {
  const lattice::Scene& scene = study.variants[v].scene;
  return std::string(name_of(scene.field.fidelity)) +
         (v == 3 ? ", method " + scene.gate.run.method : "");
}

}  // namespace

Figure figure_of(const FidelityStudy& study) {
  constexpr double kLine = 15, kRow = 4 * kLine + 12, kTop = 92;
  const std::size_t n = study.starts.size(), variants = study.variants.size();
  const double bottom = kTop + kRow * static_cast<double>(n);
  const Box changes{100, 330, kTop, bottom}, times{362, 492, kTop, bottom};
  const Sheet sheet{static_cast<int>(bottom + 62)};
  // A line for each variant of each start, from the top down.
  std::vector<std::string> rows(variants);  // "line TV TV- TV+ chance ms"
  std::string tics;
  double most = lattice::kSmallChange, slowest = 0.0;
  for (std::size_t s = 0; s < n; ++s) {
    const lattice::FidelityOfStart& of = study.starts[s];
    const double first = kRow * static_cast<double>(s) + 0.5 * (kRow - 3 * kLine);
    tics += (s ? ", '" : "'") + digits(of.start.d) + ", " + digits(of.start.vx) + ", " +
            digits(of.start.vy) + "' " + digits(first + 1.5 * kLine);
    for (std::size_t v = 0; v < variants; ++v) {
      const FidelityRun& run = of.runs[v];
      slowest = std::max(slowest, 1e3 * run.seconds_per_trial);
      std::string change = "NaN NaN NaN NaN";
      if (run.change) {
        const double tv = run.change->apart.total_variation, apart = run.change->uncertainty();
        most = std::max(most, tv + apart);
        change = digits(tv) + " " + digits(std::max(0.0, tv - apart)) + " " + digits(tv + apart) +
                 " " + digits(run.change->in_pairs.floor_total_variation);
      }
      rows[v] += digits(first + kLine * static_cast<double>(v)) + " " + change + " " +
                 digits(1e3 * run.seconds_per_trial) + "\n";
    }
  }
  std::string blocks, left, right;
  std::vector<std::string> entries;
  for (std::size_t v = 0; v < variants; ++v) {
    const std::string name = "$variant" + std::to_string(v), look = kLooks[v % kLooks.size()];
    blocks += data_block(name, rows[v]);
    if (v > 0)
      left += ", " + name + " using 2:1:3:4 with xerrorbars ps 0.8 lw 1.2 " + look + ", " + name +
              " using 5:1 with points pt 2 ps 0.7 lw 1.2 lt -1";
    right += (v ? ", " : "plot ") + name + " using 6:1 with points ps 0.8 " + look;
    entries.push_back("with points ps 0.8 " + look + " title '" + plain_name(study, v) + "'");
  }
  entries.push_back("with points pt 2 ps 0.7 lw 1.2 lt -1 title 'chance'");
  const std::string bound = digits(lattice::kSmallChange);
  entries.push_back("with lines lt -1 dt 2 title 'bound " + bound + "'");
  return {Sheet::kWidth, sheet.height,
          blocks + "set multiplot\n" + sheet.key(8, 30, {entries[0], entries[1]}) +
              sheet.key(140, 30, {entries[2], entries[3]}) +
              sheet.key(330, 30, {entries[4], entries[5]}) + kFrame + "set grid xtics" + kThin +
              "\nset yrange [" + digits(bottom - kTop) + ":0]\nset ytics (" + tics +
              ") scale 0\nset xrange [0:" + digits(1.05 * most) + "]\nset xtics " +
              digits(tic_step(most, 4)) + "\n" +
              sheet.text(std::to_string(study.trials) + " trials; starts: d (m), v_x, v_y (m/s)", 8,
                         16) +
              sheet.margins(changes) + Sheet::x_axis("'total variation to active'") +
              "set arrow from " + bound + ", graph 0 to " + bound +
              ", graph 1 nohead lt -1 dt 2\nplot NaN" + left + "\nunset label\nunset arrow\n" +
              sheet.margins(times) + "unset ytics\nset xrange [0:*]\nset xtics " +
              digits(tic_step(slowest, 2)) + "\n" +
              Sheet::x_axis("'ms, " + std::to_string(study.threads) +
                            (study.threads == 1 ? " thread'" : " threads'")) +
              right + "\nunset multiplot\n",
          kFont};
}

}  // namespace gatewalk::cli
