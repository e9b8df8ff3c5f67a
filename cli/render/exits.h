// SPDX-License-Identifier: MIT
#pragma once
/// Where along its sides bodies leave a field, as JSON, as a table and as panels of a figure.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "cli/render/shown_field.h"
#include "lattice/field/exits.h"

namespace gatewalk::cli {

/// The places of a prediction, with shares rounded to 0 as in shown_endings().
[[nodiscard]] lattice::FieldExits shown_exits(lattice::FieldExits exits,
                                              const markov::FinalDistribution& f);
/// The key "exits", by side: the places along it with their bounds, shares and intervals.
void describe_exits(Fields& out, const lattice::FieldExits& exits, const ShownField& shown);
/// The key "exits" with the shares of the dynamics and of a chain.
void describe_exits(Fields& out, const lattice::FieldExits& dynamics,
                    const lattice::FieldExits& chain, const ShownField& shown);
/// A line for each place at which bodies leave. Empty if none leaves, and for fields too large to
/// print.
[[nodiscard]] std::string table_of(const lattice::FieldExits& exits, const ShownField& shown);
/// The number of places where the chain's share lies outside the interval of the dynamics: "3 of
/// 27".
[[nodiscard]] std::string places_outside(const lattice::FieldExits& dynamics,
                                         const lattice::FieldExits& chain);

/// The height of the panels; and the panels from a height on: bars with 95 % intervals by place
/// along each side. `tag` distinguishes the data of several starts.
[[nodiscard]] double height_of_exits();
void add_exits(Panels& out, const lattice::FieldExits& exits, const ShownField& shown, double top,
               const std::string& tag);

}  // namespace gatewalk::cli
