// SPDX-License-Identifier: MIT
#pragma once
/// First passages to a gate, a state or an ending, as a result and in words.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/study/first_passage.h"

namespace gatewalk::cli {

/// What --first-passage asks for, and its text.
struct PassageAsked {
  std::string text;
  markov::PassageTarget target;
};

struct PassageResult {
  PassageAsked asked{};
  lattice::FirstPassage found{};
  std::vector<std::string> names{};  // of the chain's states
  std::vector<int> order{};          // the order of states in tables
  /// Whether the tables are given; they are left out above 2 million numbers.
  [[nodiscard]] bool has_tables() const;
};
void describe(Fields& out, const PassageResult& result);
[[nodiscard]] std::string text_of(const PassageResult& result);

}  // namespace gatewalk::cli
