// SPDX-License-Identifier: MIT
#pragma once
/// Starts of trials and of chains, as keys of results and in words.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/field/gate_chain.h"

namespace gatewalk::cli {

/// The keys of an entry: its coordinates' own, with "face" where it is not the first one, and its
/// "name" where it has one. Of a range [from, to] each.
void describe(Fields& out, const dynamics::Section& section, const dynamics::Entry& entry);
void describe(Fields& out, const dynamics::Section& section, const dynamics::StateRange& range);
/// An object of these, the key "start" of most results; "as seen" where there is no entry.
void describe_start(Fields& out, const Label& l, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start);
void describe_start(Fields& out, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start);
/// "  23  -11   16": columns as wide as the numbers of all starts need, of six digits at most.
struct StartTexts {
  std::string header;              // "   d   vx   vy"
  std::vector<std::string> texts;  // (starts)
  StartTexts(const dynamics::Section& section, const std::vector<dynamics::Entry>& starts);
};
[[nodiscard]] std::string start_text(const dynamics::Section& section,
                                     const dynamics::Entry& start);
/// The state of a chain in which bodies start, as it is shown.
struct ShownState {
  int number = 0;   // from 0
  std::string bin;  // the entries that it stands for
  bool clamped = false;
};
[[nodiscard]] ShownState shown_state(const lattice::ChainStart& start,
                                     const dynamics::StateSpace& space);
/// Its keys, and the key "start_state" with these.
void describe(Fields& out, const ShownState& state);
void describe_start_state(Fields& out, const ShownState& state);

}  // namespace gatewalk::cli
