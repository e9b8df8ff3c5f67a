// SPDX-License-Identifier: MIT
#pragma once
/// What the results of plans, designs and best starts share: how often bodies cross the field, the
/// gain, the search, and numbers by gate.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "lattice/field/field_params.h"
#include "lattice/study/crossings.h"

namespace gatewalk::cli {

/// The keys "crossed" and "crossed_95".
void describe_crossed(Fields& out, std::string_view meaning, const lattice::Crossings& c);
/// The keys "crossed" to "chain", with which results of `plan` begin.
void describe_chance(Fields& out, const lattice::Crossings& c, double chain);
/// The keys "gain" and "gain_95"; null for the reference itself.
void describe_gain(Fields& out, std::string_view meaning, const lattice::Gain& gain);
/// The keys "rounds" to "status".
void describe_search(Fields& out, const lattice::ChoiceSummary& search, double seconds);

/// "Chance to cross`of`: 17.61 [16.87, 18.37] % in 1068 new trials that ...", in lines.
[[nodiscard]] std::string chance_text(const lattice::Crossings& c, std::string_view of = {});
/// "+2.7 [1.4, 3.9]", in percentage points.
[[nodiscard]] std::string gain_text(const lattice::Gain& gain);
/// "`what` gains 2.7 points over `other`.", or that no gain is shown; in lines.
[[nodiscard]] std::string gain_sentence(const lattice::Gain& gain, const std::string& what,
                                        const std::string& other);
/// "From 200000 gate runs in 2 rounds of choosing."
[[nodiscard]] std::string basis_text(const lattice::ChoiceSummary& search);

/// A warning that few trials crossed; empty if there are enough.
[[nodiscard]] std::string few_crossings(const lattice::Crossings& c);

/// A number for each gate as a map, the near row first.
[[nodiscard]] markov::CellProbabilities by_gate(const double* numbers,
                                                const lattice::FieldParams& field);
/// The largest number of columns and rows of a map in a table.
inline constexpr int kMostPrinted = 40;

/// Draws a bar for each of these from `top` on, one below the other. Returns where the bars end.
double add_crossings(Panels& out, double top, const Caption& caption,
                     const std::vector<std::pair<std::string, lattice::Crossings>>& all);

}  // namespace gatewalk::cli
