// SPDX-License-Identifier: MIT
#pragma once
/// A field's chain in the formats of model checkers, and as a sparse matrix.

#include <string>
#include <utility>
#include <vector>

#include "cli/exchange/sparse_table.h"
#include "markov/explicit_chain.h"

namespace gatewalk::cli {

/// A tar of the Unified Markov Binary format (version 1): read by PRISM from 4.10, Storm from 1.12.
/// `command`: how it was made. Bit-exact.
[[nodiscard]] std::string umb_of(const markov::ExplicitChain& chain, const std::string& command);
/// Storm's explicit text, with labels.
[[nodiscard]] std::string drn_of(const markov::ExplicitChain& chain);
/// PRISM's transitions, states and labels. `numbers`: as which number each state of the chain is
/// written.
struct PrismFiles {
  std::string transitions, states, labels;
};
[[nodiscard]] PrismFiles prism_of(const markov::ExplicitChain& chain,
                                  const std::vector<int>& numbers);

/// The same as a sparse matrix, (states x states), and a table of its states: number, name, i_x and
/// i_y of the cell, the state in which it is entered, how many were entered before, and the ending
/// of those that are never left. `names`: of the states in which cells are entered.
[[nodiscard]] SparseTable table_of(const markov::ExplicitChain& chain);
[[nodiscard]] std::vector<std::string> names_of(const markov::ExplicitChain& chain,
                                                const std::vector<std::string>& names);
[[nodiscard]] std::string states_csv(const markov::ExplicitChain& chain,
                                     const std::vector<std::string>& names);

}  // namespace gatewalk::cli
