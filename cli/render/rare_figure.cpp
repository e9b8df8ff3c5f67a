// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/render/rare.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

Figure figure_of(const RareResult& result) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  std::string split, chain, trials;
  double least = 1.0;
  const auto row = [](std::size_t r, double p, const std::array<double, 2>& interval) {
    return std::to_string(r + 1) + " " + digits(p) + " " + digits(interval[0]) + " " +
           digits(interval[1]) + "\n";
  };
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    if (event.chain[r] > 0.0) {
      chain += std::to_string(r + 1) + " " + digits(event.chain[r]) + "\n";
      least = std::min(least, event.chain[r]);
    }
    if (const lattice::RowChance& c = s.rows[r]; c.probability > 0.0) {
      split += row(r, c.probability, c.interval_95());
      least = std::min(least, c.probability);
    }
    if (direct.trials > 0 && direct.entered[r] > 0)
      trials += row(r, static_cast<double>(direct.entered[r]) / static_cast<double>(direct.trials),
                    dynamics::share_interval(direct.entered[r], direct.trials));
  }
  const Sheet sheet{330};
  const Box box{84, 490, 44, 272};
  std::string plot = "plot ";
  if (!chain.empty())
    plot += std::string("$chain using 1:2 with lines lw 2 lc rgb '") + kSecondColour +
            "' title 'chain', ";
  if (!trials.empty())  // beside the others
    plot += std::string("$direct using ($1+0.25):2:3:4 with yerrorbars pt 4 ps 0.5 lc rgb '") +
            kThirdColour + "' title '" + std::to_string(direct.trials) + " direct trials, 95 %', ";
  if (!split.empty())
    plot += std::string("$split using 1:2:3:4 with yerrorbars pt 7 ps 0.5 lc rgb '") +
            kFirstColour + "' title 'splitting, 95 %', ";
  return {
      Sheet::kWidth, sheet.height,
      data_block("$chain", chain) + data_block("$split", split) + data_block("$direct", trials) +
          sheet.margins(box) + sheet.text("How likely a body gets so far", 8, 18) + kFrame +
          "set logscale y\nset format y '10^{%T}'\n" + Sheet::axes("'row entered'", "'chance'") +
          "set xrange [0:" + digits(static_cast<double>(s.rows.size()) + 1.0) + "]\nset yrange [" +
          digits(std::pow(10.0, std::floor(std::log10(least)) - 0.2)) +
          ":2]\nset key on bottom left Left reverse samplen 1.5 width -4\n" + plot + "\n",
      kFont};
}

}  // namespace gatewalk::cli
