// SPDX-License-Identifier: MIT
#pragma once
/// Starts of trials and chains, as keys of results and in words.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/field/gate_chain.h"

namespace gatewalk::cli {

/// The keys of an entry: its coordinates, "face" if it is not the first face, and "name" if the
/// entry has one. For a range, each coordinate is [from, to].
void describe(Fields& out, const dynamics::Section& section, const dynamics::Entry& entry);
void describe(Fields& out, const dynamics::Section& section, const dynamics::StateRange& range);
/// The key "start" of most results: an object with the keys of an entry; the text "as seen" without
/// an entry.
void describe_start(Fields& out, const Label& l, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start);
void describe_start(Fields& out, const dynamics::Section& section,
                    const std::optional<dynamics::Entry>& start);
/// Texts of starts in aligned columns, with at most six digits: "  23  -11   16".
struct StartTexts {
  std::string header;              // "   d   vx   vy"
  std::vector<std::string> texts;  // (starts)
  StartTexts(const dynamics::Section& section, const std::vector<dynamics::Entry>& starts);
};
[[nodiscard]] std::string start_text(const dynamics::Section& section,
                                     const dynamics::Entry& start);
/// The state of a chain in which bodies start, as results show it.
struct ShownState {
  int number = 0;   // from 0
  std::string bin;  // the range of entries in this state
  bool clamped = false;
};
[[nodiscard]] ShownState shown_state(const lattice::ChainStart& start,
                                     const dynamics::StateSpace& space);
/// The keys of `state`; and the key "start_state".
void describe(Fields& out, const ShownState& state);
void describe_start_state(Fields& out, const ShownState& state);

}  // namespace gatewalk::cli
