// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "cli/render/fidelity.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

using lattice::FidelityRun;
using lattice::FidelityStudy;

/// How each variant looks.
constexpr std::array<Pen, 4> kLooks{Pen{.colour = kFirstColour, .mark = 7, .size = 0.8},
                                    Pen{.colour = kSecondColour, .mark = 5, .size = 0.8},
                                    Pen{.colour = kThirdColour, .mark = 9, .size = 0.8},
                                    Pen{.colour = kFourthColour, .mark = 13, .size = 0.8}};

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
  Panels out;
  // A line for each variant of each start, from the top down: "line TV TV- TV+ chance ms".
  std::vector<Rows*> rows;
  for (std::size_t v = 0; v < variants; ++v)
    rows.push_back(&out.data(fmt::format("$variant{}", v)));
  std::vector<Tic> tics;
  double most = lattice::kSmallChange, slowest = 0.0;
  for (std::size_t s = 0; s < n; ++s) {
    const lattice::FidelityOfStart& of = study.starts[s];
    const double first = kRow * static_cast<double>(s) + 0.5 * (kRow - 3 * kLine);
    tics.push_back(
        {fmt::format("{}, {}, {}", digits(of.start.d), digits(of.start.vx), digits(of.start.vy)),
         first + 1.5 * kLine});
    for (std::size_t v = 0; v < variants; ++v) {
      const FidelityRun& run = of.runs[v];
      const double line = first + kLine * static_cast<double>(v), ms = 1e3 * run.seconds_per_trial;
      slowest = std::max(slowest, ms);
      if (run.change) {
        const double tv = run.change->apart.total_variation, apart = run.change->uncertainty();
        most = std::max(most, tv + apart);
        rows[v]->add(line, tv, std::max(0.0, tv - apart), tv + apart,
                     run.change->in_pairs.floor_total_variation, ms);
      } else {
        rows[v]->add(line, "NaN NaN NaN NaN", ms);
      }
    }
  }
  const Pen chance{.colour = kInk, .width = 1.2, .mark = 2, .size = 0.7},
      bound{.colour = kInk, .dashes = 2};
  std::vector<Layer> key;
  for (std::size_t v = 0; v < variants; ++v)
    key.push_back(entry("points", kLooks[v % kLooks.size()], plain_name(study, v)));
  out.add_key(8, 30, {key[0], key[1]});
  out.add_key(140, 30, {key[2], key[3]});
  out.add_key(330, 30,
              {entry("points", chance, "chance"),
               entry("lines", bound, "bound " + digits(lattice::kSmallChange))});

  Panel& changes = out.add({100, 330, kTop, bottom});
  changes.say(fmt::format("{} trials; starts: d (m), v_x, v_y (m/s)", study.trials), 8, 16);
  changes.x = {"total variation to active", 0, 1.05 * most, digits(tic_step(most, 4))};
  changes.y = {"", bottom - kTop, 0, tics_of(tics) + " scale 0"};
  changes.grid = std::string("xtics") + kThin;
  changes.uprights.push_back({lattice::kSmallChange, bound});
  Panel& times = out.add({362, 492, kTop, bottom});
  times.x = {fmt::format("ms, {}{}", study.threads, study.threads == 1 ? " thread" : " threads"), 0,
             kFree, digits(tic_step(slowest, 2))};
  times.y = {"", changes.y.low, changes.y.high, kNoTics};
  times.grid = changes.grid;
  for (std::size_t v = 0; v < variants; ++v) {
    Pen pen = kLooks[v % kLooks.size()];
    times.draw(*rows[v], "6:1", "points", pen);
    if (v == 0) continue;
    pen.width = 1.2;
    changes.draw(*rows[v], "2:1:3:4", "xerrorbars", pen);
    changes.draw(*rows[v], "5:1", "points", chance);
  }
  return out.figure(static_cast<int>(bottom + 62));
}

}  // namespace gatewalk::cli
