// SPDX-License-Identifier: MIT
#pragma once
/// Where along its sides bodies leave a field, as JSON, as a table and as panels of a figure.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "cli/render/shown_field.h"
#include "lattice/field/exits.h"

namespace gatewalk::cli {

/// A prediction's places as they are shown: 0 as in shown_endings.
[[nodiscard]] lattice::FieldExits shown_exits(lattice::FieldExits exits,
                                              const markov::FinalDistribution& f);
/// The key "exits", by side: the places along it with their bounds, shares and intervals.
void describe_exits(Fields& out, const lattice::FieldExits& exits, const ShownField& shown);
/// The same of the dynamics beside a chain.
void describe_exits(Fields& out, const lattice::FieldExits& dynamics,
                    const lattice::FieldExits& chain, const ShownField& shown);
/// A line for each place that bodies leave at; empty if none does, and for fields too large to
/// print.
[[nodiscard]] std::string table_of(const lattice::FieldExits& exits, const ShownField& shown);
/// Of how many places the chain's share lies outside the interval of the dynamics: "3 of 27".
[[nodiscard]] std::string places_outside(const lattice::FieldExits& dynamics,
                                         const lattice::FieldExits& chain);

/// Height of the panels, and the panels from this height on: bars with 95 % intervals by place
/// along each side. `tag` tells their data from that of others.
[[nodiscard]] double height_of_exits();
void add_exits(Panels& out, const lattice::FieldExits& exits, const ShownField& shown, double top,
               const std::string& tag);

}  // namespace gatewalk::cli
