// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/render/panel.h"
#include "cli/render/rare.h"

namespace gatewalk::cli {

Figure figure_of(const RareResult& result) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  Panels out;
  Rows &chain = out.data("$chain"), &split = out.data("$split"), &trials = out.data("$direct");
  double least = 1.0;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    if (event.chain[r] > 0.0) {
      chain.add(r + 1, event.chain[r]);
      least = std::min(least, event.chain[r]);
    }
    if (const lattice::RowChance& c = s.rows[r]; c.probability > 0.0) {
      split.add(r + 1, c.probability, c.interval_95());
      least = std::min(least, c.probability);
    }
    if (const std::int64_t n = direct.trials; n > 0 && direct.entered[r] > 0)
      trials.add(r + 1, static_cast<double>(direct.entered[r]) / static_cast<double>(n),
                 dynamics::share_interval(direct.entered[r], n));
  }
  Panel& p = out.add({84, 490, 44, 272});
  p.say("How likely a body gets so far", 8, 18);
  p.x = {"row entered", 0, static_cast<double>(s.rows.size()) + 1.0};
  p.y = {"chance", std::pow(10.0, std::floor(std::log10(least)) - 0.2), 2, "", "10^{%T}"};
  p.y.logarithmic = true;
  p.key = {"on bottom left Left reverse samplen 1.5 width -4"};
  p.draw(chain, "1:2", "lines", {.colour = kSecondColour, .width = 2}, "chain");
  p.draw(trials, "($1+0.25):2:3:4", "yerrorbars",  // beside the others
         {.colour = kThirdColour, .mark = 4, .size = 0.5},
         fmt::format("{} direct trials, 95 %", direct.trials));
  p.draw(split, "1:2:3:4", "yerrorbars", {.colour = kFirstColour, .mark = 7, .size = 0.5},
         "splitting, 95 %");
  return out.figure(330);
}

}  // namespace gatewalk::cli
