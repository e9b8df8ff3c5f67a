// SPDX-License-Identifier: MIT
#pragma once
/// Writes a field's chain in the formats of model checkers, and as a sparse matrix.

#include <string>
#include <utility>
#include <vector>

#include "cli/exchange/sparse_table.h"
#include "markov/explicit_chain.h"

namespace gatewalk::cli {

/// A tar archive in the Unified Markov Binary format (version 1), which PRISM reads from version
/// 4.10 and Storm from 1.12. Probabilities are exact to the bit. `command` says how the chain was
/// made.
[[nodiscard]] std::string umb_of(const markov::ExplicitChain& chain, const std::string& command);
/// The chain in Storm's explicit text format (DRN), with labels.
[[nodiscard]] std::string drn_of(const markov::ExplicitChain& chain);
/// PRISM's files of transitions, states and labels. `numbers` gives each state of the chain its
/// number in these files.
struct PrismFiles {
  std::string transitions, states, labels;
};
[[nodiscard]] PrismFiles prism_of(const markov::ExplicitChain& chain,
                                  const std::vector<int>& numbers);

/// The chain as a sparse matrix (states x states), and a CSV table of its states: number, name,
/// column and row of the cell, the state in which the cell is entered, how many cells were entered
/// before, and the ending of absorbing states. `names` are the names of the states in which cells
/// are entered.
[[nodiscard]] SparseTable table_of(const markov::ExplicitChain& chain);
[[nodiscard]] std::vector<std::string> names_of(const markov::ExplicitChain& chain,
                                                const std::vector<std::string>& names);
[[nodiscard]] std::string states_csv(const markov::ExplicitChain& chain,
                                     const std::vector<std::string>& names);

}  // namespace gatewalk::cli
