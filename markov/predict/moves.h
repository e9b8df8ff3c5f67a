// SPDX-License-Identifier: MIT
#pragma once
/// The moves of chains without moves to a row below, for solutions row by row.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "markov/chain.h"
#include "markov/predict/row_sweeps.h"

namespace gatewalk::markov {

/// A chain's entries by input, with moves within a row of the field apart from moves upwards.
struct Moves {
  struct Entry {
    double p;
    int di_x, di_y, next;
  };
  std::vector<Entry> entries;
  std::vector<double> ends;  // (inputs) probability of the ending in the next draw, in any cell
  std::vector<std::size_t> up,
      side;        // (inputs + 1) first entry of an input; its `side` entries follow its `up`
  int widest = 0;  // largest |di_x| within a row

  Moves(const Chain& chain, Ending ending) {
    for (int input = 0; input < chain.inputs(); ++input) {
      ends.push_back(ending == Ending::unsampled && !chain.is_sampled(input) ? 1.0 : 0.0);
      for (const bool upwards : {true, false}) {
        (upwards ? up : side).push_back(entries.size());
        for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
          const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
          if (exit.next_input == Exit::kTrapped) {
            if (ending == Ending::trapped && upwards) ends.back() += it.value();
          } else if ((exit.di_y > 0) == upwards) {
            entries.push_back({it.value(), exit.di_x, exit.di_y, exit.next_input});
            if (!upwards) widest = std::max(widest, std::abs(exit.di_x));
          }
        }
      }
    }
    up.push_back(entries.size());
  }

  [[nodiscard]] std::vector<RowSweeps::Move> within_row() const {
    std::vector<RowSweeps::Move> within;
    for (int input = 0; input + 1 < std::ssize(up); ++input)
      for (std::size_t i = side[static_cast<std::size_t>(input)];
           i < up[static_cast<std::size_t>(input) + 1]; ++i)
        within.push_back({input, entries[i].next, entries[i].di_x, entries[i].p});
    return within;
  }
};

}  // namespace gatewalk::markov
