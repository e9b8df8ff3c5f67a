// SPDX-License-Identifier: MIT
#pragma once
/// First passages to a gate, a state or an ending, as JSON and in words.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "dynamics/cells/state_space.h"
#include "lattice/study/first_passage.h"

namespace gatewalk::cli {

/// What --first-passage asks for, and as it is written there.
struct PassageAsked {
  std::string text;
  markov::PassageTarget target;
};

/// Tables of more numbers than this are left out.
inline constexpr double kMostOfStates = 2e6;
[[nodiscard]] bool has_tables(const markov::FirstPassages& all, std::size_t states);

/// `names`: of the states; tables are (rows x columns x states) of them, in `order`.
[[nodiscard]] Json to_json(const lattice::FirstPassage& f, const PassageAsked& asked,
                           const std::vector<std::string>& names, const std::vector<int>& order);
[[nodiscard]] std::string text_of(const lattice::FirstPassage& f, const PassageAsked& asked);

}  // namespace gatewalk::cli
